// Which MJCF bodies become one rigid body, and which keyframe applies.
#include <set>

#include "io/mjcf_build.h"

namespace avbd::mjcf {

Clusters clustersOf(const Description& description) {
  using Link = Clusters::Link;
  // Static bodies named by an exclude stay apart so that it does not reach the rest of the world; an exclude of the
  // world itself must not reach any other static body.
  std::set<int> apart;
  for (const Exclude& exclude : description.excludes) {
    apart.insert(exclude.bodyA);
    apart.insert(exclude.bodyB);
  }
  Clusters out;
  out.rootOf.resize(description.bodies.size());
  out.linkOf.resize(description.bodies.size(), Link::Static);
  for (size_t i = 1; i < description.bodies.size(); ++i) {
    const Body& body = description.bodies[i];
    const int self = static_cast<int>(i), parent = out.rootOf[static_cast<size_t>(body.parent)];
    const bool isJointed = !body.joints.empty(), isFree = isJointed && body.joints[0].kind == JointKind::Free;
    out.linkOf[i] = body.mocap       ? Link::Mocap
                    : body.flex >= 0 ? Link::Particle
                    : isFree         ? Link::Free
                    : isJointed      ? Link::Jointed
                                     : Link::Static;
    out.rootOf[i] = out.linkOf[i] != Link::Static ? self : parent;
    const bool onStatic = out.linkOf[static_cast<size_t>(parent)] == Link::Static;
    if (out.linkOf[i] != Link::Static || !onStatic) continue;
    out.rootOf[i] = apart.contains(self) || apart.contains(0) ? self : 0;
  }
  return out;
}

std::string keyName(const Description& description, size_t key) {
  const std::string& name = description.keys[key].name;
  return name.empty() ? "key_" + std::to_string(key + 1) : name;
}

int chosenKey(const Description& description, const MjcfOptions& options) {
  if (!options.useKeyframe) return -1;
  for (size_t i = 0; i < description.keys.size(); ++i) {
    if (options.keyframe.empty() || keyName(description, i) == options.keyframe) return static_cast<int>(i);
  }
  if (options.keyframe.empty()) return -1;
  throw FileError(description.fileName + ": keyframe \"" + options.keyframe + "\": no key has this name",
                  description.fileName);
}

}  // namespace avbd::mjcf
