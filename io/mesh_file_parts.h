// What the mesh readers share: the reader of each kind, and a scan over text that knows its line.
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_file.h"

namespace avbd::mesh_file {

MeshFile readObj(std::string_view text, const std::string& name);
MeshFile readStl(std::string_view bytes, const std::string& name);
MeshFile readMsh(std::string_view bytes, const std::string& name);

/// readMeshFile, but a file of points alone will do.
MeshFile readFile(const std::filesystem::path& file);

/// Sure to be STL whatever its file is called: text with facets, or binary whose count fits its size.
bool isStl(std::string_view bytes);
/// The counts of the head fit the size.
bool isMsh(std::string_view bytes);

/// Little-endian number at a byte that the caller has checked.
uint32_t word(std::string_view bytes, size_t at);
float real(std::string_view bytes, size_t at);

/// The value that text stands for; false where it is none. Too small numbers are 0.
bool parseNumber(std::string_view text, double& out);

/// Tokens of a text, line by line. A backslash before the end of a line joins it with the next one.
class TextScan {
 public:
  TextScan(std::string_view text, const std::string& name)
      : at_(text.data()), end_(text.data() + text.size()), name_(name) {}

  /// The next token of this line; empty at its end.
  std::string_view token();
  /// Goes to the start of the next line; false at the end of the text.
  bool nextLine();
  /// The next token on this line or a later one; empty at the end of the text.
  std::string_view tokenAnywhere();
  /// The next token as a finite float; `what` names it in the message.
  float number(std::string_view what);
  /// `NAME:LINE: WHAT = "VALUE": RANGE`
  [[noreturn]] void fail(std::string_view what, std::string_view value, const std::string& range) const;
  /// The same for another line.
  [[noreturn]] void failAt(int line, const std::string& message) const;
  int line() const { return line_; }

 private:
  void skipBlanks();

  const char *at_, *end_;
  const std::string& name_;
  int line_ = 1;
};

}  // namespace avbd::mesh_file
