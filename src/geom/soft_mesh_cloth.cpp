// Cloth of triangles (soft_mesh.h).
#include <avbd/error.h>

#include <algorithm>
#include <cmath>

#include "base/format.h"
#include "geom/soft_mesh_parts.h"

namespace avbd {

using namespace soft_mesh;

namespace {

using Triangle = std::array<uint32_t, 3>;

[[noreturn]] void refuse(std::string field, std::string value, std::string range) {
  throw Error("ClothMeshDef", std::move(field), std::move(value), std::move(range));
}

/// Its least height is twice its area over its longest edge.
bool isFlat(std::span<const Vec3> points, const Triangle& t) {
  const Vec3d a = toDouble(points[t[0]]), b = toDouble(points[t[1]]), c = toDouble(points[t[2]]);
  const Vec3d n = crossOf(b - a, c - a);
  double longest = 0;
  for (const Vec3d& edge : {b - a, c - b, a - c}) longest = std::max(longest, dot(edge, edge));
  return !(std::sqrt(dot(n, n)) > kFlat * longest);
}

/// An edge with the triangle that has it, and that one's other corner.
struct Edge {
  std::array<uint32_t, 2> ends;
  uint32_t triangle, opposite;
};

std::vector<std::array<uint32_t, 4>> hingesOf(const std::vector<Triangle>& triangles) {
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < triangles.size(); ++i)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = triangles[i][k], b = triangles[i][(k + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, i, triangles[i][(k + 2) % 3]});
    }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle; });
  std::vector<std::array<uint32_t, 4>> hinges;
  for (size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i + 1; end < edges.size() && edges[end].ends == edges[i].ends;) ++end;
    if (end - i > 2)
      refuse("triangles",
             toText(end - i) + " of them share the edge " + toText(edges[i].ends[0]) + " " + toText(edges[i].ends[1]),
             "must be at most two at an edge");
    if (end - i == 2) hinges.push_back({edges[i].ends[0], edges[i].ends[1], edges[i].opposite, edges[i + 1].opposite});
  }
  return hinges;
}

}  // namespace

std::shared_ptr<const SoftMeshData> makeClothMesh(const ClothMeshDef& def) {
  check("ClothMeshDef", "triangles", def.points, def.triangles);
  auto parts = std::make_unique<SoftMeshData::Parts>();
  for (const Triangle& t : def.triangles) {
    if (isFlat(def.points, t))
      ++parts->report.degenerate;
    else
      parts->triangles.push_back(t);
  }
  dropDuplicates(parts->triangles, parts->report);
  if (parts->triangles.empty())
    refuse("triangles", toText(def.triangles.size()) + " triangles", "must have at least one that has area");
  takePoints(def.points, parts->triangles, *parts);
  parts->hinges = hingesOf(parts->triangles);
  parts->surface = parts->triangles;
  return finish(std::move(parts));
}

std::shared_ptr<const SoftMeshData> makeClothGrid(float hx, float hz, int nx, int nz) {
  for (const float h : {hx, hz})
    if (!(h > 0 && h <= 1e6f)) throw Error("makeClothGrid", "h", toText(h), "must be finite and > 0 and at most 1e+06");
  for (const int n : {nx, nz})
    if (n < 1 || n > 1000) throw Error("makeClothGrid", "cells", toText(n), "must be 1 .. 1000");
  std::vector<Vec3> points;
  const auto along = [](float half, int i, int n) {
    return half * (2 * static_cast<float>(i) / static_cast<float>(n) - 1);
  };
  for (int z = 0; z <= nz; ++z)
    for (int x = 0; x <= nx; ++x) points.push_back({along(hx, x, nx), 0, along(hz, z, nz)});
  const auto point = [&](int x, int z) { return static_cast<uint32_t>(z * (nx + 1) + x); };
  std::vector<Triangle> triangles;
  for (int z = 0; z < nz; ++z)
    for (int x = 0; x < nx; ++x) {
      const uint32_t a = point(x, z), b = point(x + 1, z), c = point(x + 1, z + 1), d = point(x, z + 1);
      if ((x + z) % 2 == 0)
        triangles.push_back({a, c, b}), triangles.push_back({a, d, c});
      else
        triangles.push_back({a, d, b}), triangles.push_back({b, d, c});
    }
  return makeClothMesh({points, triangles});
}

}  // namespace avbd
