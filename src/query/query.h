// Queries over a world's data: what the public calls of World do once their arguments are checked.
//
// A query walks the tree of bounds and asks each shape there exactly. Rays are double throughout. A cast starts where
// the moving shape's bounds meet those of the other, with that place as origin, so that float is enough for the rest
// however long the way is and however far away the world's origin. Before the walk the tree must hold every shape where
// it is now: a step moves bodies after it has fitted the tree, so the first query after it fits those that have left
// their bounds (freshenTree).
#pragma once

#include <vector>

#include "query/frame.h"
#include "world/world_data.h"

namespace avbd {

/// Fits the bounds of shapes that a step moved out of theirs. These are looked at by the next step as if the user had
/// moved them, which it would have found out by itself: the simulation is the same with and without queries.
void freshenTree(WorldData& data);

/// Where a shape is: as the step sees it.
Pose shapePose(const WorldData& data, const ShapeData& shape);

/// A filter, ready for use.
struct Sight {
  const WorldData& data;
  const QueryFilter& filter;
  uint32_t ignored = kNone;  ///< body slot

  bool sees(uint32_t slot) const;  ///< all but `accept`
  bool accepts(uint32_t slot) const { return !filter.accept || filter.accept(data.shapeIds.id(slot)); }
};

/// A queried geometry in the world. Convex.
struct Placed {
  ShapeGeom geom;
  Pose pose;
};

struct Way {
  Vec3d direction;  ///< unit
  double length = 0;
};

/// A CastHit by slot. distance < 0: none.
struct WayHit {
  uint32_t slot = kNone;
  uint32_t element = kNoElement;
  double distance = -1;
  Vec3d position;
  Vec3d normal;
  explicit operator bool() const { return slot != kNone; }
};

/// A NearHit by slot.
struct GapHit {
  uint32_t slot = kNone;
  uint32_t element = kNoElement;
  float distance = 0;
  Vec3d onPlaced, onShape;
  Vec3 normal;  ///< from the shape to the placed
  explicit operator bool() const { return slot != kNone; }
};

WayHit rayClosest(const Sight& sight, Vec3d from, const Way& way);
bool rayAny(const Sight& sight, Vec3d from, const Way& way);
std::vector<WayHit> rayAll(const Sight& sight, Vec3d from, const Way& way);  ///< by distance, then slot

WayHit castClosest(const Sight& sight, const Placed& placed, const Way& way);
bool castAny(const Sight& sight, const Placed& placed, const Way& way);
std::vector<WayHit> castAll(const Sight& sight, const Placed& placed, const Way& way);

bool overlapsAny(const Sight& sight, const Placed& placed);
std::vector<uint32_t> overlapping(const Sight& sight, const Placed& placed);  ///< slots, ascending
std::vector<uint32_t> containing(const Sight& sight, Vec3d point);
bool containsAny(const Sight& sight, Vec3d point);

GapHit nearestClosest(const Sight& sight, const Placed& placed, float maxDistance);
std::vector<GapHit> nearestAll(const Sight& sight, const Placed& placed,
                               float maxDistance);  ///< by distance, then slot

}  // namespace avbd
