// Rays and casts through the world (query.h).
#include <algorithm>

#include "query/meet_shape.h"

namespace avbd {
namespace {

/// What moves: a point or a placed.
struct MovingPoint {
  Vec3d from;
  BoxWay box(const Way& way) const { return {from, way.direction, way.length, {}}; }
  WayHit meet(const Candidate& c, const Way& way, bool backFaces) const { return meetRay(c, from, way, backFaces); }
};

struct MovingShape {
  const Placed& placed;
  BoxWay box(const Way& way) const {
    // About the position, where floats are fine.
    const Aabb b = bounds(placed.geom, {{}, placed.pose.rotation}, 0);
    return {placed.pose.position + (toDouble(b.lower) + toDouble(b.upper)) * 0.5, way.direction, way.length,
            (toDouble(b.upper) - toDouble(b.lower)) * (0.5 * (1 + 1e-6))};
  }
  WayHit meet(const Candidate& c, const Way& way, bool backFaces) const {
    return meetPlaced(c, placed, way, backFaces);
  }
};

/// Calls found(hit) -> length left for each shape's first hit within the length that is left.
template <class Mover, class F>
void search(const Sight& sight, const Mover& mover, const Way& way, F&& found) {
  const BoxWay box = mover.box(way);
  const WorldData& data = sight.data;
  data.tree.along(box, [&](uint32_t slot, double left) {
    if (!sight.sees(slot)) return left;
    const ShapeData& shape = data.shapes[slot];
    const Candidate candidate{shape, slot, shapePose(data, shape), box};
    const WayHit hit = mover.meet(candidate, {way.direction, left}, sight.filter.backFaces);
    return hit ? found(hit, left) : left;
  });
}

bool isBefore(const WayHit& a, const WayHit& b) {
  return a.distance < b.distance || (a.distance == b.distance && a.slot < b.slot);
}

/// Of the distance: what of the way stays to be searched behind a hit, so that another one at the same distance is seen
/// although rounding put it a little farther. More than a fraction of a way loses as a float.
constexpr double kTie = 1e-6;

template <class Mover>
WayHit closest(const Sight& sight, const Mover& mover, const Way& way) {
  WayHit best;
  search(sight, mover, way, [&](const WayHit& hit, double left) {
    if ((best && !isBefore(hit, best)) || !sight.accepts(hit.slot)) return left;
    best = hit;
    return std::min(left, hit.distance * (1 + kTie));
  });
  return best;
}

template <class Mover>
bool any(const Sight& sight, const Mover& mover, const Way& way) {
  bool met = false;
  search(sight, mover, way, [&](const WayHit& hit, double left) {
    met = sight.accepts(hit.slot);
    return met ? -1.0 : left;
  });
  return met;
}

template <class Mover>
std::vector<WayHit> all(const Sight& sight, const Mover& mover, const Way& way) {
  std::vector<WayHit> hits;
  search(sight, mover, way, [&](const WayHit& hit, double left) {
    if (sight.accepts(hit.slot)) hits.push_back(hit);
    return left;
  });
  std::sort(hits.begin(), hits.end(), isBefore);
  return hits;
}

}  // namespace

WayHit rayClosest(const Sight& sight, Vec3d from, const Way& way) { return closest(sight, MovingPoint{from}, way); }
bool rayAny(const Sight& sight, Vec3d from, const Way& way) { return any(sight, MovingPoint{from}, way); }
std::vector<WayHit> rayAll(const Sight& sight, Vec3d from, const Way& way) {
  return all(sight, MovingPoint{from}, way);
}

WayHit castClosest(const Sight& sight, const Placed& placed, const Way& way) {
  return closest(sight, MovingShape{placed}, way);
}
bool castAny(const Sight& sight, const Placed& placed, const Way& way) { return any(sight, MovingShape{placed}, way); }
std::vector<WayHit> castAll(const Sight& sight, const Placed& placed, const Way& way) {
  return all(sight, MovingShape{placed}, way);
}

}  // namespace avbd
