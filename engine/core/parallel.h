// Loops over independent items on all cores, for set-up and training; frames use the host's pool.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace toile {

/// Calls `work(i)` once for each i in [0, count), in any order, on as many threads as there are
/// cores. Results must not depend on the order. The first exception is thrown again when all
/// threads have stopped.
template <class Work>
void parallel_for(std::size_t count, Work&& work) {
    const std::size_t threads =
        std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex guard;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++)
            try {
                work(i);
            } catch (...) {
                const std::lock_guard lock(guard);
                if (!failure) failure = std::current_exception();
                next = count;
            }
    };
    std::vector<std::jthread> pool;
    for (std::size_t t = 1; t < threads; ++t)
        pool.emplace_back(run);
    run();
    pool.clear();
    if (failure) std::rethrow_exception(failure);
}

} // namespace toile
