// Shapes and their materials (check.h).
#include "geom/height_field_parts.h"
#include "geom/mesh_parts.h"
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
    checkRounding(b.rounding);
  }
  void operator()(const HalfSpace&) const {}
  void operator()(const Cylinder& c) const {
    check(path / "radius", c.radius, size);
    check(path / "halfHeight", c.halfHeight, size);
    checkRounding(c.rounding);
  }
  void operator()(const Cone& c) const {
    check(path / "radius", c.radius, size);
    check(path / "halfHeight", c.halfHeight, size);
    checkRounding(c.rounding);
  }
  void operator()(const Ellipsoid& e) const {
    check(path / "x", e.x, size);
    check(path / "y", e.y, size);
    check(path / "z", e.z, size);
  }
  void operator()(const Hull& h) const {
    checkData(h.data != nullptr, "makeHull");
    checkScale(h.scale, true);
    checkRounding(h.rounding);
  }
  void operator()(const Mesh& m) const {
    checkData(m.data != nullptr, "makeMesh");
    checkScale(m.scale, true);
  }
  void operator()(const HeightField& f) const {
    checkData(f.data != nullptr, "makeHeightField");
    checkScale(f.scale, false);
  }

  void checkRounding(float rounding) const { check(path / "rounding", rounding, notNegative(size.high)); }
  void checkData(bool isThere, const char* maker) const {
    if (!isThere) (path / "data").refuse("null", std::string("must be what ") + maker + " returned");
  }
  void checkScale(Vec3 scale, bool mayMirror) const {
    for (const float s : {scale.x, scale.y, scale.z}) {
      const float size1 = mayMirror && s < 0 ? -s : s;
      // Written so that NaN is refused.
      if (size1 >= static_cast<float>(kMinScale) && size1 <= static_cast<float>(kMaxScale)) continue;
      (path / "scale")
          .refuse(toText(scale), mayMirror ? "each must be finite and of size 0.001 to 1000"
                                           : "each must be finite and from 0.001 to 1000");
    }
  }
};

void checkCombine(const Path& path, Combine rule) {
  if (rule > Combine::Maximum) path.refuse(toText(static_cast<int>(rule)), "must be a value of Combine");
}

}  // namespace

void checkGeometry(const Path& path, const Geometry& geometry, float unit) {
  checkGeometry(path, geometry, Range{kMinSize * unit, kMaxSize * unit});
}

void checkGeometry(const Path& path, const Geometry& geometry, Range size) {
  if (geometry.valueless_by_exception()) path.refuse("nothing", "must be a shape");
  std::visit(GeometryCheck{path, size}, geometry);
}

void checkMayMove(const Path& path, const Geometry& geometry, BodyType type) {
  if (type != BodyType::Dynamic || !isOnlyFixed(geometry)) return;
  const bool unbounded = std::holds_alternative<HalfSpace>(geometry);
  path.refuse(geometryName(geometry),
              unbounded ? "must be bounded on a dynamic body" : "must be convex on a dynamic body");
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
  check(path / "torsionalFriction", m.torsionalFriction, notNegative(kMaxSize));
  check(path / "rollingFriction", m.rollingFriction, notNegative(kMaxSize));
  checkCombine(path / "frictionCombine", m.frictionCombine);
  checkCombine(path / "restitutionCombine", m.restitutionCombine);
}

namespace {

/// How many materials the triangles of a surface name.
size_t materialsNamed(const Geometry& geometry) {
  size_t named = 0;
  const auto count = [&](const std::vector<uint16_t>& indices) {
    if (indices.empty()) named = 1;
    for (const uint16_t index : indices)
      if (index != HeightFieldDef::kHole) named = std::max(named, size_t{index} + 1);
  };
  if (const Mesh* mesh = std::get_if<Mesh>(&geometry)) count(mesh->data->parts().materials);
  if (const HeightField* field = std::get_if<HeightField>(&geometry)) count(field->data->parts().materials);
  return named;
}

}  // namespace

void checkMaterials(const Path& path, std::span<const Material> materials, const Geometry& geometry) {
  if (materials.empty()) return;
  if (materials.size() > 0xffff) path.refuse(toText(materials.size()) + " materials", "must be at most 65535");
  for (size_t i = 0; i < materials.size(); ++i) checkMaterial(path[i], materials[i]);
  const size_t named = materialsNamed(geometry);
  if (materials.size() >= named) return;
  path.refuse(toText(materials.size()) + " materials", "must be none or at least the " + toText(named) +
                                                           " that the triangles of the " + geometryName(geometry) +
                                                           " name");
}

ShapeDef checkedShape(const Path& path, const ShapeDef& def, BodyType type, float unit) {
  const Path geometry = path / "geometry";
  checkGeometry(geometry, def.geometry, unit);
  checkMayMove(geometry, def.geometry, type);
  ShapeDef shape = def;
  shape.pose = checkedPose(path / "pose", def.pose, kMaxSize * unit);
  check(path / "density", def.density, notNegative(kMaxDensity));
  checkMaterial(path / "material", def.material);
  checkMaterials(path / "materials", def.materials, def.geometry);
  return shape;
}

}  // namespace avbd
