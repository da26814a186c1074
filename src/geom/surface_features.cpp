// Points and edges of a triangulated surface (surface_features.h).
#include "geom/surface_features.h"

#include <algorithm>

namespace avbd {

namespace {

/// A side of a face, by its ends.
struct Side {
  std::array<uint32_t, 2> ends;
  uint32_t face, k;
};

std::vector<Side> sidesOf(std::span<const std::array<uint32_t, 3>> faces) {
  std::vector<Side> sides;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = faces[f][k], b = faces[f][(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, f, k});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& x, const Side& y) { return x.ends != y.ends ? x.ends < y.ends : x.face < y.face; });
  return sides;
}

}  // namespace

SurfaceFeatures surfaceFeatures(size_t points, std::span<const std::array<uint32_t, 3>> faces) {
  SurfaceFeatures all;
  all.faceEdges.resize(faces.size());
  all.owned.resize(faces.size());
  std::vector<uint8_t> taken(points);
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < 3; ++k) {
      if (taken[faces[f][k]]) continue;
      taken[faces[f][k]] = 1;
      all.owned[f] = static_cast<uint8_t>(all.owned[f] | 1u << k);
    }
  for (const Side& side : sidesOf(faces)) {
    const bool again = !all.edges.empty() && all.edges.back() == side.ends;
    if (again) {
      all.edgeFaces.back()[1] = side.face;
    } else {
      all.edges.push_back(side.ends);
      all.edgeFaces.push_back({side.face, SurfaceFeatures::kNoFace});
      all.owned[side.face] = static_cast<uint8_t>(all.owned[side.face] | 1u << (3 + side.k));
    }
    all.faceEdges[side.face][side.k] = static_cast<uint32_t>(all.edges.size() - 1);
  }
  return all;
}

}  // namespace avbd
