// MJCF default classes: what an element's attributes are where the element itself does not say.
#pragma once

#include <map>

#include "io/mjcf_values.h"
#include "io/notes.h"

namespace avbd::mjcf {

/// Checks an element's attributes against the schema under the name `element`: numbers must be numbers and as many as
/// allowed; what is unknown or not used is noted.
void checkAttributes(const XmlSource& source, Elem elem, std::string_view element, Notes& notes);

class Defaults {
 public:
  explicit Defaults(const XmlSource& source) : source_(source) { classes_.push_back({"main", {}}); }

  /// Reads a <default> of the top level with all those inside.
  void read(Elem top, Notes& notes);

  /// The class of that name, which an attribute of `elem` asks for; refuses an unknown one.
  int find(Elem elem, std::string_view attribute) const;
  static constexpr int kMain = 0;

  /// Attributes of an element: its own before those of its class (its `class` attribute, else `cls`).
  Attributes resolve(Elem elem, std::string_view element, int cls) const;

 private:
  static constexpr size_t kMostClasses = 10000;                            // each holds a copy of what it inherits
  using Settings = std::map<std::string, std::vector<Attr>, std::less<>>;  // by element
  struct Class {
    std::string name;
    Settings settings;
  };

  int open(Elem elem, int parent);
  void readSettings(Elem elem, Class& cls, Notes& notes);

  const XmlSource& source_;
  std::vector<Class> classes_;
  std::map<std::string, int, std::less<>> byName_;  // "main" is kMain where no class has that name
};

}  // namespace avbd::mjcf
