// Poses and inertias in double.
#include "io/mjcf_math.h"

#include <cmath>

namespace avbd::mjcf {

Quatd normalized(Quatd q) {
  const double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(n > 0)) return {};
  return {q.w / n, q.x / n, q.y / n, q.z / n};
}

Quatd turnAbout(Vec3d axis, double angle) {
  const Vec3d u = axis * (std::sin(angle / 2) / length(axis));
  return {std::cos(angle / 2), u.x, u.y, u.z};
}

Quatd turnFromZ(Vec3d direction) {
  const Vec3d axis = cross({0, 0, 1}, direction);
  const double sine = length(axis);
  // Along z the axis is free; x is MuJoCo's choice.
  if (sine < 1e-10 * length(direction)) return direction.z < 0 ? Quatd{0, 1, 0, 0} : Quatd{};
  return turnAbout(axis, std::atan2(sine, direction.z));
}

Quatd fromAxes(Vec3d x, Vec3d y, Vec3d z) {
  // The largest of the four squares keeps the division well conditioned.
  const double tw = x.x + y.y + z.z, tx = x.x - y.y - z.z, ty = y.y - x.x - z.z, tz = z.z - x.x - y.y;
  if (tw >= tx && tw >= ty && tw >= tz) return normalized({1 + tw, y.z - z.y, z.x - x.z, x.y - y.x});
  if (tx >= ty && tx >= tz) return normalized({y.z - z.y, 1 + tx, x.y + y.x, z.x + x.z});
  if (ty >= tz) return normalized({z.x - x.z, x.y + y.x, 1 + ty, y.z + z.y});
  return normalized({x.y - y.x, z.x + x.z, y.z + z.y, 1 + tz});
}

Sym3d fromPrincipal(const std::array<double, 3>& values, const std::array<Vec3d, 3>& axes) {
  Sym3d m;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d a = axes[i];
    m = m + Sym3d{a.x * a.x, a.y * a.y, a.z * a.z, a.x * a.y, a.x * a.z, a.y * a.z} * values[i];
  }
  return m;
}

Sym3d rotated(const Sym3d& m, Quatd q) {
  const Vec3d ax = rotate(q, Vec3d{1, 0, 0}), ay = rotate(q, Vec3d{0, 1, 0}), az = rotate(q, Vec3d{0, 0, 1});
  const auto row = [&](double a, double b, double c) { return ax * a + ay * b + az * c; };
  // columns of R M, then (R M) R^T
  const Vec3d cx = row(m.xx, m.xy, m.xz), cy = row(m.xy, m.yy, m.yz), cz = row(m.xz, m.yz, m.zz);
  const auto at = [&](double Vec3d::*i, double Vec3d::*j) { return cx.*i * ax.*j + cy.*i * ay.*j + cz.*i * az.*j; };
  return {at(&Vec3d::x, &Vec3d::x), at(&Vec3d::y, &Vec3d::y), at(&Vec3d::z, &Vec3d::z),
          at(&Vec3d::x, &Vec3d::y), at(&Vec3d::x, &Vec3d::z), at(&Vec3d::y, &Vec3d::z)};
}

Sym3d pointInertia(double mass, Vec3d d) {
  return Sym3d{
             d.y * d.y + d.z * d.z, d.x * d.x + d.z * d.z, d.x * d.x + d.y * d.y, -d.x * d.y, -d.x * d.z, -d.y * d.z} *
         mass;
}

Principal principal(const Sym3d& m) {
  double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // Cyclic Jacobi: each turn clears one element off the diagonal; it converges quadratically, so 30 rounds are plenty.
  for (int round = 0; round < 30; ++round) {
    if (a[0][1] == 0 && a[0][2] == 0 && a[1][2] == 0) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = a[p][k], qk = a[q][k], vp = v[k][p], vq = v[k][q];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
          v[k][p] = c * vp - s * vq;
          v[k][q] = s * vp + c * vq;
        }
        a[p][q] = a[q][p] = 0;
      }
    }
  }
  Principal out;
  for (size_t i = 0; i < 3; ++i) {
    out.values[i] = a[i][i];
    out.axes[i] = {v[0][i], v[1][i], v[2][i]};
  }
  return out;
}

}  // namespace avbd::mjcf
