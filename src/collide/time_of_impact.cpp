// When two moving convex shapes meet (time_of_impact.h).
#include "collide/time_of_impact.h"

#include <avbd/hull.h>
#include <avbd/rows/math.h>

#include <algorithm>

#include "collide/support_nearest.h"

namespace avbd {

namespace {

constexpr int kMaxSteps = 128;

Quat turnedBy(Vec3 turn, float time) {
  const rows::Q4<float> q = rows::expQuat(rows::V3<float>{turn.x * time, turn.y * time, turn.z * time});
  return {q.w, q.x, q.y, q.z};
}

Vec3d turned(Quat q, Vec3d v) { return mul(exactMatrix(q), v); }
Vec3d turnedBack(Quat q, Vec3d v) { return mulT(exactMatrix(q), v); }

/// Farthest point of a shape along a direction (unit), relative to the centre of turning.
double reachAlong(const ShapeGeom& geom, const NearPose& pose, Vec3d center, Vec3d n) {
  const Vec3d point = turned(pose.q, supportPoint(geom, turnedBack(pose.q, n))) + toDouble(pose.p);
  return dot3(point - center, n) + geom.radius;
}

double fromAxis(Vec3d point, Vec3d axis) { return length(cross3(point, axis)); }

/// Farthest distance of a shape's points from an axis through the centre of turning.
double reachAcross(const ShapeGeom& geom, const NearPose& pose, Vec3d center, Vec3d axis) {
  const Vec3d e = toDouble(geom.extent), p = toDouble(pose.p) - center;
  const auto away = [&](Vec3d local) { return fromAxis(turned(pose.q, local) + p, axis); };
  double far = 0;
  switch (geom.type) {
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      for (int k = 0; k < 8; ++k)
        far = std::max(far, away({k & 1 ? e.x : -e.x, k & 2 ? e.y : -e.y, k & 4 ? e.z : -e.z}));
      break;
    case ShapeType::Hull:
      for (const Vec3 v : geom.hull().vertices()) far = std::max(far, away(toDouble(v)));
      break;
    case ShapeType::Triangle:
      for (int k = 0; k < 3; ++k) far = std::max(far, away(toDouble(geom.triangle()[k])));
      break;
    case ShapeType::Ellipsoid:
      far = away({}) + std::max({e.x, e.y, e.z});
      break;
    default:  // two points of the axis, with a circle about each
      far = std::max(away({0, e.y, 0}), away({0, -e.y, 0})) + e.x;
  }
  return far + geom.radius;
}

/// One of the two as it moves, and what bounds its turning.
class MovingSide {
 public:
  MovingSide(const ShapeGeom& geom, const ShapeMotion& motion)
      : geom_(geom), motion_(motion), rate_(length(toDouble(motion.turn))) {
    if (!(rate_ > 0) || geom.type == ShapeType::HalfSpace) return;
    axis_ = toDouble(motion.turn) * (1 / rate_);
    const Vec3d center = toDouble(motion.center);
    across_ = reachAcross(geom, motion.start, center, axis_);
    up_ = reachAlong(geom, motion.start, center, axis_);
    down_ = reachAlong(geom, motion.start, center, axis_ * -1.0);
  }
  NearPose pose(double time) const { return at(motion_, static_cast<float>(time)); }
  Vec3d shift() const { return toDouble(motion_.shift); }
  /// How far turning may take a point at most in a time.
  double turning(double span) const { return std::min(rate_ * span, 2.0) * across_; }

  /// How much farther along n turning may take the shape, from this pose on.
  struct Swing {
    double rate = 0;  ///< [m] over the whole time
    double most = 0;
  };
  Swing swing(const NearPose& pose, double time, Vec3d n) const {
    if (!(rate_ > 0)) return {};
    const double along = dot3(n, axis_), beside = length(cross3(n, axis_));
    const Vec3d center = toDouble(motion_.center) + shift() * time;
    const double most = (along > 0 ? along * up_ : -along * down_) + beside * across_;
    return {beside * rate_ * across_, std::max(most - reachAlong(geom_, pose, center, n), 0.0)};
  }

 private:
  const ShapeGeom& geom_;
  const ShapeMotion& motion_;
  double rate_, across_ = 0, up_ = 0, down_ = 0;
  Vec3d axis_;
};

struct Separation {
  bool apart = false;
  double distance = 0;
  Vec3d normal;
};

Separation separationOf(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB,
                        double beyond) {
  Separation out;
  if (b.type == ShapeType::HalfSpace) {
    const Vec3d up = turned(poseB.q, {0, 1, 0});
    out.normal = up * -1.0;
    out.distance = -reachAlong(a, poseA, toDouble(poseB.p), out.normal);
    out.apart = out.distance > beyond;
    return out;
  }
  const CorePair pair = corePair(a, poseA, b, poseB);
  const double radii = double{a.radius} + b.radius;
  const CoreNearest near = coreNearest(pair, beyond + radii);
  out.apart = near.apart;
  out.distance = near.distance - radii;
  if (!near.apart) out.normal = mul(pair.frameA, near.normal);
  return out;
}

/// How long a gap lasts that shrinks by `speed` and by both swings.
double lasts(double gap, double speed, MovingSide::Swing a, MovingSide::Swing b) {
  const auto end = [](const MovingSide::Swing& s) { return s.most < s.rate ? s.most / s.rate : 1.0; };
  if (end(b) < end(a)) std::swap(a, b);
  const double ends[2] = {end(a), end(b)}, rates[3] = {speed + a.rate + b.rate, speed + b.rate, speed};
  double time = 0;
  for (int i = 0; i < 3; ++i) {
    const double until = i < 2 ? ends[i] : 2.0, span = until - time;
    if (rates[i] > 0 && gap < rates[i] * span) return time + gap / rates[i];
    gap -= rates[i] * span;
    time = until;
  }
  return time;
}

}  // namespace

NearPose at(const ShapeMotion& motion, float time) {
  if (motion.turn == Vec3{}) return {motion.start.p + motion.shift * time, motion.start.q};
  const Quat turn = turnedBy(motion.turn, time);
  return {motion.center + motion.shift * time + rotate(turn, motion.start.p - motion.center), turn * motion.start.q};
}

Impact timeOfImpact(const ShapeGeom& a, const ShapeMotion& motionA, const ShapeGeom& b, const ShapeMotion& motionB,
                    const ImpactQuery& query) {
  const MovingSide sideA(a, motionA), sideB(b, motionB);
  const Vec3d shift = sideA.shift() - sideB.shift();
  const double tolerance = query.tolerance;
  double time = query.from;
  Impact out;
  for (int step = 0; step < kMaxSteps; ++step) {
    const NearPose poseA = sideA.pose(time), poseB = sideB.pose(time);
    const double span = query.to - time;
    const double reach = length(shift) * span + sideA.turning(span) + sideB.turning(span);
    const Separation near = separationOf(a, poseA, b, poseB, query.distance + reach + tolerance);
    if (step == 0) out.before = static_cast<float>(near.distance);
    if (near.apart) return out;
    const double gap = near.distance - query.distance;
    out.time = static_cast<float>(time);
    out.normal = toFloat(near.normal);
    if (gap <= tolerance) break;
    const double wait = lasts(gap - 0.5 * tolerance, dot3(near.normal, shift), sideA.swing(poseA, time, near.normal),
                              sideB.swing(poseB, time, near.normal * -1.0));
    time += wait;
    if (time > query.to) return out;
  }
  out.happens = true;
  return out;
}

}  // namespace avbd
