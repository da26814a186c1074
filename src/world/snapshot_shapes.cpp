// Snapshots: shapes, their geometry, and the tree of their bounds.
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include "geom/shape.h"
#include "world/check.h"
#include "world/snapshot_parts.h"

namespace avbd {
namespace {

// The numbers of each geometry; what is shared is coded apart.
template <MaybeConst<Sphere> T>
auto numbersOf(T& x) {
  auto& [radius] = x;
  return std::tie(radius);
}
template <MaybeConst<Capsule> T>
auto numbersOf(T& x) {
  auto& [radius, halfHeight] = x;
  return std::tie(radius, halfHeight);
}
template <MaybeConst<Box> T>
auto numbersOf(T& x) {
  auto& [hx, hy, hz, rounding] = x;
  return std::tie(hx, hy, hz, rounding);
}
template <MaybeConst<HalfSpace> T>
auto numbersOf(T&) {
  return std::tuple<>();
}
template <MaybeConst<Cylinder> T>
auto numbersOf(T& x) {
  auto& [radius, halfHeight, rounding] = x;
  return std::tie(radius, halfHeight, rounding);
}
template <MaybeConst<Cone> T>
auto numbersOf(T& x) {
  auto& [radius, halfHeight, rounding] = x;
  return std::tie(radius, halfHeight, rounding);
}
template <MaybeConst<Ellipsoid> T>
auto numbersOf(T& x) {
  auto& [hx, hy, hz] = x;
  return std::tie(hx, hy, hz);
}
template <MaybeConst<Hull> T>
auto numbersOf(T& x) {
  auto& [data, scale, rounding] = x;
  return std::tie(scale, rounding);
}
template <MaybeConst<Mesh> T>
auto numbersOf(T& x) {
  auto& [data, scale] = x;
  return std::tie(scale);
}
template <MaybeConst<HeightField> T>
auto numbersOf(T& x) {
  auto& [data, scale] = x;
  return std::tie(scale);
}

template <class T>
concept Shared = requires(const T& x) {
  x.data.get();
};

template <class T>
constexpr SharedTable::Kind kindOf() {
  if constexpr (std::is_same_v<T, Hull>) return SharedTable::Kind::Hull;
  if constexpr (std::is_same_v<T, Mesh>) return SharedTable::Kind::Mesh;
  return SharedTable::Kind::HeightField;
}

bool sameGeometry(const Geometry& a, const Geometry& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& x) {
        using T = std::remove_cvref_t<decltype(x)>;
        const T& y = std::get<T>(b);
        bool equal = true;
        if constexpr (Shared<T>) equal = x.data == y.data;
        snapshot::zip(numbersOf(x), numbersOf(y),
                      [&](const auto& p, const auto& q) { equal = equal && snapshot::same(p, q); });
        return equal;
      },
      a);
}

}  // namespace

namespace snapshot {
namespace {

void codeGeometry(Writer& out, const Geometry& geometry, SharedTable& table) {
  out.put(static_cast<uint8_t>(geometry.index()));
  std::visit(
      [&](const auto& x) {
        if constexpr (Shared<std::remove_cvref_t<decltype(x)>>) out.put(table.number(x.data));
        std::apply([&](const auto&... number) { (out.put(number), ...); }, numbersOf(x));
      },
      geometry);
}

template <class T>
Geometry readGeometry(Reader& in, const KnownThings& things) {
  T x{};
  if constexpr (Shared<T>) x.data = std::get<decltype(x.data)>(things.thing(in.take<uint32_t>(), kindOf<T>()));
  std::apply([&](auto&... number) { (in.put(number), ...); }, numbersOf(x));
  return x;
}

template <size_t... i>
Geometry readGeometry(Reader& in, const KnownThings& things, std::index_sequence<i...>) {
  const uint8_t index = in.take<uint8_t>();
  Geometry geometry;
  const bool known =
      ((index == i && (geometry = readGeometry<std::variant_alternative_t<i, Geometry>>(in, things), true)) || ...);
  require(known, "a geometry of no kind");
  return geometry;
}

/// What a shape is expected to be: like the one before, of the next body, with the next leaf.
void expect(ShapeData& expected, const ShapeData& before) {
  copyFields(expected, before);
  ++expected.body;
  expected.proxy += 2;
}

constexpr uint8_t kOtherGeometry = 1, kHasMaterials = 2;

void write(Writer& out, const ShapeData& shape, const ShapeData* before, SharedTable& table) {
  uint8_t flags = 0;
  if (!before || !sameGeometry(shape.geometry, before->geometry)) flags |= kOtherGeometry;
  if (!shape.materials.empty()) flags |= kHasMaterials;
  out.put(flags);
  if (flags & kOtherGeometry) codeGeometry(out, shape.geometry, table);
  if (flags & kHasMaterials) recordList(out, shape.materials);
}

void read(Reader& in, uint32_t slot, ShapeData& shape, const ShapeData* before, const KnownThings& things,
          const WorldDef& def) {
  const uint8_t flags = in.take<uint8_t>();
  require(flags <= (kOtherGeometry | kHasMaterials), "a shape of unknown flags");
  if (flags & kOtherGeometry) {
    shape.geometry = readGeometry(in, things, std::make_index_sequence<std::variant_size_v<Geometry>>());
    const Path path("World::restore"), whole = path / "snapshot", shapes = whole / "shapes";
    checkGeometry(shapes[slot] / "geometry", shape.geometry, def.lengthUnit);
    shape.scaled.reset();
    shape.geom = toShapeGeom(shape.geometry, shape.scaled);
  } else {
    require(before != nullptr, "a shape without geometry");
    shape.geometry = before->geometry, shape.scaled = before->scaled, shape.geom = before->geom;
  }
  shape.materials.clear();
  if (flags & kHasMaterials) recordList(in, shape.materials);
}

void writeTree(Writer& out, const DynamicTree& tree) {
  out.put(tree.root());
  out.put(tree.firstFree());
  for (int32_t i = tree.firstFree(); i >= 0; i = tree.nodes()[static_cast<size_t>(i)].parent)
    out.put(tree.nodes()[static_cast<size_t>(i)].parent);
  for (const DynamicTree::Node& node : tree.nodes())
    if (node.height > 0) out.put(node.child);
}

/// Leaves are in their places.
void readTree(Reader& in, DynamicTree::Saved& saved) {
  in.put(saved.root);
  in.put(saved.free);
  for (int32_t i = saved.free; i != -1;) {
    require(i >= 0 && static_cast<size_t>(i) < saved.nodes.size(), "a free node of the tree that there is not");
    DynamicTree::Node& node = saved.nodes[static_cast<size_t>(i)];
    require(node.height == 1, "a free node of the tree that is not free");
    node.height = -1;
    in.put(node.parent);
    i = node.parent;
  }
  for (DynamicTree::Node& node : saved.nodes)
    if (node.height > 0) in.put(node.child);
}

}  // namespace

void codeShapes(Writer& out, const WorldData& data, SharedTable& table) {
  out.number(data.tree.nodes().size());
  ShapeData expected;
  const ShapeData* before = nullptr;
  data.shapeIds.forEach([&](uint32_t slot) {
    const ShapeData& shape = data.shapes[slot];
    out.record(shape, expected);
    write(out, shape, before, table);
    out.put(data.tree.box(shape.proxy));
    expect(expected, shape), before = &shape;
  });
  writeTree(out, data.tree);
}

void codeShapes(Reader& in, WorldData& data, const KnownThings& things) {
  DynamicTree::Saved saved;
  saved.nodes = data.tree.takeNodes();
  saved.nodes.assign(in.count(sizeof(int32_t)), DynamicTree::Node{{}, -1, {-1, -1}, 1, 0});
  require(data.shapeIds.count() <= in.left(), "more shapes than bytes");
  data.shapes.resize(data.shapeIds.slotCount());
  data.hookedShapes = 0;
  ShapeData expected;
  const ShapeData* before = nullptr;
  for (uint32_t slot = 0; slot < data.shapes.size(); ++slot) {
    ShapeData& shape = data.shapes[slot];
    if (!data.shapeIds.isAliveSlot(slot)) {
      shape = {};
      continue;
    }
    in.record(shape, expected);
    read(in, slot, shape, before, things, data.def);
    data.hookedShapes += shape.contactHook;
    require(shape.proxy >= 0 && static_cast<size_t>(shape.proxy) < saved.nodes.size(), "a shape outside the tree");
    DynamicTree::Node& leaf = saved.nodes[static_cast<size_t>(shape.proxy)];
    require(leaf.height == 1, "two shapes at one place of the tree");
    leaf.height = 0, leaf.userData = slot;
    in.put(leaf.box);
    expect(expected, shape), before = &shape;
  }
  readTree(in, saved);
  require(data.tree.restore(std::move(saved)), "a tree that is none");
}

}  // namespace snapshot
}  // namespace avbd
