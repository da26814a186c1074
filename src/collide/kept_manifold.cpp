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

OtherPlace otherPlace(What what, const NearPose& a, const NearPose& b) {
  const bool ofB = what == What::PointsOnB;
  const NearPose &base = ofB ? b : a, &other = ofB ? a : b;
  const Mat3 frame = matrix(base.q);
  return {ofB, base.p, frame, offsetIn(frame, base, other), conjugate(base.q) * other.q};
}

namespace {

/// How the other body has moved in the base's frame since.
struct Motion {
  Quat turned;
  Mat3 turn;  ///< less the identity
  Vec3 shift;
};

AVBD_INLINE Motion motionSince(const KeptManifold& kept, const OtherPlace& now) {
  const Quat turned = now.turn * conjugate(kept.turn);
  return {turned, turnLess(turned), now.offset - kept.offset};
}

AVBD_INLINE void carryBy(const Motion& motion, const KeptManifold& kept, const OtherPlace& now, CarriedPoints& out) {
  out.offset = now.offset, out.turn = now.turn, out.ofB = now.ofB;
  const Points p{lane::loadUnaligned<Lanes>(kept.x), lane::loadUnaligned<Lanes>(kept.y),
                 lane::loadUnaligned<Lanes>(kept.z)};
  const Points n = lanes(kept.normal), way = times(motion.turn, p - lanes(kept.offset)) + lanes(motion.shift);
  out.separation = lane::loadUnaligned<Lanes>(kept.height) + dot(n, way);
  out.onBase = p + way - n * (out.separation * 0.5f);
  out.position = times(now.frame, out.onBase) + lanes(now.base);
  const Vec3 normal = mul(now.frame, kept.normal);
  out.normal = now.ofB ? -normal : normal;
}

}  // namespace

void carryPoints(const KeptManifold& kept, const OtherPlace& now, CarriedPoints& out) {
  carryBy(motionSince(kept, now), kept, now, out);
}

Carry carry(const KeptManifold& kept, const NearPose& a, const NearPose& b, const KeepLimits& limits,
            CarriedPoints& out) {
  const OtherPlace now = otherPlace(kept.what, a, b);
  const Motion motion = motionSince(kept, now);
  const Vec3 way = kept.aroundBase ? motion.shift - mul(motion.turn, kept.offset) : motion.shift;
  const Quat turned = motion.turned;
  const float moved = length(way) + 2 * length(Vec3{turned.x, turned.y, turned.z}) * kept.reach;
  const float clear = kept.clear - moved;
  if (kept.what == What::Apart) {
    // Only where nothing would be found anew, whatever the rounding: then nobody can tell whether it was kept.
    const float rounding = kOfMargin * limits.margin + kOfSizes * (kept.reach + length(now.offset));
    return clear > limits.margin + rounding ? Carry::Apart : Carry::Anew;
  }
  if (!(moved <= limits.allowed && clear >= limits.margin - limits.slack)) return Carry::Anew;
  carryBy(motion, kept, now, out);
  return Carry::Points;
}

PlacesOnBodies placesOnBodies(const CarriedPoints& points) {
  const Points onOther = timesT(matrix(points.turn), points.onBase - lanes(points.offset));
  if (points.ofB) return {onOther, points.onBase};
  return {points.onBase, onOther};
}

}  // namespace avbd
