// Depth of overlap of convex shapes by trying directions (penetration_convex.h).
#include "scenes/penetration_convex.h"

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace avbd::scenes {
namespace {

Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec3d unitOf(Vec3d v) { return v * (1 / length(v)); }
Vec3d times(Vec3d v, Vec3 s) { return {v.x * s.x, v.y * s.y, v.z * s.z}; }

// Rotation in double about a quaternion of any length.
Vec3d turnBy(Quat q, Vec3d v) {
  const double w = q.w, x = q.x, y = q.y, z = q.z, n = w * w + x * x + y * y + z * z;
  return Vec3d{(w * w + x * x - y * y - z * z) * v.x + 2 * (x * y - w * z) * v.y + 2 * (x * z + w * y) * v.z,
               2 * (x * y + w * z) * v.x + (w * w - x * x + y * y - z * z) * v.y + 2 * (y * z - w * x) * v.z,
               2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y + (w * w - x * x - y * y + z * z) * v.z} *
         (1 / n);
}

Vec3d placed(const Pose& pose, Vec3d local) { return pose.position + turnBy(pose.rotation, local); }

// Directions that differ, up to sign.
void addDirection(std::vector<Vec3d>& list, Vec3d d) {
  for (const Vec3d& known : list)
    if (std::abs(dot(known, d)) > 1 - 1e-14) return;
  list.push_back(d);
}

void addCorners(ConvexBody& body, const Pose& pose, std::initializer_list<Vec3d> corners) {
  for (const Vec3d& c : corners) body.corners.push_back(placed(pose, c));
}

struct Maker {
  const Pose& pose;
  ConvexBody& body;

  void operator()(const Sphere& s) const {
    addCorners(body, pose, {{}});
    body.radius = s.radius;
  }
  void operator()(const Capsule& s) const {
    addCorners(body, pose, {{0, -s.halfHeight, 0}, {0, s.halfHeight, 0}});
    body.edges = {body.axis[1]};
    body.radius = s.radius;
  }
  void operator()(const Box& s) const {
    for (int k = 0; k < 8; ++k) addCorners(body, pose, {{k & 1 ? s.x : -s.x, k & 2 ? s.y : -s.y, k & 4 ? s.z : -s.z}});
    body.edges = body.normals = {body.axis[0], body.axis[1], body.axis[2]};
    body.radius = s.rounding;
  }
  void operator()(const Cylinder& s) const {
    smooth(ConvexBody::Core::Cylinder, {s.radius, s.halfHeight, s.radius}, s.rounding);
  }
  void operator()(const Cone& s) const {
    smooth(ConvexBody::Core::Cone, {s.radius, s.halfHeight, s.radius}, s.rounding);
  }
  void operator()(const Ellipsoid& s) const { smooth(ConvexBody::Core::Ellipsoid, {s.x, s.y, s.z}, 0); }
  void operator()(const Hull& s) const {
    for (const Vec3 v : s.data->vertices()) body.corners.push_back(placed(pose, times(toDouble(v), s.scale)));
    for (const HullData::Edge& e : s.data->edges())
      addDirection(body.edges, unitOf(body.corners[e.vertex[1]] - body.corners[e.vertex[0]]));
    for (const HullData::Face& f : s.data->faces()) {
      const uint8_t* loop = s.data->loops().data() + f.first;
      const Vec3d a = body.corners[loop[0]];
      // The widest pair of edges, lest a short one spoil the normal.
      Vec3d n;
      for (size_t i = 1; i + 1 < f.count; ++i) {
        const Vec3d c = crossOf(body.corners[loop[i]] - a, body.corners[loop[i + 1]] - a);
        if (dot(c, c) > dot(n, n)) n = c;
      }
      addDirection(body.normals, unitOf(n));
    }
    body.radius = s.rounding;
  }
  template <class Unbounded>
  void operator()(const Unbounded&) const {}

  void smooth(ConvexBody::Core core, Vec3d half, double rounding) const {
    body.core = core;
    body.half = half;
    body.radius = rounding;
    body.normals = {body.axis[0], body.axis[1], body.axis[2]};
  }
};

double overlapAlong(const ConvexBody& a, const ConvexBody& b, Vec3d n) { return a.reach(n) + b.reach(n * -1); }

struct Try {
  double depth;
  Vec3d n;
};

// Goes downhill over the unit sphere in ever smaller steps, turning the pattern of steps each time that none helps.
Try improve(const ConvexBody& a, const ConvexBody& b, Try best) {
  double angle = 0;
  int failures = 0;
  for (double step = 0.1; step > 1e-10;) {
    const Vec3d side = std::abs(best.n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d u = unitOf(crossOf(best.n, side)), v = crossOf(best.n, u);
    Try next = best;
    for (int k = 0; k < 6; ++k) {
      const double turn = angle + k * (3.14159265358979 / 3);
      const Vec3d n = unitOf(best.n + (u * std::cos(turn) + v * std::sin(turn)) * step);
      const double depth = overlapAlong(a, b, n);
      if (depth < next.depth) next = {depth, n};
    }
    angle += 2.39996323;
    if (next.depth < best.depth) {
      best = next;
      failures = 0;
    } else if (++failures >= 24) {
      step *= 0.5;
      failures = 0;
    }
  }
  return best;
}

class Search {
 public:
  Search(const ConvexBody& a, const ConvexBody& b) : a_(a), b_(b) {}
  void both(Vec3d n) {
    add(n);
    add(n * -1);
  }
  double least() {
    const bool exact = a_.core == ConvexBody::Core::Corners && b_.core == ConvexBody::Core::Corners;
    if (exact && best_[0].depth > 0 && !a_.edges.empty() && !b_.edges.empty()) return best_[0].depth;
    double depth = std::numeric_limits<double>::infinity();
    for (const Try& t : best_)
      if (t.depth < 1e300) depth = std::min(depth, improve(a_, b_, t).depth);
    return depth;
  }

 private:
  void add(Vec3d n) {
    Try t{overlapAlong(a_, b_, n), n};
    for (Try& known : best_)
      if (t.depth < known.depth) std::swap(t, known);
  }
  const ConvexBody &a_, &b_;
  std::array<Try, 6> best_{Try{1e301, {}}, Try{1e301, {}}, Try{1e301, {}},
                           Try{1e301, {}}, Try{1e301, {}}, Try{1e301, {}}};
};

}  // namespace

double ConvexBody::reach(Vec3d n) const {
  if (core == Core::Corners) {
    double far = -std::numeric_limits<double>::infinity();
    for (const Vec3d& c : corners) far = std::max(far, dot(n, c));
    return far;
  }
  const Vec3d local{dot(n, axis[0]), dot(n, axis[1]), dot(n, axis[2])};
  const double middle = dot(n, center), across = std::hypot(local.x, local.z) * half.x;
  if (core == Core::Cylinder) return middle + std::abs(local.y) * half.y + across;
  if (core == Core::Cone) return middle + std::max(local.y * half.y, across - local.y * half.y);
  return middle + std::hypot(local.x * half.x, local.y * half.y, local.z * half.z);
}

Vec3d ConvexBody::upper() const {
  return Vec3d{reach({1, 0, 0}), reach({0, 1, 0}), reach({0, 0, 1})} + Vec3d{radius, radius, radius};
}

Vec3d ConvexBody::lower() const {
  return Vec3d{-reach({-1, 0, 0}), -reach({0, -1, 0}), -reach({0, 0, -1})} - Vec3d{radius, radius, radius};
}

ConvexBody convexBody(const Geometry& geometry, const Pose& pose) {
  ConvexBody body;
  body.center = pose.position;
  const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) body.axis[i] = turnBy(pose.rotation, axes[i]);
  std::visit(Maker{pose, body}, geometry);
  return body;
}

ConvexBody triangleBody(Vec3d a, Vec3d b, Vec3d c) {
  ConvexBody body;
  body.corners = {a, b, c};
  body.center = (a + b + c) * (1.0 / 3);
  body.normals = {unitOf(crossOf(b - a, c - a))};
  body.edges = {unitOf(b - a), unitOf(c - b), unitOf(a - c)};
  return body;
}

double convexDepth(const ConvexBody& a, const ConvexBody& b) {
  Search search(a, b);
  for (const Vec3d& n : a.normals) search.both(n);
  for (const Vec3d& n : b.normals) search.both(n);
  for (const Vec3d& u : a.edges)
    for (const Vec3d& v : b.edges) {
      const Vec3d n = crossOf(u, v);
      if (dot(n, n) > 1e-16) search.both(unitOf(n));
    }
  const Vec3d between = b.center - a.center;
  if (dot(between, between) > 0) search.both(unitOf(between));
  constexpr int kDirections = 128;  // spread evenly over the sphere (Fibonacci lattice)
  for (int i = 0; i < kDirections; ++i) {
    const double y = 1 - (i + 0.5) * 2 / kDirections, r = std::sqrt(1 - y * y), turn = i * 2.39996323;
    search.both({r * std::cos(turn), y, r * std::sin(turn)});
  }
  return search.least() + a.radius + b.radius;
}

namespace {

template <class Data>
void addTriangles(const Data& data, Vec3 scale, const Pose& pose, std::vector<ConvexBody>& out) {
  for (uint32_t i = 0; i < data.triangleCount(); ++i) {
    std::array<Vec3, 3> t = data.triangle(i);
    const auto corner = [&](int k) { return placed(pose, times(toDouble(t[static_cast<size_t>(k)]), scale)); };
    const Vec3d a = corner(0), b = corner(1), c = corner(2), n = crossOf(b - a, c - a);
    if (dot(n, n) > 0) out.push_back(triangleBody(a, b, c));
  }
}

}  // namespace

std::vector<ConvexBody> surfaceBodies(const Geometry& geometry, const Pose& pose) {
  std::vector<ConvexBody> bodies;
  if (const auto* mesh = std::get_if<Mesh>(&geometry)) addTriangles(*mesh->data, mesh->scale, pose, bodies);
  if (const auto* field = std::get_if<HeightField>(&geometry)) addTriangles(*field->data, field->scale, pose, bodies);
  return bodies;
}

double surfaceDepth(const ConvexBody& a, const std::vector<ConvexBody>& surface) {
  const Vec3d lower = a.lower(), upper = a.upper();
  double depth = -std::numeric_limits<double>::infinity();
  for (const ConvexBody& t : surface) {
    const Vec3d low = t.lower(), high = t.upper();
    if (low.x > upper.x || high.x < lower.x || low.y > upper.y || high.y < lower.y || low.z > upper.z ||
        high.z < lower.z)
      continue;
    depth = std::max(depth, convexDepth(a, t));
  }
  return depth;
}

}  // namespace avbd::scenes
