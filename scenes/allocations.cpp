// Counting allocations with the program's counter.
#include "scenes/allocations.h"

namespace avbd::scenes {
namespace {

AllocationCount& lent() {
  static AllocationCount count = nullptr;
  return count;
}

}  // namespace

void lendAllocationCount(AllocationCount count) { lent() = count; }
AllocationCount allocationCount() { return lent(); }

}  // namespace avbd::scenes
