#include "openni2_sensor/open_ni.h"

#include "core/error.h"

#include <OpenNI.h>
#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

namespace toile::openni2_sensor {
namespace {

namespace fs = std::filesystem;

/// Paths that recordings were opened by, in the whole process: OpenNI2 lists them as devices for
/// good.
class Leases {
  public:
    static Leases& instance() {
        static auto* const leases = new Leases; // addresses may outlive everything static
        return *leases;
    }
    /// The file by a path that nobody has: dots are put in as long as somebody does.
    Address take(const fs::path& file) {
        const std::scoped_lock lock(mutex_);
        fs::path path = file;
        while (!taken_.insert(path.string()).second)
            path = path.parent_path() / "." / path.filename();
        const std::string name = path.string();
        known_.insert(name);
        return {name, true, std::shared_ptr<const void>(this, [this, name](const void*) {
                    const std::scoped_lock release(mutex_);
                    taken_.erase(name);
                })};
    }
    [[nodiscard]] bool is_recording(const std::string& uri) {
        const std::scoped_lock lock(mutex_);
        return known_.contains(uri);
    }

  private:
    std::mutex mutex_;
    std::set<std::string> taken_, known_;
};

bool is_number(const std::string& text) {
    return !text.empty() && text.size() < 4 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void check_recording(const fs::path& file) {
    if (!fs::is_regular_file(file)) throw FileError(file.string(), "there is no such recording");
    std::array<char, 4> magic{};
    std::ifstream(file, std::ios::binary).read(magic.data(), magic.size());
    if (std::string(magic.data(), magic.size()) != "NI10")
        throw FileError(file.string(), "is no OpenNI recording (does not begin with NI10)");
}

std::string what_there_is(const std::vector<DeviceName>& devices) {
    if (devices.empty())
        return "OpenNI2 sees no camera: connect one; its driver must stand in OpenNI2/Drivers "
               "beside "
               "libOpenNI2 (Kinects need one of their own), and udev must let this user read the "
               "USB device";
    std::string out = "there are:";
    for (std::size_t i = 0; i < devices.size(); ++i)
        out += " [" + std::to_string(i) + "] " + devices[i].vendor + " " + devices[i].name + " (" +
               devices[i].uri + ")";
    return out;
}

} // namespace

struct OpenNiLibrary::Queue {
    std::mutex mutex;
    std::condition_variable filled;
    std::deque<std::function<void()>> works;

    [[noreturn]] void run() {
        for (;;) {
            std::unique_lock lock(mutex);
            filled.wait(lock, [&] { return !works.empty(); });
            const auto work = std::move(works.front());
            works.pop_front();
            lock.unlock();
            work();
        }
    }
};

const OpenNiLibrary& OpenNiLibrary::running() {
    static const OpenNiLibrary* const library = new OpenNiLibrary();
    return *library;
}

OpenNiLibrary::OpenNiLibrary() : queue_(std::make_shared<Queue>()) {
    std::thread([queue = queue_] { queue->run(); }).detach();
    post([] {
        if (openni::OpenNI::initialize() != openni::STATUS_OK)
            throw Error(std::string("OpenNI2 does not start: ") +
                        openni::OpenNI::getExtendedError());
    }).get();
}

void OpenNiLibrary::enqueue(std::function<void()> work) const {
    const std::scoped_lock lock(queue_->mutex);
    queue_->works.push_back(std::move(work));
    queue_->filled.notify_one();
}

std::vector<DeviceName> list_devices(const OpenNiLibrary&) {
    openni::Array<openni::DeviceInfo> found;
    openni::OpenNI::enumerateDevices(&found);
    std::vector<DeviceName> out;
    for (int i = 0; i < found.getSize(); ++i) {
        if (Leases::instance().is_recording(found[i].getUri())) continue;
        out.push_back({found[i].getUri(), found[i].getVendor(), found[i].getName()});
    }
    return out;
}

Address resolve(const std::string& source, const OpenNiLibrary& library) {
    const bool names_file = fs::path(source).extension() == ".oni" || fs::is_regular_file(source);
    if (names_file) {
        check_recording(source);
        return Leases::instance().take(source);
    }
    const auto devices = list_devices(library);
    const std::size_t index = source.empty()      ? 0
                              : is_number(source) ? std::stoul(source)
                                                  : devices.size();
    if (source.empty() || is_number(source)) {
        if (index < devices.size()) return {devices[index].uri, false, nullptr};
        throw Error("openni2:" + source + ": no such camera; " + what_there_is(devices));
    }
    const bool known = std::any_of(devices.begin(), devices.end(),
                                   [&](const DeviceName& d) { return d.uri == source; });
    if (!known) throw Error("openni2:" + source + ": no such camera; " + what_there_is(devices));
    return {source, false, nullptr};
}

} // namespace toile::openni2_sensor
