// Soft bodies.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/soft.h"

namespace avbd {
namespace {

const SoftData& softOf(const WorldData& data, SoftId id, const char* call) {
  return data.softs[slotOf(data, id, Path(call) / "id")];
}

}  // namespace

SoftId World::create(const SoftDef& def) {
  const SoftDef checked = checkedSoft(impl_->data, def);
  return impl_->data.softIds.id(addSoft(impl_->data, checked));
}

void World::destroy(SoftId id) { removeSoft(impl_->data, slotOf(impl_->data, id, Path("World::destroy") / "id")); }
bool World::isAlive(SoftId id) const { return impl_->data.softIds.isAlive(id); }

std::vector<SoftId> World::softBodies() const {
  std::vector<SoftId> ids;
  impl_->data.softIds.forEach([&](uint32_t slot) { ids.push_back(impl_->data.softIds.id(slot)); });
  return ids;
}

std::shared_ptr<const SoftMeshData> World::mesh(SoftId id) const { return softOf(impl_->data, id, "World::mesh").mesh; }
SoftMaterial World::material(SoftId id) const { return softOf(impl_->data, id, "World::material").material; }
float World::radius(SoftId id) const { return softOf(impl_->data, id, "World::radius").radius; }

std::vector<BodyId> World::particles(SoftId id) const {
  std::vector<BodyId> ids;
  for (const uint32_t slot : softOf(impl_->data, id, "World::particles").bodies)
    ids.push_back(impl_->data.bodyIds.id(slot));
  return ids;
}

SoftId World::softBody(BodyId id) const {
  const uint32_t soft = impl_->data.bodies[slotOf(impl_->data, id, Path("World::softBody") / "id")].soft;
  return soft == kNone ? SoftId{} : impl_->data.softIds.id(soft);
}

void World::getPoints(SoftId id, std::span<Vec3d> out) const {
  const SoftData& soft = softOf(impl_->data, id, "World::getPoints");
  if (out.size() != soft.bodies.size())
    (Path("World::getPoints") / "out").refuse(toText(out.size()), "must have the mesh's " + toText(soft.bodies.size()));
  for (size_t i = 0; i < out.size(); ++i) out[i] = impl_->data.bodies[soft.bodies[i]].position;
}

double World::volume(SoftId id) const { return volumeOf(impl_->data, softOf(impl_->data, id, "World::volume")); }
uint64_t World::userData(SoftId id) const { return softOf(impl_->data, id, "World::userData").userData; }

void World::setUserData(SoftId id, uint64_t data) {
  impl_->data.softs[slotOf(impl_->data, id, Path("World::setUserData") / "id")].userData = data;
}

}  // namespace avbd
