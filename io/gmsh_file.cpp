// Gmsh's .msh, versions 2.2 and 4.1, text and binary.
#include <algorithm>
#include <array>
#include <limits>

#include "io/soft_mesh_file_parts.h"

namespace avbd::soft_mesh_file {

namespace {

constexpr int64_t kAny = std::numeric_limits<int64_t>::max();
constexpr int kMostNodes = 125;

constexpr ElementKind kKinds[] = {
    {1, 2, 0, "lines"},
    {2, 3, 3, "triangles"},
    {3, 4, 0, "quadrangles"},
    {4, 4, 4, "tetrahedra"},
    {5, 8, 0, "hexahedra"},
    {6, 6, 0, "prisms"},
    {7, 5, 0, "pyramids"},
    {8, 3, 0, "lines of 3 nodes"},
    {9, 6, 3, "triangles of 6 nodes"},
    {10, 9, 0, "quadrangles of 9 nodes"},
    {11, 10, 4, "tetrahedra of 10 nodes"},
    {12, 27, 0, "hexahedra of 27 nodes"},
    {13, 18, 0, "prisms of 18 nodes"},
    {14, 14, 0, "pyramids of 14 nodes"},
    {15, 1, 0, "points"},
    {16, 8, 0, "quadrangles of 8 nodes"},
    {17, 20, 0, "hexahedra of 20 nodes"},
    {18, 15, 0, "prisms of 15 nodes"},
    {19, 13, 0, "pyramids of 13 nodes"},
    {20, 9, 3, "incomplete triangles of 9 nodes"},
    {21, 10, 3, "triangles of 10 nodes"},
    {22, 12, 3, "incomplete triangles of 12 nodes"},
    {23, 15, 3, "triangles of 15 nodes"},
    {24, 15, 3, "incomplete triangles of 15 nodes"},
    {25, 21, 3, "triangles of 21 nodes"},
    {26, 4, 0, "lines of 4 nodes"},
    {27, 5, 0, "lines of 5 nodes"},
    {28, 6, 0, "lines of 6 nodes"},
    {29, 20, 4, "tetrahedra of 20 nodes"},
    {30, 35, 4, "tetrahedra of 35 nodes"},
    {31, 56, 4, "tetrahedra of 56 nodes"},
    {92, 64, 0, "hexahedra of 64 nodes"},
    {93, 125, 0, "hexahedra of 125 nodes"},
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : name_(name), scan_(bytes, name), elements_(mesh_) {}

  SoftMeshFile read() {
    for (std::string_view section = scan_.word(); !section.empty(); section = scan_.word()) readSection(section);
    scan_.numbers = Scan::Numbers::Text;
    if (!version_) scan_.fail("$MeshFormat is missing");
    if (!nodes_) scan_.fail("$Nodes is missing");
    elements_.note(kKinds, name_);
    return std::move(mesh_);
  }

 private:
  void readSection(std::string_view section);
  void readFormat();
  void readNodes();
  void readNodes4();
  void readElements();
  void readElements2();
  void readElements4();
  void readElement(const ElementKind& kind, int bytes);
  const ElementKind& kindOf(int64_t type) const;
  const ElementKind& nextKind() { return kindOf(scan_.integer("type of an element", 4, 1, 140)); }
  /// Binary numbers begin behind the end of the line.
  void beginNumbers() {
    if (numbers_ != Scan::Numbers::Text) scan_.line();
    scan_.numbers = numbers_;
  }

  const std::string& name_;
  Scan scan_;
  SoftMeshFile mesh_;
  Elements elements_;
  PointNames names_;
  Scan::Numbers numbers_ = Scan::Numbers::Text;
  int version_ = 0;  // 2 or 4; 0 before $MeshFormat
  bool nodes_ = false;
};

void Reader::readSection(std::string_view section) {
  scan_.numbers = Scan::Numbers::Text;
  if (!section.starts_with('$')) scan_.fail("section", section, "must begin with $");
  const std::string end = "$End" + std::string(section.substr(1));
  if (section == "$MeshFormat") {
    readFormat();
  } else if (section == "$Nodes" || section == "$Elements") {
    if (!version_) scan_.fail(std::string(section) + ": $MeshFormat must stand before it");
    if (section == "$Nodes" && nodes_) scan_.fail("$Nodes: must not stand twice");
    if (section == "$Elements" && !nodes_) scan_.fail("$Elements: $Nodes must stand before it");
    section == "$Nodes" ? readNodes() : readElements();
  } else {
    if (!scan_.skipPast(end)) scan_.fail(end + " is missing");
    return;
  }
  scan_.numbers = Scan::Numbers::Text;
  scan_.expect(end);
}

void Reader::readFormat() {
  const std::string_view version = scan_.word();
  if (version_) scan_.fail("$MeshFormat: must not stand twice");
  if (version == "2" || version == "2.0" || version == "2.1" || version == "2.2") version_ = 2;
  if (version == "4.1") version_ = 4;
  if (!version_) scan_.fail("version", version, "must be 2.2 or 4.1");
  const bool isBinary = scan_.integer("file type", 4, 0, 1) == 1;
  scan_.integer("data size", 4, isBinary ? 8 : 0, isBinary ? 8 : 64);
  if (!isBinary) return;
  numbers_ = Scan::Numbers::Little;
  beginNumbers();
  // A 1 tells the order of bytes.
  const int64_t one = scan_.integer("mark of the order of bytes", 4, 1, 1 << 24);
  if (one != 1 && one != 1 << 24) scan_.fail("mark of the order of bytes", std::to_string(one), "must be 1");
  if (one != 1) numbers_ = Scan::Numbers::Big;
}

void Reader::readNodes() {
  nodes_ = true;
  if (version_ == 4) return readNodes4();
  const size_t count = scan_.count("number of nodes", 8, 8);
  beginNumbers();
  mesh_.points.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    names_.add(scan_.integer("node", 4, 1, kAny));
    mesh_.points.push_back(scan_.point(8));
  }
  names_.finish(scan_);
}

void Reader::readNodes4() {
  beginNumbers();
  const size_t blocks = scan_.count("number of blocks", 8, 4), count = scan_.count("number of nodes", 8, 8);
  scan_.integer("least tag", 8, 0, kAny);
  scan_.integer("greatest tag", 8, 0, kAny);
  mesh_.points.reserve(count);
  for (size_t block = 0; block < blocks; ++block) {
    const int64_t dimension = scan_.integer("dimension", 4, 0, 3);
    scan_.integer("entity", 4, -kAny, kAny);
    const bool isParametric = scan_.integer("parametric", 4, 0, 1) == 1;
    const size_t size = scan_.count("number of nodes of a block", 8, 8);
    if (size > count - mesh_.points.size())
      scan_.fail("number of nodes of a block", std::to_string(size),
                 "must be at most " + std::to_string(count - mesh_.points.size()) + ", what the blocks before leave");
    for (size_t i = 0; i < size; ++i) names_.add(scan_.integer("node", 8, 1, kAny));
    for (size_t i = 0; i < size; ++i) {
      mesh_.points.push_back(scan_.point(8));
      if (isParametric) scan_.skipNumbers(static_cast<uint64_t>(dimension), 8);
    }
  }
  if (mesh_.points.size() != count)
    scan_.fail("number of nodes", std::to_string(count),
               "must be " + std::to_string(mesh_.points.size()) + ", as many as the blocks have");
  names_.finish(scan_);
}

const ElementKind& Reader::kindOf(int64_t type) const {
  for (const ElementKind& kind : kKinds)
    if (kind.type == type) return kind;
  scan_.fail("type of an element", std::to_string(type), "must be 1 .. 31, 92 or 93");
}

/// Behind its tags.
void Reader::readElement(const ElementKind& kind, int bytes) {
  std::array<uint32_t, kMostNodes> nodes{};
  for (int i = 0; i < kind.nodes; ++i)
    nodes[static_cast<size_t>(i)] = names_.find(scan_.integer("node of an element", bytes, 1, kAny), scan_);
  elements_.add(kind, [&](size_t i) { return nodes[i]; });
}

void Reader::readElements() { version_ == 4 ? readElements4() : readElements2(); }

void Reader::readElements2() {
  const bool isBinary = numbers_ != Scan::Numbers::Text;
  const size_t count = scan_.count("number of elements", 8, 8);
  beginNumbers();
  for (size_t done = 0; done < count;) {
    if (!isBinary) scan_.integer("element", 4, 0, kAny);
    const ElementKind& kind = nextKind();
    const int64_t most = static_cast<int64_t>(count - done);
    const int64_t block = isBinary ? scan_.integer("number of elements of a block", 4, 1, most) : 1;
    const int64_t tags = scan_.integer("number of tags", 4, 0, 1000000);
    for (int64_t i = 0; i < block; ++i, ++done) {
      if (isBinary) scan_.integer("element", 4, 0, kAny);
      scan_.skipNumbers(static_cast<uint64_t>(tags), 4);
      readElement(kind, 4);
    }
  }
}

void Reader::readElements4() {
  beginNumbers();
  const size_t blocks = scan_.count("number of blocks", 8, 4), count = scan_.count("number of elements", 8, 4);
  scan_.integer("least tag", 8, 0, kAny);
  scan_.integer("greatest tag", 8, 0, kAny);
  size_t done = 0;
  for (size_t block = 0; block < blocks; ++block) {
    scan_.integer("dimension", 4, 0, 3);
    scan_.integer("entity", 4, -kAny, kAny);
    const ElementKind& kind = nextKind();
    const int64_t size = scan_.integer("number of elements of a block", 8, 0, static_cast<int64_t>(count - done));
    for (int64_t i = 0; i < size; ++i, ++done) {
      scan_.integer("element", 8, 0, kAny);
      readElement(kind, 8);
    }
  }
  if (done != count)
    scan_.fail("number of elements", std::to_string(count),
               "must be " + std::to_string(done) + ", as many as the blocks have");
}

}  // namespace

bool isGmsh(std::string_view bytes) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  return bytes.substr(first).starts_with("$MeshFormat") || bytes.substr(first).starts_with("$Comments");
}

SoftMeshFile readGmsh(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace avbd::soft_mesh_file
