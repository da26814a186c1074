// The tree of an articulation (articulation_tree.h): joints around each body, walked breadth first, so that links are
// as near the root as can be and loops are cut at their far end.
#include "api/articulation_tree.h"

#include <algorithm>
#include <map>

#include "api/articulation_joint.h"

namespace avbd::articulation {
namespace {

struct Edge {
  JointId joint;
  JointEnds ends;
  bool used = false;
};

bool isLink(const World& world, BodyId id) { return id && world.type(id) == BodyType::Dynamic; }

/// Joints and the bodies that they touch. Nothing here depends on addresses: maps are ordered by id.
class Walk {
 public:
  explicit Walk(const World& world) : world_(world) {}

  void add(JointId joint, JointEnds ends) {
    for (const BodyId body : {ends.a, ends.b})
      if (isLink(world_, body)) around_[body].push_back(edges_.size());
    edges_.push_back({joint, ends});
  }

  /// From the base, or where no joint holds on to it from `root`.
  Tree run(BodyId root) {
    Tree tree;
    for (Edge& edge : edges_)
      if (!isLink(world_, edge.ends.a) || !isLink(world_, edge.ends.b)) cross(tree, edge, BodyId{}, -1);
    tree.floating = tree.links.empty();
    if (tree.floating) place(tree, {.body = root});
    for (size_t at = 0; at < tree.links.size(); ++at) {
      const BodyId body = tree.links[at].body;
      for (const size_t i : around_[body])
        if (!edges_[i].used) cross(tree, edges_[i], body, static_cast<int>(at));
    }
    return tree;
  }

  const std::vector<Edge>& edges() const { return edges_; }

 private:
  /// Goes over a joint from a link, or from the base where `from` is null.
  void cross(Tree& tree, Edge& edge, BodyId from, int parent) {
    edge.used = true;
    const bool reversed = from ? edge.ends.b == from : isLink(world_, edge.ends.a);
    const BodyId child = reversed ? edge.ends.a : edge.ends.b, base = reversed ? edge.ends.b : edge.ends.a;
    if (index_.contains(child)) {
      tree.loopJoints.push_back(edge.joint);
      return;
    }
    place(tree,
          {.body = child, .joint = edge.joint, .parent = parent, .base = from ? BodyId{} : base, .reversed = reversed});
  }

  void place(Tree& tree, const ArticulationLink& link) {
    index_[link.body] = tree.links.size();
    tree.links.push_back(link);
  }

  const World& world_;
  std::vector<Edge> edges_;
  std::map<BodyId, std::vector<size_t>> around_;
  std::map<BodyId, size_t> index_;
};

/// Links cannot have locked axes: no coordinate would tell them.
void checkEnds(const World& world, const Path& path, JointId joint, JointEnds ends) {
  bool any = false;
  for (const BodyId body : {ends.a, ends.b}) {
    if (!isLink(world, body)) continue;
    any = true;
    if (world.locks(body) != kLockNone) path.refuse(toText(joint), "must join bodies without locked axes");
  }
  if (!any) path.refuse(toText(joint), "must join a dynamic body");
}

JointEnds checkedEnds(const World& world, const Path& path, JointId joint) {
  if (!world.isAlive(joint)) path.refuse(toText(joint), "must name a living joint of this world");
  if (!isTreeJoint(world.type(joint))) path.refuse(toText(joint), "must name a hinge, slider, ball, D6 or fixed joint");
  if (!world.isEnabled(joint)) path.refuse(toText(joint), "must name a joint that is enabled");
  const JointEnds ends = readJoint(world, joint).ends;
  checkEnds(world, path, joint, ends);
  return ends;
}

/// Joints of the world that a tree can have, around their bodies.
struct Neighbours {
  std::vector<Edge> edges;
  std::map<BodyId, std::vector<size_t>> around;
};

Neighbours neighboursOf(const World& world) {
  Neighbours out;
  for (const JointId joint : world.joints()) {
    if (!isTreeJoint(world.type(joint)) || !world.isEnabled(joint)) continue;
    const JointEnds ends = readJoint(world, joint).ends;
    if (!isLink(world, ends.a) && !isLink(world, ends.b)) continue;
    for (const BodyId body : {ends.a, ends.b})
      if (body) out.around[body].push_back(out.edges.size());
    out.edges.push_back({joint, ends});
  }
  return out;
}

/// Indices of the joints that can be reached, ascending.
std::vector<size_t> reached(const World& world, const Neighbours& all, BodyId root) {
  std::vector<BodyId> bodies{root};
  std::vector<bool> found(all.edges.size(), false);
  std::map<BodyId, bool> seen{{root, true}};
  for (size_t at = 0; at < bodies.size(); ++at) {
    const auto around = all.around.find(bodies[at]);
    if (around == all.around.end()) continue;
    for (const size_t i : around->second) {
      found[i] = true;
      for (const BodyId next : {all.edges[i].ends.a, all.edges[i].ends.b})
        if (isLink(world, next) && !seen[next]) seen[next] = true, bodies.push_back(next);
    }
  }
  std::vector<size_t> out;
  for (size_t i = 0; i < found.size(); ++i)
    if (found[i]) out.push_back(i);
  return out;
}

}  // namespace

Tree treeOf(const World& world, std::span<const JointId> joints) {
  const Path call("Articulation"), path = call / "joints";
  if (joints.empty()) path.refuse("none", "must name at least one joint");
  Walk walk(world);
  std::vector<JointId> sorted(joints.begin(), joints.end());
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 0; i < joints.size(); ++i) {
    const Path at = path[i];
    walk.add(joints[i], checkedEnds(world, at, joints[i]));
    if (std::upper_bound(sorted.begin(), sorted.end(), joints[i]) -
            std::lower_bound(sorted.begin(), sorted.end(), joints[i]) >
        1) {
      at.refuse(toText(joints[i]), "must be named once");
    }
  }
  Tree tree = walk.run(walk.edges().front().ends.a);
  for (size_t i = 0; i < joints.size(); ++i)
    if (!walk.edges()[i].used) path[i].refuse(toText(joints[i]), "must be connected with the other joints");
  return tree;
}

Tree treeOf(const World& world, BodyId root) {
  const Path call("Articulation"), path = call / "root";
  if (!world.isAlive(root)) path.refuse(toText(root), "must name a living body of this world");
  const Neighbours all = neighboursOf(world);
  const std::vector<size_t> joints = reached(world, all, root);
  if (joints.empty()) path.refuse(toText(root), "must have a hinge, slider, ball, D6 or fixed joint");
  Walk walk(world);
  for (const size_t i : joints) {
    checkEnds(world, path, all.edges[i].joint, all.edges[i].ends);
    walk.add(all.edges[i].joint, all.edges[i].ends);
  }
  return walk.run(root);
}

}  // namespace avbd::articulation
