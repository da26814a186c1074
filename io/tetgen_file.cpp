// TetGen's .node and .ele: points and tetrahedra as text, numbered from 0 or 1.
#include <limits>

#include "io/soft_mesh_file_parts.h"

namespace avbd::soft_mesh_file {

namespace {

constexpr int64_t kAny = std::numeric_limits<int64_t>::max();

constexpr ElementKind kKinds[] = {{4, 4, 4, "tetrahedra"}, {10, 10, 4, "tetrahedra of 10 nodes"}};

/// What follows on a line is not needed.
void skipRest(Scan& scan) {
  while (!scan.wordHere().empty()) {
  }
}

void readNodes(std::string_view text, const std::string& name, SoftMeshFile& mesh, PointNames& names) {
  Scan scan(text, name);
  scan.comment = '#';
  const size_t count = scan.count("number of points", 4, 7);
  scan.integer("dimension", 4, 3, 3);
  skipRest(scan);
  mesh.points.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    names.add(scan.integer("number of a point", 4, -kAny, kAny));
    mesh.points.push_back(scan.point(8));
    skipRest(scan);
  }
  names.finish(scan);
}

}  // namespace

SoftMeshFile readTetgen(std::string_view node, std::string_view ele, const std::string& name) {
  SoftMeshFile mesh;
  PointNames names;
  const std::string nodeName = name + ".node", eleName = name + ".ele";
  readNodes(node, nodeName, mesh, names);
  Scan scan(ele, eleName);
  scan.comment = '#';
  const size_t count = scan.count("number of tetrahedra", 4, 9);
  const int64_t nodes = scan.integer("nodes of a tetrahedron", 4, 4, 10);
  if (nodes != 4 && nodes != 10) scan.fail("nodes of a tetrahedron", std::to_string(nodes), "must be 4 or 10");
  skipRest(scan);
  Elements elements(mesh);
  mesh.tets.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    scan.integer("number of a tetrahedron", 4, -kAny, kAny);
    std::array<uint32_t, 4> corners;
    for (uint32_t& corner : corners) corner = names.find(scan.integer("point of a tetrahedron", 4, -kAny, kAny), scan);
    elements.add(kKinds[nodes == 4 ? 0 : 1], [&](size_t k) { return corners[k]; });
    skipRest(scan);
  }
  elements.note(kKinds, eleName);
  return mesh;
}

}  // namespace avbd::soft_mesh_file
