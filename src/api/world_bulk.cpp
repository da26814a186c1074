// Many bodies at once. All ids and values are checked before the first is used.
#include "api/world_impl.h"
#include "world/bodies.h"
#include "world/check.h"
#include "world/limits.h"
#include "world/sleep.h"

namespace avbd {
namespace {

void checkSize(const Path& path, size_t size, size_t idCount) {
  if (size != idCount) path.refuse(toText(size) + " values", "must be as many as ids: " + toText(idCount));
}

void checkIds(const WorldData& data, std::span<const BodyId> ids, const Path& path) {
  for (size_t i = 0; i < ids.size(); ++i) slotOf(data, ids[i], path[i]);
}

}  // namespace

void World::getPoses(std::span<const BodyId> ids, std::span<Pose> out) const {
  const Path path("World::getPoses");
  checkSize(path / "out", out.size(), ids.size());
  checkIds(impl_->data, ids, path / "ids");
  for (size_t i = 0; i < ids.size(); ++i) out[i] = bodyPose(impl_->data.bodies[impl_->data.bodyIds.slot(ids[i])]);
}

void World::getVelocities(std::span<const BodyId> ids, std::span<Velocity> out) const {
  const Path path("World::getVelocities");
  checkSize(path / "out", out.size(), ids.size());
  checkIds(impl_->data, ids, path / "ids");
  for (size_t i = 0; i < ids.size(); ++i) {
    const BodyData& body = impl_->data.bodies[impl_->data.bodyIds.slot(ids[i])];
    out[i] = {body.linearVelocity, body.angularVelocity};
  }
}

void World::setVelocities(std::span<const BodyId> ids, std::span<const Velocity> in) {
  const Path path("World::setVelocities");
  const Path idsPath = path / "ids", inPath = path / "in";
  checkSize(inPath, in.size(), ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    movableSlotOf(impl_->data, ids[i], idsPath[i]);
    checkVelocity(inPath[i], in[i], impl_->data.def.lengthUnit);
  }
  for (size_t i = 0; i < ids.size(); ++i) changeVelocity(impl_->data, impl_->data.bodyIds.slot(ids[i]), in[i]);
}

void World::addForces(std::span<const BodyId> ids, std::span<const Vec3> forces) {
  const Path path("World::addForces");
  const Path idsPath = path / "ids", forcesPath = path / "forces";
  checkSize(forcesPath, forces.size(), ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    dynamicSlotOf(impl_->data, ids[i], idsPath[i]);
    check(forcesPath[i], forces[i], symmetric(kMaxForce));
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    const uint32_t slot = impl_->data.bodyIds.slot(ids[i]);
    if (forces[i] == Vec3{}) continue;
    wakeBody(impl_->data, slot);
    impl_->data.bodies[slot].force = impl_->data.bodies[slot].force + forces[i];
  }
}

}  // namespace avbd
