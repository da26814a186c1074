// Triangles of shared geometry in base64.
#include "viewer/surface.h"

#include <array>
#include <cstring>
#include <map>
#include <vector>

#include "viewer/encode.h"

namespace avbd::page {
namespace {

void append(std::vector<float>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

void writeTriangles(std::ostream& out, const std::vector<float>& vertices, const std::vector<uint32_t>& triangles) {
  out << "{\"vertices\":\"" << base64Of(vertices) << "\",\"triangles\":\"" << base64Of(triangles) << "\"}";
}

// Each face as a fan.
void write(std::ostream& out, const HullData& hull) {
  std::vector<float> vertices;
  std::vector<uint32_t> triangles;
  for (const Vec3 v : hull.vertices()) append(vertices, v);
  for (const HullData::Face& face : hull.faces()) {
    const auto loop = hull.loops().subspan(face.first, face.count);
    for (size_t i = 2; i < loop.size(); ++i) triangles.insert(triangles.end(), {loop[0], loop[i - 1], loop[i]});
  }
  writeTriangles(out, vertices, triangles);
}

void write(std::ostream& out, const MeshData& mesh) {
  std::map<std::array<uint32_t, 3>, uint32_t> numbers;
  std::vector<float> vertices;
  std::vector<uint32_t> triangles;
  for (uint32_t element = 0; element < mesh.triangleCount(); ++element) {
    for (const Vec3& corner : mesh.triangle(element)) {
      std::array<uint32_t, 3> bits;
      std::memcpy(bits.data(), &corner, sizeof bits);
      const auto [it, fresh] = numbers.emplace(bits, static_cast<uint32_t>(numbers.size()));
      if (fresh) append(vertices, corner);
      triangles.push_back(it->second);
    }
  }
  writeTriangles(out, vertices, triangles);
}

void write(std::ostream& out, const HeightFieldData& field) {
  std::vector<float> heights;
  std::vector<uint8_t> open;
  bool anyOpen = false;
  for (int row = 0; row < field.rows(); ++row)
    for (int column = 0; column < field.columns(); ++column) {
      heights.push_back(field.height(column, row));
      if (row + 1 == field.rows() || column + 1 == field.columns()) continue;
      open.push_back(field.cellMaterial(column, row) == HeightFieldDef::kHole);
      anyOpen = anyOpen || open.back() != 0;
    }
  if (!anyOpen) open.clear();
  out << "{\"columns\":" << field.columns() << ",\"rows\":" << field.rows() << ",\"spacingX\":" << field.spacingX()
      << ",\"spacingZ\":" << field.spacingZ() << ",\"heights\":\"" << base64Of(heights) << "\",\"open\":\""
      << base64Of(open) << "\"}";
}

}  // namespace

void writeSurface(std::ostream& out, const record::Surfaces::Data& data) {
  std::visit([&](const auto& surface) { write(out, *surface); }, data);
}

}  // namespace avbd::page
