// Joints of articulations (articulation_joint.h).
//
// With s = (0, sy, sz) the swing and t the twist, frame B stands in frame A as exp(s) exp(t x), so that b1 = exp(s) x
// and w = b1 t' + T(s) s', T as in turningFactors(). This is the inverse of the velocities that World::coordinate()
// gives.
#include "api/articulation_joint.h"

namespace avbd::articulation {
namespace {

bool isAngle(JointAxis axis) { return axis >= JointAxis::Twist; }

void addAxis(JointModel& joint, JointAxis axis, double armature) {
  const size_t i = static_cast<size_t>(joint.count++);
  joint.axes[i] = axis, joint.armature[i] = armature;
}

template <class Def>
JointModel modelOf(const Def& def) {
  JointModel joint;
  joint.ends = {def.bodyA, def.bodyB};
  joint.frameA = toDouble(def.frameA), joint.frameB = toDouble(def.frameB);
  return joint;
}

JointModel modelOfBall(const BallJoint& def) {
  JointModel joint = modelOf(def);
  joint.ball = true;
  for (const JointAxis axis : {JointAxis::Twist, JointAxis::SwingY, JointAxis::SwingZ}) addAxis(joint, axis, 0);
  return joint;
}

template <class Def>
JointModel modelOfOne(const Def& def, JointAxis axis) {
  JointModel joint = modelOf(def);
  addAxis(joint, axis, static_cast<double>(def.armature));
  return joint;
}

JointModel modelOfD6(const D6Joint& def) {
  JointModel joint = modelOf(def);
  for (size_t i = 0; i < 6; ++i) {
    const D6Axis& axis = def.axes[i];
    if (axis.motion == AxisMotion::Free) {
      addAxis(joint, static_cast<JointAxis>(i), static_cast<double>(axis.armature));
    }
  }
  return joint;
}

/// The six coordinates, locked ones zero.
struct Coordinates {
  Vec3d offset;
  double twist = 0;
  Vec3d swing;
};

Coordinates spread(const JointModel& joint, std::span<const double> values) {
  double all[6] = {};
  for (size_t i = 0; i < values.size(); ++i) all[static_cast<size_t>(joint.axes[i])] = values[i];
  return {{all[0], all[1], all[2]}, all[3], {0, all[4], all[5]}};
}

constexpr Vec3d kUnit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Turning by the rate of the rotation vector s.
Vec3d turning(const TurningFactors& f, Vec3d s, Vec3d rate) {
  const Vec3d across = cross(s, rate);
  return rate + across * f.a + cross(s, across) * f.b;
}

/// What turning() changes by while s moves at `rate`, per time.
Vec3d turningRate(const TurningFactors& f, Vec3d s, Vec3d rate) {
  const Vec3d across = cross(s, rate);
  const double along = dot(s, rate);
  return across * (f.aSlope * along) + cross(s, across) * (f.bSlope * along) + cross(rate, across) * f.b;
}

}  // namespace

bool isTreeJoint(JointType type) {
  return type == JointType::Hinge || type == JointType::Slider || type == JointType::Ball || type == JointType::D6 ||
         type == JointType::Fixed;
}

JointModel readJoint(const World& world, JointId id) {
  switch (world.type(id)) {
    case JointType::Ball:
      return modelOfBall(world.ballJoint(id));
    case JointType::Hinge:
      return modelOfOne(world.hingeJoint(id), JointAxis::Twist);
    case JointType::Slider:
      return modelOfOne(world.sliderJoint(id), JointAxis::LinearX);
    case JointType::D6:
      return modelOfD6(world.d6Joint(id));
    default:
      return modelOf(world.fixedJoint(id));
  }
}

Posed relativePose(const JointModel& joint, std::span<const double> q) {
  if (joint.ball) return {{}, rotationOf({q[0], q[1], q[2]})};
  const Coordinates at = spread(joint, q);
  const SinCos half = sinCos(0.5 * at.twist);
  return {at.offset, rotationOf(at.swing) * Quatd{half.cos, half.sin, 0, 0}};
}

JointSubspace subspace(const JointModel& joint, std::span<const double> q, std::span<const double> v) {
  JointSubspace out{};
  const Coordinates at = spread(joint, q), rate = spread(joint, v);
  const TurningFactors f = turningFactors(at.swing);
  const Vec3d twistAxis = rotate(rotationOf(at.swing), kUnit[0]);
  for (size_t i = 0; i < static_cast<size_t>(joint.count); ++i) {
    const size_t axis = static_cast<size_t>(joint.axes[i]);
    Spatial& column = out.columns[i];
    if (!isAngle(joint.axes[i])) {
      column.linear = kUnit[axis];
    } else if (joint.ball) {
      column.angular = kUnit[axis - 3];
    } else {
      column.angular = axis == 3 ? twistAxis : turning(f, at.swing, kUnit[axis - 3]);
    }
    out.velocity = out.velocity + column * v[i];
  }
  if (!joint.ball) {
    const Vec3d swinging = turning(f, at.swing, rate.swing);
    out.rate.angular = cross(swinging, twistAxis) * rate.twist + turningRate(f, at.swing, rate.swing);
  }
  return out;
}

}  // namespace avbd::articulation
