// Forward kinematics of an MJCF description.
#include <cmath>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

namespace {

Posed freePose(const double* q) { return {{q[0], q[1], q[2]}, normalized({q[3], q[4], q[5], q[6]})}; }

// The frame after one joint; q goes on behind its coordinates.
Posed moved(const Posed& before, const Joint& joint, const double*& q) {
  Posed pose = before;
  const Vec3d anchor = pose.position + rotate(pose.rotation, joint.pos);
  switch (joint.kind) {
    case JointKind::Free:
      pose = freePose(q);
      q += 7;
      return pose;
    case JointKind::Slide:
      pose.position = pose.position + rotate(pose.rotation, joint.axis) * (*q++ - joint.ref);
      return pose;
    case JointKind::Hinge:
      pose.rotation = pose.rotation * turnAbout(joint.axis, *q++ - joint.ref);
      break;
    case JointKind::Ball:
      pose.rotation = pose.rotation * normalized({q[0], q[1], q[2], q[3]});
      q += 4;
      break;
  }
  pose.position = anchor - rotate(pose.rotation, joint.pos);
  return pose;
}

}  // namespace

std::vector<Posed> posesAlong(const Body& body, const Posed& before, const double* q) {
  std::vector<Posed> out{before};
  for (const Joint& joint : body.joints) out.push_back(q ? moved(out.back(), joint, q) : before);
  // Products of many unit quaternions drift.
  for (Posed& pose : out) pose.rotation = normalized(pose.rotation);
  return out;
}

std::vector<Posed> worldPoses(const Description& description, const std::vector<double>& qpos) {
  std::vector<Posed> out(description.bodies.size());
  for (size_t i = 1; i < out.size(); ++i) {
    const Body& body = description.bodies[i];
    const Posed before = out[static_cast<size_t>(body.parent)] * body.pose;
    out[i] = posesAlong(body, before, qpos.empty() ? nullptr : qpos.data() + body.qposAt).back();
  }
  return out;
}

}  // namespace avbd::mjcf
