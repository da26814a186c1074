// What the readers of soft meshes share: a scan over text or binary numbers, and what becomes of elements.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "io/soft_mesh_file.h"

namespace avbd::soft_mesh_file {

/// Sure to be Gmsh's, not MuJoCo's.
bool isGmsh(std::string_view bytes);

SoftMeshFile readGmsh(std::string_view bytes, const std::string& name);
SoftMeshFile readVtk(std::string_view bytes, const std::string& name);
SoftMeshFile readTetgen(std::string_view node, std::string_view ele, const std::string& name);

/// Goes through a file whose numbers are text, or bytes between lines of text.
class Scan {
 public:
  enum class Numbers { Text, Little, Big };

  Scan(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Numbers numbers = Numbers::Text;
  char comment = '\0';  ///< with this the rest of a line is no text

  /// The next token on this line or a later one; empty at the end of the file.
  std::string_view word();
  /// The next token on this line; empty at its end.
  std::string_view wordHere();
  /// The rest of this line; the scan goes on behind it.
  std::string_view line();
  /// The next token must be this.
  void expect(std::string_view token);
  /// Goes on behind the next place of `text`; false where there is none.
  bool skipPast(std::string_view text);
  bool nextIs(std::string_view text);  ///< behind blanks and ends of lines

  /// A whole number of low .. high, of 4 or 8 bytes where numbers are binary.
  int64_t integer(std::string_view what, int bytes, int64_t low, int64_t high);
  /// The same, of so many things that `least` bytes each fit into what is left of the file.
  size_t count(std::string_view what, int bytes, size_t least);
  /// A finite number, of 4 or 8 bytes where numbers are binary.
  double number(std::string_view what, int bytes);
  Vec3 point(int bytes);
  /// Leaves out numbers.
  void skipNumbers(uint64_t count, size_t bytes);

  size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail(std::string_view what, std::string_view value, const std::string& range) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  uint64_t raw(std::string_view what, size_t bytes);
  bool isText() const { return numbers == Numbers::Text; }

  std::string_view bytes_;
  const std::string& name_;
  size_t at_ = 0;
  int line_ = 1;
};

/// Points by the numbers that a file calls them.
class PointNames {
 public:
  void add(int64_t tag) { byTag_.push_back({tag, static_cast<uint32_t>(byTag_.size())}); }
  /// Fails for a tag that stands twice.
  void finish(const Scan& scan);
  /// Fails for a tag of no point.
  uint32_t find(int64_t tag, const Scan& scan) const;

 private:
  std::vector<std::pair<int64_t, uint32_t>> byTag_;
  bool inRow_ = true;  ///< one follows the other
};

/// What an element of a format's kind is here.
struct ElementKind {
  int type, nodes;
  int corners;  ///< 4: a tetrahedron, 3: a triangle, 0: left out
  const char* name;
};

/// Takes elements of a file, and notes what of them was left out.
class Elements {
 public:
  explicit Elements(SoftMeshFile& mesh) : mesh_(mesh) {}
  /// `at(i)` is the point of the element's node i.
  template <class At>
  void add(const ElementKind& kind, At&& at) {
    if (kind.corners == 4) mesh_.tets.push_back({at(0), at(1), at(2), at(3)});
    if (kind.corners == 3) mesh_.triangles.push_back({at(0), at(1), at(2)});
    if (kind.corners == 0 || kind.nodes > kind.corners) ++counts_[kind.type];
  }
  template <class Kinds>
  void note(const Kinds& kinds, const std::string& name) {
    for (const auto& [type, count] : counts_)
      for (const ElementKind& kind : kinds)
        if (kind.type == type)
          mesh_.notes.push_back(name + ": " + std::to_string(count) + " " + kind.name +
                                (kind.corners == 0 ? " are left out" : " are taken by their corners"));
  }

 private:
  SoftMeshFile& mesh_;
  std::map<int, size_t> counts_;
};

}  // namespace avbd::soft_mesh_file
