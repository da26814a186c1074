// Exact quickhull (hull_exact.h).
#include "geom/hull_exact.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"

namespace avbd {
namespace {

__extension__ using Int128 = __int128;

struct ExactNormal {
  Int128 x, y, z;
};

/// (b - a) x (c - a); grid coordinates are integers below 2^39 in size, so this fits 81 bits.
ExactNormal exactNormal(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d u = b - a, v = c - a;
  const auto whole = [](double d) { return static_cast<Int128>(static_cast<int64_t>(d)); };
  const Int128 ux = whole(u.x), uy = whole(u.y), uz = whole(u.z), vx = whole(v.x), vy = whole(v.y), vz = whole(v.z);
  return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

constexpr double kSure = 1.0 / 32;  // cells; beyond it a distance in double has the right sign

}  // namespace

HullGrid::HullGrid(Vec3d lower, Vec3d upper) : center_((lower + upper) * 0.5) {
  const Vec3d size = upper - lower;
  const double extent = std::fmax(size.x, std::fmax(size.y, size.z));
  // The power of two that brings half the extent into (2^37, 2^38].
  int exponent = 0;
  if (extent > 0) std::frexp(extent, &exponent);
  scale_ = std::ldexp(1.0, 38 - exponent);
}

Vec3d HullGrid::toGrid(Vec3d p) const {
  const Vec3d d = (p - center_) * scale_;
  return {std::nearbyint(d.x), std::nearbyint(d.y), std::nearbyint(d.z)};
}

int exactSide(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const ExactNormal n = exactNormal(a, b, c);
  const Vec3d r = d - a;
  const Int128 volume =
      n.x * static_cast<int64_t>(r.x) + n.y * static_cast<int64_t>(r.y) + n.z * static_cast<int64_t>(r.z);
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

uint32_t ExactHull::addFace(uint32_t a, uint32_t b, uint32_t c) {
  uint32_t index = static_cast<uint32_t>(faces_.size());
  if (free_.empty()) {
    faces_.emplace_back();
  } else {
    index = free_.back();
    free_.pop_back();
  }
  Face& face = faces_[index];
  face = {};
  face.vertex = {a, b, c};
  const ExactNormal n = exactNormal(at(a), at(b), at(c));
  AVBD_ASSERT(n.x != 0 || n.y != 0 || n.z != 0);
  face.normal = normalized({static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)});
  return index;
}

bool ExactHull::sees(uint32_t point, const Face& face) const {
  const double distance = above(face, point);
  if (distance > kSure) return true;
  if (distance < -kSure) return false;
  return exactSide(at(face.vertex[0]), at(face.vertex[1]), at(face.vertex[2]), points_[point]) >= 0;
}

bool ExactHull::isFarther(double distance, uint32_t point, double than, uint32_t other) const {
  if (distance != than) return distance > than;
  return other == kNone || lexLess(points_[point], points_[other]);
}

/// To the new face that the point lies farthest above; to none if it lies inside.
void ExactHull::assign(uint32_t point) {
  uint32_t best = kNone;
  double farthest = kSure;
  for (uint32_t f : fresh_) {
    const double distance = above(faces_[f], point);
    if (distance > farthest) farthest = distance, best = f;
  }
  if (best == kNone) return;
  Face& face = faces_[best];
  next_[point] = face.first;
  face.first = point;
  if (isFarther(farthest, point, face.distance, face.farthest)) face.farthest = point, face.distance = farthest;
}

ExactHull::Flat ExactHull::begin(double tolerance) {
  const uint32_t count = static_cast<uint32_t>(points_.size());
  // The smallest and the largest along each axis; of the three pairs the one farther apart.
  uint32_t low[3] = {}, high[3] = {};
  const auto axis = [](Vec3d p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; };
  for (uint32_t i = 1; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double v = axis(points_[i], k), l = axis(points_[low[k]], k), h = axis(points_[high[k]], k);
      if (v < l || (v == l && lexLess(points_[i], points_[low[k]]))) low[k] = i;
      if (v > h || (v == h && lexLess(points_[i], points_[high[k]]))) high[k] = i;
    }
  }
  uint32_t corner[4] = {};
  double best = -1;
  for (int k = 0; k < 3; ++k) {
    const double d = length(points_[high[k]] - points_[low[k]]);
    if (d > best) best = d, corner[0] = low[k], corner[1] = high[k];
  }
  if (best <= tolerance) return Flat::Point;
  const auto farthest = [&](auto distance) {
    uint32_t at = kNone;
    double most = -1;
    for (uint32_t i = 0; i < count; ++i) {
      const double d = distance(points_[i]);
      if (isFarther(d, i, most, at)) most = d, at = i;
    }
    best = most;
    return at;
  };
  const Vec3d a = points_[corner[0]], along = normalized(points_[corner[1]] - a);
  corner[2] = farthest([&](Vec3d p) { return length(cross(along, p - a)); });
  if (best <= tolerance) return Flat::Line;
  const ExactNormal n = exactNormal(a, points_[corner[1]], points_[corner[2]]);
  if (n.x == 0 && n.y == 0 && n.z == 0) return Flat::Line;
  const Vec3d normal = normalized({static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)});
  corner[3] = farthest([&](Vec3d p) { return std::fabs(dot(normal, p - a)); });
  if (best <= std::fmax(tolerance, kSure)) return Flat::Plane;
  if (exactSide(a, points_[corner[1]], points_[corner[2]], points_[corner[3]]) > 0) std::swap(corner[1], corner[2]);

  vertexPoint_.assign(corner, corner + 4);
  vertexCount_ = 4;
  fresh_ = {addFace(0, 1, 2), addFace(0, 3, 1), addFace(1, 3, 2), addFace(2, 3, 0)};
  faces_[0].across = {1, 2, 3};
  faces_[1].across = {3, 2, 0};
  faces_[2].across = {1, 3, 0};
  faces_[3].across = {2, 1, 0};
  next_.assign(count, kNone);
  for (uint32_t i = 0; i < count; ++i) assign(i);
  return Flat::No;
}

/// The faces that the point sees: a disc around the given one.
void ExactHull::findVisible(uint32_t point, uint32_t face) {
  visible_.assign(1, face);
  faces_[face].seen = true;
  for (size_t i = 0; i < visible_.size(); ++i) {
    const std::array<uint32_t, 3> across = faces_[visible_[i]].across;
    for (uint32_t next : across) {
      if (faces_[next].seen || !sees(point, faces_[next])) continue;
      faces_[next].seen = true;
      visible_.push_back(next);
    }
  }
}

/// The visible faces' rim, as a cycle that starts with its oldest vertex. Counts the vertices that it encloses out.
void ExactHull::findHorizon() {
  std::vector<Rim> after(vertexPoint_.size());
  std::vector<bool> touched(vertexPoint_.size());
  int touchedCount = 0;
  uint32_t start = kNone;
  size_t edges = 0;
  for (uint32_t f : visible_) {
    const Face& face = faces_[f];
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = face.vertex[i];
      if (!touched[v]) touched[v] = true, ++touchedCount;
      if (faces_[face.across[i]].seen) continue;
      after[v] = {v, face.vertex[(i + 1) % 3], face.across[i]};
      start = std::min(start, v);
      ++edges;
    }
  }
  rim_.clear();
  uint32_t v = start;
  do {
    rim_.push_back(after[v]);
    v = after[v].to;
  } while (v != start && rim_.size() <= edges);
  AVBD_ASSERT(rim_.size() == edges);
  vertexCount_ -= touchedCount - static_cast<int>(edges);
}

/// Faces from the horizon to the apex.
void ExactHull::makeCone(uint32_t apex) {
  fresh_.clear();
  for (const Rim& edge : rim_) fresh_.push_back(addFace(edge.from, edge.to, apex));
  const size_t count = fresh_.size();
  for (size_t i = 0; i < count; ++i) {
    faces_[fresh_[i]].across = {rim_[i].beyond, fresh_[(i + 1) % count], fresh_[(i + count - 1) % count]};
    Face& beyond = faces_[rim_[i].beyond];
    for (int k = 0; k < 3; ++k) {
      if (beyond.vertex[k] == rim_[i].to) beyond.across[k] = fresh_[i];
    }
  }
}

void ExactHull::insert(uint32_t point, uint32_t face) {
  findVisible(point, face);
  findHorizon();
  vertexPoint_.push_back(point);
  ++vertexCount_;
  makeCone(static_cast<uint32_t>(vertexPoint_.size() - 1));
  for (uint32_t f : visible_) {
    for (uint32_t waiting = faces_[f].first; waiting != kNone;) {
      const uint32_t after = next_[waiting];
      if (waiting != point) assign(waiting);
      waiting = after;
    }
    faces_[f].alive = faces_[f].seen = false;
    faces_[f].first = kNone;
  }
  // Last in, first out: the faces' places, too, depend on the geometry alone.
  free_.insert(free_.end(), visible_.begin(), visible_.end());
}

ExactHull::Waiting ExactHull::farthestByPlane() const {
  Waiting best;
  for (uint32_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (!face.alive || face.farthest == kNone) continue;
    if (isFarther(face.distance, face.farthest, best.distance, best.point)) best = {face.farthest, f, face.distance};
  }
  return best;
}

/// Among all that wait. A point that projects into its own face is as far from the hull as from that plane.
ExactHull::Waiting ExactHull::farthestByEuclid() const {
  std::vector<Vec3d> corners;
  std::vector<bool> used(vertexPoint_.size());
  for (const Face& face : faces_) {
    if (!face.alive) continue;
    for (uint32_t v : face.vertex) used[v] = true;
  }
  for (uint32_t v = 0; v < vertexPoint_.size(); ++v) {
    if (used[v]) corners.push_back(at(v));
  }
  Waiting best;
  for (uint32_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (!face.alive) continue;
    const Vec3d a = at(face.vertex[0]), b = at(face.vertex[1]), c = at(face.vertex[2]);
    for (uint32_t i = face.first; i != kNone; i = next_[i]) {
      const Vec3d p = points_[i];
      double distance = length(p - nearestInTriangle(p, a, b, c));
      if (distance < best.distance) continue;
      const Vec3d q = p - face.normal * dot(face.normal, p - a);
      const bool within = dot(cross(b - a, q - a), face.normal) >= 0 && dot(cross(c - b, q - b), face.normal) >= 0 &&
                          dot(cross(a - c, q - c), face.normal) >= 0;
      if (!within) distance = length(p - nearestInHull(p, corners));
      if (isFarther(distance, i, best.distance, best.point)) best = {i, f, distance};
    }
  }
  return best;
}

void ExactHull::grow(double tolerance, int limit) {
  for (;;) {
    Waiting next;
    while (vertexCount_ < limit && (next = farthestByPlane()).point != kNone && next.distance > tolerance) {
      insert(next.point, next.face);
    }
    if (vertexCount_ >= limit) return;
    next = farthestByEuclid();
    if (next.point == kNone || next.distance <= tolerance) return;
    insert(next.point, next.face);
  }
}

double ExactHull::errorOf(const std::vector<Triangle>& triangles) {
  std::vector<uint32_t> outside = vertexPoint_;
  for (const Face& face : faces_) {
    if (!face.alive) continue;
    for (uint32_t i = face.first; i != kNone; i = next_[i]) outside.push_back(i);
  }
  vertexPoint_.clear();
  faces_.clear();
  free_.clear();
  fresh_.clear();
  for (const Triangle& t : triangles) {
    const uint32_t v = static_cast<uint32_t>(vertexPoint_.size());
    vertexPoint_.insert(vertexPoint_.end(), t.vertex.begin(), t.vertex.end());
    fresh_.push_back(addFace(v, v + 1, v + 2));
    faces_.back().across = t.across;
  }
  for (uint32_t i : outside) assign(i);
  return farthestByEuclid().distance;
}

std::vector<ExactHull::Triangle> ExactHull::triangles() const {
  std::vector<uint32_t> place(faces_.size());
  uint32_t count = 0;
  for (uint32_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].alive) place[f] = count++;
  }
  std::vector<Triangle> all;
  for (const Face& face : faces_) {
    if (!face.alive) continue;
    Triangle t;
    for (int i = 0; i < 3; ++i) t.vertex[i] = vertexPoint_[face.vertex[i]], t.across[i] = place[face.across[i]];
    all.push_back(t);
  }
  return all;
}

}  // namespace avbd
