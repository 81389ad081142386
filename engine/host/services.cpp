#include "host/services.h"

#include "core/error.h"
#include "core/log.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <optional>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace toile::host {

struct Services::Arena {
    explicit Arena(int threads) : arena(threads) {
        // More threads than cores are given only when asked for by name.
        if (threads > tbb::this_task_arena::max_concurrency())
            more.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(threads));
    }
    std::optional<tbb::global_control> more;
    tbb::task_arena arena;
};

Services::Services(std::uint32_t threads)
    : arena_(std::make_unique<Arena>(threads == 0 ? tbb::task_arena::automatic
                                                  : static_cast<int>(std::min(threads, 1024u)))) {}

Services::~Services() = default;

std::uint32_t Services::thread_count() const noexcept {
    return static_cast<std::uint32_t>(std::max(1, arena_->arena.max_concurrency()));
}

bool Services::parallel_for(std::uint32_t count, std::uint32_t grain, void* user,
                            void (*body)(void*, std::uint32_t, std::uint32_t)) noexcept {
    if (count == 0) return true;
    grain = std::max(1u, grain);
    const std::uint32_t ranges = count / grain + (count % grain != 0 ? 1 : 0);
    std::atomic<bool> threw = false;
    const auto run = [&](std::uint32_t range) {
        const std::uint32_t begin = range * grain;
        try {
            body(user, begin, begin + std::min(grain, count - begin));
        } catch (...) {
            threw = true;
        }
    };
    if (ranges == 1 || thread_count() == 1) {
        for (std::uint32_t range = 0; range < ranges; ++range)
            run(range);
    } else {
        arena_->arena.execute([&] { tbb::parallel_for(0u, ranges, run); });
    }
    return !threw;
}

RowLoop rows_of(Services& services) {
    using Work = std::function<void(std::uint32_t, std::uint32_t)>;
    return [&services](std::uint32_t count, std::uint32_t grain, const Work& work) {
        Work copy = work;
        const auto run = [](void* user, std::uint32_t begin, std::uint32_t end) {
            (*static_cast<Work*>(user))(begin, end);
        };
        if (!services.parallel_for(count, grain, &copy, run)) throw Error("out of memory");
    };
}

struct InstanceHost::State {
    Services* services;
    std::string id;
    std::mutex mutex; // guards error; never held while a plugin is called
    std::string error;
};

namespace {

log::Level to_log(std::int32_t level) {
    switch (level) {
    case TOILE_LOG_DEBUG:
        return log::Level::debug;
    case TOILE_LOG_INFO:
        return log::Level::info;
    case TOILE_LOG_WARNING:
    case TOILE_LOG_HOST_BUG:
    case TOILE_LOG_PLUGIN_BUG:
        return log::Level::warning;
    // Errors come back as the failing call's Error; saying them here too would say them twice.
    default:
        return log::Level::debug;
    }
}

// One line of printable text, whatever the plugin sent.
std::string one_line(const char* text) {
    constexpr std::size_t longest = 500;
    std::string out(text, strnlen(text, longest));
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return out;
}

} // namespace

InstanceHost::InstanceHost(Services& services, std::string plugin_id)
    : state_(std::make_unique<State>()) {
    state_->services = &services;
    state_->id = std::move(plugin_id);
    host_.size = sizeof(toile_host);
    host_.abi_minor = TOILE_ABI_MINOR;
    host_.host_data = state_.get();
    host_.host_version = TOILE_VERSION;
    host_.get_extension = &get_extension;
    host_.report = &report;
}

InstanceHost::~InstanceHost() = default;

std::string InstanceHost::take_error() {
    const std::lock_guard lock(state_->mutex);
    return std::exchange(state_->error, {});
}

const void* InstanceHost::get_extension(const toile_host*, const char* id) noexcept {
    static constexpr toile_thread_pool pool{
        sizeof(toile_thread_pool), 0,
        [](const toile_host* host) {
            return static_cast<State*>(host->host_data)->services->thread_count();
        },
        [](const toile_host* host, std::uint32_t count, std::uint32_t grain, void* user,
           void (*body)(void*, std::uint32_t, std::uint32_t)) {
            if (body == nullptr) return;
            if (!static_cast<State*>(host->host_data)
                     ->services->parallel_for(count, grain, user, body))
                report(host, TOILE_LOG_PLUGIN_BUG, TOILE_E_INTERNAL,
                       "the body of a parallel loop threw an exception");
        }};
    return id != nullptr && std::strcmp(id, TOILE_THREAD_POOL) == 0 ? &pool : nullptr;
}

void InstanceHost::report(const toile_host* host, std::int32_t level, toile_status,
                          const char* text) noexcept {
    if (host == nullptr || text == nullptr) return;
    try {
        State& state = *static_cast<State*>(host->host_data);
        const std::string line = one_line(text);
        log::write(to_log(level), state.id + ": " + line);
        if (level >= TOILE_LOG_ERROR) {
            const std::lock_guard lock(state.mutex);
            state.error = line;
        }
    } catch (...) { // out of memory: the text is lost, the status is not
    }
}

} // namespace toile::host
