// Stars of the points of solids at rest (soft_mesh_parts.h).
#include <algorithm>

#include "geom/soft_mesh_parts.h"

namespace avbd::soft_mesh {
namespace {

/// A corner of a tetrahedron of the star.
struct Share {
  uint32_t point;
  Vec3d gradient;  ///< times the volume [m^2]
};

std::vector<std::vector<uint32_t>> tetsOfPoints(const SoftMeshData::Parts& parts) {
  std::vector<std::vector<uint32_t>> of(parts.points.size());
  for (uint32_t i = 0; i < parts.tets.size(); ++i)
    for (const uint32_t p : parts.tets[i]) of[p].push_back(i);
  return of;
}

}  // namespace

void findStars(SoftMeshData::Parts& parts) {
  if (parts.tets.empty()) return;
  std::vector<Share> shares;
  parts.starBegin.push_back(0);
  const std::vector<std::vector<uint32_t>> tetsOf = tetsOfPoints(parts);
  for (uint32_t center = 0; center < tetsOf.size(); ++center) {
    shares.clear();
    double volume = 0;
    for (const uint32_t i : tetsOf[center]) {
      const TetAtRest& tet = parts.tetsAtRest[i];
      const Vec3d b = toDouble(tet.gb), c = toDouble(tet.gc), d = toDouble(tet.gd);
      const Vec3d gradients[4] = {(b + c + d) * -1.0, b, c, d};
      volume += double{tet.volume};
      for (size_t k = 0; k < 4; ++k) shares.push_back({parts.tets[i][k], gradients[k] * double{tet.volume}});
    }
    std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.point < b.point; });
    for (size_t i = 0; i < shares.size();) {
      const uint32_t point = shares[i].point;
      Vec3d sum{};
      for (; i < shares.size() && shares[i].point == point; ++i) sum = sum + shares[i].gradient;
      if (point != center) parts.starPoints.push_back({point, toFloat(sum * (1 / volume))});
    }
    parts.starBegin.push_back(static_cast<uint32_t>(parts.starPoints.size()));
    parts.starVolumes.push_back(static_cast<float>(volume / 4));
  }
}

}  // namespace avbd::soft_mesh
