// What elements and hinges of soft bodies are at rest (soft_mesh_parts.h).
#include <cmath>

#include "geom/soft_mesh_parts.h"

namespace avbd::soft_mesh {
namespace {

TetAtRest tetAtRest(const SoftMeshData::Parts& mesh, size_t tet) {
  const auto& t = mesh.tets[tet];
  const auto at = [&](size_t i) { return toDouble(mesh.points[t[i]]); };
  const Vec3d b = at(1) - at(0), c = at(2) - at(0), d = at(3) - at(0);
  const double six = dot(b, crossOf(c, d));
  return {toFloat(crossOf(c, d) * (1 / six)), toFloat(crossOf(d, b) * (1 / six)), toFloat(crossOf(b, c) * (1 / six)),
          static_cast<float>(six / 6)};
}

TriangleAtRest triangleAtRest(const SoftMeshData::Parts& mesh, size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const auto at = [&](size_t i) { return toDouble(mesh.points[t[i]]); };
  const Vec3d b = at(1) - at(0), c = at(2) - at(0), normal = crossOf(b, c);
  const double length = std::sqrt(dot(b, b)), twice = std::sqrt(dot(normal, normal));
  // In the frame along b: b = (length, 0), c = (along, twice / length).
  const double along = dot(b, c) / length, height = twice / length;
  return {static_cast<float>(1 / length), static_cast<float>(-along / (length * height)), 0,
          static_cast<float>(1 / height), static_cast<float>(twice / 2)};
}

HingeAtRest hingeAtRest(const SoftMeshData::Parts& mesh, size_t hinge) {
  const auto& h = mesh.hinges[hinge];
  const auto at = [&](size_t i) { return toDouble(mesh.points[h[i]]); };
  const auto twiceArea = [&](size_t corner) {
    const Vec3d n = crossOf(at(1) - at(0), at(corner) - at(0));
    return std::sqrt(dot(n, n));
  };
  /// Of the angle at an end of the edge, in the triangle with that corner.
  const auto cotangent = [&](size_t end, size_t corner) {
    return dot(at(1 - end) - at(end), at(corner) - at(end)) / twiceArea(corner);
  };
  const double c02 = cotangent(0, 2), c03 = cotangent(0, 3), c12 = cotangent(1, 2), c13 = cotangent(1, 3);
  return {{static_cast<float>(c12 + c13), static_cast<float>(c02 + c03), static_cast<float>(-c02 - c12),
           static_cast<float>(-c03 - c13)},
          static_cast<float>((twiceArea(2) + twiceArea(3)) / 2)};
}

}  // namespace

void findRest(SoftMeshData::Parts& parts) {
  for (size_t i = 0; i < parts.tets.size(); ++i) parts.tetsAtRest.push_back(tetAtRest(parts, i));
  for (size_t i = 0; i < parts.triangles.size(); ++i) parts.trianglesAtRest.push_back(triangleAtRest(parts, i));
  for (size_t i = 0; i < parts.hinges.size(); ++i) parts.hingesAtRest.push_back(hingeAtRest(parts, i));
  findStars(parts);
}

}  // namespace avbd::soft_mesh
