// Flexes of one dimension: edges that keep their lengths are rods in a chain, others are springs.
//
// A chain of rods with ball joints is a tree, which the solver holds exactly and fast. The rod from a point to the one
// before it is a body whose mass is all at its end, the point; what it has of a moment of inertia is small beside that.
// Edges that close a loop are distance joints between points.
#include <algorithm>
#include <cmath>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

namespace {

constexpr size_t kNone = ~size_t{0};

/// For each point the one before it on the way from one that is held, or from the first; kNone of those that begin.
std::vector<size_t> treeOf(const Flex& flex, const std::vector<bool>& held, std::vector<size_t>& order) {
  std::vector<std::vector<size_t>> next(flex.vertices.size());
  for (const FlexElement& e : flex.elements) next[e[0]].push_back(e[1]), next[e[1]].push_back(e[0]);
  std::vector<size_t> before(flex.vertices.size(), kNone);
  std::vector<bool> found = held;
  for (size_t i = 0; i < held.size(); ++i)
    if (held[i]) order.push_back(i);
  size_t at = 0;
  for (size_t first = 0; first <= found.size(); ++first) {
    for (; at < order.size(); ++at)
      for (const size_t to : next[order[at]]) {
        if (found[to]) continue;
        found[to] = true;
        before[to] = order[at];
        order.push_back(to);
      }
    if (first == found.size() || found[first]) continue;
    found[first] = true;
    order.push_back(first);
  }
  return before;
}

}  // namespace

/// A body of the world and a place in it; a place in the world for what stands still.
Builder::Held Builder::holderOf(const FlexVertex& vertex) const {
  const size_t body = static_cast<size_t>(vertex.body);
  const BodyId id = movingId(rootOf(body));
  return {id, {id ? (inRoot(body) * Posed{vertex.at, {}}).position : placeOf(vertex, start_), {}}};
}

double Builder::restLength(const Flex& flex, size_t a, size_t b) const {
  return length(placeOf(flex.vertices[a], rest_) - placeOf(flex.vertices[b], rest_));
}

void Builder::addRope(size_t index) {
  const Flex& flex = in_.flexes[index];
  if (flex.holdsEdges) return addRods(index);
  for (size_t v = 0; v < flex.vertices.size(); ++v)
    if (isPoint(flex.vertices[v], index)) addPoint(index, v);
  if (flex.elements.empty()) return;
  notes_.add(flex.where, "dim 1 without equality: touches with its points alone", "flex");
  if (!(flex.edgeStiffness > 0)) {
    notes_.add(flex.where, "its edges have neither stiffness nor an equality: nothing holds its points together",
               "flex");
    return;
  }
  for (const FlexElement& e : flex.elements) addEdge(flex, e);
}

void Builder::addEdge(const Flex& flex, const FlexElement& element) {
  const Held a = holderOf(flex.vertices[element[0]]), b = holderOf(flex.vertices[element[1]]);
  if (a.id == b.id) return;
  DistanceJoint joint{.bodyA = a.id, .bodyB = b.id, .frameA = a.frame, .frameB = b.frame};
  joint.min = joint.max = mjcf::narrow(restLength(flex, element[0], element[1]), flex.where);
  if (!flex.holdsEdges) {
    joint.stiffness = mjcf::narrow(flex.edgeStiffness, flex.where);
    joint.damping = mjcf::narrow(flex.edgeDamping, flex.where);
  }
  at(flex.where, [&] { return model_.world.create(joint); });
}

void Builder::addRods(size_t index) {
  const Flex& flex = in_.flexes[index];
  std::vector<bool> held;
  for (const FlexVertex& v : flex.vertices) held.push_back(!isPoint(v, index));
  std::vector<size_t> order;
  const std::vector<size_t> before = treeOf(flex, held, order);
  for (const size_t v : order)
    if (!held[v]) addRod(index, v, before[v]);
  for (const FlexElement& e : flex.elements)
    if (before[e[0]] != e[1] && before[e[1]] != e[0]) addEdge(flex, e);
}

// The point and what joins it to the one before.
void Builder::addRod(size_t index, size_t vertex, size_t before) {
  const Flex& flex = in_.flexes[index];
  const FlexVertex& v = flex.vertices[vertex];
  if (before == kNone) return addPoint(index, vertex);
  const Vec3d here = placeOf(v, start_), there = placeOf(flex.vertices[before], start_);
  const double rest = restLength(flex, vertex, before), now = length(there - here);
  if (!(rest > 0 && now > 0))
    throw FileError(flex.where + ": two points that an edge joins are at one place", in_.fileName);
  const Quatd turn = start_[static_cast<size_t>(v.body)].rotation;
  const Vec3d arm = rotate(conjugate(turn), there - here) * (rest / now);
  const double radius = radiusOfPoint(flex);
  ShapeDef shape = pointShape(index, radius);
  const Quatd zToY{std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  const double half = rest / 2;
  shape.geometry = Capsule{mjcf::narrow(radius, flex.where), mjcf::narrow(half, flex.where)};
  shape.pose = toPose({arm * 0.5, normalized(turnFromZ(arm) * zToY)});
  addPoint(index, vertex, shape);
  const Held from = holderOf(flex.vertices[before]);
  BallJoint joint{.bodyA = from.id, .bodyB = ids_[static_cast<size_t>(v.body)], .frameA = from.frame};
  joint.frameB.position = arm;
  at(flex.where, [&] { return model_.world.create(joint); });
}

}  // namespace avbd::mjcf
