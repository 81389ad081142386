// Counts what a program allocates: allocation_counter.cpp replaces malloc and its kin, and with
// them operator new, in the program and in every library that it loads.
#pragma once

#include <cstdint>
#include <string>

namespace toile::test {

/// Counts the allocations of all threads from its construction to `stop`. One at a time.
class AllocationCount {
  public:
    AllocationCount() noexcept;
    ~AllocationCount();
    AllocationCount(const AllocationCount&) = delete;
    AllocationCount& operator=(const AllocationCount&) = delete;

    /// Ends the counting; the number of allocations.
    std::uint64_t stop() noexcept;
    /// Call stack of the first one, one frame a line (for addr2line); empty when there was none.
    [[nodiscard]] static std::string first();
};

} // namespace toile::test
