// Acceptance, joints: chains of each type, and the force that a joint reports.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

JointId fix(Build& build, BodyId a, BodyId b, Vec3d frameA, Vec3d frameB) {
  FixedJoint def;
  def.bodyA = a;
  def.bodyB = b;
  def.frameA.position = frameA;
  def.frameB.position = frameB;
  return build.world().create(def);
}

std::vector<Figure> chainOf(const Settings& settings, JointType type) {
  Build build("types", settings);
  build.filter(kGhost);
  BodyId previous;
  for (int i = 0; i < 5; ++i) {
    const BodyId body = build.box("box_" + std::to_string(i), {2, 0.5f, 0.5f}, {2.0 + 4 * i, 0, 0}, 4);
    if (type == JointType::Ball) build.joint(previous, body, {4.0 * i, 0, 0});
    if (type == JointType::Fixed) fix(build, previous, body, {previous ? 2.0 : 0.0, 0, 0}, {-2, 0, 0});
    previous = body;
  }
  Model model = build.take();
  const Layout layout = layoutOf(model.world);
  const double start = energy(model.world), scale = 5 * 4 * kGravity * 20;
  double gap = 0, angle = 0, rise = -1;
  for (int i = 0; i < 600; ++i) {
    model.world.step(static_cast<float>(kDt));
    gap = std::max(gap, jointGapMax(layout, posesOf(model.world, layout)));
    rise = std::max(rise, (energy(model.world) - start) / scale);
    for (const JointId id : model.world.joints()) angle = std::max(angle, model.world.angleError(id));
  }
  const std::string params = type == JointType::Ball ? "type=ball" : "type=fixed";
  // Positions and velocities are rounded to float each step; a millionth of the scale is below anything real.
  std::vector<Figure> figures{atMost("gap", gap, 0.0005, "m", params),
                              {"energy_rise", params, rise, -1, 1e-6, "of m g L"},
                              holds("finite", isFinite(model.world), params)};
  if (type == JointType::Fixed) figures.push_back(atMost("locked_angle", angle / kDegree, 0.05, "degrees", params));
  return figures;
}

std::vector<Figure> types(const Settings& settings) {
  std::vector<Figure> figures = chainOf(settings, JointType::Ball);
  for (Figure& f : chainOf(settings, JointType::Fixed)) figures.push_back(std::move(f));
  return figures;
}

// A box of 4 kg held from a world point: below it, or one metre beside it, where a fixed joint carries a torque.
std::vector<Figure> hold(const Settings& settings, JointType type, bool beside, double dt) {
  Build build("reaction", settings);
  const BodyId box = build.box("box", {0.5f, 0.5f, 0.5f}, beside ? Vec3d{1, 0, 0} : Vec3d{0, -1, 0}, 4);
  const JointId joint = type == JointType::Ball ? build.joint({}, box, {0, 0, 0})
                                                : fix(build, {}, box, {}, beside ? Vec3d{-1, 0, 0} : Vec3d{0, 1, 0});
  Model model = build.take();
  for (int i = 0; i < stepsFor(3, dt); ++i) model.world.step(static_cast<float>(dt));
  const JointReaction r = model.world.reaction(joint);
  const double weight = 4 * kGravity;
  const std::string params = std::string("type=") + (type == JointType::Ball ? "ball" : "fixed") +
                             (beside ? " hung=beside" : " hung=below") + " rate=" + text(std::round(1 / dt));
  const Vec3d torque = toDouble(r.torque) - Vec3d{0, 0, beside ? -weight : 0};
  return {within("force", -r.force.y, weight, 0.005, "N", params),
          atMost("force_sideways", std::hypot(r.force.x, r.force.z), 0.005 * weight, "N", params),
          atMost("torque_error", length(torque), 0.005 * weight, "N m", params)};
}

std::vector<Figure> reaction(const Settings& settings) {
  std::vector<Figure> figures;
  const auto take = [&](std::vector<Figure> list) { figures.insert(figures.end(), list.begin(), list.end()); };
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 120}) {
    take(hold(settings, JointType::Ball, false, dt));
    take(hold(settings, JointType::Fixed, false, dt));
    take(hold(settings, JointType::Fixed, true, dt));
  }
  return figures;
}

}  // namespace

std::vector<Line> jointLines() {
  return {
      {"J", "types", types, ""},
      {"J", "reaction", reaction, ""},
  };
}

}  // namespace avbd::scenes
