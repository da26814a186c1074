// Calls decoded from bytes, and the check after each (session.h).
#include "fuzz/session.h"

#include "fuzz/session_attempt.h"

namespace avbd::fuzz {
namespace {

constexpr int kMostCalls = 200;
/// Where a float has six centimetres left.
constexpr Vec3d kFarAway{1000003.3, -999.7, -1000001.1};

}  // namespace

Session::Session(Bytes& in, int simdWidth) : in_(in) {
  WorldDef def;
  const uint32_t scene = in_.below(8);
  const int count = static_cast<int>(in_.below(10));
  const uint8_t solver = in_.byte();
  def.iterations = 1 + solver % 6;
  def.substeps = 1 + solver / 6 % 3;
  def.primalSolver = solver & 128 ? PrimalSolver::BlockSweep : PrimalSolver::Krylov;
  def.simdWidth = simdWidth;
  const uint8_t odd = in_.byte();
  def.moveEvents = odd & 1;
  def.continuousJointed = odd & 0x10;
  if (odd & 2) def.hitSpeed = 0.1f;
  if (odd & 4) def.krylovIterations = 3;
  if (odd >= 0xf0) def.lengthUnit = odd & 8 ? 0.001f : 1000;
  if (odd >= 0xe0 && odd < 0xf0) def.jointArmBlend = 0.25f * static_cast<float>(odd >> 1 & 3);
  if (odd < 0xe0 && (odd & 0x20)) offset_ = kFarAway;
  world_ = World(def);
  begin(scene, count);
}

Pose Session::placePose() {
  const Vec3d position = place();
  return {position, in_.rotation()};
}

uint64_t Session::run() {
  uint64_t all = 0;
  check();
  for (int i = 0; i < kMostCalls && !in_.empty(); ++i) {
    act();
    check();
    all = all * 0x9e3779b97f4a7c15u + world_.hash();
  }
  return all;
}

void Session::act() {
  switch (in_.below(32)) {
    case 0:
    case 1:
    case 2:
    case 3:
      return make();
    case 4:
    case 5:
      return makeJoint();
    case 6:
    case 7:
    case 8:
      return change();
    case 9:
      return changeMany();
    case 10:
    case 11:
      return remove();
    case 12:
    case 13:
    case 14:
      return push(anyBody());
    case 15:
      return read();
    case 16:
    case 17:
    case 18:
      return ask();
    case 19:
      return walk();
    case 20:
      return setHook();
    case 21:
      return moveWorld();
    case 22:
    case 23:
      return articulate();
    case 24:
      return makeSoft();
    default:
      return step();
  }
}

void Session::check() {
  require(world_.hash() == world_.hash(), "two hashes of one state");
  require(world_.bodyCount() == bodies_.size(), "bodies lost or won");
  require(world_.shapeCount() == shapes_.size(), "shapes lost or won");
  require(world_.jointCount() == joints_.size(), "joints lost or won");
  for (const BodyId id : bodies_) {
    require(world_.isAlive(id), "a living body is dead");
    const Pose pose = world_.pose(id);
    const Velocity v = world_.velocity(id);
    require(isFinite(pose.position) && isFinite(v.linear) && isFinite(v.angular), "a body that is not finite");
    const Quat q = pose.rotation;
    require(std::fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-3f, "a rotation that is not unit");
  }
  for (const BodyId id : deadBodies_) require(!world_.isAlive(id), "a dead body lives");
  for (const ShapeId id : deadShapes_) require(!world_.isAlive(id), "a dead shape lives");
  for (const JointId id : deadJoints_) require(!world_.isAlive(id), "a dead joint lives");
  checkContacts();
  checkFound();
  for (const JointId id : joints_) {
    const JointReaction reaction = world_.reaction(id);
    require(isFinite(reaction.force) && isFinite(reaction.torque), "a reaction that is not finite");
  }
}

}  // namespace avbd::fuzz
