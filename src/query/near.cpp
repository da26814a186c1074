// Overlaps, nearest points and points inside (query.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "collide/convex.h"
#include "collide/support_nearest.h"
#include "geom/triangles.h"
#include "query/point_shape.h"
#include "query/query.h"

namespace avbd {
namespace {

/// Half-space: the placed shape's lowest point.
GapHit gapToHalfSpace(const Pose& plane, const Placed& placed, float reach) {
  const Frame ground(plane), body(placed.pose);
  const Vec3d n = ground.toWorld({0, 1, 0});
  const Vec3 deepest = support(placed.geom, toFloat(body.toLocal(-n)));
  const Vec3d lowest = body.pointToWorld(toDouble(deepest)) - n * static_cast<double>(placed.geom.radius);
  const double height = ground.pointToLocal(lowest).y;
  const float distance = static_cast<float>(height);
  if (!(distance <= reach)) return {};
  return {0, kNoElement, distance, lowest, lowest - n * height, toFloat(n)};
}

/// nearest() leaves out what is exactly as far as it is asked for; a query takes it.
float justBeyond(float reach) { return std::nextafter(reach, std::numeric_limits<float>::infinity()); }

GapHit gapToConvex(const ShapeGeom& geom, const Pose& pose, const Placed& placed, float reach) {
  const Nearest near = nearest(placed.geom, {{}, placed.pose.rotation}, geom,
                               {toFloat(pose.position - placed.pose.position), pose.rotation}, justBeyond(reach));
  if (near.apart || near.distance > reach) return {};
  const Vec3d origin = placed.pose.position;
  return {0, kNoElement, near.distance, origin + near.pointA, origin + near.pointB, -near.normal};
}

/// Without the depth, which costs most where shapes overlap.
bool overlap(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB) {
  const CorePair pair = corePair(a, poseA, b, poseB);
  const double radii = double{a.radius} + b.radius;
  const Gjk g = gjk(pair, mul(pair.turn, innerPoint(b)) + pair.offset - innerPoint(a), radii);
  return g.result == GjkResult::Overlap || (g.result == GjkResult::Near && length(g.v) <= radii);
}

/// A placed shape in a surface's frame.
struct OnSurface {
  const ShapeGeom& surface;
  const Placed& placed;
  Frame frame;
  Vec3d at;  ///< its position there
  Quat turn;

  OnSurface(const ShapeGeom& geom, const Pose& pose, const Placed& p)
      : surface(geom),
        placed(p),
        frame(pose),
        at(frame.pointToLocal(p.pose.position)),
        turn(conjugate(pose.rotation) * p.pose.rotation) {}

  /// Relative to the placed shape.
  struct Corners {
    Vec3 v[3];
    ShapeGeom geom() const { return {ShapeType::Triangle, 0, {}, v}; }
  };
  Corners corners(const SurfaceTriangle& t) const {
    return {{toFloat(toDouble(t.v[0]) - at), toFloat(toDouble(t.v[1]) - at), toFloat(toDouble(t.v[2]) - at)}};
  }
  Nearest gap(const SurfaceTriangle& t, float reach) const {
    const Corners near = corners(t);
    return nearest(placed.geom, {{}, turn}, near.geom(), {}, justBeyond(reach));
  }

  /// Nearest triangle within reach.
  GapHit closest(float reach) const {
    Nearest best;
    uint32_t element = kNoElement;
    forEachBareTriangle(surface, bounds(placed.geom, {at, turn}, reach * (1 + 1e-6f)), [&](const SurfaceTriangle& t) {
      const Nearest near = gap(t, reach);
      if (near.apart || near.distance > reach) return true;
      const bool equal = near.distance == best.distance && t.element > element;
      if (element != kNoElement && (near.distance > best.distance || equal)) return true;
      best = near;
      element = t.element;
      reach = near.distance > 0 ? std::min(reach, near.distance * (1 + 1e-5f)) : 0;
      return true;
    });
    if (element == kNoElement) return {};
    return {0,
            element,
            best.distance,
            frame.pointToWorld(at + best.pointA),
            frame.pointToWorld(at + best.pointB),
            toFloat(frame.toWorld(toDouble(-best.normal)))};
  }

  bool touchesAny() const {
    bool touches = false;
    forEachBareTriangle(surface, bounds(placed.geom, {at, turn}, 0), [&](const SurfaceTriangle& t) {
      const Corners near = corners(t);
      touches = overlap(placed.geom, {{}, turn}, near.geom(), {});
      return !touches;
    });
    return touches;
  }
};

GapHit gapToSurface(const ShapeGeom& surface, const Pose& pose, const Placed& placed, float reach) {
  const OnSurface local(surface, pose, placed);
  // Looks near first, so that a long reach does not ask every triangle.
  const Aabb box = bounds(placed.geom, {{}, local.turn}, 0);
  float near = length(box.upper - box.lower);
  for (; near < reach; near *= 4) {
    const GapHit hit = local.closest(near);
    if (hit.element != kNoElement) return hit;
  }
  return local.closest(reach);
}

GapHit gapTo(const Sight& sight, uint32_t slot, const Placed& placed, float reach) {
  const ShapeData& shape = sight.data.shapes[slot];
  const Pose pose = shapePose(sight.data, shape);
  GapHit hit;
  if (isSurface(shape.geom.type)) {
    hit = gapToSurface(shape.geom, pose, placed, reach);
    if (hit.element == kNoElement) return {};
  } else {
    hit = shape.geom.type == ShapeType::HalfSpace ? gapToHalfSpace(pose, placed, reach)
                                                  : gapToConvex(shape.geom, pose, placed, reach);
    if (!hit) return {};
  }
  hit.slot = slot;
  return hit;
}

bool touches(const Sight& sight, uint32_t slot, const Placed& placed) {
  const ShapeData& shape = sight.data.shapes[slot];
  const Pose pose = shapePose(sight.data, shape);
  if (isSurface(shape.geom.type)) {
    if (OnSurface(shape.geom, pose, placed).touchesAny()) return true;
    return containsPoint(shape.geom, Frame(pose).pointToLocal(placed.pose.position));
  }
  if (shape.geom.type == ShapeType::HalfSpace) return static_cast<bool>(gapToHalfSpace(pose, placed, 0));
  return overlap(placed.geom, {{}, placed.pose.rotation}, shape.geom,
                 {toFloat(pose.position - placed.pose.position), pose.rotation});
}

bool holds(const Sight& sight, uint32_t slot, Vec3d point) {
  const ShapeData& shape = sight.data.shapes[slot];
  return containsPoint(shape.geom, Frame(shapePose(sight.data, shape)).pointToLocal(point));
}

bool isBefore(const GapHit& a, const GapHit& b) {
  return a.distance < b.distance || (a.distance == b.distance && a.slot < b.slot);
}

}  // namespace

bool overlapsAny(const Sight& sight, const Placed& placed) {
  bool found = false;
  sight.data.tree.around(bounds(placed.geom, placed.pose, 0), 0, [&](uint32_t slot, float reach) {
    found = sight.sees(slot) && touches(sight, slot, placed) && sight.accepts(slot);
    return found ? -1 : reach;
  });
  return found;
}

std::vector<uint32_t> overlapping(const Sight& sight, const Placed& placed) {
  std::vector<uint32_t> found;
  sight.data.tree.query(bounds(placed.geom, placed.pose, 0), [&](uint32_t slot) {
    if (sight.sees(slot) && touches(sight, slot, placed) && sight.accepts(slot)) found.push_back(slot);
  });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<uint32_t> containing(const Sight& sight, Vec3d point) {
  std::vector<uint32_t> found;
  sight.data.tree.query(bounds(ShapeGeom{}, {point, {}}, 0), [&](uint32_t slot) {
    if (sight.sees(slot) && holds(sight, slot, point) && sight.accepts(slot)) found.push_back(slot);
  });
  std::sort(found.begin(), found.end());
  return found;
}

bool containsAny(const Sight& sight, Vec3d point) {
  bool found = false;
  sight.data.tree.around(bounds(ShapeGeom{}, {point, {}}, 0), 0, [&](uint32_t slot, float reach) {
    found = sight.sees(slot) && holds(sight, slot, point) && sight.accepts(slot);
    return found ? -1 : reach;
  });
  return found;
}

GapHit nearestClosest(const Sight& sight, const Placed& placed, float maxDistance) {
  GapHit best;
  // Overlapping shapes are told apart by their depth, so all of them are asked.
  sight.data.tree.around(bounds(placed.geom, placed.pose, 0), maxDistance, [&](uint32_t slot, float reach) {
    if (!sight.sees(slot)) return reach;
    const GapHit hit = gapTo(sight, slot, placed, reach);
    if (!hit || (best && !isBefore(hit, best)) || !sight.accepts(slot)) return reach;
    best = hit;
    // A little farther, so that another one at the same distance is seen too.
    return hit.distance > 0 ? std::min(reach, hit.distance * (1 + 1e-5f)) : 0;
  });
  return best;
}

std::vector<GapHit> nearestAll(const Sight& sight, const Placed& placed, float maxDistance) {
  std::vector<GapHit> hits;
  sight.data.tree.around(bounds(placed.geom, placed.pose, 0), maxDistance, [&](uint32_t slot, float reach) {
    if (!sight.sees(slot)) return reach;
    const GapHit hit = gapTo(sight, slot, placed, reach);
    if (hit && sight.accepts(slot)) hits.push_back(hit);
    return reach;
  });
  std::sort(hits.begin(), hits.end(), isBefore);
  return hits;
}

}  // namespace avbd
