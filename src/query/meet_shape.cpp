// Rays and moving shapes against one shape (meet_shape.h).
#include "query/meet_shape.h"

#include <algorithm>
#include <limits>

#include "collide/convex.h"
#include "geom/triangles.h"
#include "query/ray_shape.h"

namespace avbd {
namespace {

const ShapeGeom kPoint{ShapeType::Sphere, 0, {}};

Aabb boundsOf(const SurfaceTriangle& t) {
  const auto low = [](float a, float b, float c) { return std::min({a, b, c}); };
  const auto high = [](float a, float b, float c) { return std::max({a, b, c}); };
  return {{low(t.v[0].x, t.v[1].x, t.v[2].x), low(t.v[0].y, t.v[1].y, t.v[2].y), low(t.v[0].z, t.v[1].z, t.v[2].z)},
          {high(t.v[0].x, t.v[1].x, t.v[2].x), high(t.v[0].y, t.v[1].y, t.v[2].y), high(t.v[0].z, t.v[1].z, t.v[2].z)}};
}

/// The part of a way that has to be cast: from just before bounds meet to where they part. Never empty. Before, because
/// bounds and surface may coincide there, and floats relative to its begin would show shapes that touch as overlapping.
struct Piece {
  double begin, length;
  double slack;  ///< far more than rounding, and than the gap that counts as touching

  /// `from`: from the start to the other shape's position.
  Piece(const WaySpan& span, const Way& way, Vec3d from, double size) {
    slack = 1e-6 * (avbd::length(from - way.direction * span.begin) + size);
    begin = std::max(0.0, span.begin - slack);
    length = std::max(span.end - begin, size * 1e-6);
  }
};

float largest(Vec3 v) { return std::max({v.x, v.y, v.z}); }

/// A convex shape moving along its way against a half-space: the point that lies deepest moves.
WayHit meetHalfSpace(const Candidate& c, const Placed& placed, const Way& way) {
  const Frame plane(c.pose), body(placed.pose);
  const Vec3d n = plane.toWorld({0, 1, 0}), down = body.toLocal(-n);
  const Vec3 deepest = support(placed.geom, toFloat(down));
  const Vec3d start = body.pointToWorld(toDouble(deepest)) - n * static_cast<double>(placed.geom.radius);
  const LocalRay ray{plane.pointToLocal(start), plane.toLocal(way.direction), way.length};
  const LocalHit hit = rayShape(c.shape.geom, ray);
  if (!hit || hit.distance > way.length) return {};
  const Vec3d met = start + way.direction * hit.distance;
  // What starts inside meets the plane at its deepest point's foot.
  const Vec3d position = hit.distance > 0 ? met : start - n * ray.from.y;
  return {c.slot, kNoElement, hit.distance, position, plane.toWorld(hit.normal)};
}

/// Casts a from `start + direction piece.begin` against b, relative to that place: distance along the whole way.
LocalHit castPiece(const Placed& a, const Placed& b, const Piece& piece, const Way& left, Vec3d& point) {
  const Vec3d start = a.pose.position + left.direction * piece.begin;
  // A little farther than what is left, so that the touch itself is never beyond: where it is decides below.
  const double most = (left.length + piece.slack - piece.begin) / piece.length;
  if (!(most >= 0)) return {};
  const NearPose poseA{{}, a.pose.rotation}, poseB{toFloat(b.pose.position - start), b.pose.rotation};
  const Meeting met = cast(a.geom, poseA, toFloat(left.direction * piece.length), b.geom, poseB,
                           most < 1 ? static_cast<float>(most) : 1);
  const double distance = piece.begin + static_cast<double>(met.fraction) * piece.length;
  if (!met.meets || distance > left.length) return {};
  point = start + met.point;
  if (!(distance > 0)) return {distance, -left.direction};
  if (met.fraction > 0) return {distance, unitOf(toDouble(met.normal))};
  // A way that grazes the bounds from their begin: the shapes touch there, whatever rounding says about overlap.
  const Nearest near = nearest(a.geom, poseA, b.geom, poseB, std::numeric_limits<float>::max());
  point = start + near.pointB;
  return {distance, unitOf(toDouble(-near.normal))};
}

/// Against a convex shape: from where its bounds are met, relative to the moving shape there.
WayHit meetConvex(const Candidate& c, const Placed& placed, const Way& way) {
  const Aabb box = bounds(c.shape.geom, c.pose, 0);
  const WaySpan span = WayAxes(c.whole).meet(box, c.whole.length);
  if (span.begin > span.end) return {};
  const Piece piece(span, way, c.pose.position - placed.pose.position, largest(box.upper - box.lower));
  WayHit hit;
  const LocalHit met = castPiece(placed, {c.shape.geom, c.pose}, piece, way, hit.position);
  if (!met) return {};
  hit.slot = c.slot;
  hit.distance = met.distance;
  hit.normal = met.normal;
  return hit;
}

/// A way in a surface's frame, from where the surface's bounds are met.
struct SurfaceWay {
  Frame frame;
  Vec3d from, direction;
  Vec3d start;
  double begin = 0, length = -1;  ///< length < 0: it misses

  SurfaceWay(const Candidate& c, Vec3d worldFrom, const Way& way, Vec3d half)
      : frame(c.pose), from(frame.pointToLocal(worldFrom)), direction(frame.toLocal(way.direction)) {
    const Aabb box = surfaceBounds(c.shape.geom);
    const Vec3d wide = half + toDouble(box.upper - box.lower) * 1e-6;
    const WaySpan span = WayAxes({from, direction, way.length, wide}).meet(box, way.length);
    if (span.begin > span.end) return;
    begin = span.begin;
    length = span.end - span.begin;
    start = from + direction * begin;
  }
  Vec3 slack(const ShapeGeom& surface, Vec3d half) const {
    // Where the start was rounded to float.
    const Aabb box = surfaceBounds(surface);
    return toFloat(half * (1 + 1e-6) + toDouble(box.upper - box.lower) * 1e-6);
  }
  float fractionOf(double distance) const {
    return length > 0 ? std::min(1.0f, static_cast<float>((distance - begin) / length) * (1 + 1e-6f) + 1e-7f) : 0.0f;
  }
};

WayHit rayOnSurface(const Candidate& c, Vec3d worldFrom, const Way& way, bool backFaces) {
  const SurfaceWay local(c, worldFrom, way, {});
  if (local.length < 0) return {};
  LocalRay ray{local.from, local.direction, way.length};
  LocalHit best;
  uint32_t element = kNoElement;
  const auto visit = [&](const SurfaceTriangle& t, float left) {
    const LocalHit hit = rayTriangle(t.v, ray, backFaces || t.doubleSided);
    if (!hit || (best && hit.distance == best.distance && t.element > element)) return left;
    best = hit;
    element = t.element;
    ray.length = hit.distance;
    return std::min(left, local.fractionOf(hit.distance));
  };
  forEachTriangleAlong(c.shape.geom, toFloat(local.start), toFloat(local.direction * local.length),
                       local.slack(c.shape.geom, {}), visit);
  if (!best) return {};
  return {c.slot, element, best.distance, worldFrom + way.direction * best.distance, local.frame.toWorld(best.normal)};
}

/// The moving shape against the triangles of a surface, in the surface's frame.
struct TriangleCast {
  Placed placed;  ///< at the start
  Vec3d middle;   ///< of its bounds
  Vec3d half;     ///< of its bounds
  double whole;   ///< length of the way

  TriangleCast(const Candidate& c, const Placed& p)
      : placed{p.geom, {Frame(c.pose).pointToLocal(p.pose.position), conjugate(c.pose.rotation) * p.pose.rotation}},
        whole(c.whole.length) {
    const Aabb box = bounds(p.geom, {{}, placed.pose.rotation}, 0);
    middle = placed.pose.position + (toDouble(box.lower) + toDouble(box.upper)) * 0.5;
    half = (toDouble(box.upper) - toDouble(box.lower)) * (0.5 * (1 + 1e-6));
  }

  LocalHit meet(const SurfaceTriangle& t, const Way& way, Vec3d& point) const {
    const WaySpan span = WayAxes({middle, way.direction, whole, half}).meet(boundsOf(t), whole);
    if (span.begin > span.end) return {};
    // Relative to its first corner, so that floats are fine.
    const Vec3 corners[3] = {{}, t.v[1] - t.v[0], t.v[2] - t.v[0]};
    const Placed triangle{{ShapeType::Triangle, 0, {}, corners}, {toDouble(t.v[0]), {}}};
    const Piece piece(span, way, triangle.pose.position - placed.pose.position, length(half));
    return castPiece(placed, triangle, piece, way, point);
  }
};

WayHit placedOnSurface(const Candidate& c, const Placed& placed, const Way& way, bool backFaces) {
  const TriangleCast cast(c, placed);
  const Frame frame(c.pose);
  const SurfaceWay local(c, frame.pointToWorld(cast.middle), way, cast.half);
  if (local.length < 0) return {};
  Way left{local.direction, way.length};
  LocalHit best;
  Vec3d where;
  uint32_t element = kNoElement;
  const auto visit = [&](const SurfaceTriangle& t, float fraction) {
    if (!backFaces && !t.doubleSided && dot(toDouble(t.normal), left.direction) > 0) return fraction;
    Vec3d point;
    const LocalHit hit = cast.meet(t, left, point);
    if (!hit || (best && (hit.distance > best.distance || (hit.distance == best.distance && t.element > element))))
      return fraction;
    best = hit;
    where = point;
    element = t.element;
    // A little farther, so that another one at the same distance is not lost to the rounding of fractions.
    left.length = std::min(left.length, hit.distance * (1 + 1e-6));
    return std::min(fraction, local.fractionOf(hit.distance));
  };
  forEachTriangleAlong(c.shape.geom, toFloat(local.start), toFloat(local.direction * local.length),
                       local.slack(c.shape.geom, cast.half), visit);
  if (!best) return {};
  return {c.slot, element, best.distance, frame.pointToWorld(where), frame.toWorld(best.normal)};
}

/// The point of a convex shape's surface that is nearest to a point inside or near it.
Vec3d surfacePoint(const Candidate& c, Vec3d point) {
  const NearPose shape{toFloat(c.pose.position - point), c.pose.rotation};
  return point + nearest(kPoint, {}, c.shape.geom, shape, std::numeric_limits<float>::max()).pointB;
}

/// A ball's way is its centre's way against the shape grown by its radius.
WayHit meetBall(const Candidate& c, const Placed& placed, const Way& way, const ShapeGeom& grown) {
  const Frame frame(c.pose);
  const LocalHit hit =
      rayShape(grown, {frame.pointToLocal(placed.pose.position), frame.toLocal(way.direction), way.length});
  if (!hit) return {};
  const Vec3d center = placed.pose.position + way.direction * hit.distance, n = frame.toWorld(hit.normal);
  if (!(hit.distance > 0)) return {c.slot, kNoElement, 0, surfacePoint(c, center), n};
  return {c.slot, kNoElement, hit.distance, center - n * static_cast<double>(placed.geom.radius), n};
}

}  // namespace

WayHit meetRay(const Candidate& c, Vec3d from, const Way& way, bool backFaces) {
  const ShapeGeom& geom = c.shape.geom;
  if (isSurface(geom.type)) return rayOnSurface(c, from, way, backFaces);
  if (!hasExactRay(geom)) {
    WayHit hit = meetConvex(c, {kPoint, {from, {}}}, way);
    if (hit && !(hit.distance > 0)) hit.position = from;
    return hit;
  }
  const Frame frame(c.pose);
  const LocalHit hit = rayShape(geom, {frame.pointToLocal(from), frame.toLocal(way.direction), way.length});
  if (!hit) return {};
  return {c.slot, kNoElement, hit.distance, from + way.direction * hit.distance, frame.toWorld(hit.normal)};
}

WayHit meetPlaced(const Candidate& c, const Placed& placed, const Way& way, bool backFaces) {
  const ShapeGeom& geom = c.shape.geom;
  if (isSurface(geom.type)) return placedOnSurface(c, placed, way, backFaces);
  if (geom.type == ShapeType::HalfSpace) return meetHalfSpace(c, placed, way);
  if (placed.geom.type == ShapeType::Sphere) {
    ShapeGeom grown = geom;
    grown.radius += placed.geom.radius;
    if (hasExactRay(grown)) return meetBall(c, placed, way, grown);
  }
  WayHit hit = meetConvex(c, placed, way);
  // The points of depths of round shapes are less exact than the depths.
  if (hit && !(hit.distance > 0)) hit.position = surfacePoint(c, hit.position);
  return hit;
}

}  // namespace avbd
