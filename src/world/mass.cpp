// Principal moments, inverse and sums over shapes (mass.h).
#include "world/mass.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/mass.h"

namespace avbd {
namespace {

// One Jacobi rotation in the plane of axes p and q: zeroes m[p][q].
void rotateAway(double m[3][3], int p, int q) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double pq = m[p][q], pr = m[p][r], qr = m[q][r];
  m[p][p] -= t * pq;
  m[q][q] += t * pq;
  m[p][q] = m[q][p] = 0;
  m[p][r] = m[r][p] = c * pr - s * qr;
  m[q][r] = m[r][q] = s * pr + c * qr;
}

}  // namespace

std::array<double, 3> principalMoments(const SymMat3& i) {
  double m[3][3] = {{i.xx, i.xy, i.xz}, {i.xy, i.yy, i.yz}, {i.xz, i.yz, i.zz}};
  // Converges quadratically; eight sweeps are far beyond what double can show.
  for (int sweep = 0; sweep < 8; ++sweep) {
    rotateAway(m, 0, 1);
    rotateAway(m, 0, 2);
    rotateAway(m, 1, 2);
  }
  std::array<double, 3> moments{m[0][0], m[1][1], m[2][2]};
  std::sort(moments.begin(), moments.end());
  return moments;
}

SymMat3 inverse(const SymMat3& matrix) {
  const double xx = matrix.xx, yy = matrix.yy, zz = matrix.zz, xy = matrix.xy, xz = matrix.xz, yz = matrix.yz;
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
  const double scale = 1 / (xx * cxx + xy * cxy + xz * cxz);
  return {static_cast<float>(cxx * scale),
          static_cast<float>((xx * zz - xz * xz) * scale),
          static_cast<float>((xx * yy - xy * xy) * scale),
          static_cast<float>(cxy * scale),
          static_cast<float>(cxz * scale),
          static_cast<float>((xy * xz - xx * yz) * scale)};
}

MassProperties shapesMass(std::span<const ShapeDef> shapes, float mass) {
  MassProperties sum = massProperties(shapes);
  if (mass == 0) return sum;
  if (sum.mass == 0) {
    std::vector<ShapeDef> uniform(shapes.begin(), shapes.end());
    for (ShapeDef& shape : uniform) shape.density = 1;
    sum = massProperties(uniform);
    if (sum.mass == 0) return sum;
  }
  const float scale = mass / sum.mass;
  SymMat3& i = sum.inertia;
  i = {i.xx * scale, i.yy * scale, i.zz * scale, i.xy * scale, i.xz * scale, i.yz * scale};
  sum.mass = mass;
  return sum;
}

}  // namespace avbd
