// Acceptance, joints: each type of drive by its speed, the rotation it turns to, and the bound of its force.
#include <algorithm>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/rig.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr float kSpeed = 0.8f;     // [m/s, rad/s]: less than half a turn in the time
constexpr float kRestless = 1e3f;  // a speed that no bounded drive reaches
constexpr float kMost = 4;         // [N, N m]
constexpr double kSeconds = 2;

D6Joint freeAngles() {
  D6Joint def;
  for (size_t i = 3; i < 6; ++i) def.axes[i].motion = AxisMotion::Free;
  return def;
}

/// A drive along one coordinate: of a hinge or slider, of a D6 with one free axis, or a swing or twist of a D6 whose
/// angles are all free, or about one axis of a SLERP drive.
struct DriveKind {
  const char* name;
  enum class On : uint8_t { Hinge, Slider, OneFree, AllAngles, Slerp } on;
  int axis;  ///< JointAxis
  bool linear() const { return axis < 3; }
};
using On = DriveKind::On;
constexpr DriveKind kDrives[] = {
    {"velocity_hinge", On::Hinge, 3}, {"velocity_slider", On::Slider, 0}, {"d6_x", On::OneFree, 0},
    {"d6_y", On::OneFree, 1},         {"d6_z", On::OneFree, 2},           {"twist", On::AllAngles, 3},
    {"swing_y", On::AllAngles, 4},    {"swing_z", On::AllAngles, 5},      {"slerp_x", On::Slerp, 3},
    {"slerp_y", On::Slerp, 4},        {"slerp_z", On::Slerp, 5}};

Vec3 unit(int axis) { return {axis == 0 ? 1.0f : 0, axis == 1 ? 1.0f : 0, axis == 2 ? 1.0f : 0}; }

/// A body of 1 kg, or of 1 kg m^2, on the drive.
Rig rigOf(const Settings& settings, const Placing& placing, const DriveKind& kind, const JointDrive& drive) {
  const Cube cube{.mass = kind.linear() ? 1.0 : 6.0};
  if (kind.on == On::Hinge) return rigOf(settings, placing, HingeJoint{.drive = drive}, cube);
  if (kind.on == On::Slider) return rigOf(settings, placing, SliderJoint{.drive = drive}, cube);
  D6Joint def = kind.on == On::OneFree ? D6Joint{} : freeAngles();
  D6Axis& axis = def.axes[static_cast<size_t>(kind.axis)];
  axis.motion = AxisMotion::Free;
  if (kind.on == On::Slerp) {
    def.slerp = {.stiffness = drive.stiffness,
                 .damping = drive.damping,
                 .velocity = unit(kind.axis - 3) * drive.velocity,
                 .maxForce = drive.maxForce,
                 .acceleration = drive.acceleration};
  } else {
    axis.drive = drive;
  }
  return rigOf(settings, placing, def, cube);
}

/// Of the body along the driven coordinate, from its velocity.
double speedOf(const Rig& rig, const DriveKind& kind) {
  const Velocity v = rig.model.world.velocity(rig.body);
  const Vec3 inFrame = rotate(conjugate(rig.frame), kind.linear() ? v.linear : v.angular);
  return dot(inFrame, unit(kind.axis % 3));
}

double run(Rig rig, const DriveKind& kind) {
  for (int i = 0; i < stepsFor(kSeconds, kDt); ++i) rig.world().step(static_cast<float>(kDt));
  return speedOf(rig, kind);
}

std::vector<Figure> tryDrive(const Settings& settings, const DriveKind& kind, const Placing& placing) {
  const JointDrive speed{.damping = 1e3f, .velocity = kSpeed};
  JointDrive bounded{.damping = 1e3f, .velocity = kRestless, .maxForce = kMost};
  JointDrive perMass = speed;
  perMass.acceleration = true;
  const std::string params = std::string(kind.name) + "," + placing.name;
  const double scale = kMost * kSeconds;
  std::vector<Figure> figures{
      within("speed", run(rigOf(settings, placing, kind, speed), kind), kSpeed, 0.01, "m/s or rad/s", params),
      within("speed_acceleration_drive", run(rigOf(settings, placing, kind, perMass), kind), kSpeed, 0.01,
             "m/s or rad/s", params)};
  // From rest; the inertia is one. A swing must end before half a turn, so it is driven for a shorter time.
  Rig rig = rigOf(settings, placing, kind, bounded);
  const int steps = kind.linear() ? stepsFor(kSeconds, kDt) : stepsFor(kSeconds / 2, kDt);
  for (int i = 0; i < steps; ++i) rig.world().step(static_cast<float>(kDt));
  figures.push_back(within("force_at_bound", speedOf(rig, kind) / (steps * kDt), scale / kSeconds, 0.01, "N or N m",
                           params + ",bound=" + text(kMost)));
  return figures;
}

/// Position drives of all angles at once, given as twist and swing or as a rotation, come to rest at the rotation.
Figure tryTarget(const Settings& settings, const Placing& placing, bool slerp) {
  const double swing = 0.9, twist = 0.6;
  const Vec3 swingAxis{0, 0.6f, 0.8f};
  const Quat target = turned(swingAxis, swing) * turned({1, 0, 0}, twist);
  D6Joint def = freeAngles();
  if (slerp) def.slerp = {.stiffness = 100, .damping = 20, .rotation = target};
  const float angles[3] = {static_cast<float>(twist), static_cast<float>(swing) * swingAxis.y,
                           static_cast<float>(swing) * swingAxis.z};
  for (size_t i = 0; i < 3 && !slerp; ++i)
    def.axes[3 + i].drive = {.stiffness = 100, .damping = 20, .position = angles[i]};
  Rig rig = rigOf(settings, placing, def);
  for (int i = 0; i < stepsFor(5, kDt); ++i) rig.world().step(static_cast<float>(kDt));
  const TwistSwing q = rig.angles();
  const double off = length(Vec3d{q.twist - angles[0], q.y - angles[1], q.z - angles[2]});
  const double whole = length(Vec3d{angles[0], angles[1], angles[2]});
  return atMost("target_missed", off / whole, 0.01, "of the turn",
                std::string(slerp ? "slerp," : "twist_and_swing,") + placing.name);
}

std::vector<Figure> driveTypes(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Placing& placing : kPlacings) {
    for (const DriveKind& kind : kDrives)
      for (Figure& f : tryDrive(settings, kind, placing)) figures.push_back(std::move(f));
    for (const bool slerp : {false, true}) figures.push_back(tryTarget(settings, placing, slerp));
  }
  return figures;
}

}  // namespace

std::vector<Line> driveTypeLines() { return {{"J", "drive_types", driveTypes, ""}}; }

}  // namespace avbd::scenes
