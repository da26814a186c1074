// Whose the parts of a touch are (soft_touch.h).
#include "world/soft_touch.h"

#include "geom/soft_mesh_parts.h"

namespace avbd {

uint32_t bodyOfFirst(const WorldData& data, const SoftTouch& touch) {
  return touch.kind == TouchKind::ShapeFace ? data.shapes[touch.first].body : data.softs[touch.first].bodies[0];
}

std::array<uint32_t, 4> nodesOf(const WorldData& data, const SoftTouch& touch) {
  const SoftData& second = data.softs[touch.second];
  if (touch.kind == TouchKind::EdgeEdge) {
    const SoftData& first = data.softs[touch.first];
    const auto& a = first.mesh->parts().features.edges[touch.firstPart];
    const auto& b = second.mesh->parts().features.edges[touch.secondPart];
    return {first.bodies[a[0]], first.bodies[a[1]], second.bodies[b[0]], second.bodies[b[1]]};
  }
  const auto& face = second.mesh->surface()[touch.secondPart];
  const uint32_t first = touch.kind == TouchKind::ShapeFace ? data.shapes[touch.first].body
                                                            : data.softs[touch.first].bodies[touch.firstPart];
  return {first, second.bodies[face[0]], second.bodies[face[1]], second.bodies[face[2]]};
}

std::array<float, 4> nodeWeights(TouchKind kind, Vec3 place) {
  if (kind == TouchKind::EdgeEdge) return {place.x - 1, -place.x, 1 - place.y, place.y};
  return {-1, place.x, place.y, place.z};
}

std::array<uint32_t, 2> shapesOf(const WorldData& data, const SoftTouch& touch) {
  const std::array<uint32_t, 4> nodes = nodesOf(data, touch);
  const uint32_t second = data.bodies[nodes[touch.kind == TouchKind::EdgeEdge ? 2 : 1]].firstShape;
  return {touch.kind == TouchKind::ShapeFace ? touch.first : data.bodies[nodes[0]].firstShape, second};
}

}  // namespace avbd
