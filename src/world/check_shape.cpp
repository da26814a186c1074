// Shapes and their materials (check.h).
#include "world/check.h"
#include "world/limits.h"

namespace avbd {
namespace {

struct GeometryCheck {
  const Path& path;
  Range size;

  void operator()(const Sphere& s) const { check(path / "radius", s.radius, size); }
  void operator()(const Capsule& c) const {
    check(path / "radius", c.radius, size);
    check(path / "halfHeight", c.halfHeight, notNegative(size.high));
  }
  void operator()(const Box& b) const {
    check(path / "x", b.x, size);
    check(path / "y", b.y, size);
    check(path / "z", b.z, size);
  }
  void operator()(const HalfSpace&) const {}
};

void checkCombine(const Path& path, Combine rule) {
  if (rule > Combine::Maximum) path.refuse(toText(static_cast<int>(rule)), "must be a value of Combine");
}

}  // namespace

void checkGeometry(const Path& path, const Geometry& geometry, float unit) {
  if (geometry.valueless_by_exception()) path.refuse("nothing", "must be a shape");
  std::visit(GeometryCheck{path, {kMinSize * unit, kMaxSize * unit}}, geometry);
}

void checkMaterial(const Path& path, const Material& m) {
  check(path / "friction", m.friction, notNegative(kMaxRate));
  if (m.staticFriction != -1) {
    // Written so that NaN is refused.
    const bool valid = m.staticFriction >= m.friction && m.staticFriction <= static_cast<float>(kMaxRate);
    if (!valid) {
      (path / "staticFriction").refuse(toText(m.staticFriction), "must be -1, or >= friction and at most 1e+06");
    }
  }
  check(path / "restitution", m.restitution, Range{0, 1});
  checkCombine(path / "frictionCombine", m.frictionCombine);
  checkCombine(path / "restitutionCombine", m.restitutionCombine);
}

ShapeDef checkedShape(const Path& path, const ShapeDef& def, BodyType type, float unit) {
  const Path geometry = path / "geometry";
  checkGeometry(geometry, def.geometry, unit);
  if (type == BodyType::Dynamic && std::holds_alternative<HalfSpace>(def.geometry)) {
    geometry.refuse("HalfSpace", "must be bounded on a dynamic body");
  }
  ShapeDef shape = def;
  shape.pose = checkedPose(path / "pose", def.pose, kMaxSize * unit);
  check(path / "density", def.density, notNegative(kMaxDensity));
  checkMaterial(path / "material", def.material);
  return shape;
}

}  // namespace avbd
