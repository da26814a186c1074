// GMSH: sections between $NAME and $EndNAME, each a list of lines.
#include "io/gmsh_file.h"

#include <charconv>
#include <map>

#include "io/mesh_file_parts.h"

namespace avbd {

namespace {

using mesh_file::TextScan;

constexpr int64_t kMost = int64_t{1} << 40;  // of what is counted or numbered

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : scan_(text, name) {}

  GmshFile run() {
    while (nextWords()) {
      if (words_[0] == "$MeshFormat") readFormat();
      if (!out_.leftOut.empty()) return std::move(out_);
      if (words_[0] == "$Nodes") version4_ ? readNodes4() : readNodes2();
      if (words_[0] == "$Elements") version4_ ? readElements4() : readElements2();
    }
    if (!known_) scan_.failAt(scan_.line(), "$MeshFormat is missing: not a GMSH file");
    const bool solid = !tets_.empty();
    out_.dim = solid ? 3 : 2;
    out_.elements = std::move(solid ? tets_ : triangles_);
    if (out_.elements.empty())
      scan_.failAt(scan_.line(), "elements = 0: must have at least one triangle or tetrahedron");
    return std::move(out_);
  }

 private:
  /// The words of the next line that has any.
  bool nextWords() {
    words_.clear();
    do {
      if (started_ && !scan_.nextLine()) return false;
      started_ = true;
      for (std::string_view word = scan_.token(); !word.empty(); word = scan_.token()) words_.push_back(word);
    } while (words_.empty());
    return true;
  }

  void needWords(size_t least, const char* what) {
    if (nextWords() && words_.size() >= least) return;
    scan_.failAt(scan_.line(), std::string(what) + " is missing: must be a line of " + std::to_string(least) +
                                   (least == 1 ? " number" : " numbers") + " or more");
  }

  int64_t whole(size_t word, const char* what) {
    const std::string_view text = words_[word];
    int64_t value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > kMost)
      scan_.fail(what, text, "must be a whole number >= 0");
    return value;
  }

  float coordinate(size_t word) {
    double value = 0;
    const std::string_view text = words_[word];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= -1e6 && value <= 1e6))
      scan_.fail("node", text, "must be a number within 1e6");
    return static_cast<float>(value);
  }

  void readFormat() {
    needWords(2, "version");
    known_ = true;
    version4_ = words_[0] == "4.1";
    if (!version4_ && words_[0] != "2.2") out_.leftOut = "version " + std::string(words_[0].substr(0, 20));
    if (words_[1] != "0") out_.leftOut = "binary";
  }

  void addNode(int64_t tag, size_t firstWord) {
    if (!nodes_.emplace(tag, static_cast<uint32_t>(out_.points.size())).second)
      scan_.fail("node", std::to_string(tag), "must not be given twice");
    out_.points.push_back({coordinate(firstWord), coordinate(firstWord + 1), coordinate(firstWord + 2)});
  }

  void readNodes2() {
    needWords(1, "count of nodes");
    for (int64_t left = whole(0, "count of nodes"); left > 0; --left) {
      needWords(4, "node");
      addNode(whole(0, "node"), 1);
    }
  }

  void readNodes4() {
    needWords(4, "count of nodes");
    for (int64_t blocks = whole(0, "count of blocks"); blocks > 0; --blocks) {
      needWords(4, "block of nodes");
      const int64_t count = whole(3, "count of nodes");
      std::vector<int64_t> tags;
      for (int64_t i = 0; i < count; ++i) {
        needWords(1, "node");
        tags.push_back(whole(0, "node"));
      }
      for (const int64_t tag : tags) {
        needWords(3, "coordinates of a node");
        addNode(tag, 0);
      }
    }
  }

  /// The line's words from `first` on are the nodes.
  void addElement(int64_t type, size_t first) {
    const size_t corners = type == 2 ? 3 : type == 4 ? 4 : 0;
    if (corners == 0) return;
    if (words_.size() != first + corners)
      scan_.failAt(scan_.line(),
                   "an element of type " + std::to_string(type) + " must have " + std::to_string(corners) + " nodes");
    std::array<uint32_t, 4> element{};
    for (size_t k = 0; k < corners; ++k) {
      const auto it = nodes_.find(whole(first + k, "node of an element"));
      if (it == nodes_.end()) scan_.fail("node of an element", words_[first + k], "no node has this number");
      element[k] = it->second;
    }
    for (size_t k = 0; k < corners; ++k)
      for (size_t i = 0; i < k; ++i)
        if (element[i] == element[k]) scan_.fail("node of an element", words_[first + k], "must not be named twice");
    (corners == 4 ? tets_ : triangles_).push_back(element);
  }

  void readElements2() {
    needWords(1, "count of elements");
    for (int64_t left = whole(0, "count of elements"); left > 0; --left) {
      needWords(4, "element");
      const int64_t tags = whole(2, "count of tags");
      if (tags > static_cast<int64_t>(words_.size()) - 3)
        scan_.fail("count of tags", words_[2], "must be no more than the line has");
      addElement(whole(1, "type of an element"), 3 + static_cast<size_t>(tags));
    }
  }

  void readElements4() {
    needWords(4, "count of elements");
    for (int64_t blocks = whole(0, "count of blocks"); blocks > 0; --blocks) {
      needWords(4, "block of elements");
      const int64_t type = whole(2, "type of an element"), count = whole(3, "count of elements");
      for (int64_t i = 0; i < count; ++i) {
        needWords(2, "element");
        addElement(type, 1);
      }
    }
  }

  TextScan scan_;
  bool started_ = false, known_ = false, version4_ = false;
  std::vector<std::string_view> words_;
  std::map<int64_t, uint32_t> nodes_;  // by number: index into out_.points
  std::vector<std::array<uint32_t, 4>> triangles_, tets_;
  GmshFile out_;
};

}  // namespace

GmshFile readGmsh(std::string_view text, const std::string& nameForMessages) {
  return Reader(text, nameForMessages).run();
}

}  // namespace avbd
