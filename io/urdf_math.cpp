// Angles and inertias of URDF files.
#include "io/urdf_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace avbd::urdf {

namespace {

// Taylor series on |x| <= pi/4, where the last term is below 1e-17.
double sinSmall(double x) {
  const double s = x * x;
  double sum = 0;
  for (int n = 17; n >= 3; n -= 2) sum = (1 + sum) * (-s / (n * (n - 1)));
  return x + x * sum;
}
double cosSmall(double x) {
  const double s = x * x;
  double sum = 0;
  for (int n = 18; n >= 2; n -= 2) sum = (1 + sum) * (-s / (n * (n - 1)));
  return 1 + sum;
}

}  // namespace

SinCosd sinCos(double x) {
  // pi/2 in three parts, the first two short enough that their products with a quarter count are exact.
  constexpr double kA = 1.57079632673412561417e+00, kB = 6.07710050630396597660e-11, kC = 2.02226624879595063154e-21;
  const double q = x * 0.63661977236758134308;
  const auto quarter = static_cast<int64_t>(q < 0 ? q - 0.5 : q + 0.5);
  const double n = static_cast<double>(quarter);
  const double r = ((x - n * kA) - n * kB) - n * kC;
  const double s = sinSmall(r), c = cosSmall(r);
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

mjcf::Quatd fromRollPitchYaw(Vec3d rpy) {
  const SinCosd r = sinCos(rpy.x / 2), p = sinCos(rpy.y / 2), y = sinCos(rpy.z / 2);
  const mjcf::Quatd roll{r.cos, r.sin, 0, 0}, pitch{p.cos, 0, p.sin, 0}, yaw{y.cos, 0, 0, y.sin};
  return mjcf::normalized(yaw * pitch * roll);
}

InertiaFault repair(mjcf::Sym3d& inertia) {
  constexpr double kRounding = 0.01, kLeast = 1e-3, kZero = 1e-12;
  const mjcf::Sym3d& m = inertia;
  if (m.xx == 0 && m.yy == 0 && m.zz == 0 && m.xy == 0 && m.xz == 0 && m.yz == 0) return InertiaFault::Unset;
  mjcf::Principal p = mjcf::principal(inertia);
  const double half = (p.values[0] + p.values[1] + p.values[2]) / 2;
  std::array<double, 3> second{};
  for (size_t i = 0; i < 3; ++i) second[i] = half - p.values[i];
  const double most = *std::max_element(second.begin(), second.end());
  if (!(most > 0)) return InertiaFault::Hopeless;
  InertiaFault fault = InertiaFault::None;
  size_t zeros = 0, changed = 0;
  for (double& s : second) {
    if (s > kZero * most) continue;
    const bool rounding = s >= -kRounding * most;
    if (rounding) ++zeros;
    if (!rounding) fault = InertiaFault::Repaired;
    if (s < 0) ++changed;
    if (s < 0) s = rounding ? 0 : kLeast * most;
  }
  // A plate's one second moment may be zero; a rod's two would leave it without inertia about its axis.
  if (zeros > 1) {
    for (double& s : second) s = std::max(s, kLeast * most);
    fault = InertiaFault::Repaired;
  }
  if (changed == 0 && zeros < 2) return fault;
  for (size_t i = 0; i < 3; ++i) p.values[i] = second[(i + 1) % 3] + second[(i + 2) % 3];
  inertia = mjcf::fromPrincipal(p.values, p.axes);
  return fault;
}

}  // namespace avbd::urdf
