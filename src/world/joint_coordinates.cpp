// Coordinates of joints (joint_coordinates.h).
#include "world/joint_coordinates.h"

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

Vec3d crossd(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double withinHalfTurn(double x) { return x - 2 * kPi * std::nearbyint(x / (2 * kPi)); }

struct Side {
  Vec3d origin, velocity, spin;
  Quat axes;
};

Side sideAt(const WorldData& data, const JointData& joint, int i) {
  if (joint.body[i] == kNone) return {joint.frame[i].position, {}, {}, joint.axes[i]};
  const BodyData& body = data.bodies[joint.body[i]];
  Side side;
  const Vec3d arm = rotate(body.rotation, toDouble(joint.anchor[i]));
  side.origin = body.position + arm;
  side.axes = body.rotation * joint.axes[i];
  side.spin = toDouble(body.angularVelocity);
  side.velocity = toDouble(body.linearVelocity) + crossd(side.spin, arm);
  return side;
}

/// Angle over its sine, and that by the cosine.
struct Swing {
  double factor, slope;
};
Swing swingOf(double c) {
  const double squared = std::max((1 - c) * (1 + c), 0.0), sine = std::sqrt(squared);
  if (sine < 1e-4 && c > 0) return {1 + (1 - c) / 3, -1.0 / 3};
  const double factor = std::atan2(sine, c) / std::max(sine, 1e-9);
  return {factor, (c * factor - 1) / std::max(squared, 1e-12)};
}

}  // namespace

JointMotion motionOf(const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  const D6Data& d6 = data.d6[slot];
  const Side a = sideAt(data, joint, 0), b = sideAt(data, joint, 1);
  const Vec3d unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3d axis[3];
  for (int i = 0; i < 3; ++i) axis[i] = rotate(a.axes, unit[i]);
  const Vec3d offset = b.origin - a.origin, turning = b.spin - a.spin;
  JointMotion motion;
  // A's frame turns: what it carries B's origin along is no motion of the joint.
  const Vec3d velocity = b.velocity - a.velocity - crossd(a.spin, offset);
  for (int i = 0; i < 3; ++i) motion.position[i] = dot(axis[i], offset), motion.velocity[i] = dot(axis[i], velocity);
  const Vec3d b1 = rotate(b.axes, unit[0]);
  const Vec3d in{dot(axis[0], b1), dot(axis[1], b1), dot(axis[2], b1)};
  const Quat turn = conjugate(a.axes) * b.axes;
  const double raw = withinHalfTurn(2 * std::atan2(static_cast<double>(turn.x), static_cast<double>(turn.w)));
  motion.position[3] = d6.twistKnown ? d6.twist + withinHalfTurn(raw - d6.twist) : raw;
  motion.velocity[3] = dot(axis[0] + b1, turning) / std::max(1 + in.x, 1e-9);
  const Swing swing = swingOf(in.x);
  const double change = dot(turning, crossd(b1, axis[0]));
  motion.position[4] = -swing.factor * in.z;
  motion.position[5] = swing.factor * in.y;
  motion.velocity[4] = -swing.factor * dot(turning, crossd(b1, axis[2])) - in.z * swing.slope * change;
  motion.velocity[5] = swing.factor * dot(turning, crossd(b1, axis[1])) + in.y * swing.slope * change;
  return motion;
}

namespace {

/// Of the three coordinates from `first` on: how far the locked ones are from zero.
double lockedSize(const WorldData& data, uint32_t joint, int first) {
  const JointMotion motion = motionOf(data, joint);
  double squares = 0;
  for (int i = first; i < first + 3; ++i)
    if (data.d6[joint].axis[i].motion == AxisMotion::Locked) squares += motion.position[i] * motion.position[i];
  return std::sqrt(squares);
}

}  // namespace

double lockedGap(const WorldData& data, uint32_t joint) { return lockedSize(data, joint, 0); }

double lockedAngle(const WorldData& data, uint32_t joint) { return lockedSize(data, joint, 3); }

}  // namespace avbd
