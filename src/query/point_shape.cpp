// Points in shapes (point_shape.h).
#include "query/point_shape.h"

#include <avbd/height_field.h>
#include <avbd/hull.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collide/convex.h"

namespace avbd {
namespace {

double square(double x) { return x * x; }
double over(double x, double most) { return std::max(0.0, std::abs(x) - most); }

/// Squared distance in the plane from p to the segment a b.
double squaredFrom(double px, double py, const double (&a)[2], const double (&b)[2]) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], vx = px - a[0], vy = py - a[1];
  const double s = std::clamp((ux * vx + uy * vy) / (ux * ux + uy * uy), 0.0, 1.0);
  return square(vx - s * ux) + square(vy - s * uy);
}

bool inCone(const ShapeGeom& geom, Vec3d p) {
  const double h = geom.extent.y, r = geom.extent.x, far = std::sqrt(p.x * p.x + p.z * p.z);
  if (std::abs(p.y) <= h && far * 2 * h <= r * (h - p.y)) return true;
  const double rim[2] = {r, -h}, tip[2] = {0, h}, middle[2] = {0, -h};
  return std::min(squaredFrom(far, p.y, rim, tip), squaredFrom(far, p.y, middle, rim)) <= square(geom.radius);
}

bool inHull(const ShapeGeom& geom, Vec3d p) {
  double most = -1e300;
  for (const HullData::Face& face : geom.hull().faces())
    most = std::max(most, dot(toDouble(face.normal), p) - static_cast<double>(face.offset));
  if (most <= 0) return true;
  if (most > geom.radius) return false;
  const ShapeGeom point{ShapeType::Sphere, 0, {}};
  // What is exactly as far as nearest() is asked for is apart to it; here the surface belongs to the hull.
  const Nearest near = nearest(point, {toFloat(p), {}}, geom, {}, std::numeric_limits<float>::denorm_min());
  return !near.apart && near.distance <= 0;
}

bool inHeightField(const ShapeGeom& geom, Vec3d p) {
  const HeightFieldData& field = geom.heights();
  const double column = p.x / (static_cast<double>(field.spacingX()) * geom.scale.x) + 0.5 * (field.columns() - 1);
  const double row = p.z / (static_cast<double>(field.spacingZ()) * geom.scale.z) + 0.5 * (field.rows() - 1);
  // Written so that what is not on the grid, however far, never becomes an index.
  if (!(column >= 0 && column <= field.columns() - 1 && row >= 0 && row <= field.rows() - 1)) return false;
  const int c = std::min(static_cast<int>(column), field.columns() - 2);
  const int r = std::min(static_cast<int>(row), field.rows() - 2);
  if (field.cellMaterial(c, r) == HeightFieldDef::kHole) return false;
  const double u = column - c, v = row - r;
  const double low = field.height(c, r), high = field.height(c + 1, r + 1);
  // The diagonal runs from (c, r) to (c + 1, r + 1).
  const double side = u > v ? field.height(c + 1, r) : field.height(c, r + 1);
  const double y = u > v ? low + u * (side - low) + v * (high - side) : low + v * (side - low) + u * (high - side);
  const double surface = y * geom.scale.y;
  return p.y <= surface && p.y >= surface - field.thickness() * geom.scale.y;
}

}  // namespace

bool containsPoint(const ShapeGeom& geom, Vec3d p) {
  const Vec3d e = toDouble(geom.extent);
  const double radius = geom.radius, across = std::sqrt(p.x * p.x + p.z * p.z);
  switch (geom.type) {
    case ShapeType::Sphere:
      return dot(p, p) <= square(radius);
    case ShapeType::Capsule:
      return p.x * p.x + p.z * p.z + square(over(p.y, e.y)) <= square(radius);
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      return square(over(p.x, e.x)) + square(over(p.y, e.y)) + square(over(p.z, e.z)) <= square(radius);
    case ShapeType::Cylinder:
      return square(over(across, e.x)) + square(over(p.y, e.y)) <= square(radius);
    case ShapeType::Cone:
      return inCone(geom, p);
    case ShapeType::Ellipsoid:
      return square(p.x / e.x) + square(p.y / e.y) + square(p.z / e.z) <= 1;
    case ShapeType::Hull:
      return inHull(geom, p);
    case ShapeType::HalfSpace:
      return p.y <= 0;
    case ShapeType::HeightField:
      return inHeightField(geom, p);
    default:
      return false;
  }
}

}  // namespace avbd
