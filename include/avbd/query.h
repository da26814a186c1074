// Questions to a world: rays, casts, overlaps, nearest points. Answers count every living shape where it is now.
#pragma once

#include <avbd/events.h>
#include <avbd/geometry.h>
#include <avbd/id.h>

#include <functional>

namespace avbd {

/// Which shapes a query sees.
struct QueryFilter {
  Filter filter{};         ///< as if the query were a shape with this filter
  bool statics = true;     ///< shapes of static bodies
  bool kinematics = true;  ///< of kinematic bodies
  bool dynamics = true;    ///< of dynamic bodies
  bool triggers = false;   ///< shapes with isTrigger
  BodyId ignore{};         ///< shapes of this body are not seen
  /// Called for each shape that passed everything above; false leaves it out. Must not change the world.
  std::function<bool(ShapeId)> accept{};
};

/// From origin along direction for `length`. direction: any finite length > 0; only its direction counts.
struct Ray {
  Vec3d origin;
  Vec3 direction{0, -1, 0};
  float length = 1e6f;  ///< [m] > 0
};

/// Where a ray or a cast shape met a shape.
struct CastHit {
  ShapeId shape;
  BodyId body;
  uint32_t element = kNoElement;  ///< triangle of a Mesh or HeightField
  float distance = 0;             ///< [m] along the way; 0 where it starts inside or touching
  Vec3d position;                 ///< world [m], on the shape's surface
  Vec3 normal;                    ///< unit, out of the shape at that point, against the way where it starts inside
  explicit operator bool() const { return static_cast<bool>(shape); }
};

/// Nearest points of a queried geometry and a shape.
struct NearHit {
  ShapeId shape;
  BodyId body;
  uint32_t element = kNoElement;
  float distance = 0;  ///< [m]; negative: depth of overlap
  Vec3d onQuery;       ///< world [m], on the queried geometry
  Vec3d onShape;       ///< world [m], on the shape
  Vec3 normal;         ///< unit, from the shape to the query
};

}  // namespace avbd
