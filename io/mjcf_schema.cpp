// The tables of MJCF's elements and attributes.
#include "io/mjcf_schema.h"

#include <algorithm>
#include <iterator>

namespace avbd::mjcf {

namespace {

constexpr Use R = Use::Read, S = Use::Silent, N = Use::Noted, Z = Use::NotedUnless0;
constexpr int kMany = 1 << 28;

// Orientation and position are the same in every element that has them: element "*".
constexpr AttributeRule kRules[] = {
    {"*", "pos", 3, 3, R},
    {"*", "quat", 4, 4, R},
    {"*", "axisangle", 4, 4, R},
    {"*", "euler", 3, 3, R},
    {"*", "xyaxes", 6, 6, R},
    {"*", "zaxis", 3, 3, R},

    {"mujoco", "model", 0, 0, R},

    {"compiler", "angle", 0, 0, R},
    {"compiler", "coordinate", 0, 0, R},
    {"compiler", "eulerseq", 0, 0, R},
    {"compiler", "inertiafromgeom", 0, 0, R},
    {"compiler", "inertiagrouprange", 2, 2, R},
    {"compiler", "boundmass", 1, 1, R},
    {"compiler", "boundinertia", 1, 1, R},
    {"compiler", "balanceinertia", 0, 0, R},
    {"compiler", "settotalmass", 1, 1, R},
    {"compiler", "autolimits", 0, 0, S},
    {"compiler", "strippath", 0, 0, R},
    {"compiler", "fitaabb", 0, 0, R},
    {"compiler", "meshdir", 0, 0, R},
    {"compiler", "texturedir", 0, 0, S},
    {"compiler", "assetdir", 0, 0, R},
    {"compiler", "discardvisual", 0, 0, S},
    {"compiler", "convexhull", 0, 0, S},
    {"compiler", "usethread", 0, 0, S},
    {"compiler", "fusestatic", 0, 0, S},
    {"compiler", "exactmeshinertia", 0, 0, R},
    {"compiler", "saveinertial", 0, 0, S},
    {"compiler", "alignfree", 0, 0, S},

    {"option", "timestep", 1, 1, R},
    {"option", "gravity", 3, 3, R},
    {"option", "collision", 0, 0, R},
    {"option", "wind", 3, 3, Z},
    {"option", "magnetic", 3, 3, Z},
    {"option", "density", 1, 1, Z},
    {"option", "viscosity", 1, 1, Z},
    {"option", "apirate", 1, 1, S},
    {"option", "impratio", 1, 1, N},
    {"option", "tolerance", 1, 1, N},
    {"option", "ls_tolerance", 1, 1, N},
    {"option", "noslip_tolerance", 1, 1, N},
    {"option", "mpr_tolerance", 1, 1, N},
    {"option", "ccd_tolerance", 1, 1, N},
    {"option", "o_margin", 1, 1, N},
    {"option", "o_solref", 1, 2, N},
    {"option", "o_solimp", 1, 5, N},
    {"option", "o_friction", 1, 5, N},
    {"option", "integrator", 0, 0, N},
    {"option", "cone", 0, 0, N},
    {"option", "jacobian", 0, 0, N},
    {"option", "solver", 0, 0, N},
    {"option", "iterations", 1, 1, N},
    {"option", "ls_iterations", 1, 1, N},
    {"option", "noslip_iterations", 1, 1, N},
    {"option", "mpr_iterations", 1, 1, N},
    {"option", "ccd_iterations", 1, 1, N},
    {"option", "sdf_iterations", 1, 1, N},
    {"option", "sdf_initpoints", 1, 1, N},
    {"option", "actuatorgroupdisable", 0, kMany, N},

    {"flag", "constraint", 0, 0, R},
    {"flag", "contact", 0, 0, R},
    {"flag", "equality", 0, 0, R},
    {"flag", "gravity", 0, 0, R},
    {"flag", "filterparent", 0, 0, R},
    {"flag", "frictionloss", 0, 0, S},
    {"flag", "limit", 0, 0, S},
    {"flag", "passive", 0, 0, S},
    {"flag", "spring", 0, 0, S},
    {"flag", "damper", 0, 0, S},
    {"flag", "clampctrl", 0, 0, S},
    {"flag", "warmstart", 0, 0, S},
    {"flag", "actuation", 0, 0, S},
    {"flag", "refsafe", 0, 0, S},
    {"flag", "sensor", 0, 0, S},
    {"flag", "midphase", 0, 0, S},
    {"flag", "nativeccd", 0, 0, S},
    {"flag", "eulerdamp", 0, 0, S},
    {"flag", "autoreset", 0, 0, S},
    {"flag", "override", 0, 0, N},
    {"flag", "energy", 0, 0, S},
    {"flag", "fwdinv", 0, 0, S},
    {"flag", "invdiscrete", 0, 0, S},
    {"flag", "sensornoise", 0, 0, S},
    {"flag", "multiccd", 0, 0, S},
    {"flag", "island", 0, 0, S},
    {"flag", "sleep", 0, 0, S},

    {"default", "class", 0, 0, R},

    {"mesh", "name", 0, 0, R},
    {"mesh", "class", 0, 0, R},
    {"mesh", "file", 0, 0, R},
    {"mesh", "content_type", 0, 0, R},
    {"mesh", "vertex", 0, kMany, R},
    {"mesh", "face", 0, kMany, R},
    {"mesh", "scale", 3, 3, R},
    {"mesh", "refpos", 3, 3, R},
    {"mesh", "refquat", 4, 4, R},
    {"mesh", "inertia", 0, 0, R},
    {"mesh", "maxhullvert", 1, 1, R},
    {"mesh", "normal", 0, kMany, S},
    {"mesh", "texcoord", 0, kMany, S},
    {"mesh", "smoothnormal", 0, 0, S},
    {"mesh", "material", 0, 0, S},
    {"mesh", "builtin", 0, 0, N},
    {"mesh", "params", 0, kMany, S},
    {"hfield", "name", 0, 0, R},
    {"hfield", "file", 0, 0, R},
    {"hfield", "content_type", 0, 0, R},
    {"hfield", "nrow", 1, 1, R},
    {"hfield", "ncol", 1, 1, R},
    {"hfield", "elevation", 0, kMany, R},
    {"hfield", "size", 4, 4, R},

    {"worldbody", "name", 0, 0, S},
    {"worldbody", "childclass", 0, 0, R},
    {"body", "name", 0, 0, R},
    {"body", "childclass", 0, 0, R},
    {"body", "mocap", 0, 0, R},
    {"body", "gravcomp", 1, 1, R},
    {"body", "user", 0, kMany, S},
    {"body", "sleep", 0, 0, S},
    {"frame", "name", 0, 0, S},
    {"frame", "childclass", 0, 0, R},

    {"inertial", "mass", 1, 1, R},
    {"inertial", "diaginertia", 3, 3, R},
    {"inertial", "fullinertia", 6, 6, R},

    {"freejoint", "name", 0, 0, R},
    {"freejoint", "group", 1, 1, S},
    {"freejoint", "align", 0, 0, S},
    {"joint", "name", 0, 0, R},
    {"joint", "class", 0, 0, R},
    {"joint", "type", 0, 0, R},
    {"joint", "axis", 3, 3, R},
    {"joint", "ref", 1, 1, R},
    {"joint", "range", 2, 2, R},
    {"joint", "limited", 0, 0, R},
    {"joint", "stiffness", 1, 3, R},
    {"joint", "damping", 1, 3, R},
    {"joint", "springdamper", 2, 2, R},
    {"joint", "frictionloss", 1, 1, R},
    {"joint", "armature", 1, 1, R},
    {"joint", "group", 1, 1, S},
    {"joint", "springref", 1, 1, S},
    {"joint", "margin", 1, 1, S},
    {"joint", "user", 0, kMany, S},
    {"joint", "solreflimit", 1, 2, S},
    {"joint", "solimplimit", 1, 5, S},
    {"joint", "solreffriction", 1, 2, S},
    {"joint", "solimpfriction", 1, 5, S},
    {"joint", "actuatorfrcrange", 2, 2, S},
    {"joint", "actuatorfrclimited", 0, 0, S},
    {"joint", "actuatorgravcomp", 0, 0, S},

    {"geom", "name", 0, 0, R},
    {"geom", "class", 0, 0, R},
    {"geom", "type", 0, 0, R},
    {"geom", "size", 1, 3, R},
    {"geom", "fromto", 6, 6, R},
    {"geom", "mass", 1, 1, R},
    {"geom", "density", 1, 1, R},
    {"geom", "shellinertia", 0, 0, R},
    {"geom", "friction", 1, 3, R},
    {"geom", "condim", 1, 1, R},
    {"geom", "priority", 1, 1, R},
    {"geom", "contype", 1, 1, R},
    {"geom", "conaffinity", 1, 1, R},
    {"geom", "group", 1, 1, R},
    {"geom", "mesh", 0, 0, R},
    {"geom", "hfield", 0, 0, R},
    {"geom", "material", 0, 0, R},
    {"geom", "margin", 1, 1, Z},
    {"geom", "gap", 1, 1, Z},
    {"geom", "solref", 1, 2, N},
    {"geom", "solimp", 1, 5, N},
    {"geom", "solmix", 1, 1, S},
    {"geom", "fluidshape", 0, 0, S},
    {"geom", "fluidcoef", 1, 5, S},
    {"geom", "rgba", 4, 4, S},
    {"geom", "fitscale", 1, 1, R},
    {"geom", "user", 0, kMany, S},

    {"exclude", "name", 0, 0, R},
    {"exclude", "body1", 0, 0, R},
    {"exclude", "body2", 0, 0, R},
    {"pair", "name", 0, 0, R},
    {"pair", "class", 0, 0, R},
    {"pair", "geom1", 0, 0, R},
    {"pair", "geom2", 0, 0, R},
    {"pair", "condim", 1, 1, R},
    {"pair", "friction", 1, 5, R},
    {"pair", "solref", 1, 2, N},
    {"pair", "solreffriction", 1, 2, N},
    {"pair", "solimp", 1, 5, N},
    {"pair", "margin", 1, 1, Z},
    {"pair", "gap", 1, 1, Z},

    {"equality", "name", 0, 0, R},
    {"equality", "class", 0, 0, R},
    {"equality", "active", 0, 0, R},
    {"equality", "solref", 1, 2, N},
    {"equality", "solimp", 1, 5, N},
    {"equality", "body1", 0, 0, R},
    {"equality", "body2", 0, 0, R},
    {"equality", "anchor", 3, 3, R},
    {"equality", "relpose", 7, 7, R},
    {"equality", "site1", 0, 0, R},
    {"equality", "site2", 0, 0, R},
    {"equality", "torquescale", 1, 1, N},

    {"key", "name", 0, 0, R},
    {"key", "time", 1, 1, S},
    {"key", "qpos", 0, kMany, R},
    {"key", "qvel", 0, kMany, R},
    {"key", "act", 0, kMany, S},
    {"key", "ctrl", 0, kMany, S},
    {"key", "mpos", 0, kMany, N},
    {"key", "mquat", 0, kMany, N},
};

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
    {"mujoco", "sensor", Section::Noted},
    {"mujoco", "actuator", Section::Noted},
    {"mujoco", "tendon", Section::Noted},
    {"mujoco", "deformable", Section::Noted},
    {"mujoco", "extension", Section::Noted},

    {"asset", "mesh", Section::Read},
    {"asset", "hfield", Section::Read},
    {"asset", "texture", Section::Noted},
    {"asset", "material", Section::Noted},
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
    {"body", "site", Section::Silent},
    {"body", "camera", Section::Silent},
    {"body", "light", Section::Silent},
    {"body", "composite", Section::Noted},
    {"body", "flexcomp", Section::Noted},
    {"body", "attach", Section::Noted},
    {"body", "replicate", Section::Noted},
    {"body", "plugin", Section::Noted},

    {"default", "geom", Section::Read},
    {"default", "joint", Section::Read},
    {"default", "pair", Section::Read},
    {"default", "equality", Section::Read},
    {"default", "default", Section::Read},
    {"default", "mesh", Section::Read},
    {"default", "material", Section::Silent},
    {"default", "site", Section::Silent},
    {"default", "camera", Section::Silent},
    {"default", "light", Section::Silent},
    {"default", "tendon", Section::Silent},
    {"default", "general", Section::Silent},
    {"default", "motor", Section::Silent},
    {"default", "position", Section::Silent},
    {"default", "velocity", Section::Silent},
    {"default", "intvelocity", Section::Silent},
    {"default", "damper", Section::Silent},
    {"default", "cylinder", Section::Silent},
    {"default", "muscle", Section::Silent},
    {"default", "adhesion", Section::Silent},

    {"contact", "exclude", Section::Read},
    {"contact", "pair", Section::Read},
    {"equality", "connect", Section::Read},
    {"equality", "weld", Section::Read},
    {"equality", "joint", Section::Noted},
    {"equality", "tendon", Section::Noted},
    {"equality", "distance", Section::Noted},
    {"equality", "flex", Section::Noted},
    {"keyframe", "key", Section::Read},
};

// A pose is written at these elements only.
bool hasPose(std::string_view element, std::string_view attribute) {
  if (element == "body" || element == "geom" || element == "frame" || element == "inertial") return true;
  return element == "joint" && attribute == "pos";
}

}  // namespace

const AttributeRule* findRule(std::string_view element, std::string_view attribute) {
  if (element == "connect" || element == "weld") element = "equality";
  const auto matches = [&](const AttributeRule& rule) {
    return rule.name == attribute && (rule.element == element || (rule.element == "*" && hasPose(element, attribute)));
  };
  const auto it = std::find_if(std::begin(kRules), std::end(kRules), matches);
  return it == std::end(kRules) ? nullptr : &*it;
}

Section sectionOf(std::string_view parent, std::string_view element) {
  if (parent == "worldbody" || parent == "frame") parent = "body";
  for (const SectionRule& rule : kSections) {
    if (rule.parent == parent && rule.element == element) return rule.section;
  }
  return Section::Unknown;
}

}  // namespace avbd::mjcf
