// The world as a whole: making, settings, the step, ids and sums.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/limits.h"
#include "world/measure.h"
#include "world/pairs.h"
#include "world/sleep.h"
#include "world/state_hash.h"

namespace avbd {

World::World(const WorldDef& def) {
  checkWorld(def);
  impl_ = std::make_unique<Impl>();
  impl_->data.def = def;
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const StepReport& World::step(float dt) {
  // Written so that NaN is refused.
  const Path path("World::step");
  if (!(dt > 0 && dt <= 1)) (path / "dt").refuse(toText(dt), "must be finite and > 0 and at most 1");
  if (dt < kMinSubstep * static_cast<float>(impl_->data.def.substeps)) {
    (path / "dt").refuse(toText(dt), "must be at least " + toText(kMinSubstep) + " for each substep");
  }
  updateAwake(impl_->data);
  updateWishes(impl_->data);
  dropForgottenPairs(impl_->data);
  impl_->stepper.step(impl_->data, dt);
  return impl_->data.report;
}

const StepReport& World::report() const { return impl_->data.report; }
double World::time() const { return impl_->data.time; }
const WorldDef& World::definition() const { return impl_->data.def; }
uint64_t World::hash() const { return stateHash(impl_->data); }
std::array<uint64_t, kStageCount> World::stageHashes() const { return avbd::stageHashes(impl_->data); }

void World::setGravity(Vec3 gravity) {
  check(Path("World::setGravity") / "gravity", gravity, symmetric(kMaxAcceleration * impl_->data.def.lengthUnit));
  avbd::wakeAll(impl_->data);
  impl_->data.def.gravity = gravity;
}

void World::setIterations(int iterations) {
  check(Path("World::setIterations") / "iterations", iterations, Range{1, kMaxIterations});
  impl_->data.def.iterations = iterations;
}

void World::setSubsteps(int substeps) {
  check(Path("World::setSubsteps") / "substeps", substeps, Range{1, 1000});
  impl_->data.def.substeps = substeps;
}

namespace {

template <class Tag>
std::vector<Id<Tag>> livingIds(const HandlePool<Tag>& pool) {
  std::vector<Id<Tag>> ids;
  ids.reserve(pool.count());
  pool.forEach([&](uint32_t slot) { ids.push_back(pool.id(slot)); });
  return ids;
}

}  // namespace

std::vector<BodyId> World::bodies() const { return livingIds(impl_->data.bodyIds); }
std::vector<JointId> World::joints() const { return livingIds(impl_->data.jointIds); }
size_t World::bodyCount() const { return impl_->data.bodyIds.count(); }
size_t World::shapeCount() const { return impl_->data.shapeIds.count(); }
size_t World::jointCount() const { return impl_->data.jointIds.count(); }
bool World::isAlive(BodyId id) const { return impl_->data.bodyIds.isAlive(id); }
bool World::isAlive(ShapeId id) const { return impl_->data.shapeIds.isAlive(id); }
bool World::isAlive(JointId id) const { return impl_->data.jointIds.isAlive(id); }

double World::kineticEnergy() const { return totalKineticEnergy(impl_->data); }
Vec3d World::momentum() const { return totalMomentum(impl_->data); }

Vec3d World::angularMomentum(Vec3d about) const {
  check(Path("World::angularMomentum") / "about", about, symmetric(kMaxPosition * impl_->data.def.lengthUnit));
  return totalAngularMomentum(impl_->data, about);
}

}  // namespace avbd
