// Which links of a URDF file become one body, and what each body weighs.
#include "io/urdf_groups.h"

#include <algorithm>

#include "io/mjcf_mass.h"

namespace avbd::urdf {

namespace {

// Of what hangs on a link without mass: its share for that link. Small enough to change no motion, large enough to
// leave the link's joints well conditioned.
constexpr double kShareOfFrame = 1e-3;

class GroupBuilder {
 public:
  GroupBuilder(const Description& in, const std::vector<Posed>& poses, const std::vector<LinkHulls>& hulls,
               Notes& notes)
      : in_(in), poses_(poses), hulls_(hulls), notes_(notes) {}
  Groups build(bool floating);

 private:
  void weldFixed();
  bool weldFrames();
  void weldFollowers();
  void group(bool floating);
  void weigh(size_t body, bool noted);
  void noteLargeInertia(size_t link, const Mass& mass);
  void giveFramesMass();
  bool isShaped(size_t link) const;
  bool rests(size_t body) const { return out_.still == static_cast<int>(body); }
  const Joint* jointAbove(size_t link) const {
    const int joint = in_.links[link].joint;
    return joint < 0 ? nullptr : &in_.joints[static_cast<size_t>(joint)];
  }

  const Description& in_;
  const std::vector<Posed>& poses_;
  const std::vector<LinkHulls>& hulls_;
  Notes& notes_;
  std::vector<std::vector<size_t>> linksOf_;  // by first link
  Groups out_;
};

void GroupBuilder::weldFixed() {
  out_.welded.resize(in_.joints.size());
  for (size_t i = 0; i < in_.joints.size(); ++i) {
    const Joint& joint = in_.joints[i];
    const bool holds = joint.mimic && joint.mimic->multiplier == 0;
    if (holds) notes_.add(joint.where, "mimic with a multiplier of 0: welded at its offset");
    out_.welded[i] = joint.kind == JointKind::Fixed || holds;
  }
}

void GroupBuilder::weldFollowers() {
  for (size_t i = 0; i < in_.joints.size(); ++i) {
    const Joint& joint = in_.joints[i];
    if (out_.welded[i] || !joint.mimic || !out_.welded[static_cast<size_t>(joint.mimic->joint)]) continue;
    notes_.add(joint.where, "mimics a joint that is welded: welded too");
    out_.welded[i] = true;
  }
}

void GroupBuilder::group(bool floating) {
  const size_t count = in_.links.size();
  out_.bodyOf.assign(count, 0);
  out_.masses.assign(count, {});
  out_.hasShapes.assign(count, false);
  linksOf_.assign(count, {});
  for (const int index : in_.order) {
    const size_t i = static_cast<size_t>(index);
    const Joint* above = jointAbove(i);
    const bool part = above && out_.welded[static_cast<size_t>(in_.links[i].joint)];
    out_.bodyOf[i] = part ? out_.bodyOf[static_cast<size_t>(above->parent)] : i;
  }
  // In the order of the file, which sums keep.
  for (size_t i = 0; i < count; ++i) {
    linksOf_[out_.bodyOf[i]].push_back(i);
    if (isShaped(i)) out_.hasShapes[out_.bodyOf[i]] = true;
  }
  const int held = in_.anchor ? in_.anchor->link : in_.order[0];
  out_.still = floating ? -1 : static_cast<int>(out_.bodyOf[static_cast<size_t>(held)]);
}

bool GroupBuilder::isShaped(size_t link) const {
  const std::vector<Shape>& shapes = in_.links[link].collisions;
  for (size_t k = 0; k < shapes.size(); ++k) {
    if (shapes[k].kind != ShapeKind::Mesh || !hulls_[link].at(k).empty()) return true;
  }
  return false;
}

// Mere frames at the ends of the tree; leaves first. Whether there were any.
bool GroupBuilder::weldFrames() {
  std::vector<char> carries(in_.links.size(), false);
  bool any = false;
  for (auto at = in_.order.rbegin(); at != in_.order.rend(); ++at) {
    const size_t i = static_cast<size_t>(*at);
    if (out_.bodyOf[i] != i) continue;
    if (out_.masses[i].mass > 0 || out_.hasShapes[i] || rests(i)) carries[i] = true;
    const Joint* above = jointAbove(i);
    if (!above) continue;
    if (carries[i]) {
      if (joins(*above)) carries[out_.bodyOf[static_cast<size_t>(above->parent)]] = true;
      continue;
    }
    notes_.add(above->where, std::string(nameOf(above->kind)) + " joint that moves neither mass nor shape: welded");
    out_.welded[static_cast<size_t>(in_.links[i].joint)] = any = true;
  }
  return any;
}

// If none of the body's links has a mass, it gets that of its collisions.
void GroupBuilder::weigh(size_t body, bool noted) {
  const std::vector<size_t>& links = linksOf_[body];
  const bool any = std::any_of(links.begin(), links.end(), [&](size_t i) { return in_.links[i].mass.has_value(); });
  std::vector<Mass> parts;
  for (const size_t i : links) {
    const Link& link = in_.links[i];
    if (any && !link.mass) {
      if (noted && !link.collisions.empty()) {
        notes_.add(link.where, "no mass of its own: the link that it is fixed to has one");
      }
      continue;
    }
    const Mass mass = any ? withInertia(link, hulls_[i]) : massOfCollisions(link, hulls_[i]);
    if (noted) noteLargeInertia(i, mass);
    parts.push_back(mjcf::moved(mass, inBody(out_, poses_, i)));
  }
  out_.masses[body] = mjcf::sum(parts);
  if (noted && !any && out_.masses[body].mass > 0) {
    notes_.add(in_.links[body].where, "moves but has no mass: that of its collisions at 1000 kg/m^3 is taken");
  }
}

// Mass within the collisions cannot have a radius of gyration beyond their reach; four times that is no matter of
// covers.
void GroupBuilder::noteLargeInertia(size_t index, const Mass& mass) {
  const Link& link = in_.links[index];
  if (!link.mass) return;
  constexpr double kMost = 4;
  const double radius = reach(link, hulls_[index]), most = kMost * kMost * radius * radius * mass.mass;
  const auto p = mjcf::principal(mass.inertia).values;
  if (radius > 0 && *std::max_element(p.begin(), p.end()) > most) {
    notes_.add(link.where, "its inertia is larger than its mass can have within its collisions (wrong unit or frame?)");
  }
}

// Leaves first: what hangs on a frame may be a frame with its share.
void GroupBuilder::giveFramesMass() {
  std::vector<std::vector<Mass>> below(in_.links.size());  // of bodies, in the world
  for (auto at = in_.order.rbegin(); at != in_.order.rend(); ++at) {
    const size_t i = static_cast<size_t>(*at);
    if (out_.bodyOf[i] != i) continue;
    Mass hanging = mjcf::sum(below[i]);
    if (!(out_.masses[i].mass > 0) && !out_.hasShapes[i] && !rests(i) && hanging.mass > 0) {
      const Vec3d arm = hanging.center - poses_[i].position;
      const auto p = mjcf::principal(hanging.inertia + mjcf::pointInertia(hanging.mass, arm)).values;
      const double most = *std::max_element(p.begin(), p.end());
      out_.masses[i] = {kShareOfFrame * hanging.mass, {}, mjcf::Sym3d{1, 1, 1} * (kShareOfFrame * most)};
      notes_.add(in_.links[i].where, "no mass between joints: gets 1/1000 of what hangs on it");
    }
    const Joint* above = jointAbove(i);
    if (!above || !joins(*above)) continue;
    below[i].push_back(mjcf::moved(out_.masses[i], poses_[i]));
    below[out_.bodyOf[static_cast<size_t>(above->parent)]].push_back(mjcf::sum(below[i]));
  }
}

Groups GroupBuilder::build(bool floating) {
  weldFixed();
  weldFollowers();
  group(floating);
  for (size_t i = 0; i < linksOf_.size(); ++i) weigh(i, false);
  if (weldFrames()) {
    weldFollowers();
    group(floating);
  }
  for (size_t i = 0; i < linksOf_.size(); ++i) {
    if (out_.bodyOf[i] == i) weigh(i, !rests(i));
  }
  giveFramesMass();
  return std::move(out_);
}

}  // namespace

Posed inBody(const Groups& groups, const std::vector<Posed>& poses, size_t link) {
  return mjcf::inverse(poses[groups.bodyOf[link]]) * poses[link];
}

Groups groupsOf(const Description& description, const std::vector<Posed>& poses, const std::vector<LinkHulls>& hulls,
                bool floating, Notes& notes) {
  return GroupBuilder(description, poses, hulls, notes).build(floating);
}

}  // namespace avbd::urdf
