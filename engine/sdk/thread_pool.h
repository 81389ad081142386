// Parallel loops on the host's threads; plugins start none of their own.
#pragma once

#include "sdk/host.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <mutex>

namespace toile::sdk {

/// Ranges depend on count and grain only, so that a result written per element, or reduced per
/// range in order, has the same bytes for any thread count.
class ThreadPool {
  public:
    explicit ThreadPool(Host host) noexcept
        : host_(host), pool_(host.extension<toile_thread_pool>(TOILE_THREAD_POOL)) {}

    /// At least 1.
    [[nodiscard]] std::uint32_t thread_count() const noexcept {
        return pool_ == nullptr ? 1 : std::max(1u, pool_->thread_count(host_.handle()));
    }

    /// body(begin, end) over ranges [k grain, (k+1) grain) that cover [0, count); returns when all
    /// are done. Serial where the host has no pool. What body throws is thrown here: of several,
    /// that of the lowest range.
    template <class Body>
    void parallel_for(std::uint32_t count, std::uint32_t grain, const Body& body) const {
        grain = std::max(1u, grain);
        if (pool_ == nullptr) {
            for (std::uint32_t begin = 0; begin < count; begin += std::min(grain, count - begin))
                body(begin, begin + std::min(grain, count - begin));
            return;
        }
        Call<Body> call{&body, {}, nullptr, UINT32_MAX};
        pool_->parallel_for(host_.handle(), count, grain, &call, &Call<Body>::run);
        if (call.error) std::rethrow_exception(call.error);
    }

  private:
    template <class Body>
    struct Call {
        const Body* body;
        std::mutex mutex; // taken by a failing range only
        std::exception_ptr error;
        std::uint32_t error_begin;

        static void run(void* user, std::uint32_t begin, std::uint32_t end) {
            auto& self = *static_cast<Call*>(user);
            try {
                (*self.body)(begin, end);
            } catch (...) {
                const std::lock_guard lock(self.mutex);
                if (begin <= self.error_begin) {
                    self.error = std::current_exception();
                    self.error_begin = begin;
                }
            }
        }
    };

    Host host_;
    const toile_thread_pool* pool_;
};

} // namespace toile::sdk
