// Legacy VTK files of unstructured grids, text and binary; cells as before and since version 5.
#include <algorithm>
#include <array>
#include <limits>

#include "io/soft_mesh_file_parts.h"

namespace avbd::soft_mesh_file {

namespace {

constexpr int64_t kAny = std::numeric_limits<int64_t>::max();

/// nodes 0: any number.
constexpr ElementKind kKinds[] = {
    {0, 0, 0, "empty cells"},
    {1, 1, 0, "vertices"},
    {2, 0, 0, "sets of vertices"},
    {3, 2, 0, "lines"},
    {4, 0, 0, "polylines"},
    {5, 3, 3, "triangles"},
    {6, 0, 0, "strips of triangles"},
    {7, 0, 0, "polygons"},
    {8, 4, 0, "pixels"},
    {9, 4, 0, "quadrangles"},
    {10, 4, 4, "tetrahedra"},
    {11, 8, 0, "voxels"},
    {12, 8, 0, "hexahedra"},
    {13, 6, 0, "wedges"},
    {14, 5, 0, "pyramids"},
    {22, 6, 3, "triangles of 6 nodes"},
    {24, 10, 4, "tetrahedra of 10 nodes"},
};
constexpr ElementKind kOther = {-1, 0, 0, "cells of other kinds"};

bool isWord(std::string_view token, std::string_view upperCase) {
  return std::equal(token.begin(), token.end(), upperCase.begin(), upperCase.end(), [](char a, char b) {
    return (a >= 'a' && a <= 'z' ? static_cast<char>(a - ('a' - 'A')) : a) == b;
  });
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : name_(name), scan_(bytes, name) {}

  SoftMeshFile read() {
    readHead();
    for (std::string_view section = scan_.word(); !section.empty(); section = scan_.word()) {
      if (isWord(section, "CELL_DATA") || isWord(section, "POINT_DATA")) break;
      readSection(section);
      scan_.numbers = Scan::Numbers::Text;
    }
    if (mesh_.points.empty()) scan_.fail("POINTS is missing");
    if (types_.size() != starts_.size() - 1)
      scan_.fail("number of CELL_TYPES", std::to_string(types_.size()),
                 "must be " + std::to_string(starts_.size() - 1) + ", that of the cells");
    takeCells();
    return std::move(mesh_);
  }

 private:
  void readHead();
  void readSection(std::string_view section);
  void readPoints();
  void readCells();
  void readLists(size_t count, size_t total);
  void readOffsets(size_t count, size_t total);
  void readTypes();
  void skipFields();
  void takeCells();
  /// Of a kind of numbers that points or data have.
  int bytesOf(std::string_view type) const;
  void once(bool isFirst, const char* section) const {
    if (!isFirst) scan_.fail(std::string(section) + ": must not stand twice");
  }
  int64_t point() { return scan_.integer("point of a cell", indexBytes_, 0, kAny); }
  void beginNumbers() {
    if (isBinary_) scan_.line();
    scan_.numbers = isBinary_ ? Scan::Numbers::Big : Scan::Numbers::Text;
  }

  const std::string& name_;
  Scan scan_;
  SoftMeshFile mesh_;
  std::vector<int64_t> corners_;
  std::vector<size_t> starts_{0};  // of each cell in corners_, and the end
  std::vector<int64_t> types_;
  bool isBinary_ = false;
  int indexBytes_ = 4;
};

void Reader::readHead() {
  const std::string_view first = scan_.line();
  if (!first.starts_with("# vtk DataFile Version "))
    scan_.fail("first line", first, "must be # vtk DataFile Version and a number");
  scan_.line();  // a title of any words
  const std::string_view kind = scan_.word();
  isBinary_ = isWord(kind, "BINARY");
  if (!isBinary_ && !isWord(kind, "ASCII")) scan_.fail("kind", kind, "must be ASCII or BINARY");
  if (const std::string_view word = scan_.word(); !isWord(word, "DATASET"))
    scan_.fail("statement", word, "must be DATASET");
  if (const std::string_view set = scan_.word(); !isWord(set, "UNSTRUCTURED_GRID"))
    scan_.fail("DATASET", set, "must be UNSTRUCTURED_GRID");
}

void Reader::readSection(std::string_view section) {
  if (isWord(section, "POINTS")) return readPoints();
  if (isWord(section, "CELLS")) return readCells();
  if (isWord(section, "CELL_TYPES")) return readTypes();
  if (isWord(section, "FIELD")) return skipFields();
  if (!isWord(section, "METADATA"))
    scan_.fail("statement", section, "must be POINTS, CELLS, CELL_TYPES, FIELD, METADATA, CELL_DATA or POINT_DATA");
  scan_.line();
  while (scan_.left() > 0 && !scan_.line().empty()) {
  }
}

int Reader::bytesOf(std::string_view type) const {
  constexpr std::pair<const char*, int> kTypes[] = {
      {"FLOAT", 4}, {"DOUBLE", 8}, {"INT", 4},       {"UNSIGNED_INT", 4},  {"LONG", 8},           {"UNSIGNED_LONG", 8},
      {"CHAR", 1},  {"SHORT", 2},  {"VTKIDTYPE", 4}, {"UNSIGNED_CHAR", 1}, {"UNSIGNED_SHORT", 2}, {"VTKTYPEINT64", 8}};
  for (const auto& [name, bytes] : kTypes)
    if (isWord(type, name)) return bytes;
  scan_.fail("type of numbers", type, "must be float, double or a kind of int");
}

void Reader::readPoints() {
  once(mesh_.points.empty(), "POINTS");
  const size_t count = scan_.count("number of points", 4, 6);
  const std::string_view type = scan_.wordHere();
  if (!isWord(type, "FLOAT") && !isWord(type, "DOUBLE")) scan_.fail("type of points", type, "must be float or double");
  beginNumbers();
  mesh_.points.reserve(count);
  for (size_t i = 0; i < count; ++i) mesh_.points.push_back(scan_.point(bytesOf(type)));
}

void Reader::readCells() {
  once(starts_.size() == 1, "CELLS");
  const size_t count = scan_.count("number of cells", 4, 1);
  const size_t total = scan_.count("numbers of the cells", 4, 1);
  starts_.reserve(count + 1);
  corners_.reserve(total);
  if (scan_.nextIs("OFFSETS")) return readOffsets(count, total);
  readLists(count, total);
}

/// A number of points before the points of each.
void Reader::readLists(size_t count, size_t total) {
  beginNumbers();
  for (size_t i = 0; i < count; ++i) {
    const int64_t most = static_cast<int64_t>(total) - static_cast<int64_t>(corners_.size() + i + 1);
    const int64_t size = scan_.integer("number of points of a cell", 4, 0, std::max<int64_t>(most, 0));
    for (int64_t k = 0; k < size; ++k) corners_.push_back(point());
    starts_.push_back(corners_.size());
  }
}

/// Where the points of each begin, then all points.
void Reader::readOffsets(size_t count, size_t total) {
  scan_.word();
  indexBytes_ = bytesOf(scan_.wordHere());
  if (indexBytes_ < 4 || count < 1) scan_.fail("OFFSETS: must be at least one, of 4 or 8 bytes");
  beginNumbers();
  scan_.integer("first offset", indexBytes_, 0, 0);
  for (size_t i = 1; i < count; ++i)
    starts_.push_back(static_cast<size_t>(
        scan_.integer("offset", indexBytes_, static_cast<int64_t>(starts_.back()), static_cast<int64_t>(total))));
  scan_.numbers = Scan::Numbers::Text;
  scan_.expect("CONNECTIVITY");
  indexBytes_ = bytesOf(scan_.wordHere());
  if (indexBytes_ < 4) scan_.fail("CONNECTIVITY: must be of 4 or 8 bytes");
  beginNumbers();
  for (size_t i = 0; i < starts_.back(); ++i) corners_.push_back(point());
  scan_.skipNumbers(total - starts_.back(), static_cast<size_t>(indexBytes_));
}

void Reader::readTypes() {
  once(types_.empty(), "CELL_TYPES");
  const size_t count = scan_.count("number of CELL_TYPES", 4, 1);
  beginNumbers();
  types_.reserve(count);
  for (size_t i = 0; i < count; ++i) types_.push_back(scan_.integer("type of a cell", 4, 0, 255));
}

void Reader::skipFields() {
  scan_.word();
  const size_t arrays = scan_.count("number of arrays", 4, 4);
  for (size_t i = 0; i < arrays; ++i) {
    scan_.numbers = Scan::Numbers::Text;
    scan_.word();
    const size_t width = scan_.count("components of an array", 4, 1), count = scan_.count("length of an array", 4, 1);
    const int bytes = bytesOf(scan_.wordHere());
    beginNumbers();
    // Neither exceeds the file, so that their product is within 64 bits.
    scan_.skipNumbers(uint64_t{width} * count, static_cast<size_t>(bytes));
  }
}

void Reader::takeCells() {
  Elements elements(mesh_);
  const int64_t points = static_cast<int64_t>(mesh_.points.size());
  for (size_t i = 0; i < types_.size(); ++i) {
    const size_t begin = starts_[i], size = starts_[i + 1] - begin;
    const ElementKind* kind = &kOther;
    for (const ElementKind& each : kKinds)
      if (each.type == types_[i]) kind = &each;
    if (kind->corners > 0 && size != static_cast<size_t>(kind->nodes))
      scan_.fail("number of points of cell " + std::to_string(i), std::to_string(size),
                 "must be " + std::to_string(kind->nodes));
    for (size_t k = 0; k < size; ++k)
      if (corners_[begin + k] >= points)
        scan_.fail("point of cell " + std::to_string(i), std::to_string(corners_[begin + k]),
                   "must be < " + std::to_string(points) + ", the points");
    elements.add(*kind, [&](size_t k) { return static_cast<uint32_t>(corners_[begin + k]); });
  }
  std::vector<ElementKind> kinds(std::begin(kKinds), std::end(kKinds));
  kinds.push_back(kOther);
  elements.note(kinds, name_);
}

}  // namespace

SoftMeshFile readVtk(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace avbd::soft_mesh_file
