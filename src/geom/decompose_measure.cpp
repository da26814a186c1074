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

namespace {

class LeftOutside {
 public:
  LeftOutside(const std::vector<std::shared_ptr<const HullData>>& hulls, const Solid3& solid, double floor,
              double slack)
      : hulls_(hulls), solid_(solid), floor_(floor), slack_(slack) {
    for (const auto& hull : hulls) {
      std::vector<Vec3d>& corners = corners_.emplace_back();
      for (const Vec3& v : hull->vertices()) corners.push_back(toDouble(v));
    }
  }

  Reach measure() {
    std::vector<Near> all;
    for (uint32_t i = 0; i < hulls_.size(); ++i) all.push_back({i, 0});
    const Vec3d lower = solid_.surface.lower(), size = solid_.surface.upper() - lower;
    search(lower + size * 0.5, std::fmax(size.x, std::fmax(size.y, size.z)) * 0.5, all);
    return {found_, limit()};
  }

 private:
  /// A hull, and the largest distance above a plane of its.
  struct Near {
    uint32_t hull;
    double above;
  };

  double limit() const { return std::fmax(floor_, found_ + slack_); }

  /// `candidates`: hulls of which one is nearest to each point of the cube.
  void search(Vec3d middle, double half, const std::vector<Near>& candidates) {
    const double far = half * kHalfDiagonal;
    std::vector<Near> near;
    for (const Near& c : candidates) {
      near.push_back({c.hull, abovePlanes(*hulls_[c.hull], middle)});
      // About the middle is a ball of that depth within the hull.
      if (near.back().above <= 0 && near.back().above + far <= limit()) return;
    }
    const double distance = distanceFrom(middle, near);
    if (distance + far <= limit()) return;
    const Cell c = solid_.grid.cellOf(middle);
    if (solid_.grid.at(c.x, c.y, c.z) == Voxel::Outside && !solid_.surface.isWithin(middle, far)) return;
    const double outside = solid_.outside(middle);
    if (outside > far) return;
    // A point of the solid is so near that no more than the way to it can be lost.
    found_ = std::fmax(found_, distance - std::fmax(outside, 0));
    if (distance + far <= limit()) return;
    std::erase_if(near, [&](const Near& n) { return n.above > distance + 2 * far; });
    const double h = half / 2;
    for (int i = 0; i < 8; ++i) search(middle + Vec3d{i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h}, h, near);
  }

  double distanceFrom(Vec3d p, std::vector<Near>& near) const {
    std::sort(near.begin(), near.end(),
              [](const Near& l, const Near& r) { return l.above != r.above ? l.above < r.above : l.hull < r.hull; });
    double least = near[0].above <= 0 ? 0 : 1e300;
    for (const Near& n : near) {
      if (n.above >= least) break;
      if (n.above > 0) least = std::fmin(least, length(p - nearestInHull(p, corners_[n.hull])));
    }
    return least;
  }

  const std::vector<std::shared_ptr<const HullData>>& hulls_;
  const Solid3& solid_;
  double floor_, slack_, found_ = 0;
  std::vector<std::vector<Vec3d>> corners_;
};

}  // namespace

Reach leftOutside(const std::vector<std::shared_ptr<const HullData>>& hulls, const Solid3& solid, double floor,
                  double slack) {
  return LeftOutside(hulls, solid, floor, slack).measure();
}

}  // namespace avbd
