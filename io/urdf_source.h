// The XML text of a URDF file: decoded, elements with their places, attributes checked.
#pragma once

#include <avbd/types.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/notes.h"
#include "io/xml_source.h"

namespace avbd::urdf {

using mjcf::Elem;

class Source {
 public:
  static Source fromFile(const std::filesystem::path& file, Notes& notes);
  static Source fromText(std::string text, const std::string& name, Notes& notes);

  Elem root() const { return xml_.root(); }
  std::vector<Elem> children(Elem parent) const { return xml_.children(parent); }
  /// The child of that name, or none; a second one is refused.
  std::optional<Elem> only(Elem parent, std::string_view name) const;
  int line(Elem elem) const { return xml_.line(elem); }
  std::string place(Elem elem) const { return xml_.place(elem); }
  /// `robot.urdf:12: link "arm" > collision > box`
  std::string where(Elem elem) const;

  [[noreturn]] void fail(Elem elem, const std::string& message) const;
  [[noreturn]] void fail(Elem elem, std::string_view attribute, std::string_view value, const std::string& range) const;

  /// Text of an attribute; refuses xacro's ${...} and $(...).
  std::string_view text(Elem elem, const char* attribute) const;
  std::string requiredText(Elem elem, const char* attribute) const;
  /// `count` finite numbers of at most 1e15; no value where the attribute is not there.
  std::optional<std::vector<double>> numbers(Elem elem, const char* attribute, size_t count) const;
  double number(Elem elem, const char* attribute, double otherwise) const;
  double requiredNumber(Elem elem, const char* attribute) const;
  Vec3d vector(Elem elem, const char* attribute, Vec3d otherwise) const;

 private:
  explicit Source(mjcf::XmlSource xml) : xml_(std::move(xml)) {}
  mjcf::XmlSource xml_;
};

}  // namespace avbd::urdf
