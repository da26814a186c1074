// How bodies move over a step (continuous.h).
#include <algorithm>

#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "step/step_data.h"
#include "world/joints.h"

namespace avbd {

namespace {

/// The point of a body that a joint holds in the world or on what no force moves, in the body's axes; else its centre.
Vec3 heldPoint(const WorldData& world, uint32_t body) {
  Vec3 point;
  anyJoint(world, body, [&](uint32_t slot) {
    const JointData& joint = world.joints[slot];
    const int side = sideOf(joint, body);
    const bool holds =
        joint.type == JointType::Ball || joint.type == JointType::Fixed || joint.type == JointType::Hinge;
    if (!holds || !joint.enabled || isDynamic(world, joint.body[1 - side])) return false;
    point = joint.anchor[side];
    return true;
  });
  return point;
}

float turningReach(Vec3 turn, float radius) { return std::min(length(turn), 2.0f) * radius; }

}  // namespace

Pose at(const BodyMotion& motion, float time) {
  const Quat turn = quatFromVector(motion.turn * time);
  return {motion.center + motion.shift * time + rotate(turn, motion.arm), unit(turn * motion.rotation)};
}

BodyMotion motionOf(const WorldData& world, const StepData& step, uint32_t slot) {
  const BodyData& body = world.bodies[slot];
  BodyMotion motion = resting({body.position, body.rotation});
  if (body.type == BodyType::Kinematic) {
    motion.shift = body.linearVelocity * step.h, motion.turn = body.angularVelocity * step.h;
  } else if (body.type == BodyType::Dynamic && !body.asleep) {
    const uint32_t index = step.endOf[slot];
    const float* d = step.d.data() + size_t(8) * step.rowOfEnd[index];
    motion.turn = {d[4], d[5], d[6]};
    const Vec3 held = heldPoint(world, slot), arm = rotate(body.rotation, held);
    motion.center = motion.center + arm;
    motion.arm = -arm;
    motion.shift = toFloat(step.end[index].position + rotate(step.end[index].rotation, held) - motion.center);
  }
  return motion;
}

BodyMotion resting(const Pose& pose) { return {pose.position, {}, pose.rotation, {}, {}}; }

BodyMotion shifted(const BodyMotion& motion, Vec3 more, float time) {
  BodyMotion other = motion;
  other.center = motion.center - more * time;
  other.shift = motion.shift + more;
  return other;
}

BodyMotion carried(const Pose& pose, const BodyMotion& by, float time, Vec3 normal) {
  BodyMotion motion = resting(pose);
  if (by.turn == Vec3{}) {
    const float pushed = dot(normal, by.shift);
    motion.shift = normal * std::min(pushed, 0.0f);
    motion.center = motion.center - motion.shift * time;
    return motion;
  }
  // Back along the other's motion to the start.
  const Quat back = quatFromVector(by.turn * -time);
  motion.center = by.center;
  motion.arm = rotate(back, toFloat(pose.position - by.center) - by.shift * time);
  motion.rotation = unit(back * pose.rotation);
  motion.shift = by.shift, motion.turn = by.turn;
  return motion;
}

ShapeMotion motionOf(const BodyMotion& body, const ShapeData& shape, Vec3d origin) {
  const Vec3 center = toFloat(body.center - origin);
  return {{center + body.arm + rotate(body.rotation, shape.toMass.p), body.rotation * shape.toMass.q},
          center,
          body.shift,
          body.turn};
}

Aabb boundsOnWay(const BodyMotion& body, const ShapeData& shape, float radius) {
  const Vec3d mass = body.center + body.arm;
  const Pose pose{mass + rotate(body.rotation, shape.toMass.p), body.rotation * shape.toMass.q};
  return swept(bounds(shape.geom, pose, turningReach(body.turn, radius + length(body.arm))), body.shift);
}

Aabb boundsOnWay(const WorldData& world, const BodyMotion& motion, uint32_t body) {
  Aabb box{{kFarAway, kFarAway, kFarAway}, {-kFarAway, -kFarAway, -kFarAway}};
  for (uint32_t s = world.bodies[body].firstShape; s != kNone; s = world.shapes[s].next) {
    box = merge(box, boundsOnWay(motion, world.shapes[s], world.bodies[body].radius));
  }
  return box;
}

float relativeWay(const BodyMotion& a, float radiusA, const BodyMotion& b, float radiusB) {
  return length(a.shift - b.shift) + turningReach(a.turn, radiusA + length(a.arm)) +
         turningReach(b.turn, radiusB + length(b.arm));
}

std::array<uint32_t, 2> inOrder(const WorldData& world, uint32_t shapeA, uint32_t shapeB) {
  const bool convexA = isConvex(world.shapes[shapeA].geom.type), convexB = isConvex(world.shapes[shapeB].geom.type);
  if (!convexA || (convexB && shapeB < shapeA)) std::swap(shapeA, shapeB);
  return {shapeA, shapeB};
}

}  // namespace avbd
