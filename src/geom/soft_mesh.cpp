// Meshes of soft bodies: what solids and cloth share (soft_mesh.h).
#include <avbd/error.h>

#include <algorithm>
#include <cmath>

#include "base/format.h"
#include "base/hash.h"
#include "geom/soft_mesh_parts.h"

namespace avbd {

SoftMeshData::SoftMeshData(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
SoftMeshData::~SoftMeshData() = default;
const SoftMeshReport& SoftMeshData::report() const { return parts_->report; }
std::span<const Vec3> SoftMeshData::points() const { return parts_->points; }
std::span<const std::array<uint32_t, 4>> SoftMeshData::tets() const { return parts_->tets; }
std::span<const std::array<uint32_t, 3>> SoftMeshData::triangles() const { return parts_->triangles; }
std::span<const std::array<uint32_t, 4>> SoftMeshData::hinges() const { return parts_->hinges; }
std::span<const std::array<uint32_t, 3>> SoftMeshData::surface() const { return parts_->surface; }
uint32_t SoftMeshData::sourcePoint(uint32_t point) const { return parts_->sourcePoints[point]; }
float SoftMeshData::faceSize() const { return parts_->faceSize; }
double SoftMeshData::volume() const { return parts_->volume; }
double SoftMeshData::area() const { return parts_->area; }
uint64_t SoftMeshData::contentHash() const { return parts_->hash; }
const FaceTree& SoftMeshData::faceTree() const { return *parts_->faceTree; }

namespace soft_mesh {
namespace {

constexpr float kMaxCoordinate = 1e6f;

std::string at(const char* field, size_t index) { return std::string(field) + "[" + toText(index) + "]"; }

bool inRange(float x) { return x >= -kMaxCoordinate && x <= kMaxCoordinate; }

}  // namespace

template <size_t n>
void check(const char* definition, const char* field, std::span<const Vec3> points,
           std::span<const std::array<uint32_t, n>> elements) {
  if (elements.empty()) throw Error(definition, field, "none", "must have at least one");
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    if (!inRange(p.x) || !inRange(p.y) || !inRange(p.z))
      throw Error(definition, at("points", i), toText(p), "must be finite and within +-1e+06");
  }
  for (size_t i = 0; i < elements.size(); ++i)
    for (const uint32_t p : elements[i])
      if (p >= points.size())
        throw Error(definition, at(field, i), toText(p), "must be < " + toText(points.size()) + ", the points");
}

template <size_t n>
void dropDuplicates(std::vector<std::array<uint32_t, n>>& elements, SoftMeshReport& report) {
  std::vector<std::pair<std::array<uint32_t, n>, uint32_t>> names;
  for (uint32_t i = 0; i < elements.size(); ++i) {
    names.push_back({elements[i], i});
    std::sort(names.back().first.begin(), names.back().first.end());
  }
  std::sort(names.begin(), names.end());
  std::vector<uint8_t> again(elements.size());
  for (size_t i = 1; i < names.size(); ++i)
    if (names[i].first == names[i - 1].first) again[names[i].second] = 1, ++report.duplicate;
  size_t kept = 0;
  for (size_t i = 0; i < elements.size(); ++i)
    if (!again[i]) elements[kept++] = elements[i];
  elements.resize(kept);
  report.elements = static_cast<uint32_t>(kept);
}

template <size_t n>
void takePoints(std::span<const Vec3> points, std::vector<std::array<uint32_t, n>>& elements,
                SoftMeshData::Parts& parts) {
  std::vector<uint32_t> place(points.size(), 0);
  for (const auto& element : elements)
    for (const uint32_t p : element) place[p] = 1;
  for (uint32_t i = 0; i < place.size(); ++i) {
    if (!place[i]) {
      ++parts.report.unused;
      continue;
    }
    place[i] = static_cast<uint32_t>(parts.points.size());
    parts.points.push_back(points[i]);
    parts.sourcePoints.push_back(i);
  }
  for (auto& element : elements)
    for (uint32_t& p : element) p = place[p];
}

template void check(const char*, const char*, std::span<const Vec3>, std::span<const std::array<uint32_t, 3>>);
template void check(const char*, const char*, std::span<const Vec3>, std::span<const std::array<uint32_t, 4>>);
template void dropDuplicates(std::vector<std::array<uint32_t, 3>>&, SoftMeshReport&);
template void dropDuplicates(std::vector<std::array<uint32_t, 4>>&, SoftMeshReport&);
template void takePoints(std::span<const Vec3>, std::vector<std::array<uint32_t, 3>>&, SoftMeshData::Parts&);
template void takePoints(std::span<const Vec3>, std::vector<std::array<uint32_t, 4>>&, SoftMeshData::Parts&);

std::shared_ptr<const SoftMeshData> finish(std::unique_ptr<SoftMeshData::Parts> parts) {
  SoftMeshData::Parts& p = *parts;
  findRest(p);
  p.faceTree = std::make_unique<const FaceTree>(p.points, p.surface);
  p.features = surfaceFeatures(p.points.size(), p.surface);
  p.atRest = SurfaceAtRest(p.points, *p.faceTree, p.surface);
  double edges = 0;
  for (const auto& face : p.surface) {
    const Vec3d a = toDouble(p.points[face[0]]), b = toDouble(p.points[face[1]]), c = toDouble(p.points[face[2]]);
    for (const Vec3d& edge : {b - a, c - b, a - c}) edges += std::sqrt(dot(edge, edge));
    const Vec3d normal = crossOf(b - a, c - a);
    p.area += std::sqrt(dot(normal, normal)) / 2;
  }
  p.faceSize = static_cast<float>(edges / (3 * static_cast<double>(p.surface.size())));
  Hash64 hash;
  hash.values(p.points);
  hash.values(p.tets);
  hash.values(p.triangles);
  p.hash = hash.digest();
  return std::make_shared<const SoftMeshData>(std::move(parts));
}

}  // namespace soft_mesh
}  // namespace avbd
