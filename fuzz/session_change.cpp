// Calls that change what is there.
#include <algorithm>

#include "fuzz/session.h"
#include "fuzz/session_attempt.h"

namespace avbd::fuzz {

void Session::change() {
  const uint32_t what = in_.below(14);
  attempt([&] {
    if (what > 9 && what < 13) return changeJoint();
    switch (what) {
      case 0:
        return changeShape(anyShape());
      case 1:
        return world_.setGravity(in_.vector());
      case 2:
        return world_.excludeCollision(anyBody(), anyBody());
      case 3:
        return world_.setIterations(static_cast<int>(in_.below(7)));
      case 4:
        return world_.setSubsteps(static_cast<int>(in_.below(5)));
      case 13:
        return world_.allowCollision(anyBody(), anyBody());
      default:
        return changeBody(anyBody());
    }
  });
}

void Session::changeShape(ShapeId shape) {
  switch (in_.below(3)) {
    case 0:
      return world_.setMaterial(shape, material());
    case 1:
      return world_.setFilter(shape, filter());
    default:
      return world_.setUserData(shape, in_.byte());
  }
}

void Session::changeJoint() {
  if (joints_.empty()) return;
  const JointId id = joints_[in_.byte() % joints_.size()];
  const JointAxis name = static_cast<JointAxis>(in_.below(7));
  switch (in_.below(8)) {
    case 0:
      return world_.setLimit(id, name, axis().limit);
    case 1:
      return world_.setDrive(id, name, axis().drive);
    case 2:
      return world_.setSpring(id, name, axis().spring);
    case 3:
      return world_.addJointForce(id, name, in_.number());
    case 4:
      return world_.setEnabled(id, in_.flag());
    case 5:
      return world_.setBreakLimits(id, {in_.number(), in_.number()});
    case 6: {
      const Pose frameA = in_.pose();
      return world_.setFrames(id, frameA, in_.pose());
    }
    default:
      return world_.setDrive(id, axis().drive);
  }
}

void Session::changeBody(BodyId body) {
  switch (in_.below(9)) {
    case 0:
    case 1:
      return world_.setPose(body, placePose());
    case 2:
      return world_.setVelocity(body, {in_.vector(), in_.vector()});
    case 3:
      return world_.setMassProperties(
          body, {in_.number(), in_.vector(), {in_.number(), in_.number(), in_.number(), in_.number(), 0, 0}});
    case 4: {
      const float linear = in_.number();
      return world_.setDamping(body, linear, in_.number());
    }
    case 5:
      return world_.setLocks(body, in_.byte());
    case 6:
      return world_.setGravityScale(body, in_.number());
    case 7:
      return world_.setIterations(body, in_.byte() / 8);
    default: {
      const float linear = in_.number();
      return world_.setMaxSpeeds(body, linear, in_.number());
    }
  }
}

/// Bulk calls: also with a body twice, and with spans that do not fit.
void Session::changeMany() {
  std::vector<BodyId> ids;
  const uint32_t count = in_.below(6);
  for (uint32_t i = 0; i < count; ++i) ids.push_back(anyBody());
  const size_t given = in_.byte() < 230 ? ids.size() : in_.below(6);
  std::vector<Velocity> velocities(given);
  std::vector<Vec3> forces(given);
  std::vector<Pose> poses(given);
  const bool forcesOnly = in_.flag();
  for (size_t i = 0; i < given; ++i) {
    velocities[i] = {in_.vector(), in_.vector()};
    forces[i] = velocities[i].linear;
  }
  attempt([&] {
    if (forcesOnly)
      world_.addForces(ids, forces);
    else
      world_.setVelocities(ids, velocities);
  });
  attempt([&] {
    world_.getPoses(ids, poses);
    world_.getVelocities(ids, velocities);
    for (size_t i = 0; i < ids.size(); ++i) require(poses[i] == world_.pose(ids[i]), "two poses of one body");
  });
}

void Session::push(BodyId body) {
  attempt([&] {
    switch (in_.below(6)) {
      case 0:
        return world_.addForce(body, in_.vector());
      case 1: {
        const Vec3 force = in_.vector();
        return world_.addForceAt(body, force, place());
      }
      case 2:
        return world_.addTorque(body, in_.vector());
      case 3: {
        const Vec3 impulse = in_.vector();
        return world_.addImpulseAt(body, impulse, place());
      }
      case 4:
        return world_.addImpulse(body, in_.vector() * 1e3f);
      default:
        return world_.addAngularImpulse(body, in_.vector());
    }
  });
}

void Session::bodyGone(BodyId id) {
  std::erase(bodies_, id);
  deadBodies_.push_back(id);
  const auto sweep = [&](auto& living, auto& dead) {
    std::erase_if(living, [&](auto thing) {
      if (world_.isAlive(thing)) return false;
      dead.push_back(thing);
      return true;
    });
  };
  sweep(shapes_, deadShapes_);
  sweep(joints_, deadJoints_);
}

void Session::remove() {
  const uint32_t what = in_.below(4);
  attempt([&] {
    if (what == 0) {
      const ShapeId shape = anyShape();
      world_.destroy(shape);
      std::erase(shapes_, shape);
      deadShapes_.push_back(shape);
    } else if (what == 1) {
      if (joints_.empty()) return;
      const JointId joint = joints_[in_.byte() % joints_.size()];
      world_.destroy(joint);
      // With the couplings that name it.
      std::erase_if(joints_, [&](JointId id) {
        if (world_.isAlive(id)) return false;
        deadJoints_.push_back(id);
        return true;
      });
    } else {
      const BodyId body = anyBody();
      world_.destroy(body);
      bodyGone(body);
    }
  });
}

void Session::moveWorld() {
  const uint64_t before = world_.hash();
  World moved(std::move(world_));
  require(moved.hash() == before, "a moved world is another");
  world_ = std::move(moved);
  require(world_.hash() == before, "a moved world is another");
}

/// What the hook checks it is given, and what it answers depends on its argument and on constants alone.
void Session::setHook() {
  const uint32_t answer = in_.below(8);
  const float number = in_.number();
  const Vec3 belt = in_.vector();
  if (answer == 0) return world_.setContactHook({});
  world_.setContactHook([answer, number, belt](ContactPlan& plan) {
    require(plan.pointCount >= 1 && plan.pointCount <= 4, "a plan without points");
    require(isUnit(plan.normal), "a plan's normal that is not unit");
    for (size_t i = 0; i < static_cast<size_t>(plan.pointCount); ++i)
      require(isFinite(plan.positions[i]) && isFinite(plan.velocities[i]) && std::isfinite(plan.separations[i]),
              "a plan that is not finite");
    if (answer == 1) return plan.shapeA.index % 2 == 0;
    if (answer == 2) plan.friction = plan.staticFriction = number;
    if (answer == 3) plan.restitution = number;
    if (answer == 4) plan.surfaceVelocity = belt;
    if (answer == 5) plan.inverseMassScaleA = std::fabs(number) / 8;
    if (answer == 6) plan.inverseMassScaleA = plan.inverseMassScaleB = number;
    if (answer == 7) plan.torsionalFriction = plan.rollingFriction = number;
    return true;
  });
}

}  // namespace avbd::fuzz
