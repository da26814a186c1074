// Exact penetration: separating axes for boxes, distances between segments, points and boxes for round shapes.
#include "scenes/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "scenes/penetration_convex.h"

namespace avbd::scenes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Kind : uint8_t { Sphere, Capsule, Box, Convex, Surface, HalfSpace };

Vec3d crossProduct(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

// A shape in world coordinates: a core (point, segment along axis[1], or box) grown by a radius.
struct Solid {
  Kind kind = Kind::Sphere;
  Vec3d center;
  std::array<Vec3d, 3> axis;
  Vec3d half;  // of a box; of a capsule only y
  double radius = 0;
  Vec3d lower, upper;
  ConvexBody convex;                // of what is not exact below
  std::vector<ConvexBody> surface;  // triangles
};

std::array<Vec3d, 3> axesOf(Quat q) {
  const double n = std::sqrt(double(q.w) * q.w + double(q.x) * q.x + double(q.y) * q.y + double(q.z) * q.z);
  const double w = q.w / n, x = q.x / n, y = q.y / n, z = q.z / n;
  return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3d{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

// A shape that only trying directions can measure.
Solid toGeneralSolid(const PlacedShape& shape, Solid s) {
  s.surface = surfaceBodies(shape.geometry, shape.pose);
  if (s.surface.empty()) {
    s.convex = convexBody(shape.geometry, shape.pose);
    s.lower = s.convex.lower();
    s.upper = s.convex.upper();
    return s;
  }
  s.kind = Kind::Surface;
  s.lower = {kInfinity, kInfinity, kInfinity};
  s.upper = {-kInfinity, -kInfinity, -kInfinity};
  for (const ConvexBody& t : s.surface) {
    const Vec3d low = t.lower(), high = t.upper();
    s.lower = {std::min(s.lower.x, low.x), std::min(s.lower.y, low.y), std::min(s.lower.z, low.z)};
    s.upper = {std::max(s.upper.x, high.x), std::max(s.upper.y, high.y), std::max(s.upper.z, high.z)};
  }
  return s;
}

Solid toSolid(const PlacedShape& shape) {
  Solid s;
  s.center = shape.pose.position;
  s.axis = axesOf(shape.pose.rotation);
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    s.radius = sphere->radius;
  } else if (const auto* capsule = std::get_if<Capsule>(&shape.geometry)) {
    s.kind = Kind::Capsule;
    s.radius = capsule->radius;
    s.half.y = capsule->halfHeight;
  } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
    s.kind = Kind::Box;
    s.half = {box->x, box->y, box->z};
    if (box->rounding > 0) s.kind = Kind::Convex;
  } else {
    s.kind = std::holds_alternative<HalfSpace>(shape.geometry) ? Kind::HalfSpace : Kind::Convex;
  }
  if (s.kind == Kind::Convex) return toGeneralSolid(shape, s);
  const auto reach = [&](double Vec3d::*c) {
    if (s.kind == Kind::HalfSpace) return kInfinity;
    return s.radius + std::abs(s.axis[0].*c) * s.half.x + std::abs(s.axis[1].*c) * s.half.y +
           std::abs(s.axis[2].*c) * s.half.z;
  };
  const Vec3d r{reach(&Vec3d::x), reach(&Vec3d::y), reach(&Vec3d::z)};
  s.lower = s.center - r;
  s.upper = s.center + r;
  return s;
}

// Half of a solid's core along a unit direction.
double coreReach(const Solid& s, Vec3d n) {
  return std::abs(dot(s.axis[0], n)) * s.half.x + std::abs(dot(s.axis[1], n)) * s.half.y +
         std::abs(dot(s.axis[2], n)) * s.half.z;
}

// Overlap of two boxes, or of a box and a capsule's segment: the least over the faces of their Minkowski difference.
// Zero or less where an axis separates them.
double axisDepth(const Solid& a, const Solid& b) {
  const Vec3d d = b.center - a.center;
  double depth = kInfinity;
  const auto test = [&](Vec3d n) {
    depth = std::min(depth, coreReach(a, n) + coreReach(b, n) - std::abs(dot(d, n)));
    return depth > 0;
  };
  const bool segment = b.kind == Kind::Capsule;
  for (const Vec3d& n : a.axis)
    if (!test(n)) return depth;
  for (const Vec3d& n : b.axis)
    if (!segment && !test(n)) return depth;
  for (const Vec3d& u : a.axis)
    for (size_t j = 0; j < 3; ++j) {
      if (segment && j != 1) continue;
      const Vec3d n = crossProduct(u, b.axis[j]);
      const double squared = dot(n, n);
      // Parallel edges add no face; any other direction is a true bound however short the product.
      if (squared < 1e-16) continue;
      if (!test(n * (1 / std::sqrt(squared)))) return depth;
    }
  return depth;
}

double pointBoxDistance(Vec3d p, Vec3d half) {
  const double x = std::max(0.0, std::abs(p.x) - half.x), y = std::max(0.0, std::abs(p.y) - half.y),
               z = std::max(0.0, std::abs(p.z) - half.z);
  return std::sqrt(x * x + y * y + z * z);
}

Vec3d toLocal(const Solid& box, Vec3d world) {
  const Vec3d d = world - box.center;
  return {dot(d, box.axis[0]), dot(d, box.axis[1]), dot(d, box.axis[2])};
}

double sphereBox(const Solid& sphere, const Solid& box) {
  const Vec3d p = toLocal(box, sphere.center);
  const double distance = pointBoxDistance(p, box.half);
  if (distance > 0) return sphere.radius - distance;
  const double inside = std::min({box.half.x - std::abs(p.x), box.half.y - std::abs(p.y), box.half.z - std::abs(p.z)});
  return sphere.radius + inside;
}

// Least distance of a segment p + t d, t in 0..1, to a box about the origin. Its square is convex and quadratic between
// the parameters at which a coordinate crosses a face, so the zero of its derivative is found exactly.
double segmentBoxDistance(Vec3d p, Vec3d d, Vec3d half) {
  std::array<double, 8> knots{0, 1, 1, 1, 1, 1, 1, 1};
  size_t count = 1;
  const double from[3] = {p.x, p.y, p.z}, along[3] = {d.x, d.y, d.z}, face[3] = {half.x, half.y, half.z};
  for (int i = 0; i < 3; ++i)
    for (const double side : {-face[i], face[i]}) {
      const double t = along[i] != 0 ? (side - from[i]) / along[i] : -1;
      if (t > 0 && t < 1) knots[count++] = t;
    }
  std::sort(knots.begin(), knots.end());
  const auto slope = [&](double t) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double x = from[i] + t * along[i];
      sum += (x - std::clamp(x, -face[i], face[i])) * along[i];
    }
    return sum;
  };
  double best = slope(0) >= 0 ? 0 : 1;
  for (size_t k = 0; k + 1 < knots.size(); ++k) {
    const double s0 = slope(knots[k]), s1 = slope(knots[k + 1]);
    if (s0 < 0 && s1 >= 0) {
      best = knots[k] + (knots[k + 1] - knots[k]) * (s0 / (s0 - s1));
      break;
    }
  }
  return pointBoxDistance(p + d * best, half);
}

double capsuleBox(const Solid& capsule, const Solid& box) {
  const Vec3d arm = capsule.axis[1] * capsule.half.y;
  const Vec3d from = toLocal(box, capsule.center - arm), to = toLocal(box, capsule.center + arm);
  const double distance = segmentBoxDistance(from, to - from, box.half);
  // Where the segment goes in, rounding may leave a distance.
  if (distance > 1e-12 * length(box.half)) return capsule.radius - distance;
  return capsule.radius + std::max(0.0, axisDepth(box, capsule));
}

// Least distance of the segments of two capsules (a sphere is a segment of no length).
double segmentDistance(const Solid& a, const Solid& b) {
  const double ha = a.half.y, hb = b.half.y;
  const Vec3d u = a.axis[1], v = b.axis[1], r = a.center - b.center;
  const double uv = dot(u, v), ur = dot(u, r), vr = dot(v, r), det = 1 - uv * uv;
  double s = det > 1e-12 ? std::clamp((uv * vr - ur) / det, -ha, ha) : 0;
  double t = std::clamp(uv * s + vr, -hb, hb);
  s = std::clamp(uv * t - ur, -ha, ha);
  t = std::clamp(uv * s + vr, -hb, hb);
  return length(r + u * s - v * t);
}

// A simple solid as one that can be measured against any.
ConvexBody generalBody(const Solid& s) {
  if (s.kind == Kind::Convex) return s.convex;
  ConvexBody body;
  body.center = s.center;
  body.radius = s.radius;
  for (int i = 0; i < 3; ++i) body.axis[i] = s.axis[static_cast<size_t>(i)];
  const bool flat = s.kind == Kind::Box;
  for (int k = 0; k < 8; ++k) {
    if (!flat && (k & 5 || (k & 2 && s.half.y == 0))) continue;
    body.corners.push_back(s.center + s.axis[0] * (k & 1 ? s.half.x : -s.half.x) +
                           s.axis[1] * (k & 2 ? s.half.y : -s.half.y) + s.axis[2] * (k & 4 ? s.half.z : -s.half.z));
  }
  if (flat) body.normals = body.edges = {s.axis[0], s.axis[1], s.axis[2]};
  if (s.kind == Kind::Capsule) body.edges = {s.axis[1]};
  return body;
}

double depthOf(const Solid& a, const Solid& b) {
  if (a.kind > b.kind) return depthOf(b, a);
  if (b.kind == Kind::HalfSpace) {
    if (a.kind == Kind::HalfSpace || a.kind == Kind::Surface) return 0;
    const Vec3d n = b.axis[1];
    if (a.kind == Kind::Convex) return a.convex.radius + a.convex.reach(n * -1) + dot(n, b.center);
    return a.radius + coreReach(a, n) - dot(n, a.center - b.center);
  }
  if (b.kind == Kind::Surface) return a.kind == Kind::Surface ? 0 : surfaceDepth(generalBody(a), b.surface);
  if (b.kind == Kind::Convex) return convexDepth(generalBody(a), b.convex);
  if (a.kind == Kind::Box) return axisDepth(a, b);
  if (b.kind == Kind::Box) return a.kind == Kind::Sphere ? sphereBox(a, b) : capsuleBox(a, b);
  return a.radius + b.radius - segmentDistance(a, b);
}

// Pairs whose bounds overlap, by a sweep along the axis on which the shapes spread most.
template <class F>
void sweep(const std::vector<Solid>& solids, F&& found) {
  std::vector<uint32_t> order, unbounded;
  Vec3d sum, squares;
  for (uint32_t i = 0; i < solids.size(); ++i) {
    (solids[i].kind == Kind::HalfSpace ? unbounded : order).push_back(i);
    if (solids[i].kind == Kind::HalfSpace) continue;
    const Vec3d c = solids[i].center;
    sum = sum + c;
    squares = squares + Vec3d{c.x * c.x, c.y * c.y, c.z * c.z};
  }
  const double n = static_cast<double>(std::max<size_t>(order.size(), 1));
  const Vec3d spread{squares.x - sum.x * sum.x / n, squares.y - sum.y * sum.y / n, squares.z - sum.z * sum.z / n};
  double Vec3d::*axis = &Vec3d::x;
  if (spread.y > spread.*axis) axis = &Vec3d::y;
  if (spread.z > spread.*axis) axis = &Vec3d::z;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const double la = solids[a].lower.*axis, lb = solids[b].lower.*axis;
    return la != lb ? la < lb : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const Solid& a = solids[order[i]];
    for (size_t j = i + 1; j < order.size(); ++j) {
      const Solid& b = solids[order[j]];
      if (b.lower.*axis > a.upper.*axis) break;
      if (a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
          a.lower.z <= b.upper.z && b.lower.z <= a.upper.z)
        found(order[i], order[j]);
    }
    for (const uint32_t h : unbounded) found(order[i], h);
  }
}

bool finite(const Solid& s) {
  double sum = s.center.x + s.center.y + s.center.z;
  for (const Vec3d& axis : s.axis) sum += axis.x + axis.y + axis.z;
  return std::isfinite(sum);
}

}  // namespace

double penetrationDepth(const PlacedShape& a, const PlacedShape& b) {
  return std::max(0.0, depthOf(toSolid(a), toSolid(b)));
}

Penetration measurePenetration(std::span<const PlacedShape> shapes, const PairPredicate& mayTouch) {
  std::vector<Solid> solids;
  solids.reserve(shapes.size());
  Penetration result;
  for (const PlacedShape& shape : shapes) {
    solids.push_back(toSolid(shape));
    if (!finite(solids.back())) {
      result.max = result.mean = std::numeric_limits<double>::quiet_NaN();
      return result;
    }
  }
  double sum = 0;
  sweep(solids, [&](uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    if (shapes[a].body == shapes[b].body || (!shapes[a].movable && !shapes[b].movable)) return;
    const double depth = depthOf(solids[a], solids[b]);
    if (!(depth > 0) || (mayTouch && !mayTouch(a, b))) return;
    ++result.count;
    sum += depth;
    if (depth > result.max) {
      result.max = depth;
      result.shapeA = static_cast<int>(a);
      result.shapeB = static_cast<int>(b);
    }
  });
  result.mean = result.count ? sum / static_cast<double>(result.count) : 0;
  return result;
}

}  // namespace avbd::scenes
