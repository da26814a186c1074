// All scenes and all lines of acceptance, in the order in which they are listed.
#include "scenes/catalogue.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenes/large.h"

namespace avbd::scenes {
namespace {

void append(std::vector<Scene>& to, std::vector<Scene> from) {
  for (Scene& s : from) to.push_back(std::move(s));
}

// The order of the lists in the acceptance document; names say what a run prints.
constexpr std::array<std::string_view, 87> kOrder{"rest",
                                                  "tower10",
                                                  "pyramid10",
                                                  "pyramid30",
                                                  "bricks",
                                                  "pile",
                                                  "heavy_on_light",
                                                  "doubling",
                                                  "tonnes",
                                                  "card_house",
                                                  "arch",
                                                  "slide",
                                                  "slide_diagonal",
                                                  "slope_hold",
                                                  "slope_slip",
                                                  "stack_slide",
                                                  "static_dynamic",
                                                  "roll",
                                                  "bounce",
                                                  "spin_free",
                                                  "dzhanibekov",
                                                  "fall_together",
                                                  "momentum",
                                                  "scale_mass",
                                                  "scale_length",
                                                  "step_size",
                                                  "deep_overlap",
                                                  "ghost_edges",
                                                  "bullet",
                                                  "bullet_chain",
                                                  "million_to_one",
                                                  "chain",
                                                  "net",
                                                  "chainmail",
                                                  "hanging",
                                                  "types",
                                                  "reaction",
                                                  "limits",
                                                  "drive_force",
                                                  "drive_accel",
                                                  "drive_types",
                                                  "motor",
                                                  "gear",
                                                  "rack",
                                                  "mimic",
                                                  "custom",
                                                  "break",
                                                  "pendulum",
                                                  "double_pendulum",
                                                  "fixed_base",
                                                  "chain100",
                                                  "mass_tree",
                                                  "limits_both",
                                                  "drives",
                                                  "joint_friction",
                                                  "armature",
                                                  "max_velocity",
                                                  "floating",
                                                  "mirror",
                                                  "loop",
                                                  "scissor",
                                                  "scissor_heavy",
                                                  "scissor_floor",
                                                  "inverse_dynamics",
                                                  "robots",
                                                  "ragdolls",
                                                  "free_fall",
                                                  "soft_spin",
                                                  "bar",
                                                  "cantilever",
                                                  "poisson",
                                                  "independence",
                                                  "drape",
                                                  "curtain",
                                                  "stack_soft",
                                                  "self",
                                                  "inverted",
                                                  "attach",
                                                  "mixed",
                                                  "same_bits",
                                                  "rollback",
                                                  "unrelated",
                                                  "churn",
                                                  "bad_input",
                                                  "no_allocation",
                                                  "asleep",
                                                  "soak"};

std::vector<Line> collect() {
  std::vector<Line> list;
  for (const auto group : {restLines,
                           frictionLines,
                           motionLines,
                           collisionLines,
                           shapeLines,
                           scaleLines,
                           jointLines,
                           limitLines,
                           driveLines,
                           driveTypeLines,
                           couplingLines,
                           customLines,
                           breakLines,
                           mechanismLines,
                           treeLines,
                           treeDriveLines,
                           loopLines,
                           scissorLines,
                           inverseDynamicsLines,
                           ragdollLines,
                           stateLines,
                           badInputLines,
                           skippedLines,
                           continuousLines,
                           rollbackLines,
                           sleepLines,
                           softLines,
                           clothLines,
                           selfLines,
                           mixedLines,
                           closedLines})
    for (Line& line : group()) list.push_back(std::move(line));
  const auto rank = [](const Line& line) {
    return std::find(kOrder.begin(), kOrder.end(), line.name) - kOrder.begin();
  };
  std::stable_sort(list.begin(), list.end(), [&](const Line& a, const Line& b) { return rank(a) < rank(b); });
  return list;
}

}  // namespace

const std::vector<Scene>& all() {
  static const std::vector<Scene> scenes = [] {
    std::vector<Scene> list;
    append(list, pileScenes());
    append(list, chainScenes());
    append(list, stackScenes());
    append(list, netScenes());
    append(list, softScenes());
    append(list, mixedScenes());
    list.push_back(softTorusScene());
    append(list, scissorScenes());
    append(list, ragdollScenes());
    append(list, sleeperScenes());
    return list;
  }();
  return scenes;
}

const std::vector<Scene>& large() {
  static const std::vector<Scene> scenes = [] {
    std::vector<Scene> list = crowdScenes();
    list.push_back(manyRagdolls());
    append(list, slabScenes());
    return list;
  }();
  return scenes;
}

const std::vector<Line>& lines() {
  static const std::vector<Line> list = collect();
  return list;
}

const Scene* find(std::string_view name) {
  for (const Scene& s : all())
    if (s.name == name || (!s.alias.empty() && s.alias == name)) return &s;
  for (const Scene& s : large())
    if (s.name == name) return &s;
  return nullptr;
}

const Line* findLine(std::string_view name) {
  for (const Line& line : lines())
    if (line.name == name) return &line;
  return nullptr;
}

}  // namespace avbd::scenes
