// Public geometry <-> the plain data that collision works on.
#include "geom/shape.h"

namespace avbd {
namespace {

ShapeGeom fromShape(const Sphere& s) { return {ShapeType::Sphere, s.radius, {}}; }
ShapeGeom fromShape(const Capsule& s) { return {ShapeType::Capsule, s.radius, {0, s.halfHeight, 0}}; }
ShapeGeom fromShape(const Box& s) { return {ShapeType::Box, 0, {s.x, s.y, s.z}}; }
ShapeGeom fromShape(const HalfSpace&) { return {ShapeType::HalfSpace, 0, {}}; }

}  // namespace

ShapeGeom toShapeGeom(const Geometry& geometry) {
  return std::visit([](const auto& shape) { return fromShape(shape); }, geometry);
}

Geometry toGeometry(const ShapeGeom& geom) {
  switch (geom.type) {
    case ShapeType::Sphere:
      return Sphere{geom.radius};
    case ShapeType::Capsule:
      return Capsule{geom.radius, geom.extent.y};
    case ShapeType::Box:
      return Box{geom.extent.x, geom.extent.y, geom.extent.z};
    case ShapeType::HalfSpace:
      break;
  }
  return HalfSpace{};
}

}  // namespace avbd
