// Bounds by dividing cells (decompose_measure.h).
#include "geom/decompose_measure.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace avbd {

double Solid3::outside(Vec3d p) const {
  const Cell c = grid.cellOf(p);
  const Voxel voxel = grid.at(c.x, c.y, c.z);
  const ClosedSurface::Nearest near = surface.nearest(p);
  const bool inside = voxel == Voxel::Inside || (voxel == Voxel::Surface && near.behind);
  return inside ? -near.distance : near.distance;
}

namespace {

constexpr double kHalfDiagonal = 1.7320508075688772;  // of a cube with half side 1

struct Cube {
  Vec3d middle;
  double half, bound;
  bool operator<(const Cube& other) const { return bound < other.bound; }
};

/// Largest distance above a face's plane; at most the distance from the hull, negative inside.
double abovePlanes(const HullData& hull, Vec3d p) {
  double most = -1e300;
  for (const HullData::Face& face : hull.faces()) most = std::fmax(most, dot(toDouble(face.normal), p) - face.offset);
  return most;
}

}  // namespace

Reach reachOf(const HullData& hull, const Solid3& solid, double floor, double slack) {
  std::vector<Vec3d> corners;
  Reach reach;
  for (const Vec3& v : hull.vertices()) {
    corners.push_back(toDouble(v));
    reach.found = std::fmax(reach.found, solid.outside(corners.back()));
  }
  std::priority_queue<Cube> open;
  const auto limit = [&] { return std::fmax(reach.found, floor) + slack; };
  const auto consider = [&](Vec3d middle, double half) {
    const double far = half * kHalfDiagonal, above = abovePlanes(hull, middle);
    if (above > far) return;
    // So near the surface, or inside, the cell's bound cannot exceed the limit.
    const double room = limit() - far;
    const Cell c = solid.grid.cellOf(middle);
    if (room >= 0 && (solid.grid.at(c.x, c.y, c.z) == Voxel::Inside || solid.surface.isWithin(middle, room))) return;
    const double distance = solid.outside(middle);
    if (above <= 0) {
      reach.found = std::fmax(reach.found, distance);
    } else if (far < slack && distance + far > limit()) {
      // The middle is no point of the hull; one near it is.
      reach.found = std::fmax(reach.found, solid.outside(nearestInHull(middle, corners)));
    }
    if (distance + far > limit()) open.push({middle, half, distance + far});
  };
  const Vec3 size = hull.upper() - hull.lower();
  consider((toDouble(hull.lower()) + toDouble(hull.upper())) * 0.5, std::fmax(size.x, std::fmax(size.y, size.z)) * 0.5);
  while (!open.empty() && open.top().bound > limit()) {
    const Cube cube = open.top();
    open.pop();
    const double half = cube.half / 2;
    for (int i = 0; i < 8; ++i) {
      consider(cube.middle + Vec3d{i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half}, half);
    }
  }
  reach.bound = limit();
  return reach;
}

}  // namespace avbd
