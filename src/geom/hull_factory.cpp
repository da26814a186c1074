// Finished polyhedra: planes, edges, neighbours, inner ball, masses (hull_builder.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.h"
#include "base/hash.h"
#include "geom/hull_builder.h"
#include "geom/hull_merge.h"
#include "geom/solid_moments.h"

namespace avbd {
namespace {

/// The float at or above a double.
float roundedUp(double value) {
  const float f = static_cast<float>(value);
  return f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

struct Plane {
  Vec3d normal;
  double offset;
};

/// The centre of the largest ball inside, nearly: walks uphill on the distance to the nearest plane, which is concave.
/// The direction is the one that leaves all planes that are nearly nearest at least at the same rate.
Vec3d deepestPoint(std::span<const Plane> planes, Vec3d start, double size) {
  const auto depth = [&](Vec3d p) {
    double least = 1e300;
    for (const Plane& plane : planes) least = std::fmin(least, plane.offset - dot(plane.normal, p));
    return least;
  };
  Vec3d p = start;
  double deep = depth(p);
  std::vector<Vec3d> near;
  double band = size / 8;
  for (int round = 0; round < 60 && band > 1e-7 * size; ++round) {
    near.clear();
    for (const Plane& plane : planes) {
      if (plane.offset - dot(plane.normal, p) <= deep + band) near.push_back(plane.normal);
    }
    const Vec3d away = nearestInHull({0, 0, 0}, near);
    const double rate = length(away);
    // Planes of the band on all sides: nothing to gain at this width.
    if (rate < 1e-6) {
      band /= 4;
      continue;
    }
    // As far as the nearest plane's distance grows; the path bends where another plane becomes the nearest.
    const Vec3d step = away * (-1 / rate);
    double far = size;
    double best = deep;
    Vec3d to = p;
    for (int half = 0; half < 40; ++half, far /= 2) {
      const Vec3d q = p + step * far;
      const double d = depth(q);
      if (d > best)
        best = d, to = q;
      else if (best > deep)
        break;
    }
    if (!(best > deep)) {
      band /= 4;
      continue;
    }
    p = to;
    deep = best;
  }
  return p;
}

}  // namespace

void HullFactory::fillFaces(HullData& hull, const HullParts& parts) {
  std::vector<Vec3d> points;
  for (const Vec3& v : parts.vertices) points.push_back(toDouble(v));
  for (const auto& loop : parts.loops) {
    HullData::Face face;
    face.normal = toFloat(normalized(loopArea(points, loop)));
    const Vec3d normal = toDouble(face.normal);
    double support = -1e300;
    for (const Vec3d& p : points) support = std::fmax(support, dot(normal, p));
    face.offset = roundedUp(support);
    face.first = static_cast<uint16_t>(hull.loops_.size());
    face.count = static_cast<uint16_t>(loop.size());
    for (uint32_t v : loop) hull.loops_.push_back(static_cast<uint8_t>(v));
    hull.faces_.push_back(face);
  }
}

/// Edges by their smaller vertex, then the larger; each vertex's neighbours in the same order.
void HullFactory::fillEdges(HullData& hull) {
  struct Half {
    uint8_t from, to;
    uint16_t face;
  };
  std::vector<Half> halves;
  for (size_t f = 0; f < hull.faces_.size(); ++f) {
    const HullData::Face& face = hull.faces_[f];
    for (int i = 0; i < face.count; ++i) {
      const uint8_t a = hull.loops_[face.first + i], b = hull.loops_[face.first + (i + 1) % face.count];
      halves.push_back({a, b, static_cast<uint16_t>(f)});
    }
  }
  const auto byEnds = [](const Half& l, const Half& r) { return l.from != r.from ? l.from < r.from : l.to < r.to; };
  std::sort(halves.begin(), halves.end(), byEnds);
  hull.neighborFirst_.assign(hull.vertices_.size() + 1, 0);
  for (const Half& half : halves) {
    hull.neighbors_.push_back(half.to);
    ++hull.neighborFirst_[half.from + 1];
    const auto twin = std::lower_bound(halves.begin(), halves.end(), Half{half.to, half.from, 0}, byEnds);
    AVBD_ASSERT(twin != halves.end() && twin->from == half.to && twin->to == half.from);
    if (half.from < half.to) hull.edges_.push_back({{half.from, half.to}, {half.face, twin->face}});
  }
  for (size_t v = 0; v < hull.vertices_.size(); ++v) hull.neighborFirst_[v + 1] += hull.neighborFirst_[v];
}

/// Bounds, masses, inner ball.
void HullFactory::fillInside(HullData& hull) {
  hull.lower_ = hull.upper_ = hull.vertices_[0];
  std::vector<Vec3d> points;
  for (const Vec3& v : hull.vertices_) {
    hull.lower_ = {std::fmin(hull.lower_.x, v.x), std::fmin(hull.lower_.y, v.y), std::fmin(hull.lower_.z, v.z)};
    hull.upper_ = {std::fmax(hull.upper_.x, v.x), std::fmax(hull.upper_.y, v.y), std::fmax(hull.upper_.z, v.z)};
    points.push_back(toDouble(v));
  }
  const SolidMoments moments = polyhedronMoments(points, hullTriangles(points));
  hull.volume_ = moments.volume;
  hull.massCenter_ = moments.center;
  const SymMat3d& m = moments.second;
  hull.second_ = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
  std::vector<Plane> planes;
  for (const HullData::Face& face : hull.faces_) planes.push_back({toDouble(face.normal), face.offset});
  hull.center_ = toFloat(deepestPoint(planes, moments.center, length(hull.upper_ - hull.lower_)));
  double radius = 1e300;
  for (const Plane& plane : planes) {
    radius = std::fmin(radius, plane.offset - dot(plane.normal, toDouble(hull.center_)));
  }
  hull.innerRadius_ = static_cast<float>(std::fmax(radius, 0));
}

SolidMoments HullFactory::moments(const HullData& hull) {
  const auto& m = hull.second_;
  return {hull.volume_, hull.massCenter_, {m[0], m[1], m[2], m[3], m[4], m[5]}};
}

std::shared_ptr<const HullData> HullFactory::make(const HullParts& parts) {
  const std::shared_ptr<HullData> hull(new HullData);
  hull->vertices_ = parts.vertices;
  hull->error_ = roundedUp(parts.error);
  fillFaces(*hull, parts);
  fillEdges(*hull);
  fillInside(*hull);
  Hash64 hash;
  for (const Vec3& v : hull->vertices_) hash.value(v.x), hash.value(v.y), hash.value(v.z);
  for (const HullData::Face& face : hull->faces_) hash.value(face.count);
  hash.values(hull->loops_);
  hull->hash_ = hash.digest();
  return hull;
}

std::shared_ptr<const HullData> HullFactory::scale(const HullData& hull, Vec3 scale) {
  HullParts parts;
  const bool mirrored = scale.x * scale.y * scale.z < 0;
  for (const Vec3& v : hull.vertices_) parts.vertices.push_back({v.x * scale.x, v.y * scale.y, v.z * scale.z});
  for (const HullData::Face& face : hull.faces_) {
    std::vector<uint32_t> loop(hull.loops_.begin() + face.first, hull.loops_.begin() + face.first + face.count);
    if (mirrored) std::reverse(loop.begin() + 1, loop.end());
    parts.loops.push_back(std::move(loop));
  }
  const double largest = std::fmax(std::fabs(scale.x), std::fmax(std::fabs(scale.y), std::fabs(scale.z)));
  parts.error = hull.error_ * largest;
  return make(parts);
}

}  // namespace avbd
