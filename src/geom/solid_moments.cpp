// Sums over tetrahedra (solid_moments.h).
#include "geom/solid_moments.h"

#include <cmath>

namespace avbd {

void addOuter(SymMat3d& total, Vec3d v, double scale) {
  total.xx += scale * v.x * v.x;
  total.yy += scale * v.y * v.y;
  total.zz += scale * v.z * v.z;
  total.xy += scale * v.x * v.y;
  total.xz += scale * v.x * v.z;
  total.yz += scale * v.y * v.z;
}

void addMixed(SymMat3d& total, Vec3d a, Vec3d b, double scale) {
  total.xx += scale * 2 * a.x * b.x;
  total.yy += scale * 2 * a.y * b.y;
  total.zz += scale * 2 * a.z * b.z;
  total.xy += scale * (a.x * b.y + a.y * b.x);
  total.xz += scale * (a.x * b.z + a.z * b.x);
  total.yz += scale * (a.y * b.z + a.z * b.y);
}

void addScaled(SymMat3d& total, const SymMat3d& m, double scale) {
  total.xx += scale * m.xx;
  total.yy += scale * m.yy;
  total.zz += scale * m.zz;
  total.xy += scale * m.xy;
  total.xz += scale * m.xz;
  total.yz += scale * m.yz;
}

SymMat3d SolidMoments::inertia() const {
  const SymMat3d& s = second;
  return {s.yy + s.zz, s.xx + s.zz, s.xx + s.yy, -s.xy, -s.xz, -s.yz};
}

MassProperties SolidMoments::properties(double density) const {
  const SymMat3d i = inertia();
  const auto f = [density](double v) { return static_cast<float>(density * v); };
  return {f(volume), toFloat(center), {f(i.xx), f(i.yy), f(i.zz), f(i.xy), f(i.xz), f(i.yz)}};
}

void MomentSums::addTetrahedron(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const double v = dot(cross(b - a, c - a), d - a) / 6;
  const Vec3d sum = a + b + c + d;
  volume += v;
  first = first + sum * (v / 4);
  // Integral of p p^T over a tetrahedron: V/20 (sum of corners' outer products + outer product of their sum).
  addOuter(second, sum, v / 20);
  addOuter(second, a, v / 20);
  addOuter(second, b, v / 20);
  addOuter(second, c, v / 20);
  addOuter(second, d, v / 20);
}

SolidMoments MomentSums::about(Vec3d origin) const {
  if (!(volume > 0)) return {};
  const Vec3d c = first * (1 / volume);
  SolidMoments m{volume, origin + c, second};
  addOuter(m.second, c, -volume);
  return m;
}

SolidMoments polyhedronMoments(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles) {
  if (points.empty()) return {};
  Vec3d middle;
  for (const Vec3d& p : points) middle = middle + p * (1.0 / static_cast<double>(points.size()));
  MomentSums sums;
  for (const auto& t : triangles) {
    // Seen from outside the triangle is anticlockwise, so the middle lies behind it.
    sums.addTetrahedron({}, points[t[0]] - middle, points[t[1]] - middle, points[t[2]] - middle);
  }
  return sums.about(middle);
}

}  // namespace avbd
