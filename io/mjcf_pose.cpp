// Forward kinematics of an MJCF description.
#include <cmath>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

namespace {

Posed freePose(const double* q) { return {{q[0], q[1], q[2]}, normalized({q[3], q[4], q[5], q[6]})}; }

}  // namespace

std::vector<Posed> worldPoses(const Description& description, const std::vector<double>& qpos) {
  std::vector<Posed> out(description.bodies.size());
  for (size_t i = 1; i < out.size(); ++i) {
    const Body& body = description.bodies[i];
    Posed pose = out[static_cast<size_t>(body.parent)] * body.pose;
    const double* q = qpos.empty() ? nullptr : qpos.data() + body.qposAt;
    for (const Joint& joint : body.joints) {
      if (!q) break;
      const Vec3d anchor = pose.position + rotate(pose.rotation, joint.pos);
      switch (joint.kind) {
        case JointKind::Free:
          pose = freePose(q);
          q += 7;
          continue;
        case JointKind::Slide:
          pose.position = pose.position + rotate(pose.rotation, joint.axis) * (*q++ - joint.ref);
          continue;
        case JointKind::Hinge:
          pose.rotation = pose.rotation * turnAbout(joint.axis, *q++ - joint.ref);
          break;
        case JointKind::Ball:
          pose.rotation = pose.rotation * normalized({q[0], q[1], q[2], q[3]});
          q += 4;
          break;
      }
      pose.position = anchor - rotate(pose.rotation, joint.pos);
    }
    // Products of many unit quaternions drift.
    pose.rotation = normalized(pose.rotation);
    out[i] = pose;
  }
  return out;
}

}  // namespace avbd::mjcf
