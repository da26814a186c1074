// Which attributes MJCF elements have and what becomes of each.
#pragma once

#include <span>
#include <string_view>

namespace avbd::mjcf {

enum class Use {
  Read,         ///< means something to us
  Silent,       ///< drawing, files of others, speed: changes no motion
  Noted,        ///< changes motion in MuJoCo and is not used here
  NotedUnless0  ///< the same, but says nothing where all its numbers are 0
};

/// One attribute. most = 0: text, checked where it is read.
struct AttributeRule {
  std::string_view element, name;
  int least, most;  ///< how many numbers
  Use use;
};

/// Elements that share their attributes and one default: "actuator" for a motor, "equality" for a weld, "tendon" for a
/// fixed one; all others are their own.
std::string_view familyOf(std::string_view element);

/// Those of flexes and composites, whose children go by their own names here.
std::span<const AttributeRule> softRules();

/// Rule of an attribute; null where MJCF has none of that name.
const AttributeRule* findRule(std::string_view element, std::string_view attribute);

enum class Section { Read, Silent, Noted, Unknown };
/// What becomes of an element under `parent` ("mujoco", "body", "contact", "actuator", ...).
Section sectionOf(std::string_view parent, std::string_view element);

}  // namespace avbd::mjcf
