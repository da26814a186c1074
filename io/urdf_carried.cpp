// What a drive of a URDF joint has to move.
#include "io/urdf_carried.h"

#include <algorithm>

#include "io/mjcf_mass.h"

namespace avbd::urdf {

namespace {

double momentAbout(const Mass& mass, Vec3d point, Vec3d direction) {
  const Vec3d d = direction, c = mjcf::cross(d, mass.center - point);
  const mjcf::Sym3d& m = mass.inertia;
  const Vec3d turned{m.xx * d.x + m.xy * d.y + m.xz * d.z, m.xy * d.x + m.yy * d.y + m.yz * d.z,
                     m.xz * d.x + m.yz * d.y + m.zz * d.z};
  return dot(d, turned) + mass.mass * dot(c, c);
}

}  // namespace

Carried::Carried(const Description& description, const Groups& groups, const std::vector<Posed>& poses)
    : in_(description), groups_(groups), poses_(poses) {
  const size_t count = in_.links.size();
  below_.resize(count);
  restsBelow_.resize(count);
  top_.resize(count);
  std::vector<std::vector<Mass>> parts(count);
  const auto parentBody = [&](size_t link) -> int {
    const int joint = in_.links[link].joint;
    if (joint < 0 || !joins(in_.joints[static_cast<size_t>(joint)])) return -1;
    return static_cast<int>(groups_.bodyOf[static_cast<size_t>(in_.joints[static_cast<size_t>(joint)].parent)]);
  };
  for (const int index : in_.order) {
    const size_t i = static_cast<size_t>(index);
    const int parent = parentBody(i);
    if (groups_.bodyOf[i] == i) top_[i] = parent < 0 ? i : top_[static_cast<size_t>(parent)];
  }
  for (auto at = in_.order.rbegin(); at != in_.order.rend(); ++at) {
    const size_t i = static_cast<size_t>(*at);
    if (groups_.bodyOf[i] != i) continue;
    const bool rests = groups_.still == static_cast<int>(i);
    if (!rests) parts[i].push_back(mjcf::moved(groups_.masses[i], poses_[i]));
    below_[i] = mjcf::sum(parts[i]);
    restsBelow_[i] = restsBelow_[i] || rests;
    const int parent = parentBody(i);
    if (parent < 0) continue;
    parts[static_cast<size_t>(parent)].push_back(below_[i]);
    if (restsBelow_[i]) restsBelow_[static_cast<size_t>(parent)] = true;
  }
}

template <class Measure>
double Carried::felt(size_t joint, const Measure& measure) const {
  const size_t child = groups_.bodyOf[static_cast<size_t>(in_.joints[joint].child)];
  const size_t top = top_[child];
  const double below = measure(below_[child]), above = measure(below_[top]) - below;
  if (restsBelow_[child]) return std::max(above, 0.0);
  return restsBelow_[top] ? below : std::max(below, above);
}

double Carried::along(size_t joint) const {
  return felt(joint, [](const Mass& m) { return m.mass; });
}

double Carried::about(size_t joint, Vec3d direction) const {
  const Vec3d point = poses_[static_cast<size_t>(in_.joints[joint].child)].position;
  return felt(joint, [&](const Mass& m) { return momentAbout(m, point, direction); });
}

}  // namespace avbd::urdf
