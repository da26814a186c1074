// A convex shape moving straight against another one (convex.h): conservative advancement.
//
// Along the way the distance of two convex shapes is a convex function of the time. Where they are apart by more than
// their radii, the plane across the nearest points separates them; they cannot touch before the moving one has covered
// the gap along the plane's normal. Advancing by that is Newton's method from the convex side: it never passes the
// touch, doubles the digits with every step, and halves the gap where the shapes graze.
#include "collide/support_nearest.h"

namespace avbd {
namespace {

constexpr int kMaxSteps = 64;
constexpr double kClose = 1e-7;    // of the size: gap that counts as touching
constexpr double kGrazing = 1e-5;  // the same when the steps are used up

struct Way {
  CorePair pair;  // at the time t
  Vec3d motion;   // in a's frame
  double radii;
};

/// The touch at time t: b's point, in the pair's frame.
Vec3 pointOnB(const Way& way, const NearPose& poseA, Vec3d onB, double t) {
  return toFloat(mul(way.pair.frameA, onB + way.motion * t) + toDouble(poseA.p));
}

/// Overlapping at the start.
Meeting already(const Way& way, const NearPose& poseA) {
  const CoreNearest near = coreNearest(way.pair, way.radii);
  Meeting out;
  out.meets = true;
  const double l = length(way.motion);
  const Vec3d against = l > 0 ? way.motion * (-1 / l) : near.normal * -1.0;
  out.normal = toFloat(mul(way.pair.frameA, against));
  out.point = pointOnB(way, poseA, near.onA + near.normal * (near.distance - way.pair.b.radius), 0);
  return out;
}

}  // namespace

Meeting cast(const ShapeGeom& a, const NearPose& poseA, Vec3 motion, const ShapeGeom& b, const NearPose& poseB,
             float maxFraction) {
  Way way{corePair(a, poseA, b, poseB), {}, double{a.radius} + b.radius};
  way.motion = mulT(way.pair.frameA, toDouble(motion));
  const Vec3d start = way.pair.offset;
  const double reach = length(way.motion), close = kClose * way.pair.size, last = maxFraction;
  Vec3d direction = mul(way.pair.turn, innerPoint(b)) + start - innerPoint(a), normal;
  double t = 0, gap = 0;
  Meeting out;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Gjk g = gjk(way.pair, direction, way.radii + reach * (last - t));
    if (g.result == GjkResult::Apart) return out;
    const double distance = g.result == GjkResult::Near ? length(g.v) : 0;
    if (step == 0 && distance <= way.radii) return already(way, poseA);
    gap = 0;
    if (g.result == GjkResult::Overlap) break;  // rounding led past the touch: the last step's is it
    direction = g.v;
    normal = g.v * (1 / distance);
    out.point = pointOnB(way, poseA, pointOnA(g.simplex) + g.v - normal * b.radius, t);
    gap = g.lower - way.radii;
    const double speed = dot3(normal, way.motion);
    if (!(speed > 0)) return out;
    if (gap <= close) break;
    t += (gap - 0.5 * close) / speed;  // half of what counts as touching is left, so that there is a direction
    if (t > last) return out;
    way.pair.offset = start - way.motion * t;
  }
  if (gap > kGrazing * way.pair.size) return out;
  out.meets = true;
  out.fraction = static_cast<float>(t);
  out.normal = toFloat(mul(way.pair.frameA, normal) * -1.0);
  return out;
}

}  // namespace avbd
