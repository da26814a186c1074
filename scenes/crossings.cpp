// Counting crossings of surfaces (crossings.h): faces by the cells of a grid that they overlap, edges against the faces
// of theirs, by the signs of volumes.
#include "scenes/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace avbd::scenes {
namespace {

Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double volumeOf(Vec3d a, Vec3d b, Vec3d c, Vec3d d) { return dot(crossOf(b - a, c - a), d - a); }

/// Surfaces of all soft bodies, points numbered over all.
struct Surfaces {
  std::vector<Vec3d> points;
  std::vector<std::array<uint32_t, 3>> faces;
  std::vector<std::array<uint32_t, 2>> edges;

  explicit Surfaces(std::span<const PlacedMesh> meshes) {
    for (const auto& [mesh, places] : meshes) {
      const auto begin = static_cast<uint32_t>(points.size());
      points.insert(points.end(), places.begin(), places.end());
      for (auto face : mesh->surface()) {
        for (uint32_t& p : face) p += begin;
        faces.push_back(face);
        for (size_t k = 0; k < 3; ++k)
          edges.push_back({std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])});
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }

  double edgeLength() const {
    double sum = 0;
    for (const auto& [a, b] : edges) sum += std::sqrt(dot(points[b] - points[a], points[b] - points[a]));
    return edges.empty() ? 1 : sum / static_cast<double>(edges.size());
  }
};

std::vector<PlacedMesh> meshesOf(const World& world) {
  std::vector<PlacedMesh> meshes;
  for (const SoftId id : world.softBodies()) {
    PlacedMesh& placed = meshes.emplace_back();
    placed.mesh = world.mesh(id);
    placed.points.resize(placed.mesh->points().size());
    world.getPoints(id, placed.points);
  }
  return meshes;
}

struct Cells {
  double size;
  /// Calls f(cell) for all that a triangle or an edge may overlap.
  template <size_t n, class F>
  void forEach(const Surfaces& s, const std::array<uint32_t, n>& part, F&& f) const {
    std::array<long, 3> low, high;
    low.fill(std::numeric_limits<long>::max()), high.fill(std::numeric_limits<long>::min());
    for (const uint32_t p : part) {
      const double at[3] = {s.points[p].x, s.points[p].y, s.points[p].z};
      for (size_t k = 0; k < 3; ++k) {
        const long cell = std::lround(std::floor(at[k] / size));
        low[k] = std::min(low[k], cell), high[k] = std::max(high[k], cell);
      }
    }
    for (long x = low[0]; x <= high[0]; ++x)
      for (long y = low[1]; y <= high[1]; ++y)
        for (long z = low[2]; z <= high[2]; ++z) f(std::array<long, 3>{x, y, z});
  }
};

bool passesThrough(const Surfaces& s, const std::array<uint32_t, 2>& edge, const std::array<uint32_t, 3>& face) {
  for (const uint32_t end : edge)
    if (end == face[0] || end == face[1] || end == face[2]) return false;
  const Vec3d p = s.points[edge[0]], q = s.points[edge[1]];
  const Vec3d a = s.points[face[0]], b = s.points[face[1]], c = s.points[face[2]];
  const double from = volumeOf(a, b, c, p), to = volumeOf(a, b, c, q);
  if ((from > 0) == (to > 0)) return false;
  const double u = volumeOf(p, q, a, b), v = volumeOf(p, q, b, c), w = volumeOf(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

}  // namespace

int crossings(const World& world) { return crossings(meshesOf(world)); }

int crossings(std::span<const PlacedMesh> meshes) {
  const Surfaces s(meshes);
  const Cells cells{2 * s.edgeLength()};
  std::vector<std::pair<std::array<long, 3>, uint32_t>> in;
  for (uint32_t f = 0; f < s.faces.size(); ++f)
    cells.forEach(s, s.faces[f], [&](const std::array<long, 3>& cell) { in.push_back({cell, f}); });
  std::sort(in.begin(), in.end());
  int count = 0;
  std::vector<uint32_t> seen;
  for (const auto& edge : s.edges) {
    seen.clear();
    cells.forEach(s, edge, [&](const std::array<long, 3>& cell) {
      for (auto at = std::lower_bound(in.begin(), in.end(), std::make_pair(cell, 0u)); at != in.end(); ++at) {
        if (at->first != cell) break;
        if (std::find(seen.begin(), seen.end(), at->second) != seen.end()) continue;
        seen.push_back(at->second);
        count += passesThrough(s, edge, s.faces[at->second]);
      }
    });
  }
  return count;
}

double distanceTo(const Solid& solid, Vec3d point) {
  const Quat q = solid.pose.rotation, back{q.w, -q.x, -q.y, -q.z};
  const Vec3d p = rotate(back, point - solid.pose.position);
  if (const auto* ball = std::get_if<Sphere>(&solid.geometry)) return std::sqrt(dot(p, p)) - double{ball->radius};
  if (std::get_if<HalfSpace>(&solid.geometry)) return p.y;
  if (const auto* capsule = std::get_if<Capsule>(&solid.geometry)) {
    const double half = double{capsule->halfHeight};
    const Vec3d off{p.x, p.y - std::clamp(p.y, -half, half), p.z};
    return std::sqrt(dot(off, off)) - double{capsule->radius};
  }
  const auto& box = std::get<Box>(solid.geometry);
  const double x = std::fabs(p.x) - double{box.x}, y = std::fabs(p.y) - double{box.y},
               z = std::fabs(p.z) - double{box.z};
  const Vec3d out{std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)};
  return std::max({x, y, z}) < 0 ? std::max({x, y, z}) : std::sqrt(dot(out, out));
}

double deepestInside(const World& world, const std::vector<Solid>& solids) {
  constexpr int kSamples = 4;
  const Surfaces s(meshesOf(world));
  double deepest = 0;
  for (const auto& [a, b] : s.edges)
    for (int i = 0; i <= kSamples; ++i) {
      const Vec3d p = s.points[a] + (s.points[b] - s.points[a]) * (static_cast<double>(i) / kSamples);
      for (const Solid& solid : solids) deepest = std::max(deepest, -distanceTo(solid, p));
    }
  return deepest;
}

}  // namespace avbd::scenes
