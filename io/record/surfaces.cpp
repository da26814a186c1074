// Shapes, and the hulls, meshes and height fields that they share.
#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "io/file_error.h"
#include "io/record/content.h"
#include "io/record/softs.h"

namespace avbd::record {
namespace {

enum SurfaceField : uint16_t {
  kKind = 1,
  kHash = 2,
  kHullVertices = 10,
  kHullCounts = 11,
  kHullLoops = 12,
  kMeshVertices = 20,
  kMeshTriangles = 21,
  kMeshMaterials = 22,
  kMeshDoubleSided = 23,
  kFieldGrid = 30,
  kFieldSpacing = 31,
  kFieldHeights = 32,
  kFieldMaterials = 33,
};
enum ShapeField : uint16_t {
  kBody = 1,
  kGeometry = 2,
  kSize = 3,
  kSurface = 4,
  kPosition = 5,
  kRotation = 6,
  kFlags = 7,
  kColors = 8
};
constexpr uint8_t kTriggerFlag = 1;
constexpr uint8_t kFirstShared = 7;  // hull; mesh and height field follow, as the kinds of surfaces do
constexpr uint8_t kNoSurface = 255;

void append(std::vector<float>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

void put(FieldWriter& out, const std::shared_ptr<const HullData>& hull) {
  out.value(kHash, hull->contentHash());
  std::vector<float> vertices;
  for (const Vec3 v : hull->vertices()) append(vertices, v);
  std::vector<uint16_t> counts;
  std::vector<uint8_t> loops;
  for (const HullData::Face& face : hull->faces()) {
    counts.push_back(face.count);
    const auto loop = hull->loops().subspan(face.first, face.count);
    loops.insert(loops.end(), loop.begin(), loop.end());
  }
  out.list(kHullVertices, vertices, Encoding::Shuffled);
  out.list(kHullCounts, counts);
  out.list(kHullLoops, loops);
}

// Corners with the same bits are one vertex; triangles stand in the order of the mesh's source.
void put(FieldWriter& out, const std::shared_ptr<const MeshData>& mesh) {
  std::vector<uint32_t> order(mesh->triangleCount());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return mesh->sourceTriangle(a) < mesh->sourceTriangle(b); });
  std::map<std::array<uint32_t, 3>, uint32_t> numbers;
  std::vector<float> vertices;
  std::vector<uint32_t> corners;
  std::vector<uint16_t> materials;
  for (const uint32_t element : order) {
    for (const Vec3& corner : mesh->triangle(element)) {
      std::array<uint32_t, 3> bits;
      std::memcpy(bits.data(), &corner, sizeof bits);
      const auto [it, fresh] = numbers.emplace(bits, static_cast<uint32_t>(numbers.size()));
      if (fresh) append(vertices, corner);
      corners.push_back(it->second);
    }
    materials.push_back(mesh->materialIndex(element));
  }
  out.value(kHash, mesh->contentHash());
  out.list(kMeshVertices, vertices, Encoding::Shuffled);
  out.list(kMeshTriangles, corners, Encoding::Delta, 3);
  if (std::any_of(materials.begin(), materials.end(), [](uint16_t m) { return m != 0; }))
    out.list(kMeshMaterials, materials);
  out.value(kMeshDoubleSided, static_cast<uint8_t>(mesh->doubleSided()));
}

void put(FieldWriter& out, const std::shared_ptr<const HeightFieldData>& field) {
  out.value(kHash, field->contentHash());
  const int columns = field->columns(), rows = field->rows();
  out.list(kFieldGrid, std::vector<int32_t>{columns, rows});
  out.list(kFieldSpacing, std::vector<float>{field->spacingX(), field->spacingZ(), field->thickness()});
  std::vector<float> heights;
  std::vector<uint16_t> materials;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      heights.push_back(field->height(column, row));
      if (row + 1 < rows && column + 1 < columns) materials.push_back(field->cellMaterial(column, row));
    }
  out.list(kFieldHeights, heights, Encoding::Delta, 1);
  if (std::any_of(materials.begin(), materials.end(), [](uint16_t m) { return m != 0; }))
    out.list(kFieldMaterials, materials);
}

std::vector<Vec3> pointsOf(const FieldReader& f, uint16_t id) {
  const std::vector<float> numbers = f.list<float>(id);
  if (numbers.size() % 3 != 0) f.refuse(id, "is cut off");
  std::vector<Vec3> points;
  for (size_t i = 0; i < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return points;
}

std::shared_ptr<const HullData> hullOf(const FieldReader& f) {
  const std::vector<Vec3> points = pointsOf(f, kHullVertices);
  // They are the vertices of a finished hull: nothing is to be left out, however far from the origin it lies.
  Vec3 lower = points.empty() ? Vec3{} : points[0], upper = lower;
  for (const Vec3 p : points) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  const Vec3 size = upper - lower;
  const float extent = std::max({size.x, size.y, size.z});
  HullDef def;
  def.points = points;
  def.tolerance = extent * 1e-6f;
  def.maxVertices = 255;
  return makeHull(def);
}

std::shared_ptr<const MeshData> meshOf(const FieldReader& f) {
  const std::vector<Vec3> points = pointsOf(f, kMeshVertices);
  const std::vector<uint32_t> corners = f.list<uint32_t>(kMeshTriangles);
  if (corners.size() % 3 != 0) f.refuse(kMeshTriangles, "is cut off");
  std::vector<std::array<uint32_t, 3>> triangles(corners.size() / 3);
  for (size_t i = 0; i < corners.size(); ++i) triangles[i / 3][i % 3] = corners[i];
  const std::vector<uint16_t> materials = f.listOf<uint16_t>(kMeshMaterials, triangles.size());
  MeshDef def;
  def.vertices = points;
  def.triangles = triangles;
  def.materials = materials;
  def.doubleSided = f.value<uint8_t>(kMeshDoubleSided, 0) != 0;
  return makeMesh(def);
}

std::shared_ptr<const HeightFieldData> fieldOf(const FieldReader& f) {
  const std::vector<int32_t> grid = f.listOf<int32_t>(kFieldGrid, 2);
  const std::vector<float> spacing = f.listOf<float>(kFieldSpacing, 3);
  if (grid.empty() || spacing.empty()) f.refuse(kFieldGrid, "is missing");
  const std::vector<float> heights = f.list<float>(kFieldHeights);
  const std::vector<uint16_t> materials = f.list<uint16_t>(kFieldMaterials);
  HeightFieldDef def;
  def.columns = grid[0];
  def.rows = grid[1];
  def.spacingX = spacing[0];
  def.spacingZ = spacing[1];
  def.thickness = spacing[2];
  def.heights = heights;
  def.materials = materials;
  return makeHeightField(def);
}

struct Size {
  float v[4] = {0, 0, 0, 0};
};
Size sizeOf(const Sphere& s) { return {{s.radius}}; }
Size sizeOf(const Capsule& s) { return {{s.radius, s.halfHeight}}; }
Size sizeOf(const Box& s) { return {{s.x, s.y, s.z, s.rounding}}; }
Size sizeOf(const HalfSpace&) { return {}; }
Size sizeOf(const Cylinder& s) { return {{s.radius, s.halfHeight, 0, s.rounding}}; }
Size sizeOf(const Cone& s) { return {{s.radius, s.halfHeight, 0, s.rounding}}; }
Size sizeOf(const Ellipsoid& s) { return {{s.x, s.y, s.z}}; }
Size sizeOf(const Hull& s) { return {{s.scale.x, s.scale.y, s.scale.z, s.rounding}}; }
Size sizeOf(const Mesh& s) { return {{s.scale.x, s.scale.y, s.scale.z}}; }
Size sizeOf(const HeightField& s) { return {{s.scale.x, s.scale.y, s.scale.z}}; }

template <class Shape>
Geometry withData(const Surfaces::Data& data, Vec3 scale) {
  Shape shape;
  shape.data = std::get<decltype(shape.data)>(data);
  shape.scale = scale;
  return shape;
}

}  // namespace

uint32_t packedColor(const std::optional<Color>& color) {
  if (!color) return 0;
  const auto at = [](uint8_t byte, int shift) { return static_cast<uint32_t>(byte) << shift; };
  return at(color->red, 0) | at(color->green, 8) | at(color->blue, 16) | at(color->alpha, 24);
}

std::optional<Color> unpackedColor(uint32_t color) {
  if (color == 0) return {};
  const auto byte = [&](int shift) { return static_cast<uint8_t>(color >> shift & 0xff); };
  return Color{byte(0), byte(8), byte(16), byte(24)};
}

uint32_t Surfaces::add(const Geometry& geometry) {
  return std::visit(
      [&](const auto& shape) {
        if constexpr (requires { shape.data->contentHash(); }) {
          if (!shape.data) return kNotRecorded;
          const auto [it, fresh] = numbers_.emplace(std::pair{geometry.index(), shape.data->contentHash()},
                                                    static_cast<uint32_t>(all_.size()));
          if (fresh) all_.push_back(shape.data);
          return it->second;
        } else {
          return kNotRecorded;
        }
      },
      geometry);
}

Bytes surfaceContent(const Surfaces::Data& data) {
  FieldWriter out;
  out.value(kKind, static_cast<uint8_t>(data.index()));
  std::visit([&](const auto& surface) { put(out, surface); }, data);
  return out.bytes();
}

Bytes shapesContent(const Recording& r, Surfaces& surfaces) {
  std::vector<uint32_t> bodies, numbers, colors;
  std::vector<uint8_t> kinds, flags;
  std::vector<float> sizes, rotations;
  std::vector<double> positions;
  for (const RecordedShape& shape : std::span(r.shapes).first(solidShapes(r))) {
    const Size size = std::visit([](const auto& geometry) { return sizeOf(geometry); }, shape.geometry);
    bodies.push_back(shape.body);
    kinds.push_back(static_cast<uint8_t>(shape.geometry.index()));
    sizes.insert(sizes.end(), std::begin(size.v), std::end(size.v));
    numbers.push_back(surfaces.add(shape.geometry));
    const auto& [p, q] = shape.pose;
    positions.insert(positions.end(), {p.x, p.y, p.z});
    rotations.insert(rotations.end(), {q.w, q.x, q.y, q.z});
    flags.push_back(shape.trigger ? kTriggerFlag : 0);
    colors.push_back(packedColor(shape.color));
  }
  FieldWriter out;
  out.list(kBody, bodies);
  out.list(kGeometry, kinds);
  out.list(kSize, sizes, Encoding::Shuffled);
  out.list(kSurface, numbers);
  out.list(kPosition, positions, Encoding::Shuffled);
  out.list(kRotation, rotations, Encoding::Shuffled);
  out.list(kFlags, flags);
  if (std::any_of(colors.begin(), colors.end(), [](uint32_t color) { return color != 0; })) out.list(kColors, colors);
  return out.bytes();
}

void HeadReader::takeSurface(const FieldReader& f) {
  const auto kind = f.value<uint8_t>(kKind, kNoSurface);
  try {
    if (kind == 0) return surfaces.push_back({kind, hullOf(f)});
    if (kind == 1) return surfaces.push_back({kind, meshOf(f)});
    if (kind == 2) return surfaces.push_back({kind, fieldOf(f)});
    notes.push_back(f.place() + ": a surface of kind " + std::to_string(kind) + " is left out");
  } catch (const Error& e) {
    notes.push_back(f.place() + ": a surface is left out: " + e.what());
  }
  surfaces.push_back({kind, std::shared_ptr<const HullData>()});  // keeps its number, which shapes refer to
}

Geometry HeadReader::geometryOf(uint8_t kind, const float size[4], uint32_t surface, const FieldReader& f) {
  const Vec3 scale{size[0], size[1], size[2]};
  const bool shared = kind >= kFirstShared && kind < kFirstShared + 3;
  if (shared && (surface >= surfaces.size() || surfaces[surface].kind != kind - kFirstShared))
    f.refuse(kSurface, "names a surface that there is not");
  const Geometry nothing = Sphere{0};  // keeps its number, which contacts refer to, and shows as nothing
  if (shared && std::visit([](const auto& data) { return data == nullptr; }, surfaces[surface].data)) return nothing;
  switch (kind) {
    case 0:
      return Sphere{size[0]};
    case 1:
      return Capsule{size[0], size[1]};
    case 2:
      return Box{size[0], size[1], size[2], size[3]};
    case 3:
      return HalfSpace{};
    case 4:
      return Cylinder{size[0], size[1], size[3]};
    case 5:
      return Cone{size[0], size[1], size[3]};
    case 6:
      return Ellipsoid{size[0], size[1], size[2]};
    case 7: {
      Geometry hull = withData<Hull>(surfaces[surface].data, scale);
      std::get<Hull>(hull).rounding = size[3];
      return hull;
    }
    case 8:
      return withData<Mesh>(surfaces[surface].data, scale);
    case 9:
      return withData<HeightField>(surfaces[surface].data, scale);
    default:
      notes.push_back(f.place() + ": a shape of kind " + std::to_string(kind) + " is left out");
      return nothing;
  }
}

void HeadReader::takeShapes(const FieldReader& f) {
  refuseMore(f, kBody, recording.shapes.size());
  if (!recording.softs.empty()) f.refuse(kBody, "adds shapes behind soft bodies");
  const std::vector<uint32_t> bodies = f.list<uint32_t>(kBody);
  const size_t n = bodies.size();
  const std::vector<uint8_t> kinds = f.listOf<uint8_t>(kGeometry, n), flags = f.listOf<uint8_t>(kFlags, n);
  const std::vector<float> sizes = f.listOf<float>(kSize, 4 * n), rotations = f.listOf<float>(kRotation, 4 * n);
  const std::vector<uint32_t> numbers = f.listOf<uint32_t>(kSurface, n);
  const std::vector<double> positions = f.listOf<double>(kPosition, 3 * n);
  const std::vector<uint32_t> colors = f.listOf<uint32_t>(kColors, n);
  if (n > 0 && (kinds.empty() || sizes.empty() || numbers.empty() || rotations.empty() || positions.empty()))
    f.refuse(kBody, "stands alone");
  for (size_t i = 0; i < n; ++i) {
    if (bodies[i] >= recording.bodies.size()) f.refuse(kBody, "names a body that there is not");
    const double* p = &positions[3 * i];
    const float* q = &rotations[4 * i];
    recording.shapes.push_back({bodies[i],
                                geometryOf(kinds[i], &sizes[4 * i], numbers[i], f),
                                {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}},
                                !flags.empty() && (flags[i] & kTriggerFlag) != 0,
                                colors.empty() ? std::nullopt : unpackedColor(colors[i])});
  }
}

}  // namespace avbd::record
