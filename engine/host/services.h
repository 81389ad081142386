// What the host offers to every plugin instance: the thread pool and the limits of its threads.
#pragma once

#include "abi/host.h"
#include "core/row_loop.h"

#include <cstdint>
#include <memory>
#include <string>

namespace toile::host {

/// One for the program; outlives every instance. [any thread]
class Services {
  public:
    /// `threads` 0: all cores.
    explicit Services(std::uint32_t threads = 0);
    ~Services();
    Services(const Services&) = delete;
    Services& operator=(const Services&) = delete;

    [[nodiscard]] std::uint32_t thread_count() const noexcept;

    /// body(user, begin, end) over ranges [k grain, (k+1) grain) of [0, count); returns when all
    /// are done. What a body throws is caught; false then.
    bool parallel_for(std::uint32_t count, std::uint32_t grain, void* user,
                      void (*body)(void* user, std::uint32_t begin, std::uint32_t end)) noexcept;

  private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
};

/// `parallel_for` as a loop over ranges; `services` must outlive it. The loop throws Error when a
/// range failed.
[[nodiscard]] RowLoop rows_of(Services& services);

/// The toile_host of one instance: copies what the plugin reports. Outlives the instance.
class InstanceHost {
  public:
    InstanceHost(Services& services, std::string plugin_id);
    ~InstanceHost();
    InstanceHost(const InstanceHost&) = delete;
    InstanceHost& operator=(const InstanceHost&) = delete;

    [[nodiscard]] const toile_host* handle() const noexcept { return &host_; }
    /// The last error text that was reported, and forgets it; empty when there is none.
    [[nodiscard]] std::string take_error();

  private:
    static const void* get_extension(const toile_host* host, const char* id) noexcept;
    static void report(const toile_host* host, std::int32_t level, toile_status code,
                       const char* text) noexcept;

    struct State;
    std::unique_ptr<State> state_;
    toile_host host_{};
};

} // namespace toile::host
