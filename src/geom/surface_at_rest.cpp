// Surfaces at rest (surface_at_rest.h).
#include "geom/surface_at_rest.h"

#include "avbd/rows/math.h"

namespace avbd {

namespace {

constexpr float kAlike = 0.3f;   ///< cosine of the angle between faces of which neither can be before the other
constexpr float kBefore = 0.1f;  ///< sine of how far a face is before another's plane that counts as behind it

}  // namespace

Vec3 unitNormal(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  const float size2 = dot(n, n);
  return size2 > 0 ? n * (1 / rows::sqrt(size2)) : Vec3{};
}

bool surfaceFrame(Vec3 normal, Vec3 toNeighbour, SurfaceFrame& frame) {
  const float size2 = dot(normal, normal);
  if (!(size2 > 0)) return false;
  const Vec3 n = normal * (1 / rows::sqrt(size2));
  const Vec3 along = toNeighbour - n * dot(n, toNeighbour);
  const float length2 = dot(along, along);
  if (!(length2 > 1e-6f * dot(toNeighbour, toNeighbour))) return false;
  frame = {n, along * (1 / rows::sqrt(length2))};
  return true;
}

SurfaceAtRest::SurfaceAtRest(std::span<const Vec3> points, const FaceTree& tree,
                             std::span<const std::array<uint32_t, 3>> faces)
    : neighbour(points.size()), frames(points.size()) {
  std::vector<Vec3> sums(points.size());
  for (uint32_t i = 0; i < points.size(); ++i) neighbour[i] = i;
  for (const auto& face : faces) {
    const Vec3 a = points[face[0]], b = points[face[1]], c = points[face[2]], normal = unitNormal(a, b, c);
    centres.push_back((a + b + c) * (1.0f / 3));
    normals.push_back(normal);
    for (size_t k = 0; k < 3; ++k) {
      sums[face[k]] = sums[face[k]] + normal;
      neighbour[face[k]] = face[(k + 1) % 3];
    }
  }
  // A point whose faces have no mean normal keeps no frame: it counts as turned.
  for (size_t i = 0; i < points.size(); ++i) surfaceFrame(sums[i], points[neighbour[i]] - points[i], frames[i]);
  tree.refit(
      ranges,
      [&](uint32_t f) {
        return RestRange{{centres[f], centres[f]}, {normals[f], normals[f]}};
      },
      [](const RestRange& a, const RestRange& b) {
        return RestRange{merge(a.centres, b.centres), merge(a.normals, b.normals)};
      });
}

bool SurfaceAtRest::nodesAreBeside(uint32_t a, uint32_t b, float size) const {
  const Aabb both = merge(ranges[a].centres, ranges[b].centres);
  const Vec3 off = both.upper - both.lower;
  if (!(dot(off, off) < size * size)) return false;
  const Aabb directions = merge(ranges[a].normals, ranges[b].normals);
  const Vec3 apart = directions.upper - directions.lower;
  return dot(apart, apart) < 2 - 2 * kAlike;  // of unit vectors the square of what parts them
}

bool SurfaceAtRest::areBeside(uint32_t a, uint32_t b, float size, bool isCloth) const {
  const Vec3 off = centres[b] - centres[a];
  const float distance2 = dot(off, off);
  if (!(distance2 < size * size)) return false;
  if (dot(normals[a], normals[b]) > kAlike) return true;
  const float before = kBefore * rows::sqrt(distance2);
  return !isCloth && dot(normals[a], off) < before && dot(normals[b], off) > -before;
}

}  // namespace avbd
