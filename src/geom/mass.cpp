// Mass, centre and inertia of uniform solids: closed forms, summed in double.
#include "geom/mass.h"

#include <variant>

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Diagonal inertia about the shape's own centre; all our solids are centred on their frame.
struct Solid {
  double mass = 0;
  Vec3d inertia;
};

Solid solid(const Sphere& s, double density) {
  const double r = s.radius, mass = density * (4.0 / 3.0 * kPi * r * r * r), i = 0.4 * mass * r * r;
  return {mass, {i, i, i}};
}

Solid solid(const Capsule& s, double density) {
  const double r = s.radius, h = s.halfHeight;
  const double ends = density * (4.0 / 3.0 * kPi * r * r * r), side = density * (2 * kPi * r * r * h);
  // The half balls' centres lie 3r/8 beyond the cylinder's ends.
  const double across = side * (r * r / 4 + h * h / 3) + ends * (0.4 * r * r + h * h + 0.75 * h * r);
  return {ends + side, {across, side * r * r / 2 + ends * 0.4 * r * r, across}};
}

Solid solid(const Box& s, double density) {
  const double x = s.x, y = s.y, z = s.z, mass = density * (8 * x * y * z), third = mass / 3;
  return {mass, {third * (y * y + z * z), third * (x * x + z * z), third * (x * x + y * y)}};
}

Solid solid(const HalfSpace&, double) { return {}; }
Solid solid(const Mesh&, double) { return {}; }
Solid solid(const HeightField&, double) { return {}; }
Solid solid(const Cylinder&, double) { return {}; }
Solid solid(const Cone&, double) { return {}; }
Solid solid(const Ellipsoid&, double) { return {}; }
Solid solid(const Hull&, double) { return {}; }

Solid solid(const Geometry& geometry, double density) {
  return std::visit([density](const auto& shape) { return solid(shape, density); }, geometry);
}

struct SymMat3d {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// total += scale * v v^T
void addOuter(SymMat3d& total, Vec3d v, double scale) {
  total.xx += scale * v.x * v.x;
  total.yy += scale * v.y * v.y;
  total.zz += scale * v.z * v.z;
  total.xy += scale * v.x * v.y;
  total.xz += scale * v.x * v.z;
  total.yz += scale * v.y * v.z;
}

/// The shape's axis, exactly unit however long q is.
Vec3d axis(Quat q, Vec3d v) {
  const Vec3d a = rotate(q, v);
  return a * (1 / length(a));
}

MassProperties result(double mass, Vec3d center, const SymMat3d& i) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(mass), toFloat(center), {f(i.xx), f(i.yy), f(i.zz), f(i.xy), f(i.xz), f(i.yz)}};
}

}  // namespace

MassProperties massProperties(const Geometry& geometry, float density) {
  const Solid s = solid(geometry, density);
  return result(s.mass, {}, {s.inertia.x, s.inertia.y, s.inertia.z, 0, 0, 0});
}

MassProperties massProperties(std::span<const ShapeDef> shapes) {
  double mass = 0;
  Vec3d moment;
  for (const ShapeDef& shape : shapes) {
    const double m = solid(shape.geometry, shape.density).mass;
    mass += m;
    moment = moment + shape.pose.position * m;
  }
  if (!(mass > 0)) return result(0, {}, {});
  const Vec3d center = moment * (1 / mass);
  SymMat3d total;
  for (const ShapeDef& shape : shapes) {
    const Solid s = solid(shape.geometry, shape.density);
    if (s.mass == 0) continue;  // a half-space may be anywhere
    const Quat q = shape.pose.rotation;
    addOuter(total, axis(q, Vec3d{1, 0, 0}), s.inertia.x);
    addOuter(total, axis(q, Vec3d{0, 1, 0}), s.inertia.y);
    addOuter(total, axis(q, Vec3d{0, 0, 1}), s.inertia.z);
    // Parallel axes: m (|r|^2 1 - r r^T).
    const Vec3d r = shape.pose.position - center;
    const double rr = s.mass * dot(r, r);
    total.xx += rr;
    total.yy += rr;
    total.zz += rr;
    addOuter(total, r, -s.mass);
  }
  return result(mass, center, total);
}

}  // namespace avbd
