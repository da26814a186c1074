// Events of the last step and the contact hook.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/sleep.h"

namespace avbd {

const Events& World::events() const { return impl_->data.events; }
void World::setContactHook(std::function<bool(ContactPlan&)> hook) {
  avbd::wakeAll(impl_->data);
  impl_->data.contactHook = std::move(hook);
}

namespace {

ShapeData& shapeOf(WorldData& data, ShapeId id, const char* call) {
  return data.shapes[slotOf(data, id, Path(call) / "id")];
}

void wish(WorldData& data, const ShapeData& shape, bool& flag, bool wanted) {
  if (flag != wanted) wakeBody(data, shape.body);
  data.wishesChanged = data.wishesChanged || flag != wanted;
  flag = wanted;
}

/// Whether the flag of any point's shape is set.
bool anyWishes(const WorldData& data, SoftId id, const char* call, bool ShapeData::*flag) {
  for (const uint32_t body : data.softs[slotOf(data, id, Path(call) / "id")].bodies)
    for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next)
      if (data.shapes[s].*flag) return true;
  return false;
}

void wishAll(WorldData& data, SoftId id, const char* call, bool ShapeData::*flag, bool wanted) {
  for (const uint32_t body : data.softs[slotOf(data, id, Path(call) / "id")].bodies)
    for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next)
      wish(data, data.shapes[s], data.shapes[s].*flag, wanted);
}

}  // namespace

bool World::isTrigger(ShapeId id) const { return shapeOf(impl_->data, id, "World::isTrigger").isTrigger; }
bool World::contactEvents(ShapeId id) const { return shapeOf(impl_->data, id, "World::contactEvents").contactEvents; }
bool World::hitEvents(ShapeId id) const { return shapeOf(impl_->data, id, "World::hitEvents").hitEvents; }
bool World::contactHook(ShapeId id) const { return shapeOf(impl_->data, id, "World::contactHook").contactHook; }

void World::setContactEvents(ShapeId id, bool wanted) {
  ShapeData& shape = shapeOf(impl_->data, id, "World::setContactEvents");
  wish(impl_->data, shape, shape.contactEvents, wanted);
}

void World::setHitEvents(ShapeId id, bool wanted) {
  ShapeData& shape = shapeOf(impl_->data, id, "World::setHitEvents");
  wish(impl_->data, shape, shape.hitEvents, wanted);
}

void World::setContactHook(ShapeId id, bool wanted) {
  ShapeData& shape = shapeOf(impl_->data, id, "World::setContactHook");
  impl_->data.hookedShapes = impl_->data.hookedShapes + wanted - shape.contactHook;
  wish(impl_->data, shape, shape.contactHook, wanted);
}

bool World::contactEvents(SoftId id) const {
  return anyWishes(impl_->data, id, "World::contactEvents", &ShapeData::contactEvents);
}
void World::setContactEvents(SoftId id, bool wanted) {
  wishAll(impl_->data, id, "World::setContactEvents", &ShapeData::contactEvents, wanted);
}
bool World::hitEvents(SoftId id) const { return anyWishes(impl_->data, id, "World::hitEvents", &ShapeData::hitEvents); }
void World::setHitEvents(SoftId id, bool wanted) {
  wishAll(impl_->data, id, "World::setHitEvents", &ShapeData::hitEvents, wanted);
}

}  // namespace avbd
