// MJCF geoms as shapes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mjcf_build.h"

namespace avbd::mjcf {

namespace {

constexpr double kHalf = 0.5;

std::string lengthText(double meters) {
  std::string text = std::to_string(meters);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text + " m";
}

}  // namespace

float narrow(double value, const std::string& where) {
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
    throw FileError(where + ": a number that follows from it is beyond the range of float");
  }
  return static_cast<float>(value);
}

GeomShapes::GeomShapes(const Description& description, Notes& notes)
    : in_(description), notes_(notes), hulls_(description.meshes.size()), heightData_(description.heights.size()) {}

std::optional<GeomShape> GeomShapes::shape(const Geom& geom) {
  const auto f = [&](double v) { return narrow(v, geom.where); };
  const Quatd yToZ{std::sqrt(kHalf), std::sqrt(kHalf), 0, 0};
  const Vec3d s = geom.size;
  switch (geom.kind) {
    case GeomKind::Sphere:
      return GeomShape{Sphere{f(s.x)}};
    case GeomKind::Capsule:
      return GeomShape{Capsule{f(s.x), f(s.y)}, yToZ};
    case GeomKind::Cylinder:
      return GeomShape{Cylinder{f(s.x), f(s.y)}, yToZ};
    case GeomKind::Ellipsoid:
      return GeomShape{Ellipsoid{f(s.x), f(s.y), f(s.z)}};
    case GeomKind::Box:
      return GeomShape{Box{f(s.x), f(s.y), f(s.z)}};
    case GeomKind::Plane:
      return GeomShape{HalfSpace{}, yToZ};
    case GeomKind::Mesh:
      if (auto data = hull(geom)) return GeomShape{Hull{std::move(data)}};
      return {};
    case GeomKind::HeightField:
      // x to y to z to x: columns of ours are its rows, so that cells are cut along the same diagonal.
      if (auto data = heights(geom)) return GeomShape{HeightField{std::move(data)}, {kHalf, kHalf, kHalf, kHalf}};
      return {};
    case GeomKind::Sdf:
      return {};
  }
  return {};
}

std::shared_ptr<const HullData> GeomShapes::hull(const Geom& geom) {
  const size_t index = static_cast<size_t>(geom.asset);
  if (hulls_[index]) return hulls_[index];
  const MeshAsset& mesh = in_.meshes[index];
  std::vector<Vec3> points;
  for (const Vec3d& v : mesh.vertices) points.push_back(toFloat(v));
  HullDef def{.points = points};
  if (mesh.mostVertices > 0) def.maxVertices = std::min(mesh.mostVertices, 255);
  try {
    hulls_[index] = makeHull(def);
  } catch (const Error& error) {
    // What never collides may be flat.
    if (geom.contype != 0 || geom.conaffinity != 0) throw FileError(mesh.where + ": " + error.what());
    notes_.add(geom.where, std::string("only for drawing, left out: ") + error.what());
    return {};
  }
  const HullData& made = *hulls_[index];
  if (made.error() > 1e-3 * length(made.upper() - made.lower())) {
    notes_.add(mesh.where, "its hull has " + std::to_string(made.vertices().size()) +
                               " vertices; the farthest left out is " + lengthText(made.error()) + " outside");
  }
  return hulls_[index];
}

std::shared_ptr<const HeightFieldData> GeomShapes::heights(const Geom& geom) {
  const size_t index = static_cast<size_t>(geom.asset);
  if (heightData_[index]) return heightData_[index];
  const HeightAsset& asset = in_.heights[index];
  if (asset.rows == 0) {
    notes_.add(geom.where, "left out: its height field was not read");
    return {};
  }
  const size_t rows = static_cast<size_t>(asset.rows), columns = static_cast<size_t>(asset.columns);
  std::vector<float> turned(rows * columns);
  for (size_t r = 0; r < rows; ++r) {
    for (size_t c = 0; c < columns; ++c) {
      turned[c * rows + r] = narrow(asset.radius.z * static_cast<double>(asset.heights[r * columns + c]), asset.where);
    }
  }
  HeightFieldDef def;
  def.columns = asset.rows;
  def.rows = asset.columns;
  def.spacingX = narrow(2 * asset.radius.y / (asset.rows - 1), asset.where);
  def.spacingZ = narrow(2 * asset.radius.x / (asset.columns - 1), asset.where);
  def.heights = turned;
  // Solid down to -base under the highest point too.
  def.thickness = narrow(asset.base + asset.radius.z, asset.where);
  try {
    heightData_[index] = makeHeightField(def);
  } catch (const Error& error) {
    throw FileError(asset.where + ": " + error.what());
  }
  return heightData_[index];
}

}  // namespace avbd::mjcf
