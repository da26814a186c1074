// XML text of a scene with everything it includes: elements that know their file and line.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/file_error.h"

namespace avbd::mjcf {

/// An element and the file it stands in.
struct Elem {
  pugi::xml_node node;
  uint32_t file = 0;
  std::string_view name() const { return node.name(); }
  bool has(const char* attribute) const { return !node.attribute(attribute).empty(); }
  std::string_view get(const char* attribute) const { return node.attribute(attribute).value(); }
};

/// The main file and the files that it includes, all parsed. An <include> stands for the children of its file's root.
class XmlSource {
 public:
  static constexpr size_t kMaxBytes = size_t{64} << 20;  ///< of all files together

  static XmlSource fromFile(const std::filesystem::path& file);
  static XmlSource fromText(std::string_view text, std::string_view name);

  /// That of the main file; nothing where the source is text.
  std::optional<std::filesystem::path> folder() const;
  Elem root() const;
  /// Child elements in order, includes replaced by what they hold.
  std::vector<Elem> children(Elem parent) const;

  const std::string& fileName(Elem elem) const { return files_[elem.file]->name; }
  int line(Elem elem) const;
  /// `geom "a"`, or `body "b" > geom` for one without a name.
  std::string label(Elem elem) const;
  /// `tower.xml:12`
  std::string place(Elem elem) const;
  /// `tower.xml:12: geom "a"`
  std::string where(Elem elem) const;

  /// `WHERE: MESSAGE`
  [[noreturn]] void fail(Elem elem, const std::string& message) const;
  /// `WHERE: ATTRIBUTE = "VALUE": RANGE`
  [[noreturn]] void fail(Elem elem, std::string_view attribute, std::string_view value, const std::string& range) const;

 private:
  struct File {
    std::string name;
    std::string text;  // parsed in place: names and values point into it
    std::vector<size_t> lineStarts;
    pugi::xml_document document;
  };

  void addFile(const std::filesystem::path& path, const Elem* includedBy);
  void addText(std::string text, std::string name);
  void readIncludes(uint32_t file);
  void include(Elem elem);
  void checkAttributesOnce(Elem elem) const;

  std::vector<std::unique_ptr<File>> files_;
  std::vector<std::filesystem::path> paths_;  // canonical, of files_; empty for text
  std::filesystem::path folder_;              // of the main file
  size_t bytes_ = 0;
  std::unordered_map<const void*, uint32_t> included_;  // <include> node -> file
};

/// Text for a message: at most 60 characters, control characters replaced.
std::string quoted(std::string_view text);

}  // namespace avbd::mjcf
