// Events of the last step and the contact hook.
#include "api/world_impl.h"
#include "world/check.h"

namespace avbd {

const Events& World::events() const { return impl_->data.events; }
void World::setContactHook(std::function<bool(ContactPlan&)> hook) { impl_->data.contactHook = std::move(hook); }

bool World::isTrigger(ShapeId id) const {
  return impl_->data.shapes[slotOf(impl_->data, id, Path("World::isTrigger") / "id")].isTrigger;
}

}  // namespace avbd
