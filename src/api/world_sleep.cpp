// Sleep: asking and telling.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/sleep.h"

namespace avbd {

bool World::isAwake(BodyId id) const {
  return avbd::isAwake(impl_->data, slotOf(impl_->data, id, Path("World::isAwake") / "id"));
}

void World::wake(BodyId id) { wakeBody(impl_->data, slotOf(impl_->data, id, Path("World::wake") / "id")); }
void World::wakeAll() { avbd::wakeAll(impl_->data); }

void World::putToSleep(BodyId id) {
  avbd::putToSleep(impl_->data, dynamicSlotOf(impl_->data, id, Path("World::putToSleep") / "id"));
}

bool World::canSleep(BodyId id) const {
  return impl_->data.bodies[slotOf(impl_->data, id, Path("World::canSleep") / "id")].canSleep;
}

void World::setCanSleep(BodyId id, bool canSleep) {
  const uint32_t slot = slotOf(impl_->data, id, Path("World::setCanSleep") / "id");
  if (isDynamic(impl_->data, slot) && !canSleep) wakeBody(impl_->data, slot);
  impl_->data.bodies[slot].canSleep = canSleep;
}

}  // namespace avbd
