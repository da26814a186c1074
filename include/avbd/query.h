// Questions to a world: rays, casts, overlaps, nearest points. Answers count every living shape where it is now.
#pragma once

#include <avbd/events.h>
#include <avbd/geometry.h>
#include <avbd/id.h>

#include <functional>

namespace avbd {

/// Which shapes a query sees. All conditions must hold.
struct QueryFilter {
  /// As if the query were a shape with this filter: by the same rules as two shapes (geometry.h), so that the shape's
  /// mask must let this category through too. As it stands it is a usual shape's: category 1, sees all.
  Filter filter{};
  bool statics = true;     ///< shapes of static bodies
  bool kinematics = true;  ///< of kinematic bodies
  bool dynamics = true;    ///< of dynamic bodies
  bool triggers = false;   ///< shapes with isTrigger too
  bool backFaces = false;  ///< rays and casts meet one-sided triangles (Mesh, HeightField) from behind too
  BodyId ignore{};         ///< shapes of this body are not seen; null: all are
  /// Asked last, about a shape that would otherwise be an answer (by the closest-forms: a better one than the best so
  /// far); false leaves it out. It must not change the world, and depend on its argument alone: how often and in which
  /// order it is asked is not told. Queries from several threads call it from all of them.
  std::function<bool(ShapeId)> accept{};
};

/// From origin along direction for `length`. direction: any finite length > 0; only its direction counts.
struct Ray {
  Vec3d origin;
  Vec3 direction{0, -1, 0};
  float length = 1e6f;  ///< [m] > 0
};

/// A convex geometry moving from a pose along `motion` without turning.
struct ShapeCast {
  Geometry geometry = Sphere{};
  Pose pose{};
  Vec3 motion{0, -1, 0};  ///< [m], not zero
};

/// A convex geometry at a pose in the world.
struct PlacedGeometry {
  Geometry geometry = Sphere{};
  Pose pose{};
};

/// Where a ray or a cast shape met a shape. Convex shapes and half-spaces are solid: what starts inside or touching
/// meets them at distance 0. The triangles of Mesh and HeightField are surfaces: they are met from the front (or as
/// doubleSided and backFaces say), a ray that starts behind one does not meet it, and of one shape the nearest triangle
/// counts.
struct CastHit {
  ShapeId shape;
  BodyId body;
  uint32_t element = kNoElement;  ///< triangle of a Mesh or HeightField
  float distance = 0;             ///< [m] along the way; 0 where it starts inside or touching
  Vec3d position;                 ///< world [m], on the shape's surface; where a ray starts inside: its origin
  Vec3 normal;                    ///< unit, out of the shape at that point, against the way where it starts inside
  explicit operator bool() const { return static_cast<bool>(shape); }
};

/// Nearest points of a queried geometry and a shape; of a Mesh or HeightField its nearest triangle. Triangles are thin
/// and have no back here: depth is the way out of the triangle.
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
