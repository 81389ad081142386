#include "allocations/allocation_counter.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <execinfo.h>

// What glibc's own functions are called underneath.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace toile::test {
namespace {

constexpr int kDeepestStack = 24;

std::atomic<bool> counting = false;
std::atomic<std::uint64_t> allocations = 0;
std::array<void*, kDeepestStack> first_stack;
std::atomic<int> first_depth = 0;

void note() noexcept {
    if (!counting.load(std::memory_order_relaxed)) return;
    if (allocations.fetch_add(1) > 0) return;
    first_depth = backtrace(first_stack.data(), kDeepestStack);
}

} // namespace

AllocationCount::AllocationCount() noexcept {
    std::array<void*, 1> unused;
    (void)backtrace(unused.data(), 1); // its first call loads a library
    allocations = 0;
    first_depth = 0;
    counting = true;
}

AllocationCount::~AllocationCount() {
    counting = false;
}

std::uint64_t AllocationCount::stop() noexcept {
    counting = false;
    return allocations;
}

std::string AllocationCount::first() {
    std::string out;
    char** lines = backtrace_symbols(first_stack.data(), first_depth);
    for (int i = 0; lines != nullptr && i < first_depth; ++i)
        out += std::string(lines[i]) + "\n";
    std::free(lines);
    return out;
}

} // namespace toile::test

#define TOILE_EXPORT __attribute__((visibility("default")))

extern "C" {

TOILE_EXPORT void* malloc(std::size_t bytes) {
    toile::test::note();
    return __libc_malloc(bytes);
}

TOILE_EXPORT void* calloc(std::size_t count, std::size_t bytes) {
    toile::test::note();
    return __libc_calloc(count, bytes);
}

TOILE_EXPORT void* realloc(void* block, std::size_t bytes) {
    toile::test::note();
    return __libc_realloc(block, bytes);
}

TOILE_EXPORT void* memalign(std::size_t alignment, std::size_t bytes) {
    toile::test::note();
    return __libc_memalign(alignment, bytes);
}

TOILE_EXPORT void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    return memalign(alignment, bytes);
}

TOILE_EXPORT int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
    *block = memalign(alignment, bytes);
    return *block == nullptr ? ENOMEM : 0;
}
}
