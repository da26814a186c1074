// The flag that a signal sets.
#include <atomic>

#include "app/command_line.h"
#include "app/failure.h"

namespace avbd::cli {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void requestStop() noexcept { requested = true; }

void throwIfStopped() {
  if (requested.exchange(false)) throw Stopped{};
}

}  // namespace avbd::cli
