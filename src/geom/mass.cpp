// Mass, centre and inertia of uniform solids: closed forms, summed in double (mass.h).
#include "geom/mass.h"

#include <cmath>
#include <variant>
#include <vector>

#include "geom/hull_builder.h"
#include "geom/solid_moments.h"

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Mass, centre in the shape's frame, and inertia about the centre in the shape's axes.
struct Solid {
  double mass = 0;
  SymMat3d inertia;
  Vec3d center;
};

Solid diagonal(double mass, double x, double y, double z) { return {mass, {x, y, z, 0, 0, 0}, {}}; }

Solid scaled(const SolidMoments& m, double density) {
  SymMat3d i = m.inertia();
  i = {i.xx * density, i.yy * density, i.zz * density, i.xy * density, i.xz * density, i.yz * density};
  return {m.volume * density, i, m.center};
}

Solid solid(const Sphere& s, double density) {
  const double r = s.radius, mass = density * (4.0 / 3.0 * kPi * r * r * r), i = 0.4 * mass * r * r;
  return diagonal(mass, i, i, i);
}

Solid solid(const Capsule& s, double density) {
  const double r = s.radius, h = s.halfHeight;
  const double ends = density * (4.0 / 3.0 * kPi * r * r * r), side = density * (2 * kPi * r * r * h);
  // The half balls' centres lie 3r/8 beyond the cylinder's ends.
  const double across = side * (r * r / 4 + h * h / 3) + ends * (0.4 * r * r + h * h + 0.75 * h * r);
  return diagonal(ends + side, across, side * r * r / 2 + ends * 0.4 * r * r, across);
}

Solid solid(const Box& s, double density) {
  const double x = s.x, y = s.y, z = s.z;
  if (s.rounding > 0) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z});
    const SolidMoments m = roundedMoments(corners, hullTriangles(corners), s.rounding);
    // Symmetric but for rounding errors of the sums.
    const SymMat3d i = m.inertia();
    return diagonal(m.volume * density, i.xx * density, i.yy * density, i.zz * density);
  }
  const double mass = density * (8 * x * y * z), third = mass / 3;
  return diagonal(mass, third * (y * y + z * z), third * (x * x + z * z), third * (x * x + y * y));
}

Solid solid(const Cylinder& s, double density) {
  const double r = s.radius, h = s.halfHeight, q = s.rounding;
  Revolution solid;
  solid.addArc(-h, r, q, {0, -1}, {1, 0});
  solid.addCone(-h, r + q, h, r + q);
  solid.addArc(h, r, q, {1, 0}, {0, 1});
  SolidMoments m = solid.moments();
  m.center = {};  // by symmetry
  return scaled(m, density);
}

Solid solid(const Cone& s, double density) {
  const double r = s.radius, h = s.halfHeight, q = s.rounding;
  // Where the side's normal points: the base's rim is round up to there, the tip from there on.
  const double slant = std::sqrt(4 * h * h + r * r);
  const Direction side{2 * h / slant, r / slant};
  Revolution solid;
  solid.addArc(-h, r, q, {0, -1}, side);
  solid.addCone(-h + q * side.sin, r + q * side.cos, h + q * side.sin, q * side.cos);
  solid.addArc(h, 0, q, side, {0, 1});
  return scaled(solid.moments(), density);
}

Solid solid(const Ellipsoid& s, double density) {
  const double xx = double{s.x} * s.x, yy = double{s.y} * s.y, zz = double{s.z} * s.z;
  const double mass = density * (4.0 / 3.0 * kPi * s.x * s.y * s.z), fifth = mass / 5;
  return diagonal(mass, fifth * (yy + zz), fifth * (xx + zz), fifth * (xx + yy));
}

Solid solid(const Hull& s, double density) {
  const Vec3d k = toDouble(s.scale);
  if (s.rounding > 0) {
    std::vector<Vec3d> corners;
    for (const Vec3& v : s.data->vertices()) corners.push_back({v.x * k.x, v.y * k.y, v.z * k.z});
    return scaled(roundedMoments(corners, hullTriangles(corners), s.rounding), density);
  }
  SolidMoments m = HullFactory::moments(*s.data);
  const double volume = std::fabs(k.x * k.y * k.z);
  m.volume *= volume;
  m.center = {m.center.x * k.x, m.center.y * k.y, m.center.z * k.z};
  const SymMat3d& a = m.second;
  m.second = {a.xx * k.x * k.x * volume, a.yy * k.y * k.y * volume, a.zz * k.z * k.z * volume,
              a.xy * k.x * k.y * volume, a.xz * k.x * k.z * volume, a.yz * k.y * k.z * volume};
  return scaled(m, density);
}

// Unbounded or hollow.
Solid solid(const HalfSpace&, double) { return {}; }
Solid solid(const Mesh&, double) { return {}; }
Solid solid(const HeightField&, double) { return {}; }

Solid solid(const Geometry& geometry, double density) {
  return std::visit([density](const auto& shape) { return solid(shape, density); }, geometry);
}

Solid solid(const ShapeDef& shape) { return shape.isTrigger ? Solid{} : solid(shape.geometry, shape.density); }

/// The shape's axis, exactly unit however long q is.
Vec3d axis(Quat q, Vec3d v) {
  const Vec3d a = rotate(q, v);
  return a * (1 / length(a));
}

/// A solid and its axes in the body's frame.
struct Placed {
  Solid solid;
  Vec3d x, y, z, center;
};

Placed placed(const Solid& s, const Pose& pose) {
  Placed p{s,
           axis(pose.rotation, Vec3d{1, 0, 0}),
           axis(pose.rotation, Vec3d{0, 1, 0}),
           axis(pose.rotation, Vec3d{0, 0, 1}),
           {}};
  p.center = pose.position + (p.x * s.center.x + p.y * s.center.y + p.z * s.center.z);
  return p;
}

void addTurned(SymMat3d& total, const Placed& p) {
  const SymMat3d& i = p.solid.inertia;
  addOuter(total, p.x, i.xx);
  addOuter(total, p.y, i.yy);
  addOuter(total, p.z, i.zz);
  addMixed(total, p.x, p.y, i.xy);
  addMixed(total, p.x, p.z, i.xz);
  addMixed(total, p.y, p.z, i.yz);
}

MassProperties result(double mass, Vec3d center, const SymMat3d& i) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(mass), toFloat(center), {f(i.xx), f(i.yy), f(i.zz), f(i.xy), f(i.xz), f(i.yz)}};
}

}  // namespace

MassProperties massProperties(const Geometry& geometry, float density) {
  const Solid s = solid(geometry, density);
  return result(s.mass, s.center, s.inertia);
}

MassProperties massProperties(std::span<const ShapeDef> shapes) {
  std::vector<Placed> solids;
  double mass = 0;
  Vec3d moment;
  for (const ShapeDef& shape : shapes) {
    const Solid s = solid(shape);
    if (s.mass == 0) continue;  // a half-space may be anywhere
    solids.push_back(placed(s, shape.pose));
    mass += s.mass;
    moment = moment + solids.back().center * s.mass;
  }
  if (!(mass > 0)) return result(0, {}, {});
  const Vec3d center = moment * (1 / mass);
  SymMat3d total;
  for (const Placed& p : solids) {
    addTurned(total, p);
    // Parallel axes: m (|r|^2 1 - r r^T).
    const Vec3d r = p.center - center;
    const double rr = p.solid.mass * dot(r, r);
    total.xx += rr;
    total.yy += rr;
    total.zz += rr;
    addOuter(total, r, -p.solid.mass);
  }
  return result(mass, center, total);
}

}  // namespace avbd
