// Fine points in the elements of a soft mesh (soft_binding.h).
#include <avbd/error.h>
#include <avbd/soft_binding.h>

#include <algorithm>
#include <cmath>

#include "base/format.h"
#include "geom/hull_math.h"
#include "geom/tree.h"

namespace avbd {
namespace {

constexpr float kMaxCoordinate = 1e6f;
constexpr double kSame = 1e-9;  // parts by which two distances differ and are still the same

bool inRange(float x) { return x >= -kMaxCoordinate && x <= kMaxCoordinate; }

void check(const SurfaceBindingDef& def) {
  const auto no = [](std::string field, std::string value, const char* range) {
    throw Error("SurfaceBindingDef", std::move(field), std::move(value), range);
  };
  if (!def.mesh) no("mesh", "null", "must be a soft mesh");
  if (def.points.empty()) no("points", "none", "must have at least one");
  for (size_t i = 0; i < def.points.size(); ++i) {
    const Vec3 p = def.points[i];
    if (!inRange(p.x) || !inRange(p.y) || !inRange(p.z))
      no("points[" + toText(i) + "]", toText(p), "must be finite and within +-1e+06");
  }
}

/// A point as one element sees it.
struct Seen {
  BoundPoint bound;
  double distance = 1e300;  // [m]
  double least = -1e300;    // of its weights

  /// Of elements at the same distance, as at a corner of the mesh, the one that needs the least extrapolation.
  bool isBetter(const Seen& than) const {
    if (distance < than.distance * (1 - kSame)) return true;
    if (distance > than.distance * (1 + kSame)) return false;
    return least != than.least ? least > than.least : bound.element < than.bound.element;
  }
};

/// The elements of a mesh, and which is nearest to a point.
class Elements {
 public:
  explicit Elements(const SoftMeshData& mesh) : mesh_(mesh) {
    for (uint32_t i = 0; i < mesh.tets().size(); ++i) insert(mesh.tets()[i], i);
    for (uint32_t i = 0; i < mesh.triangles().size(); ++i) insert(mesh.triangles()[i], i);
  }

  Seen nearest(Vec3 p) const {
    Seen best;
    tree_.around({p, p}, kFarAway, [&](uint32_t element, float) {
      const Seen seen = mesh_.isCloth() ? inTriangle(element, toDouble(p)) : inTet(element, toDouble(p));
      if (seen.isBetter(best)) best = seen;
      // A little more than the distance, as the tree asks in float.
      return static_cast<float>(best.distance * (1 + 1e-6));
    });
    return best;
  }

 private:
  template <size_t n>
  void insert(const std::array<uint32_t, n>& element, uint32_t index) {
    Aabb box{mesh_.points()[element[0]], mesh_.points()[element[0]]};
    for (const uint32_t i : element) box = merge(box, {mesh_.points()[i], mesh_.points()[i]});
    tree_.insert(box, index);
  }
  Vec3d at(uint32_t point) const { return toDouble(mesh_.points()[point]); }
  Seen inTet(uint32_t element, Vec3d p) const;
  Seen inTriangle(uint32_t element, Vec3d p) const;

  const SoftMeshData& mesh_;
  DynamicTree tree_;
};

Seen Elements::inTet(uint32_t element, Vec3d p) const {
  const auto& t = mesh_.tets()[element];
  const Vec3d o = at(t[0]), a = at(t[1]) - o, b = at(t[2]) - o, c = at(t[3]) - o, d = p - o;
  const double six = dot(a, cross(b, c));
  const double wa = dot(d, cross(b, c)) / six, wb = dot(d, cross(c, a)) / six, wc = dot(d, cross(a, b)) / six;
  Seen seen{{t, {1 - wa - wb - wc, wa, wb, wc}, 0, element}, 0, 0};
  seen.least = *std::min_element(seen.bound.weights.begin(), seen.bound.weights.end());
  if (seen.least >= 0) return seen;
  seen.distance = 1e300;
  for (size_t i = 0; i < 4; ++i) {
    // Seen from its opposite corner the nearest point lies behind only where that corner's weight is negative.
    if (seen.bound.weights[i] >= 0) continue;
    const Vec3d q = nearestInTriangle(p, at(t[(i + 1) % 4]), at(t[(i + 2) % 4]), at(t[(i + 3) % 4]));
    seen.distance = std::fmin(seen.distance, length(p - q));
  }
  return seen;
}

Seen Elements::inTriangle(uint32_t element, Vec3d p) const {
  const auto& t = mesh_.triangles()[element];
  const Vec3d o = at(t[0]), a = at(t[1]) - o, b = at(t[2]) - o, d = p - o, n = cross(a, b);
  const double square = dot(n, n), wa = dot(cross(d, b), n) / square, wb = dot(cross(a, d), n) / square;
  Seen seen{{{t[0], t[1], t[2], t[2]}, {1 - wa - wb, wa, wb, 0}, dot(d, n) / std::sqrt(square), element}, 0, 0};
  seen.least = std::fmin(1 - wa - wb, std::fmin(wa, wb));
  seen.distance = length(p - nearestInTriangle(p, o, o + a, o + b));
  return seen;
}

[[noreturn]] void refuse(const char* call, std::string field, size_t count, size_t needed) {
  throw Error(call, std::move(field), toText(count), "must be " + toText(needed));
}

}  // namespace

SurfaceBinding::SurfaceBinding(const SurfaceBindingDef& def) {
  check(def);
  const Elements elements(*def.mesh);
  cageSize_ = def.mesh->points().size();
  points_.reserve(def.points.size());
  for (const Vec3 p : def.points) {
    const Seen seen = elements.nearest(p);
    points_.push_back(seen.bound);
    if (!def.mesh->isCloth() && seen.least < 0) ++outside_;
    farthest_ = std::fmax(farthest_, seen.distance);
  }
}

void SurfaceBinding::skin(std::span<const Vec3d> cage, std::span<Vec3d> out) const {
  if (cage.size() != cageSize_) refuse("SurfaceBinding::skin", "cage.size", cage.size(), cageSize_);
  if (out.size() != points_.size()) refuse("SurfaceBinding::skin", "out.size", out.size(), points_.size());
  for (size_t i = 0; i < points_.size(); ++i) {
    const BoundPoint& p = points_[i];
    const Vec3d o = cage[p.corners[0]], a = cage[p.corners[1]] - o, b = cage[p.corners[2]] - o,
                c = cage[p.corners[3]] - o;
    out[i] = o + a * p.weights[1] + b * p.weights[2] + c * p.weights[3];
    if (p.offset != 0) out[i] = out[i] + normalized(cross(a, b)) * p.offset;
  }
}

void smoothNormals(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles,
                   std::span<Vec3> out) {
  if (out.size() != points.size()) refuse("smoothNormals", "out.size", out.size(), points.size());
  std::vector<Vec3d> sums(points.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& t = triangles[i];
    for (const uint32_t p : t)
      if (p >= points.size())
        throw Error("smoothNormals", "triangles[" + toText(i) + "]", toText(p),
                    "must be < " + toText(points.size()) + ", the points");
    const Vec3d n = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    for (const uint32_t p : t) sums[p] = sums[p] + n;
  }
  for (size_t i = 0; i < out.size(); ++i) out[i] = toFloat(normalized(sums[i]));
}

}  // namespace avbd
