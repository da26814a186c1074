// Walks a URDF file: collisions and visuals.
#include "io/urdf_parser.h"

namespace avbd::urdf {

std::vector<Shape> Parser::readShapes(Elem link, std::string_view name) {
  std::vector<Shape> out;
  for (const Elem& part : source_.children(link)) {
    if (part.name() != name) continue;
    if (std::optional<Shape> shape = readShape(part)) out.push_back(std::move(*shape));
  }
  return out;
}

std::optional<Shape> Parser::readShape(Elem elem) {
  Shape shape;
  shape.where = source_.where(elem);
  shape.place = source_.place(elem);
  shape.line = source_.line(elem);
  shape.pose = readOrigin(elem);
  const auto geometry = source_.only(elem, "geometry");
  std::vector<Elem> kinds;
  if (geometry) kinds = source_.children(*geometry);
  if (kinds.empty()) {
    note(elem, "no geometry: left out");
    return {};
  }
  for (const Elem& part : source_.children(elem)) {
    const std::string_view name = part.name();
    if (name == "origin" || name == "geometry" || name == "verbose") continue;
    if (name == "material") {
      shape.color = readMaterial(part);
    } else {
      noteUnused(part, "not used");
    }
  }
  if (kinds.size() > 1) source_.fail(*geometry, "holds " + std::to_string(kinds.size()) + " shapes: must be one");
  const std::string_view kind = kinds[0].name();
  if (kind == "box") {
    shape.kind = ShapeKind::Box;
  } else if (kind == "cylinder") {
    shape.kind = ShapeKind::Cylinder;
  } else if (kind == "sphere") {
    shape.kind = ShapeKind::Sphere;
  } else if (kind == "capsule") {
    shape.kind = ShapeKind::Capsule;
  } else if (kind == "mesh") {
    shape.kind = ShapeKind::Mesh;
    readMesh(kinds[0], shape);
    return shape;
  } else {
    note(kinds[0], "a shape that is not part of URDF: left out");
    return {};
  }
  readSize(kinds[0], shape);
  const Vec3d s = shape.size;
  const bool flat = shape.kind == ShapeKind::Box ? s.x == 0 && s.y == 0 && s.z == 0 : s.x == 0;
  if (!flat) return shape;
  note(kinds[0], "a shape without size: left out");
  return {};
}

void Parser::readSize(Elem elem, Shape& shape) {
  const auto refuseNegative = [&](const char* name, double value) {
    if (value < 0) source_.fail(elem, name, elem.get(name), "must be finite and > 0");
  };
  if (shape.kind == ShapeKind::Box) {
    if (!elem.has("size")) source_.fail(elem, "size is missing: must be 3 numbers");
    const Vec3d size = source_.vector(elem, "size", {});
    const bool empty = size.x == 0 && size.y == 0 && size.z == 0;
    if (!empty && !(size.x > 0 && size.y > 0 && size.z > 0)) {
      source_.fail(elem, "size", elem.get("size"), "each must be finite and > 0");
    }
    shape.size = size * 0.5;
    return;
  }
  const double radius = source_.requiredNumber(elem, "radius");
  refuseNegative("radius", radius);
  shape.size.x = radius;
  if (shape.kind == ShapeKind::Sphere) return;
  const double length = source_.requiredNumber(elem, "length");
  refuseNegative("length", length);
  shape.size.y = length * 0.5;
  if (length == 0 && radius > 0 && shape.kind == ShapeKind::Cylinder) {
    source_.fail(elem, "length", elem.get("length"), "must be finite and > 0");
  }
}

void Parser::readMesh(Elem elem, Shape& shape) {
  shape.mesh = source_.requiredText(elem, "filename");
  if (!elem.has("scale")) return;
  // One number for all three axes is a common slip with one meaning.
  const std::string_view text = source_.text(elem, "scale");
  if (text.find_first_of(" \t\r\n", text.find_first_not_of(" \t\r\n")) == std::string_view::npos) {
    const double s = source_.number(elem, "scale", 1);
    shape.scale = {s, s, s};
    note(elem, "scale is one number: taken for all three axes");
  } else {
    shape.scale = source_.vector(elem, "scale", {1, 1, 1});
  }
  if (shape.scale.x == 0 || shape.scale.y == 0 || shape.scale.z == 0) {
    source_.fail(elem, "scale", text, "each must be finite and not 0");
  }
}

}  // namespace avbd::urdf
