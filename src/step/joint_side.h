// What a joint's rows need of each of its bodies, and what of a violation a step corrects.
#pragma once

#include <algorithm>

#include "step/begin_rows.h"

namespace avbd {

struct JointSide {
  rows::V3<float> arm{0, 0, 0};      ///< world axes; zero of the world
  Vec3d anchor;                      ///< world
  rows::Q4<float> axes{1, 0, 0, 0};  ///< joint frame to world
  float invMass = 0, turning = 0;    ///< turning: mean inverse inertia across the arm
  rows::Sym3<float> invInertia{};
};

inline JointSide jointSide(const WorldData& world, const JointData& joint, int i) {
  JointSide side;
  if (joint.body[i] == kNone) {
    side.anchor = joint.frame[i].position;
    side.axes = toRow(joint.axes[i]);
    return side;
  }
  const BodyData& body = world.bodies[joint.body[i]];
  const Vec3 arm = rotate(body.rotation, joint.anchor[i]);
  side.anchor = body.position + arm;
  side.axes = toRow(body.rotation * joint.axes[i]);
  side.arm = toRow(arm);
  if (body.type != BodyType::Dynamic) return side;
  side.invMass = (body.locks & 7) == 7 ? 0 : 1 / body.mass;
  side.invInertia = rotated(toRow(body.invInertia), toRow(body.rotation));
  const float trace = side.invInertia.xx + side.invInertia.yy + side.invInertia.zz;
  const float size = dot(side.arm, side.arm);
  if ((body.locks >> 3) == 7)
    side.invInertia = {};
  else
    side.turning = 0.5f * (trace - (size > 0 ? dot(side.arm, side.invInertia * side.arm) / size : trace / 3));
  return side;
}

/// How far the arms in J go from the start of the step to its end: by the joint's own stability number
/// chi = h^2 |F| |r| w, whose limit for the symplectic choice (0) is 4. Rows take more where a body turns far (row.h).
inline float armBlend(const StepData& step, const JointSide& a, const JointSide& b, float force) {
  const float chi =
      step.h * step.h * force * std::max(rows::length(a.arm) * a.turning, rows::length(b.arm) * b.turning);
  return 0.5f * std::clamp((chi - 1) / 3, 0.0f, 1.0f);
}

/// The part of a violation that this step corrects; no faster than allowed, so that parts far from where their joint
/// wants them are drawn together and not shot.
inline rows::V3<float> corrected(const StepData& step, const rows::V3<float>& violation, float speed) {
  const rows::V3<float> part = violation * (1 - step.alpha);
  const float size = length(part), most = speed * step.h;
  return size > most ? part * (most / size) : part;
}

inline float corrected(const StepData& step, float violation, float speed) {
  const float most = speed * step.h;
  return std::clamp(violation * (1 - step.alpha), -most, most);
}

}  // namespace avbd
