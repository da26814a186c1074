// Where and how fast the bodies of an MJCF description start.
#include "io/mjcf_builder.h"

namespace avbd::mjcf {

void Builder::chooseStart(const MjcfOptions& options) {
  motion_.resize(in_.bodies.size());
  for (size_t i = 0; i < in_.keys.size(); ++i) model_.keyframes.push_back(keyName(in_, i));
  const int key = chosenKey(in_, options);
  if (key >= 0) key_ = &in_.keys[static_cast<size_t>(key)];
  start_ = key_ ? worldPoses(in_, key_->qpos) : rest_;
  if (!key_ || (key_->qpos.empty() && key_->qvel.empty())) return;
  notes_.add(key_->where, "the bodies start at keyframe " + keyName(in_, static_cast<size_t>(key)));
  if (!key_->qvel.empty()) setVelocities();
}

void Builder::setVelocities() {
  for (size_t i = 1; i < in_.bodies.size(); ++i) motion_[i] = motionsAlong(i).back();
}

std::vector<Posed> Builder::posesAlong(size_t index) const {
  const Body& body = in_.bodies[index];
  return mjcf::posesAlong(body, start_[static_cast<size_t>(body.parent)] * body.pose, qposOf(body));
}

// Of the body's frame before its first joint and after each.
std::vector<Motion> Builder::motionsAlong(size_t index) const {
  const Body& body = in_.bodies[index];
  const size_t parent = static_cast<size_t>(body.parent);
  const std::vector<Posed> poses = posesAlong(index);
  const double* v = key_ && !key_->qvel.empty() ? key_->qvel.data() + body.qvelAt : nullptr;
  Motion m = motion_[parent];
  m.linear = m.linear + cross(m.angular, poses[0].position - start_[parent].position);
  std::vector<Motion> out{m};
  for (size_t k = 0; k < body.joints.size(); ++k) {
    const Joint& joint = body.joints[k];
    const Posed &before = poses[k], &after = poses[k + 1];
    const auto carried = [&](Vec3d point) { return m.linear + cross(m.angular, point - before.position); };
    const Vec3d axis = rotate(before.rotation, joint.axis);
    if (!v) {
      m.linear = carried(after.position);
    } else if (joint.kind == JointKind::Free) {
      m = {{v[0], v[1], v[2]}, rotate(after.rotation, Vec3d{v[3], v[4], v[5]})};
    } else if (joint.kind == JointKind::Slide) {
      m.linear = carried(after.position) + axis * *v++;
    } else {
      const Vec3d anchor = before.position + rotate(before.rotation, joint.pos);
      const bool ball = joint.kind == JointKind::Ball;
      const Vec3d turn = ball ? rotate(after.rotation, Vec3d{v[0], v[1], v[2]}) : axis * v[0];
      v += ball ? 3 : 1;
      const Vec3d atAnchor = carried(anchor);
      m.angular = m.angular + turn;
      m.linear = atAnchor + cross(m.angular, after.position - anchor);
    }
    out.push_back(m);
  }
  return out;
}

}  // namespace avbd::mjcf
