// Counting allocations: only a program that replaces operator new can do it, so it lends its counter.
#pragma once

#include <cstdint>

namespace avbd::scenes {

using AllocationCount = uint64_t (*)();

/// Lends the program's count of allocations so far; without it the line no_allocation is skipped. Call before lines().
void lendAllocationCount(AllocationCount count);
/// Null where none was lent.
AllocationCount allocationCount();

}  // namespace avbd::scenes
