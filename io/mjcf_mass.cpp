// Masses of MJCF geoms and bodies.
#include "io/mjcf_mass.h"

#include <numbers>

namespace avbd::mjcf {

using std::numbers::pi;

double volume(GeomKind kind, Vec3d size) {
  const double r = size.x, h = size.y;
  switch (kind) {
    case GeomKind::Sphere:
      return 4 * pi / 3 * r * r * r;
    case GeomKind::Capsule:
      return pi * r * r * (2 * h + 4 * r / 3);
    case GeomKind::Cylinder:
      return pi * r * r * 2 * h;
    case GeomKind::Ellipsoid:
      return 4 * pi / 3 * size.x * size.y * size.z;
    case GeomKind::Box:
      return 8 * size.x * size.y * size.z;
    default:
      return 0;
  }
}

Sym3d unitInertia(GeomKind kind, Vec3d s) {
  const double r = s.x, h = s.y;
  switch (kind) {
    case GeomKind::Sphere:
      return Sym3d{1, 1, 1} * (0.4 * r * r);
    case GeomKind::Cylinder: {
      const double across = r * r / 4 + h * h / 3;
      return {across, across, r * r / 2};
    }
    case GeomKind::Capsule: {
      // A cylinder and two half balls whose centres of mass stand 3/8 r beyond its ends.
      const double part = 2 * h / (2 * h + 4 * r / 3), ball = 1 - part;
      const double across = part * (r * r / 4 + h * h / 3) + ball * (0.4 * r * r + h * h + 0.75 * h * r);
      return {across, across, part * r * r / 2 + ball * 0.4 * r * r};
    }
    case GeomKind::Ellipsoid:
    case GeomKind::Box: {
      const double c = kind == GeomKind::Box ? 1.0 / 3 : 0.2;
      return Sym3d{s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y} * c;
    }
    default:
      return {};
  }
}

Mass massOf(const Geom& geom, std::span<const MeshAsset> meshes) {
  if (!(geom.mass > 0)) return {};
  if (geom.kind == GeomKind::Mesh) {
    const MeshAsset& mesh = meshes[static_cast<size_t>(geom.asset)];
    const Mass& unit = geom.isShell ? mesh.shell : mesh.solid;
    return moved({geom.mass, unit.center, unit.inertia * (geom.mass / unit.mass)}, geom.pose);
  }
  return {geom.mass, geom.pose.position, rotated(unitInertia(geom.kind, geom.size) * geom.mass, geom.pose.rotation)};
}

Mass sum(std::span<const Mass> parts) {
  Mass out;
  for (const Mass& part : parts) out.mass += part.mass;
  if (!(out.mass > 0)) return out;
  for (const Mass& part : parts) out.center = out.center + part.center * (part.mass / out.mass);
  for (const Mass& part : parts) {
    out.inertia = out.inertia + part.inertia + pointInertia(part.mass, part.center - out.center);
  }
  return out;
}

Mass moved(const Mass& mass, const Posed& pose) {
  return {mass.mass, pose.position + rotate(pose.rotation, mass.center), rotated(mass.inertia, pose.rotation)};
}

}  // namespace avbd::mjcf
