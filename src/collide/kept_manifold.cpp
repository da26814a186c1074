// Keeping a manifold and carrying its points along (kept_manifold.h).
#include "collide/kept_manifold.h"

#include "collide/pair_math.h"

namespace avbd {
namespace {

using Lanes = CarriedPoints::Lanes;
using Points = rows::V3<Lanes>;
using What = KeptManifold::What;

Points times(const Mat3& m, Points p) {
  return {p.x * m.m[0][0] + p.y * m.m[0][1] + p.z * m.m[0][2], p.x * m.m[1][0] + p.y * m.m[1][1] + p.z * m.m[1][2],
          p.x * m.m[2][0] + p.y * m.m[2][1] + p.z * m.m[2][2]};
}

Points timesT(const Mat3& m, Points p) {
  return {p.x * m.m[0][0] + p.y * m.m[1][0] + p.z * m.m[2][0], p.x * m.m[0][1] + p.y * m.m[1][1] + p.z * m.m[2][1],
          p.x * m.m[0][2] + p.y * m.m[1][2] + p.z * m.m[2][2]};
}

Points lanes(Vec3 v) { return {v.x, v.y, v.z}; }

/// matrix(q) less the identity: exact for small turns.
Mat3 turnLess(Quat q) {
  const float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const float xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {{{-(yy + zz), xy - wz, xz + wy}, {xy + wz, -(xx + zz), yz - wx}, {xz - wy, yz + wx, -(xx + yy)}}};
}

/// By what a distance found anew may be shorter than a kept one [of the margin; of the bodies' sizes].
constexpr float kOfMargin = 0.01f, kOfSizes = 1e-5f;

/// Where the other body's centre is, as the base sees it.
Vec3 offsetIn(const Mat3& frame, const NearPose& base, const NearPose& other) { return mulT(frame, other.p - base.p); }

}  // namespace

void keep(const Manifold& found, const NearBody& a, const NearBody& b, KeptManifold& kept) {
  kept.what = What::Nothing;
  if (!(found.clear > 0) || (found.count > 0 && found.carrier == Carrier::None)) return;
  const bool ofB = found.count > 0 && found.carrier == Carrier::B;
  const NearBody &base = ofB ? b : a, &other = ofB ? a : b;
  const Mat3 frame = matrix(base.pose.q);
  kept.offset = offsetIn(frame, base.pose, other.pose);
  kept.turn = conjugate(base.pose.q) * other.pose.q;
  kept.clear = found.clear;
  kept.aroundBase = other.radius > base.radius + found.clear;
  kept.reach = kept.aroundBase ? base.radius + found.clear : other.radius;
  kept.what = found.count == 0 ? What::Apart : (ofB ? What::PointsOnB : What::PointsOnA);
  if (found.count == 0) return;
  const Vec3 normal = ofB ? -found.normal : found.normal;
  kept.normal = mulT(frame, normal);
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    const bool isPoint = k < found.count;
    const float height = isPoint ? found.points[k].separation : 0;
    const Vec3 arm = found.points[k].position - base.pose.p + normal * (0.5f * height);
    const Vec3 p = isPoint ? mulT(frame, arm) : Vec3{};
    kept.x[k] = p.x, kept.y[k] = p.y, kept.z[k] = p.z, kept.height[k] = height;
  }
}

Carry carry(const KeptManifold& kept, const NearPose& a, const NearPose& b, const KeepLimits& limits,
            CarriedPoints& out) {
  const bool ofB = kept.what == What::PointsOnB;
  const NearPose &base = ofB ? b : a, &other = ofB ? a : b;
  const Mat3 frame = matrix(base.q);
  out.offset = offsetIn(frame, base, other);
  out.turn = conjugate(base.q) * other.q;
  out.ofB = ofB;
  const Quat turned = out.turn * conjugate(kept.turn);
  const Mat3 turn = turnLess(turned);
  const Vec3 shift = out.offset - kept.offset;
  const Vec3 way = kept.aroundBase ? shift - mul(turn, kept.offset) : shift;
  const float moved = length(way) + 2 * length(Vec3{turned.x, turned.y, turned.z}) * kept.reach;
  const float clear = kept.clear - moved;
  if (kept.what == What::Apart) {
    // Only where nothing would be found anew, whatever the rounding: then nobody can tell whether it was kept.
    const float rounding = kOfMargin * limits.margin + kOfSizes * (kept.reach + length(out.offset));
    return clear > limits.margin + rounding ? Carry::Apart : Carry::Anew;
  }
  if (!(moved <= limits.allowed && clear >= limits.margin - limits.slack)) return Carry::Anew;
  const Points p{lane::loadUnaligned<Lanes>(kept.x), lane::loadUnaligned<Lanes>(kept.y),
                 lane::loadUnaligned<Lanes>(kept.z)};
  const Points n = lanes(kept.normal), motion = times(turn, p - lanes(kept.offset)) + lanes(shift);
  out.separation = lane::loadUnaligned<Lanes>(kept.height) + dot(n, motion);
  out.onBase = p + motion - n * (out.separation * 0.5f);
  out.position = times(frame, out.onBase) + lanes(base.p);
  const Vec3 normal = mul(frame, kept.normal);
  out.normal = ofB ? -normal : normal;
  return Carry::Points;
}

PlacesOnBodies placesOnBodies(const CarriedPoints& points) {
  const Points onOther = timesT(matrix(points.turn), points.onBase - lanes(points.offset));
  if (points.ofB) return {onOther, points.onBase};
  return {points.onBase, onOther};
}

}  // namespace avbd
