// Triangle meshes: checks, accessors, the order of the steps (mesh.h).
#include <avbd/error.h>
#include <avbd/mesh.h>

#include <algorithm>

#include "base/format.h"
#include "base/hash.h"
#include "geom/mesh_parts.h"

namespace avbd {
namespace {

constexpr float kMaxCoordinate = 1e6f;

[[noreturn]] void refuse(const char* field, std::string value, std::string range) {
  throw Error("MeshDef", field, std::move(value), std::move(range));
}

std::string at(const char* field, size_t index) { return std::string(field) + "[" + toText(index) + "]"; }

bool inRange(float x) { return x >= -kMaxCoordinate && x <= kMaxCoordinate; }

void check(const MeshDef& def) {
  if (def.triangles.empty()) refuse("triangles", "0 triangles", "must have at least one");
  if (def.vertices.size() < 3) refuse("vertices", toText(def.vertices.size()) + " vertices", "must be at least three");
  if (def.triangles.size() > MeshTree::kMaxEntries || def.vertices.size() > MeshTree::kMaxEntries) {
    refuse("triangles", toText(def.triangles.size()), "must be at most " + toText(MeshTree::kMaxEntries));
  }
  if (!(def.weldDistance >= 0 && def.weldDistance <= kMaxCoordinate)) {
    refuse("weldDistance", toText(def.weldDistance), "must be finite and >= 0 and at most 1e+06");
  }
  for (size_t i = 0; i < def.vertices.size(); ++i) {
    const Vec3 v = def.vertices[i];
    if (inRange(v.x) && inRange(v.y) && inRange(v.z)) continue;
    refuse(at("vertices", i).c_str(), toText(v), "must be finite and within +-1e+06");
  }
  for (size_t i = 0; i < def.triangles.size(); ++i) {
    for (const uint32_t v : def.triangles[i]) {
      if (v >= def.vertices.size()) {
        refuse(at("triangles", i).c_str(), toText(v), "must be < " + toText(def.vertices.size()) + ", the vertices");
      }
    }
  }
  if (!def.materials.empty() && def.materials.size() != def.triangles.size()) {
    refuse("materials", toText(def.materials.size()) + " materials",
           "must be empty or one for each of the " + toText(def.triangles.size()) + " triangles");
  }
}

template <class T>
size_t bytesOf(const std::vector<T>& all) {
  return all.size() * sizeof(T);
}

void finish(MeshData::Parts& parts) {
  parts.lower = parts.upper = parts.vertices[0];
  for (const Vec3 v : parts.vertices) {
    parts.lower = {std::min(parts.lower.x, v.x), std::min(parts.lower.y, v.y), std::min(parts.lower.z, v.z)};
    parts.upper = {std::max(parts.upper.x, v.x), std::max(parts.upper.y, v.y), std::max(parts.upper.z, v.z)};
  }
  parts.report.bytes = sizeof(MeshData::Parts) + bytesOf(parts.vertices) + bytesOf(parts.triangles) +
                       bytesOf(parts.source) + bytesOf(parts.materials) + bytesOf(parts.tree.nodes);
  Hash64 hash;
  hash.values(parts.vertices);
  for (const MeshTriangle& t : parts.triangles) hash.bytes(t.vertex, sizeof(t.vertex));
  hash.values(parts.materials);
  hash.value(parts.doubleSided);
  parts.hash = hash.digest();
}

}  // namespace

MeshData::MeshData(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
MeshData::~MeshData() = default;
const MeshReport& MeshData::report() const { return parts_->report; }
Vec3 MeshData::lower() const { return parts_->lower; }
Vec3 MeshData::upper() const { return parts_->upper; }
uint64_t MeshData::contentHash() const { return parts_->hash; }
uint32_t MeshData::triangleCount() const { return parts_->report.triangles; }
std::array<Vec3, 3> MeshData::triangle(uint32_t element) const {
  const uint32_t* v = parts_->triangles[element].vertex;
  return {parts_->vertices[v[0]], parts_->vertices[v[1]], parts_->vertices[v[2]]};
}
uint32_t MeshData::sourceTriangle(uint32_t element) const { return parts_->source[element]; }
uint16_t MeshData::materialIndex(uint32_t element) const {
  return parts_->materials.empty() ? uint16_t{0} : parts_->materials[element];
}
bool MeshData::doubleSided() const { return parts_->doubleSided; }

std::shared_ptr<const MeshData> makeMesh(const MeshDef& def) {
  check(def);
  auto parts = std::make_unique<MeshData::Parts>();
  parts->doubleSided = def.doubleSided;
  weldVertices(def, *parts);
  dropBadTriangles(def, *parts);
  if (parts->triangles.empty()) {
    refuse("triangles", toText(def.triangles.size()) + " triangles without area", "must have at least one of an area");
  }
  linkTriangles(*parts);
  orderByTree(*parts);
  finish(*parts);
  return std::make_shared<const MeshData>(std::move(parts));
}

}  // namespace avbd
