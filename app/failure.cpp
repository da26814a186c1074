// The flag that a signal sets, and words for what the world threw.
#include "app/failure.h"

#include <atomic>

#include "app/command_line.h"
#include "app/number_text.h"

namespace avbd::cli {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void requestStop() noexcept { requested = true; }

void throwIfStopped() {
  if (requested.exchange(false)) throw Stopped{};
}

NonFiniteRun nonFiniteRun(const Model& model, const NonFiniteError& error, int64_t step, double time) {
  std::string name = "number " + std::to_string(error.bodyIndex());
  for (const NamedBody& body : model.bodies)
    if (body.id.index == error.bodyIndex() && body.id.generation == error.bodyGeneration())
      name = "\"" + body.name + "\"";
  return NonFiniteRun("step " + std::to_string(step) + " (time " + digits(time, 6) + " s): body " + name +
                      " left the finite numbers in stage " + error.stage());
}

}  // namespace avbd::cli
