// STL, text and binary. Each triangle brings its own corners; equal ones become one vertex.
#include <cmath>
#include <cstring>

#include "io/mesh_file_parts.h"

namespace avbd::mesh_file {

namespace {

constexpr size_t kHead = 84, kTriangle = 50;  // bytes of the head with the count, and of each triangle

// Vertices by value, in the order of their first use. Open addressing: a map would take ten times as long.
class Corners {
 public:
  Corners(std::vector<Vec3>& vertices, size_t expected) : vertices_(vertices) {
    size_t size = 64;
    while (size < expected * 2) size *= 2;
    slots_.assign(size, kEmpty);
  }

  uint32_t index(Vec3 v) {
    v = {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // -0 is 0
    if (vertices_.size() * 2 >= slots_.size()) grow();
    uint32_t& slot = find(v);
    if (slot == kEmpty) {
      slot = static_cast<uint32_t>(vertices_.size());
      vertices_.push_back(v);
    }
    return slot;
  }

 private:
  static constexpr uint32_t kEmpty = 0xffffffffu;

  uint32_t& find(Vec3 v) {
    uint64_t hash = 0;
    for (const float f : {v.x, v.y, v.z}) {
      uint32_t bits;
      std::memcpy(&bits, &f, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    const size_t mask = slots_.size() - 1;
    for (size_t i = hash & mask;; i = (i + 1) & mask) {
      if (slots_[i] == kEmpty || vertices_[slots_[i]] == v) return slots_[i];
    }
  }

  void grow() {
    slots_.assign(slots_.size() * 2, kEmpty);
    for (uint32_t i = 0; i < vertices_.size(); ++i) find(vertices_[i]) = i;
  }

  std::vector<Vec3>& vertices_;
  std::vector<uint32_t> slots_;
};

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

bool isWord(std::string_view token, std::string_view lowerCase) {
  if (token.size() != lowerCase.size()) return false;
  for (size_t i = 0; i < token.size(); ++i) {
    const char c = token[i] >= 'A' && token[i] <= 'Z' ? static_cast<char>(token[i] + ('a' - 'A')) : token[i];
    if (c != lowerCase[i]) return false;
  }
  return true;
}

bool fitsExactly(std::string_view bytes) {
  return bytes.size() >= kHead && kHead + kTriangle * uint64_t{word(bytes, 80)} == bytes.size();
}

// A binary head may say "solid" too, but the count behind it has a zero byte.
bool isText(std::string_view bytes) {
  if (fitsExactly(bytes) || !isWord(trimmed(bytes).substr(0, 5), "solid")) return false;
  return bytes.substr(0, 512).find('\0') == std::string_view::npos;
}

MeshFile readText(std::string_view text, const std::string& name) {
  MeshFile out;
  Corners corners(out.vertices, text.size() / 500);
  TextScan scan(text, name);
  std::array<uint32_t, 3> triangle{};
  int count = -1;  // of the vertices of the open facet; -1: none is open
  for (;;) {
    const std::string_view token = scan.tokenAnywhere();
    if (token.empty()) break;
    if (isWord(token, "vertex")) {
      const float x = scan.number("vertex.x"), y = scan.number("vertex.y"), z = scan.number("vertex.z");
      if (count < 0) scan.failAt(scan.line(), "vertex: must stand between facet and endfacet");
      if (count == 3) scan.failAt(scan.line(), "vertex: a facet must have exactly 3");
      triangle[static_cast<size_t>(count++)] = corners.index({x, y, z});
    } else if (isWord(token, "facet")) {
      if (count >= 0) scan.failAt(scan.line(), "facet: the one before has no endfacet");
      count = 0;
      scan.nextLine();  // its normal follows from the corners
    } else if (isWord(token, "endfacet")) {
      if (count != 3) {
        scan.failAt(scan.line(),
                    "endfacet: the facet has " + std::to_string(std::max(count, 0)) + " vertices, must be 3");
      }
      out.triangles.push_back(triangle);
      count = -1;
    } else if (isWord(token, "solid") || isWord(token, "endsolid")) {
      if (count >= 0) scan.fail("statement", token, "the facet before it has no endfacet");
      scan.nextLine();  // a name of any words
    } else if (!isWord(token, "outer") && !isWord(token, "loop") && !isWord(token, "endloop")) {
      scan.fail("statement", token, "must be solid, facet, outer loop, vertex, endloop, endfacet or endsolid");
    }
  }
  if (count >= 0) scan.failAt(scan.line(), "the file ends within a facet: endfacet is missing");
  return out;
}

MeshFile readBinary(std::string_view bytes, const std::string& name) {
  const auto fail = [&](size_t at, const std::string& message) {
    throw FileError(name + ": byte " + std::to_string(at) + ": " + message, name);
  };
  if (bytes.size() < kHead) {
    fail(bytes.size(), "size = " + std::to_string(bytes.size()) + ": the head must have 84 bytes");
  }
  const uint64_t count = word(bytes, 80), room = (bytes.size() - kHead) / kTriangle;
  if (count > room) {
    fail(80, "number of triangles = " + std::to_string(count) + ": must be at most " + std::to_string(room) +
                 ", as many as the file's " + std::to_string(bytes.size()) + " bytes hold");
  }
  MeshFile out;
  out.triangles.reserve(count);
  out.vertices.reserve(count / 2 + 2);
  Corners corners(out.vertices, count / 2);
  for (uint64_t i = 0; i < count; ++i) {
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const size_t at = kHead + kTriangle * i + 12 + 12 * k;
      const Vec3 v{real(bytes, at), real(bytes, at + 4), real(bytes, at + 8)};
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
        fail(at, "triangle " + std::to_string(i) + ": vertex = (" + std::to_string(v.x) + ", " + std::to_string(v.y) +
                     ", " + std::to_string(v.z) + "): must be finite");
      }
      triangle[k] = corners.index(v);
    }
    out.triangles.push_back(triangle);
  }
  if (const size_t used = kHead + kTriangle * count; used < bytes.size()) {
    out.notes.push_back(name + ": " + std::to_string(bytes.size() - used) +
                        " bytes after the last triangle are left out");
  }
  return out;
}

}  // namespace

bool isStl(std::string_view bytes) {
  if (fitsExactly(bytes) && word(bytes, 80) > 0) return true;
  return isText(bytes) && bytes.substr(0, 2048).find("facet") != std::string_view::npos;
}

MeshFile readStl(std::string_view bytes, const std::string& name) {
  return isText(bytes) ? readText(bytes, name) : readBinary(bytes, name);
}

}  // namespace avbd::mesh_file
