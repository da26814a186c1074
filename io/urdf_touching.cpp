// Which links of a robot overlap from the start.
#include "io/urdf_touching.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace avbd::urdf {

namespace {

using Pair = std::array<size_t, 2>;

// Of indices into model.bodies, each once, in ascending order.
std::vector<Pair> touchingPairs(const Model& model) {
  const World& world = model.world;
  std::vector<Pair> out;
  std::map<BodyId, size_t> indexOf;
  for (size_t i = 0; i < model.bodies.size(); ++i) indexOf[model.bodies[i].id] = i;
  for (size_t i = 0; i < model.bodies.size(); ++i) {
    QueryFilter others;
    others.ignore = model.bodies[i].id;
    for (const ShapeId shape : world.shapes(model.bodies[i].id)) {
      const Pose pose = world.pose(model.bodies[i].id) * world.localPose(shape);
      for (const ShapeId met : world.overlaps(world.geometry(shape), pose, others)) {
        const size_t k = indexOf.at(world.body(met));
        out.push_back({std::min(i, k), std::max(i, k)});
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

void separateTouching(Model& model, Notes& notes) {
  const auto excluded = model.world.excludedPairs();
  const std::set<std::array<BodyId, 2>> known(excluded.begin(), excluded.end());
  for (const auto& [i, k] : touchingPairs(model)) {
    const NamedBody &a = model.bodies[i], &b = model.bodies[k];
    if (known.contains({a.id, b.id}) || known.contains({b.id, a.id})) continue;
    model.world.excludeCollision(a.id, b.id);
    notes.add("links \"" + a.name + "\" and \"" + b.name + "\"", "overlap at the start: do not collide");
  }
}

}  // namespace avbd::urdf
