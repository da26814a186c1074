// Acceptance, joints: chains of each type, and the force that a joint reports.
#include <algorithm>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/joint_kinds.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
const Quat kAlongZ = along({0, 0, 1});

/// A chain along x: its joints' frames, and for sliders a stop on either side.
struct Chain {
  JointKind kind;
  Quat frame{};
  float stop = 0;
};

// Revolute: about z. D6: y along z. Cone and universal: along the chain. Prismatic: along the chain, which is then a
// beam, and on slopes of 45 degrees with stops.
const Chain kChains[] = {{JointKind::Fixed},
                         {JointKind::Spherical},
                         {JointKind::Revolute, kAlongZ},
                         {JointKind::Prismatic},
                         {JointKind::Prismatic, turned({0, 0, 1}, -45 * kDegree), 2},
                         {JointKind::D6, turned({1, 0, 0}, 90 * kDegree)},
                         {JointKind::Distance},
                         {JointKind::Rope},
                         {JointKind::Cone},
                         {JointKind::Pulley},
                         {JointKind::Universal}};

Model chainOf(const Settings& settings, const Chain& chain) {
  Build build("types", settings);
  build.filter(kGhost);
  const double span = chain.kind == JointKind::Distance || chain.kind == JointKind::Rope ? 1 : 0, pitch = 4 + span;
  BodyId previous;
  for (int i = 0; i < 5; ++i) {
    const Vec3d a{pitch * i, 0, 0}, b{pitch * i + span, 0, 0};
    const BodyId body = build.box("box_" + std::to_string(i), {2, 0.5f, 0.5f}, {b.x + 2, 0, 0}, 4);
    if (chain.stop > 0)
      build.join(SliderJoint{.limit = {-chain.stop, chain.stop}}, previous, body, {a, chain.frame});
    else
      connect(build, chain.kind, previous, body, {a, b, chain.frame});
    previous = body;
  }
  return build.take();
}

std::vector<Figure> tryChain(const Settings& settings, const Chain& chain) {
  Model model = chainOf(settings, chain);
  const Layout layout = layoutOf(model.world);
  const double scale = 5 * 4 * kGravity * 20;
  double start = NAN, gap = 0, angle = 0, rise = -1;
  for (int i = 0; i < 600; ++i) {
    const std::vector<Motion> before = motionsOf(model.world);
    model.world.step(static_cast<float>(kDt));
    const std::vector<Pose> poses = posesOf(model.world, layout);
    gap = std::max(gap, jointGapMax(layout, poses));
    angle = std::max(angle, jointAngleMax(layout, poses));
    const double now = energyBetween(before, model.world);
    if (i == 0) start = now;
    rise = std::max(rise, (now - start) / scale);
  }
  const std::string params = std::string("type=") + nameOf(chain.kind) + (chain.stop > 0 ? " slope=45" : "");
  // Positions and velocities are rounded to float each step; a millionth of the scale is below anything real.
  return {atMost("gap", gap, 0.0005, "m", params),
          atMost("locked_angle", angle / kDegree, 0.05, "degrees", params),
          {"energy_rise", params, rise, -1, 1e-6, "of m g L"},
          holds("finite", isFinite(model.world), params)};
}

std::vector<Figure> types(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Chain& chain : kChains)
    for (Figure& f : tryChain(settings, chain)) figures.push_back(std::move(f));
  return figures;
}

std::vector<Figure> hold(const Settings& settings, const Holding& how, double dt) {
  Build build("reaction", settings);
  const Vec3d at = how.beside ? Vec3d{1, 0, 0} : Vec3d{0, -1, 0};
  const BodyId box = build.box("box", {0.5f, 0.5f, 0.5f}, at, 4);
  const JointId joint = connect(build, how.kind, {}, box, {{}, spans(how.kind) ? at : Vec3d{}, how.frame});
  Model model = build.take();
  for (int i = 0; i < stepsFor(3, dt); ++i) model.world.step(static_cast<float>(dt));
  const JointReaction r = model.world.reaction(joint);
  // On the world the joint pulls down, but a pulley's rope pulls both its ends up to its wheels.
  const double weight = 4 * kGravity, up = how.kind == JointKind::Pulley ? 1 : -1;
  const double arm = !how.beside ? 0 : how.kind == JointKind::Cone ? std::cos(kConeAngle) : 1;
  const std::string params = std::string("type=") + nameOf(how.kind) + (how.beside ? " hung=beside" : " hung=below") +
                             " rate=" + text(std::round(1 / dt));
  const Vec3d torque = toDouble(r.torque) - Vec3d{0, 0, -weight * arm};
  return {within("force", up * r.force.y, weight, 0.005, "N", params),
          atMost("force_sideways", std::hypot(r.force.x, r.force.z), 0.005 * weight, "N", params),
          atMost("torque_error", length(torque), 0.005 * weight, "N m", params)};
}

std::vector<Figure> reaction(const Settings& settings) {
  std::vector<Figure> figures;
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 120})
    for (const Holding& how : holdings())
      for (Figure& f : hold(settings, how, dt)) figures.push_back(std::move(f));
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
