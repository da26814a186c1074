// Masses of URDF links.
#include "io/urdf_mass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/mjcf_mass.h"

namespace avbd::urdf {

namespace {

mjcf::GeomKind solidOf(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::Box:
      return mjcf::GeomKind::Box;
    case ShapeKind::Cylinder:
      return mjcf::GeomKind::Cylinder;
    case ShapeKind::Capsule:
      return mjcf::GeomKind::Capsule;
    case ShapeKind::Mesh:
      return mjcf::GeomKind::Mesh;
    case ShapeKind::Sphere:
      break;
  }
  return mjcf::GeomKind::Sphere;
}

// In the link's frame.
Mass massOf(const Shape& shape, const MeshHulls& hulls) {
  std::vector<Mass> parts;
  for (const auto& hull : hulls) {
    const MassProperties m = hull->massProperties(static_cast<float>(kDensity));
    const SymMat3& i = m.inertia;
    parts.push_back({m.mass, toDouble(m.center), {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz}});
  }
  if (shape.kind != ShapeKind::Mesh) {
    const double mass = mjcf::volume(solidOf(shape.kind), shape.size) * kDensity;
    parts.push_back({mass, {}, mjcf::unitInertia(solidOf(shape.kind), shape.size) * mass});
  }
  return mjcf::moved(mjcf::sum(parts), shape.pose);
}

double cubeRoot(double x) {
  double r = x > 1 ? x : 1;
  for (int i = 0; i < 200; ++i) r = (2 * r + x / (r * r)) / 3;
  return r;
}

}  // namespace

Mass massOfCollisions(const Link& link, const LinkHulls& hulls) {
  std::vector<Mass> parts;
  for (size_t i = 0; i < link.collisions.size(); ++i) {
    const auto hull = hulls.find(i);
    parts.push_back(massOf(link.collisions[i], hull == hulls.end() ? MeshHulls{} : hull->second));
  }
  return mjcf::sum(parts);
}

Mass withInertia(const Link& link, const LinkHulls& hulls) {
  Mass out = *link.mass;
  if (link.inertiaKnown) return out;
  const Mass solid = massOfCollisions(link, hulls);
  if (solid.mass > 0) {
    out.inertia = solid.inertia * (out.mass / solid.mass);
  } else {
    const double radius = cubeRoot(out.mass / (kDensity * 4 * std::numbers::pi / 3));
    out.inertia = mjcf::Sym3d{1, 1, 1} * (0.4 * out.mass * radius * radius);
  }
  return out;
}

double reach(const Link& link, const LinkHulls& hulls) {
  double out = 0;
  for (size_t i = 0; i < link.collisions.size(); ++i) {
    const Shape& shape = link.collisions[i];
    double radius = length(shape.size);  // never less than what the shape has
    if (shape.kind == ShapeKind::Capsule) radius = shape.size.x + shape.size.y;
    if (const auto found = hulls.find(i); found != hulls.end()) {
      for (const auto& hull : found->second) {
        for (const Vec3& v : hull->vertices()) radius = std::max(radius, length(toDouble(v)));
      }
    }
    out = std::max(out, radius + length(shape.pose.position - link.mass->center));
  }
  return out;
}

double lowest(const Shape& shape, const HullData* hull, const Posed& pose) {
  // The frame's z as the shape's own axes see it.
  const Vec3d z = rotate(conjugate(pose.rotation), Vec3d{0, 0, 1});
  const Vec3d s = shape.size;
  double depth = 0;
  switch (shape.kind) {
    case ShapeKind::Box:
      depth = std::abs(z.x) * s.x + std::abs(z.y) * s.y + std::abs(z.z) * s.z;
      break;
    case ShapeKind::Sphere:
      depth = s.x;
      break;
    case ShapeKind::Cylinder:
      depth = s.x * std::sqrt(z.x * z.x + z.y * z.y) + s.y * std::abs(z.z);
      break;
    case ShapeKind::Capsule:
      depth = s.x + s.y * std::abs(z.z);
      break;
    case ShapeKind::Mesh:
      depth = -std::numeric_limits<double>::infinity();
      for (const Vec3& v : hull->vertices()) depth = std::max(depth, -dot(toDouble(v), z));
      break;
  }
  return pose.position.z - depth;
}

}  // namespace avbd::urdf
