// Poses and inertias in double for reading files: the world gets its floats only at the end.
#pragma once

#include <avbd/types.h>

#include <array>

namespace avbd::mjcf {

struct Quatd {
  double w = 1, x = 0, y = 0, z = 0;
};

struct Posed {
  Vec3d position;
  Quatd rotation;
};

/// Symmetric 3x3.
struct Sym3d {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

constexpr Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr Quatd operator*(Quatd a, Quatd b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
constexpr Quatd conjugate(Quatd q) { return {q.w, -q.x, -q.y, -q.z}; }
constexpr Vec3d rotate(Quatd q, Vec3d v) {
  const Vec3d u{q.x, q.y, q.z};
  const Vec3d t = cross(u, v) * 2.0;
  return v + t * q.w + cross(u, t);
}
constexpr Posed operator*(const Posed& a, const Posed& b) {
  return {a.position + rotate(a.rotation, b.position), a.rotation * b.rotation};
}
constexpr Posed inverse(const Posed& a) {
  const Quatd q = conjugate(a.rotation);
  return {rotate(q, a.position) * -1.0, q};
}

/// Length 1; the identity for a quaternion of zero.
Quatd normalized(Quatd q);
/// Turn by an angle [rad] about an axis of any length but zero.
Quatd turnAbout(Vec3d axis, double angle);
/// Shortest turn that takes z to `direction` (any length but zero).
Quatd turnFromZ(Vec3d direction);
/// The rotation whose columns are these unit axes.
Quatd fromAxes(Vec3d x, Vec3d y, Vec3d z);

constexpr Sym3d operator+(const Sym3d& a, const Sym3d& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
constexpr Sym3d operator*(const Sym3d& a, double s) {
  return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
}
/// Sum of v[i] a[i] a[i]^T.
Sym3d fromPrincipal(const std::array<double, 3>& values, const std::array<Vec3d, 3>& axes);
/// Inertia given in a frame that q turns into the wanted one.
Sym3d rotated(const Sym3d& m, Quatd q);
/// Inertia of a point mass at d.
Sym3d pointInertia(double mass, Vec3d d);

struct Principal {
  std::array<double, 3> values{};
  std::array<Vec3d, 3> axes;
};
/// Eigenvalues and unit eigenvectors.
Principal principal(const Sym3d& m);

}  // namespace avbd::mjcf
