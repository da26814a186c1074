// Distance or depth of two convex shapes: GJK on their cores, EPA where they overlap (support_nearest.h, convex.h).
#include "collide/support_nearest.h"

#include "collide/epa.h"

namespace avbd {
namespace {

constexpr double kPolytope = 1e-10;    // of the size: gap between the bounds of a depth that is exact up to rounding
constexpr double kShift = 1.0 / 1024;  // of the size: gap that a depth is sharpened over
constexpr double kSharp = 1e-7;        // of the size: gain of depth that ends the sharpening
constexpr double kLevel = 1e-5;        // of the size: how far the touching points may lie beside each other then
constexpr int kMaxSharpen = 6;

}  // namespace

CoreNearest coreNearest(const CorePair& pair, double beyond) {
  const Vec3d start = mul(pair.turn, innerPoint(pair.b)) + pair.offset - innerPoint(pair.a);
  const Gjk g = gjk(pair, start, beyond);
  CoreNearest out;
  if (g.result == GjkResult::Apart) {
    out.apart = true;
    out.distance = g.lower;
  } else if (g.result == GjkResult::Near) {
    out.distance = length(g.v);
    out.normal = g.v * (1 / out.distance);
    out.onA = pointOnA(g.simplex);
  } else {
    Depth depth;
    const bool flat = isPolytope(pair.a.type) && isPolytope(pair.b.type);
    epa(pair, g.simplex, flat ? kPolytope : kCoarse, depth);
    out.sharp = flat || depth.flat;
    out.distance = -depth.depth;
    out.normal = depth.normal;
    out.onA = pointOnA(depth.face);
  }
  return out;
}

// Where the cores are curved: b is moved out along the normal, a little farther than the depth, and the direction of
// the distance there taken as the normal. A direction of least depth is what that leaves as it is; the error shrinks by
// about the depth over the radius of curvature with every turn. A normal is only taken if it shows less depth.
void sharpen(const CorePair& pair, CoreNearest& near) {
  CorePair moved = pair;
  const double shift = kShift * pair.size;
  for (int turn = 0; turn < kMaxSharpen && !near.sharp; ++turn) {
    moved.offset = pair.offset + near.normal * (shift - near.distance);
    const Gjk g = gjk(moved, near.normal, 4 * shift);
    if (g.result != GjkResult::Near) break;
    const Vec3d normal = g.v * (1 / length(g.v)), turned = normal - near.normal;
    const double now = dot3(normal, lowest(pair, normal).w), gain = now - near.distance;
    if (turn == 0) near.onA = pointOnA(g.simplex);
    if (!(gain >= 0)) break;
    near.onA = pointOnA(g.simplex);
    near.distance = now;
    near.normal = normal;
    if (gain < kSharp * pair.size && length(turned) * -now < kLevel * pair.size) break;
  }
  near.sharp = true;
}

Nearest nearest(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB, float beyond) {
  const CorePair pair = corePair(a, poseA, b, poseB);
  const double radii = double{a.radius} + b.radius;
  CoreNearest core = coreNearest(pair, beyond + radii);
  sharpen(pair, core);
  Nearest out;
  out.distance = static_cast<float>(core.distance - radii);
  out.apart = core.apart || out.distance >= beyond;
  if (core.apart) return out;
  const Vec3d surfaceA = core.onA + core.normal * a.radius;
  const Vec3d surfaceB = core.onA + core.normal * (core.distance - b.radius);
  out.normal = toFloat(mul(pair.frameA, core.normal));
  out.pointA = toFloat(mul(pair.frameA, surfaceA) + toDouble(poseA.p));
  out.pointB = toFloat(mul(pair.frameA, surfaceB) + toDouble(poseA.p));
  return out;
}

}  // namespace avbd
