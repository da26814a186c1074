// Events of the last step and the contact hook.
#include "api/world_impl.h"
#include "world/check.h"

namespace avbd {

const Events& World::events() const { return impl_->data.events; }
void World::setContactHook(std::function<bool(ContactPlan&)> hook) { impl_->data.contactHook = std::move(hook); }

namespace {

ShapeData& shapeOf(WorldData& data, ShapeId id, const char* call) {
  return data.shapes[slotOf(data, id, Path(call) / "id")];
}

void wish(WorldData& data, bool& flag, bool wanted) {
  data.wishesChanged = data.wishesChanged || flag != wanted;
  flag = wanted;
}

}  // namespace

bool World::isTrigger(ShapeId id) const { return shapeOf(impl_->data, id, "World::isTrigger").isTrigger; }
bool World::contactEvents(ShapeId id) const { return shapeOf(impl_->data, id, "World::contactEvents").contactEvents; }
bool World::hitEvents(ShapeId id) const { return shapeOf(impl_->data, id, "World::hitEvents").hitEvents; }
bool World::contactHook(ShapeId id) const { return shapeOf(impl_->data, id, "World::contactHook").contactHook; }

void World::setContactEvents(ShapeId id, bool wanted) {
  wish(impl_->data, shapeOf(impl_->data, id, "World::setContactEvents").contactEvents, wanted);
}

void World::setHitEvents(ShapeId id, bool wanted) {
  wish(impl_->data, shapeOf(impl_->data, id, "World::setHitEvents").hitEvents, wanted);
}

void World::setContactHook(ShapeId id, bool wanted) {
  bool& flag = shapeOf(impl_->data, id, "World::setContactHook").contactHook;
  impl_->data.hookedShapes = impl_->data.hookedShapes + wanted - flag;
  wish(impl_->data, flag, wanted);
}

}  // namespace avbd
