// Which triangles of a surface a moving convex shape may meet (time_of_impact.h).
#include <algorithm>

#include "collide/convex.h"
#include "collide/support.h"
#include "collide/time_of_impact.h"
#include "geom/triangles.h"

namespace avbd {

namespace {

/// The convex shape in the frame that the surface has at time 0.
struct OnSurface {
  NearPose pose;
  Vec3 shift;       ///< against the surface, which stands still or turns
  Vec3 inner;       ///< a point well inside
  Aabb box;         ///< at `from`
  float wander;     ///< how far turning may take a point
  bool isStraight;  ///< the surface does not turn
};

float turning(const ShapeMotion& motion, Vec3 point) {
  return std::min(length(motion.turn), 2.0f) * length(point - motion.center);
}

OnSurface onSurface(const ShapeGeom& convex, const ShapeMotion& motion, const ShapeMotion& surface,
                    const ImpactQuery& query) {
  const NearPose now = at(motion, query.from), frame = at(surface, query.from);
  const Quat back = conjugate(frame.q);
  OnSurface on;
  on.pose = {rotate(back, now.p - frame.p), back * now.q};
  on.shift = rotate(back, (motion.shift - surface.shift) * (query.to - query.from));
  on.inner = on.pose * toFloat(innerPoint(convex));
  on.isStraight = surface.turn == Vec3{};
  on.box = bounds(convex, {toDouble(on.pose.p), on.pose.q}, 0);
  const float size = length(on.box.upper - on.box.lower);
  on.wander = motion.turn == Vec3{} ? 0 : turning(motion, motion.start.p) + std::min(length(motion.turn), 2.0f) * size;
  if (!on.isStraight)
    on.wander += turning(surface, now.p) + std::min(length(surface.turn), 2.0f) * (size + length(motion.shift));
  return on;
}

/// How far the shape may come below a plane that does not turn, at most.
bool staysAbove(const ShapeGeom& convex, const OnSurface& on, const SurfaceTriangle& t, const ImpactQuery& query) {
  const Vec3 down = -t.normal;
  const Vec3 lowest = on.pose * support(convex, rotate(conjugate(on.pose.q), down));
  const float gap = dot(t.normal, lowest - t.v[0]) - convex.radius;
  const float sinks = std::max(-dot(t.normal, on.shift), 0.0f) + on.wander;
  return gap - sinks > query.distance + query.tolerance;
}

MovingTriangle moving(const SurfaceTriangle& t, const ShapeMotion& surface) {
  MovingTriangle out;
  for (int i = 0; i < 3; ++i) out.v[i] = t.v[i] - t.v[0];
  out.doubleSided = t.doubleSided;
  out.motion = surface;
  out.motion.start.p = surface.start * t.v[0];
  return out;
}

}  // namespace

bool isInFront(const ShapeGeom& convex, const ShapeMotion& motion, const MovingTriangle& triangle, float time) {
  if (triangle.doubleSided) return true;
  const NearPose frame = at(triangle.motion, time);
  const Vec3 inner = at(motion, time) * toFloat(innerPoint(convex));
  return dot(rotate(frame.q, cross(triangle.v[1], triangle.v[2])), inner - frame.p) >= 0;
}

void forEachTriangleMet(const ShapeGeom& convex, const ShapeMotion& motion, const ShapeGeom& surface,
                        const ShapeMotion& surfaceMotion, const ImpactQuery& query,
                        FunctionRef<float(const MovingTriangle&, float to)> f) {
  const OnSurface on = onSurface(convex, motion, surfaceMotion, query);
  float to = query.to;
  const auto visit = [&](const SurfaceTriangle& t) {
    const float side = dot(t.normal, on.inner - t.v[0]);
    if (on.isStraight && side < 0 && !t.doubleSided) return;
    if (on.isStraight && side >= 0 && staysAbove(convex, on, t, query)) return;
    to = std::min(to, f(moving(t, surfaceMotion), to));
  };
  const float grow = on.wander + query.tolerance + std::max(query.distance, 0.0f);
  const Vec3 margin{grow, grow, grow};
  if (on.isStraight) {
    const Vec3 half = (on.box.upper - on.box.lower) * 0.5f + margin;
    const float span = query.to - query.from;
    forEachTriangleAlong(surface, (on.box.lower + on.box.upper) * 0.5f, on.shift, half,
                         [&](const SurfaceTriangle& t, float fraction) {
                           visit(t);
                           return std::min(fraction, (to - query.from) / span);
                         });
    return;
  }
  const float more = length(on.shift);
  const Aabb box{on.box.lower - margin - Vec3{more, more, more}, on.box.upper + margin + Vec3{more, more, more}};
  forEachBareTriangle(surface, box, [&](const SurfaceTriangle& t) {
    visit(t);
    return true;
  });
}

float distanceToSurface(const ShapeGeom& convex, const NearPose& pose, const ShapeGeom& surface,
                        const NearPose& surfacePose, float beyond) {
  const Quat back = conjugate(surfacePose.q);
  const NearPose local{rotate(back, pose.p - surfacePose.p), back * pose.q};
  const Vec3 inner = local * toFloat(innerPoint(convex));
  const Aabb box = bounds(convex, {toDouble(local.p), local.q}, std::max(beyond, 0.0f));
  float least = beyond;
  forEachBareTriangle(surface, box, [&](const SurfaceTriangle& t) {
    if (dot(t.normal, inner - t.v[0]) < 0 && !t.doubleSided) return true;
    const Vec3 v[3] = {t.v[0] - local.p, t.v[1] - local.p, t.v[2] - local.p};
    const Nearest near = nearest(convex, {{}, local.q}, {ShapeType::Triangle, 0, {}, v}, {}, least);
    if (!near.apart) least = std::min(least, near.distance);
    return true;
  });
  return least;
}

}  // namespace avbd
