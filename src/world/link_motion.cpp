// Lengths of distance joints and pulleys, sums of couplings, and what users' joints miss (joint_coordinates.h).
#include <algorithm>
#include <cmath>

#include "world/bodies.h"
#include "world/joint_coordinates.h"
#include "world/joints.h"

namespace avbd {
namespace {

struct MovingPoint {
  Vec3d position, velocity;
};

MovingPoint pointOf(const WorldData& data, const JointData& joint, int side) {
  if (joint.body[side] == kNone) return {joint.frame[side].position, {}};
  const BodyData& body = data.bodies[joint.body[side]];
  const Vec3d arm = rotate(body.rotation, toDouble(joint.anchor[side])), w = toDouble(body.angularVelocity);
  const Vec3d turning{w.y * arm.z - w.z * arm.y, w.z * arm.x - w.x * arm.z, w.x * arm.y - w.y * arm.x};
  return {body.position + arm, toDouble(body.linearVelocity) + turning};
}

LinkMotion between(const MovingPoint& a, const MovingPoint& b) {
  const Vec3d line = b.position - a.position;
  const double size = length(line);
  return {size, size > 0 ? dot(line, b.velocity - a.velocity) / size : 0};
}

}  // namespace

LinkMotion couplingMotion(const WorldData& data, const LinkData& link) {
  LinkMotion sum;
  for (const LinkTerm& term : link.terms) {
    const JointMotion motion = motionOf(data, term.joint);
    const size_t i = innerAxis(data.d6[term.joint], term.axis);
    sum.position += term.curve.value(motion.position[i]);
    sum.velocity += motion.velocity[i] * term.curve.slope(motion.position[i]);
  }
  return sum;
}

CustomBody customBodyOf(const WorldData& data, uint32_t slot) {
  if (slot == kNone) return {};
  return {bodyPose(data.bodies[slot]), data.bodies[slot].position};
}

LinkMotion linkMotionOf(const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  const LinkData& link = data.links[slot];
  if (joint.type == JointType::Coupling) return couplingMotion(data, link);
  const MovingPoint a = pointOf(data, joint, 0), b = pointOf(data, joint, 1);
  if (joint.type == JointType::Distance) return between(a, b);
  const LinkMotion ropeA = between({link.wheel[0], {}}, a), ropeB = between({link.wheel[1], {}}, b);
  const double ratio = static_cast<double>(link.ratio);
  return {ropeA.position + ratio * ropeB.position, ropeA.velocity + ratio * ropeB.velocity};
}

double linkGap(const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  const LinkData& link = data.links[slot];
  const double q = linkMotionOf(data, slot).position;
  const double min = static_cast<double>(link.min), max = static_cast<double>(link.max);
  if (joint.type == JointType::Distance) return std::max({0.0, q - max, min - q});
  if (joint.type == JointType::Pulley) return link.slack ? std::max(0.0, q - max) : std::abs(q - max);
  return link.axis.motion == AxisMotion::Locked ? std::abs(q - link.rest) : 0;
}

double customGap(const WorldData& data, uint32_t slot) {
  const LinkData& link = data.links[slot];
  std::vector<CustomBody> bodies;
  for (int i = 0; i < link.bodies; ++i) bodies.push_back(customBodyOf(data, data.joints[slot].body[i]));
  std::vector<CustomRow> rows(static_cast<size_t>(link.family->rowCount()));
  link.family->evaluate(bodies, bodies, 0, link.constants, link.memory, rows);
  double gap = 0;
  for (const CustomRow& row : rows) {
    if (row.stiffness > 0) continue;
    const bool open = (row.lower == 0 && row.C < 0) || (row.upper == 0 && row.C > 0);
    if (!open) gap = std::max(gap, std::abs(row.C));
  }
  return gap;
}

}  // namespace avbd
