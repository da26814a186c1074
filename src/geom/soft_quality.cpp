// How good the elements of a soft mesh are (soft_lattice.h).
#include <avbd/soft_lattice.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "geom/hull_math.h"

namespace avbd {
namespace {

void add(SoftMeshQuality& quality, double angle) {
  quality.leastAngle = std::fmin(quality.leastAngle, angle);
  quality.greatestAngle = std::fmax(quality.greatestAngle, angle);
}

void addTet(SoftMeshQuality& quality, const std::array<Vec3d, 4>& p) {
  // Of the face opposite each corner: its normal to the outside, twice its area long.
  constexpr size_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::array<Vec3d, 4> normals;
  double areas = 0, largest = 0;
  for (size_t i = 0; i < 4; ++i) {
    const auto& f = kFaces[i];
    normals[i] = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    areas += length(normals[i]);
    largest = std::fmax(largest, length(normals[i]));
  }
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < i; ++k)
      add(quality, angleOf(-dot(normals[i], normals[k]), length(cross(normals[i], normals[k]))));
  const Vec3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const double six = dot(a, cross(b, c));
  // The middle of the sphere through the corners, from corner 0, six volumes times two away.
  const Vec3d out = cross(b, c) * dot(a, a) + cross(c, a) * dot(b, b) + cross(a, b) * dot(c, c);
  const double inner = six / areas, outer = length(out) / (2 * six);
  quality.leastRadiusRatio = std::fmin(quality.leastRadiusRatio, 3 * inner / outer);
  quality.leastHeight = std::fmin(quality.leastHeight, six / largest);
}

void addTriangle(SoftMeshQuality& quality, const std::array<Vec3d, 3>& p) {
  const double area = length(cross(p[1] - p[0], p[2] - p[0])) / 2;
  std::array<double, 3> sides;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
    add(quality, angleOf(dot(u, v), length(cross(u, v))));
    sides[i] = length(u);
  }
  const double sum = sides[0] + sides[1] + sides[2], product = sides[0] * sides[1] * sides[2];
  quality.leastRadiusRatio = std::fmin(quality.leastRadiusRatio, 16 * area * area / (sum * product));
  const double longest = std::fmax(sides[0], std::fmax(sides[1], sides[2]));
  quality.leastHeight = std::fmin(quality.leastHeight, 2 * area / longest);
}

/// Sets of points that elements join.
class Pieces {
 public:
  explicit Pieces(size_t points) : to_(points), count_(static_cast<uint32_t>(points)) {
    std::iota(to_.begin(), to_.end(), 0u);
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a), b = root(b);
    if (a == b) return;
    to_[a] = b;
    --count_;
  }
  uint32_t count() const { return count_; }

 private:
  uint32_t root(uint32_t a) {
    while (to_[a] != a) a = to_[a] = to_[to_[a]];
    return a;
  }
  std::vector<uint32_t> to_;
  uint32_t count_;
};

template <size_t n>
std::array<Vec3d, n> cornersOf(const SoftMeshData& mesh, const std::array<uint32_t, n>& element, Pieces& pieces) {
  std::array<Vec3d, n> corners;
  for (size_t i = 0; i < n; ++i) {
    corners[i] = toDouble(mesh.points()[element[i]]);
    pieces.join(element[0], element[i]);
  }
  return corners;
}

}  // namespace

SoftMeshQuality qualityOf(const SoftMeshData& mesh) {
  SoftMeshQuality quality{.leastAngle = 4, .leastRadiusRatio = 1, .leastHeight = 1e300};
  Pieces pieces(mesh.points().size());
  for (const auto& tet : mesh.tets()) addTet(quality, cornersOf(mesh, tet, pieces));
  for (const auto& triangle : mesh.triangles()) addTriangle(quality, cornersOf(mesh, triangle, pieces));
  quality.pieces = pieces.count();
  return quality;
}

}  // namespace avbd
