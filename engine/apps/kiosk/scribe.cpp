#include "apps/kiosk/scribe.h"

#include "apps/kiosk/whole_file.h"
#include "core/error.h"

#include <utility>

namespace toile::apps::kiosk {

Scribe::Scribe(bool at_once) : at_once_(at_once) {
    if (!at_once_) thread_ = std::thread([this] { run(); });
}

Scribe::~Scribe() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Scribe::put(const Sheet& sheet) {
    try {
        if (fail_next_.exchange(false))
            throw FileError(sheet.file.string(), "cannot be written (is the disk full?)");
        write_whole(sheet.file, sheet.bytes);
    } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        errors_.emplace_back(e.what());
    }
}

void Scribe::write(std::filesystem::path file, std::string bytes) {
    Sheet sheet{std::move(file), std::move(bytes)};
    if (at_once_) {
        put(sheet);
        return;
    }
    const std::lock_guard lock(mutex_);
    // A disk that hangs: the newest of each file is enough.
    std::erase_if(sheets_, [&](const Sheet& old) { return old.file == sheet.file; });
    sheets_.push_back(std::move(sheet));
    wake_.notify_one();
}

void Scribe::run() {
    for (;;) {
        Sheet sheet;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stop_ || !sheets_.empty(); });
            if (sheets_.empty()) return; // what was asked for is written before the end
            sheet = std::move(sheets_.front());
            sheets_.pop_front();
        }
        put(sheet);
    }
}

std::vector<std::string> Scribe::take_errors() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock.owns_lock() ? std::exchange(errors_, {}) : std::vector<std::string>{};
}

} // namespace toile::apps::kiosk
