// Attributes of an MJCF element as numbers, keywords and flags, each checked with its place in the file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/xml_source.h"

namespace avbd::mjcf {

/// An attribute's text and the element that it was written at: its own, or one of a default class.
struct Attr {
  std::string_view name, value;
  Elem from;
};

/// Why text is not a list of numbers.
struct NumberFault {
  std::string_view token;
  const char* reason = nullptr;
};

/// Numbers parted by white space, at most `most`. False with `fault` set if one is not a finite number below 1e15 or
/// there are more.
bool readNumbers(std::string_view text, size_t most, std::vector<double>& out, NumberFault& fault);

/// What an element says, its default class included.
class Attributes {
 public:
  Attributes(const XmlSource& source, Elem elem, std::vector<Attr> attrs)
      : source_(source), elem_(elem), attrs_(std::move(attrs)) {}

  const Attr* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  Elem elem() const { return elem_; }

  /// Numbers of an attribute; empty where it is not given. Counts outside [least, most] are refused.
  std::vector<double> numbers(std::string_view name, size_t least, size_t most) const;
  double number(std::string_view name, double otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  std::string text(std::string_view name) const;           ///< empty where not given
  std::string requiredText(std::string_view name) const;   ///< must be given and not empty
  bool flag(std::string_view name, bool otherwise) const;  ///< true or false
  bool enabled(std::string_view name) const;               ///< enable or disable; enabled where not given
  /// Index into the words, or `otherwise` where not given.
  int keyword(std::string_view name, const std::vector<std::string_view>& words, int otherwise) const;

  /// Refuses an attribute's value, or says that it is missing.
  [[noreturn]] void fail(std::string_view name, const std::string& range) const;

 private:
  const XmlSource& source_;
  Elem elem_;
  std::vector<Attr> attrs_;
};

}  // namespace avbd::mjcf
