// Acceptance, joints: drives against the equation they stand for, and motors with a bounded torque.
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/rig.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kStep = 1.0 / 240;

/// One coordinate to be driven: of a body of this mass (slider) or this moment of inertia about the axis (hinge).
struct Driven {
  bool hinge;
  double inertia;
  JointDrive drive;
};

Rig driveRig(const Settings& settings, const Driven& driven, const Placing& placing) {
  if (driven.hinge) return rigOf(settings, placing, HingeJoint{.drive = driven.drive}, {.mass = 6 * driven.inertia});
  return rigOf(settings, placing, SliderJoint{.drive = driven.drive}, {.mass = driven.inertia});
}

std::string paramsOf(const Driven& driven, const Placing& placing) {
  return std::string(driven.hinge ? "hinge," : "slider,") + placing.name + ",inertia=" + text(driven.inertia);
}

/// Over five seconds, until it rests, of inertia q'' = k (1 - q) - d q' from rest: the largest difference from implicit
/// Euler's solution, and the root of the mean square of that from the exact one. (Implicit Euler's own largest
/// difference from the exact one is 0.13 here: it damps by k h / 2 m.)
struct Response {
  double fromEuler = 0, fromExact = 0, end = 0, afterOne = 0;
};

Response respond(const Settings& settings, const Driven& driven, const Placing& placing, double k, double d) {
  Rig rig = driveRig(settings, driven, placing);
  const double m = driven.inertia, h = kStep, decay = d / (2 * m), omega = std::sqrt(k / m - decay * decay);
  double q = 0, v = 0, squares = 0;
  Response response;
  const int steps = stepsFor(5, kStep);
  for (int i = 1; i <= steps; ++i) {
    rig.model.world.step(static_cast<float>(kStep));
    v = (m * v + h * k * (1 - q)) / (m + h * d + h * h * k);
    q += h * v;
    const double t = i * h;
    const double exact = 1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    response.end = rig.model.world.coordinate(rig.joint).position;
    response.fromEuler = std::max(response.fromEuler, std::abs(response.end - q));
    squares += (response.end - exact) * (response.end - exact);
    if (i == stepsFor(1, kStep)) response.afterOne = response.end;
  }
  response.fromExact = std::sqrt(squares / steps);
  return response;
}

std::vector<Figure> driveForce(const Settings& settings) {
  std::vector<Figure> figures;
  for (const bool hinge : {false, true})
    for (const Placing& placing : kPlacings) {
      const float k = hinge ? 100 : 400, d = hinge ? 2 : 4;
      const Driven driven{hinge, 1, {.stiffness = k, .damping = d, .position = 1}};
      const Response r = respond(settings, driven, placing, k, d);
      figures.push_back(atMost("from_implicit_euler", r.fromEuler, 0.01, "of the step", paramsOf(driven, placing)));
      figures.push_back(atMost("from_exact", r.fromExact, 0.05, "of the step", paramsOf(driven, placing)));
    }
  return figures;
}

std::vector<Figure> driveAccel(const Settings& settings) {
  std::vector<Figure> figures;
  for (const bool hinge : {false, true})
    for (const Placing& placing : kPlacings) {
      const JointDrive drive{.stiffness = 100, .damping = 2, .position = 1, .acceleration = true};
      const Driven light{hinge, 0.1, drive}, heavy{hinge, 100, drive};
      const double a = respond(settings, light, placing, 10, 0.2).afterOne;
      const double b = respond(settings, heavy, placing, 1e4, 200).afterOne;
      figures.push_back(within("equal_motion", a, b, 0.01, "m or rad", paramsOf(light, placing)));
    }
  return figures;
}

/// A hinge motor between two free bodies, or against a torque that it cannot overcome.
std::vector<Figure> motor(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Placing& placing : kPlacings)
    for (const float most : {100.0f, 4.0f}) {
      Driven driven{true, 1, {.damping = 1e4f, .velocity = 1, .maxForce = most}};
      Rig rig = driveRig(settings, driven, placing);
      const Vec3 axis = rotate(placing.frame(), Vec3{1, 0, 0});
      for (int i = 0; i < 120; ++i) {
        rig.model.world.addTorque(rig.body, axis * -5.0f);  // [N m]: between the two limits
        rig.model.world.step(static_cast<float>(kDt));
      }
      const double speed = rig.model.world.coordinate(rig.joint).velocity;
      const std::string params = std::string(placing.name) + ",limit=" + text(most);
      if (most > 5) {
        figures.push_back(within("speed", speed, 1, 0.005, "rad/s", params));
      } else {
        figures.push_back(within("stalled_acceleration", speed / 2, -(5.0 - most), 0.01, "rad/s^2", params));
      }
    }
  return figures;
}

/// Equal and opposite: the pair of bodies keeps its momentum.
std::vector<Figure> motorMomentum(const Settings& settings) {
  WorldDef def;
  def.gravity = {};
  Build build("motor", settings, def);
  build.filter(kGhost);
  const BodyId a = build.box("a", {0.5f, 0.5f, 0.5f}, {-0.5, 0, 0}, 1),
               b = build.box("b", {0.5f, 0.5f, 0.5f}, {0.5, 0, 0}, 2);
  build.world().create(HingeJoint{.bodyA = a,
                                  .bodyB = b,
                                  .frameA = {{0.5, 0, 0}},
                                  .frameB = {{-0.5, 0, 0}},
                                  .drive = {.damping = 100, .velocity = 1}});
  Model model = build.take();
  for (int i = 0; i < 120; ++i) model.world.step(static_cast<float>(kDt));
  const double scale = 1.0 / 6;  // of one body at 1 rad/s
  const JointId joint = model.world.joints()[0];
  return {atMost("momentum", length(model.world.angularMomentum()) / scale, 1e-4, "of one body's"),
          within("speed_between", model.world.coordinate(joint).velocity, 1, 0.005, "rad/s")};
}

std::vector<Figure> motors(const Settings& settings) {
  std::vector<Figure> figures = motor(settings);
  for (Figure& f : motorMomentum(settings)) figures.push_back(std::move(f));
  return figures;
}

}  // namespace

std::vector<Line> driveLines() {
  return {{"J", "drive_force", driveForce, ""}, {"J", "drive_accel", driveAccel, ""}, {"J", "motor", motors, ""}};
}

}  // namespace avbd::scenes
