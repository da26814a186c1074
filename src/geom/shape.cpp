// Public geometry -> the plain data that collision works on.
#include "geom/shape.h"

#include "base/assert.h"
#include "geom/hull.h"

namespace avbd {
namespace {

struct Plain {
  std::shared_ptr<const HullData>& keep;

  ShapeGeom operator()(const Sphere& s) const { return {ShapeType::Sphere, s.radius, {}}; }
  ShapeGeom operator()(const Capsule& s) const { return {ShapeType::Capsule, s.radius, {0, s.halfHeight, 0}}; }
  ShapeGeom operator()(const Box& s) const {
    return {s.rounding > 0 ? ShapeType::RoundedBox : ShapeType::Box, s.rounding, {s.x, s.y, s.z}};
  }
  ShapeGeom operator()(const Cylinder& s) const {
    return {ShapeType::Cylinder, s.rounding, {s.radius, s.halfHeight, s.radius}};
  }
  ShapeGeom operator()(const Cone& s) const {
    return {ShapeType::Cone, s.rounding, {s.radius, s.halfHeight, s.radius}};
  }
  ShapeGeom operator()(const Ellipsoid& s) const { return {ShapeType::Ellipsoid, 0, {s.x, s.y, s.z}}; }
  ShapeGeom operator()(const Hull& s) const {
    ShapeGeom geom{ShapeType::Hull, s.rounding, {}};
    if (s.scale == Vec3{1, 1, 1}) {
      geom.data = s.data.get();
    } else {
      keep = scaledHull(s.data, s.scale);
      geom.data = keep.get();
    }
    return geom;
  }
  ShapeGeom operator()(const HalfSpace&) const { return {ShapeType::HalfSpace, 0, {}}; }
  ShapeGeom operator()(const Mesh& s) const {
    ShapeGeom geom{ShapeType::Mesh, 0, {}};
    geom.data = s.data.get();
    geom.scale = s.scale;
    return geom;
  }
  ShapeGeom operator()(const HeightField& s) const {
    ShapeGeom geom{ShapeType::HeightField, 0, {}};
    geom.data = s.data.get();
    geom.scale = s.scale;
    return geom;
  }
};

}  // namespace

bool isOnlyFixed(const Geometry& geometry) {
  return std::holds_alternative<HalfSpace>(geometry) || std::holds_alternative<Mesh>(geometry) ||
         std::holds_alternative<HeightField>(geometry);
}

const char* geometryName(const Geometry& geometry) {
  constexpr const char* kNames[] = {"Sphere", "Capsule",   "Box",  "HalfSpace", "Cylinder",
                                    "Cone",   "Ellipsoid", "Hull", "Mesh",      "HeightField"};
  static_assert(std::size(kNames) == std::variant_size_v<Geometry>);
  return kNames[geometry.index()];
}

ShapeGeom toShapeGeom(const Geometry& geometry, std::shared_ptr<const HullData>& keep) {
  return std::visit(Plain{keep}, geometry);
}

ShapeGeom toShapeGeom(const Geometry& geometry) {
  std::shared_ptr<const HullData> keep;
  const ShapeGeom geom = toShapeGeom(geometry, keep);
  AVBD_ASSERT(!keep);
  return geom;
}

}  // namespace avbd
