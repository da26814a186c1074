// Acceptance, joints: each type breaks at its threshold, not by one step's spike, and an event says so.
#include <algorithm>

#include "scenes/catalogue.h"
#include "scenes/joint_kinds.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr float kThreshold = 100;           // [N, N m]
constexpr float kRamp = 20;                 // a second
constexpr double kSpikeAt = 4, kSpike = 3;  // [s], times the threshold, for one step

struct Broken {
  double at = 0;  ///< load at which it broke
  bool bySpike = false, told = false;
};

bool lists(const World& world, JointId joint) {
  const std::vector<BreakEvent>& breaks = world.events().breaks;
  return std::any_of(breaks.begin(), breaks.end(), [&](const BreakEvent& e) { return e.joint == joint; });
}

Broken breakIt(World& world, BodyId box, JointId joint, bool torque) {
  Broken result;
  const int spike = stepsFor(kSpikeAt, kDt);
  for (int i = 0; i < stepsFor(8, kDt); ++i) {
    const double load = i == spike ? kSpike * kThreshold : kRamp * i * kDt;
    const float f = static_cast<float>(-load);
    if (torque)
      world.addTorque(box, {0, 0, f});
    else
      world.addForce(box, {0, f, 0});
    world.step(static_cast<float>(kDt));
    if (!lists(world, joint) && world.isEnabled(joint)) continue;
    result.at = kRamp * i * kDt;
    result.bySpike = i >= spike && i < spike + 10;
    result.told = lists(world, joint) && !world.isEnabled(joint);
    break;
  }
  return result;
}

std::vector<Figure> tryBreak(const Settings& settings, const Holding& load) {
  WorldDef def;
  def.gravity = {};
  Build build("break", settings, def);
  build.filter(kGhost);
  const Vec3d at = load.beside ? Vec3d{1, 0, 0} : Vec3d{0, -1, 0};
  const BodyId box = build.box("box", {0.5f, 0.5f, 0.5f}, at, 4);
  const JointId joint = connect(build, load.kind, {}, box, {{}, spans(load.kind) ? at : Vec3d{}, load.frame});
  JointBreak limits;
  (load.beside ? limits.torque : limits.force) = kThreshold;
  build.world().setBreakLimits(joint, limits);
  const Broken broken = breakIt(build.world(), box, joint, load.beside);
  const std::string params = std::string("type=") + nameOf(load.kind) + (load.beside ? " by=torque" : " by=force");
  return {within("breaks_at", broken.at, kThreshold, 0.03, load.beside ? "N m" : "N", params),
          holds("bears_a_spike", !broken.bySpike, params + " spike=" + text(kSpike * kThreshold)),
          holds("event", broken.told, params)};
}

std::vector<Figure> breaks(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Holding& load : holdings())
    for (Figure& f : tryBreak(settings, load)) figures.push_back(std::move(f));
  return figures;
}

}  // namespace

std::vector<Line> breakLines() { return {{"J", "break", breaks, ""}}; }

}  // namespace avbd::scenes
