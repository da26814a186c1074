// Wavefront OBJ: vertices and faces; texture, normals, groups and materials mean nothing to a shape.
#include <charconv>

#include "io/mesh_file_parts.h"
#include "io/notes.h"

namespace avbd::mesh_file {

namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name) : scan_(text, name), name_(name) {}

  MeshFile read() {
    do {
      statement(scan_.token());
    } while (scan_.nextLine());
    if (largest_ > out_.vertices.size()) {
      scan_.failAt(lineOfLargest_, "f = \"" + std::to_string(largest_) + "\": the vertex must be 1 .. " +
                                       std::to_string(out_.vertices.size()) + " (those of the file)");
    }
    out_.notes = notes_.lines();
    return std::move(out_);
  }

 private:
  void statement(std::string_view word) {
    if (word == "v") {
      const float x = scan_.number("v.x"), y = scan_.number("v.y"), z = scan_.number("v.z");
      out_.vertices.push_back({x, y, z});  // a weight or a colour may follow
    } else if (word == "f" || word == "fo") {
      face();
    } else if (!isSilent(word)) {
      std::string shown;
      for (const char c : word.substr(0, 20)) shown += c > ' ' && c <= '~' ? c : '?';
      notes_.add(name_ + ":" + std::to_string(scan_.line()), "statement \"" + shown + "\" is left out");
    }
  }

  static bool isSilent(std::string_view word) {
    constexpr std::string_view kSilent[] = {"vt", "vn", "g", "o", "s", "usemtl", "mtllib", "mg", "usemap", "maplib"};
    if (word.empty() || word[0] == '#') return true;
    for (const std::string_view silent : kSilent) {
      if (word == silent) return true;
    }
    return false;
  }

  // `7`, `7/1`, `7//2`, `7/1/2`; negative ones count back from the last vertex so far.
  uint32_t index(std::string_view text) {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool clean = error == std::errc{} && (end == text.data() + text.size() || *end == '/');
    const int64_t count = static_cast<int64_t>(out_.vertices.size());
    if (clean && value < 0 && value >= -count) return static_cast<uint32_t>(count + value);
    if (!clean || value <= 0 || value > INT32_MAX) {
      scan_.fail("f", text,
                 "the vertex must be 1 .. " + std::to_string(count) + " or -" + std::to_string(count) + " .. -1");
    }
    // Vertices may stand below the faces that use them, so this is checked at the end.
    if (static_cast<uint64_t>(value) > largest_) {
      largest_ = static_cast<uint64_t>(value);
      lineOfLargest_ = scan_.line();
    }
    return static_cast<uint32_t>(value - 1);
  }

  void face() {
    uint32_t first = 0, last = 0, count = 0;
    for (std::string_view text = scan_.token(); !text.empty() && text[0] != '#'; text = scan_.token()) {
      const uint32_t now = index(text);
      if (count == 0) first = now;
      if (count >= 2) out_.triangles.push_back({first, last, now});
      last = now;
      ++count;
    }
    if (count < 3) scan_.failAt(scan_.line(), "f has " + std::to_string(count) + " vertices: must be 3 or more");
  }

  TextScan scan_;
  const std::string& name_;
  MeshFile out_;
  Notes notes_;
  uint64_t largest_ = 0;
  int lineOfLargest_ = 0;
};

}  // namespace

MeshFile readObj(std::string_view text, const std::string& name) { return ObjReader(text, name).read(); }

}  // namespace avbd::mesh_file
