// The table of MJCF's elements.
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

struct SectionRule {
  std::string_view parent, element;
  Section section;
};

constexpr SectionRule kSections[] = {
    {"mujoco", "compiler", Section::Read},
    {"mujoco", "option", Section::Read},
    {"mujoco", "default", Section::Read},
    {"mujoco", "worldbody", Section::Read},
    {"mujoco", "contact", Section::Read},
    {"mujoco", "equality", Section::Read},
    {"mujoco", "keyframe", Section::Read},
    {"mujoco", "asset", Section::Read},
    {"mujoco", "size", Section::Silent},
    {"mujoco", "visual", Section::Silent},
    {"mujoco", "statistic", Section::Silent},
    {"mujoco", "custom", Section::Silent},
    {"mujoco", "sensor", Section::Read},
    {"mujoco", "actuator", Section::Read},
    {"mujoco", "tendon", Section::Read},
    {"mujoco", "deformable", Section::Read},
    {"mujoco", "extension", Section::Noted},

    {"asset", "mesh", Section::Read},
    {"asset", "hfield", Section::Read},
    {"asset", "texture", Section::Noted},
    {"asset", "material", Section::Read},
    {"asset", "skin", Section::Noted},
    {"asset", "model", Section::Noted},

    {"compiler", "lengthrange", Section::Silent},
    {"option", "flag", Section::Read},

    {"body", "inertial", Section::Read},
    {"body", "joint", Section::Read},
    {"body", "freejoint", Section::Read},
    {"body", "geom", Section::Read},
    {"body", "body", Section::Read},
    {"body", "frame", Section::Read},
    {"body", "site", Section::Read},
    {"body", "camera", Section::Silent},
    {"body", "light", Section::Silent},
    {"body", "composite", Section::Read},
    {"body", "flexcomp", Section::Read},
    {"body", "attach", Section::Noted},
    {"body", "replicate", Section::Noted},
    {"body", "plugin", Section::Noted},

    {"default", "geom", Section::Read},
    {"default", "joint", Section::Read},
    {"default", "pair", Section::Read},
    {"default", "equality", Section::Read},
    {"default", "default", Section::Read},
    {"default", "mesh", Section::Read},
    {"default", "material", Section::Read},
    {"default", "site", Section::Read},
    {"default", "camera", Section::Silent},
    {"default", "light", Section::Silent},
    {"default", "tendon", Section::Read},
    {"default", "general", Section::Read},
    {"default", "motor", Section::Read},
    {"default", "position", Section::Read},
    {"default", "velocity", Section::Read},
    {"default", "intvelocity", Section::Read},
    {"default", "damper", Section::Read},
    {"default", "cylinder", Section::Read},
    {"default", "muscle", Section::Read},
    {"default", "adhesion", Section::Read},

    {"contact", "exclude", Section::Read},
    {"contact", "pair", Section::Read},
    {"equality", "connect", Section::Read},
    {"equality", "weld", Section::Read},
    {"equality", "joint", Section::Read},
    {"equality", "tendon", Section::Read},
    {"equality", "distance", Section::Read},
    {"equality", "flex", Section::Read},
    {"equality", "flexvert", Section::Read},
    {"equality", "flexstrain", Section::Read},
    {"deformable", "flex", Section::Read},
    {"deformable", "skin", Section::Noted},
    {"flex", "edge", Section::Read},
    {"flex", "elasticity", Section::Read},
    {"flex", "contact", Section::Read},
    {"flex", "pin", Section::Read},
    {"flex", "plugin", Section::Read},
    {"composite", "joint", Section::Read},
    {"composite", "geom", Section::Read},
    {"composite", "pin", Section::Read},
    {"composite", "tendon", Section::Read},
    {"composite", "skin", Section::Silent},
    {"composite", "site", Section::Silent},
    {"composite", "plugin", Section::Noted},
    {"keyframe", "key", Section::Read},
    {"tendon", "fixed", Section::Read},
    {"tendon", "spatial", Section::Read},
    {"fixed", "joint", Section::Read},
    {"spatial", "site", Section::Read},
    {"spatial", "geom", Section::Read},
    {"spatial", "pulley", Section::Read},
    {"actuator", "general", Section::Read},
    {"actuator", "motor", Section::Read},
    {"actuator", "position", Section::Read},
    {"actuator", "velocity", Section::Read},
    {"actuator", "intvelocity", Section::Read},
    {"actuator", "damper", Section::Read},
    {"actuator", "cylinder", Section::Read},
    {"actuator", "muscle", Section::Read},
    {"actuator", "adhesion", Section::Read},
    {"actuator", "plugin", Section::Read},
};

}  // namespace

Section sectionOf(std::string_view parent, std::string_view element) {
  if (parent == "worldbody" || parent == "frame") parent = "body";
  for (const SectionRule& rule : kSections) {
    if (rule.parent == parent && rule.element == element) return rule.section;
  }
  return Section::Unknown;
}

}  // namespace avbd::mjcf
