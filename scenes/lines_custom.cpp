// Acceptance, joints: a family of the user's own, a point on a helix.
#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A point of bodies[1] on a helix about the z axis of bodies[0]: x = R cos q, y = R sin q, z = P q.
/// C0 = hypot(x, y) - R and C1 = (z - P q) R / hypot(R, P), q the angle of (x, y) counted over full turns; J is
/// exact where the step starts. C1 is the distance along the helix's binormal, to first order.
/// Constants: R, P [m, m/rad], the point in bodies[1]'s frame (3), the bound of either row's force [N], 0 for none.
/// Memory: the angle counted so far.
class Helix final : public CustomFamily {
 public:
  std::string name() const override { return "helix"; }
  int rowCount() const override { return 2; }

  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody> start, float,
                std::span<const float> constants, std::span<const float> memory,
                std::span<CustomRow> rows) const override {
    const double radius = constants[0], pitch = constants[1], scale = radius / std::hypot(radius, pitch);
    const Place end = placeOf(now, constants, memory[0]), at = placeOf(start, constants, memory[0]);
    rows[0].C = end.r - radius;
    rows[1].C = (end.z - pitch * end.angle) * scale;
    // J where the step starts: so the rows keep energy and angular momentum.
    const Quat turn = start[0].pose.rotation;
    const Vec3d outwards{at.x / at.r, at.y / at.r, 0}, around{-at.y / at.r, at.x / at.r, 0};
    const Vec3d directions[2] = {outwards, (Vec3d{0, 0, 1} - around * (pitch / at.r)) * scale};
    for (size_t i = 0; i < 2; ++i) {
      const Vec3 direction = toFloat(rotate(turn, directions[i]));
      rows[i].addPoint(1, start[1], at.point, direction);
      rows[i].addPoint(0, start[0], at.point, -direction);
      if (!(constants[5] > 0)) continue;
      rows[i].lower = -constants[5];
      rows[i].upper = constants[5];
    }
  }

  void remember(std::span<const CustomBody> now, std::span<const float> constants,
                std::span<float> memory) const override {
    memory[0] = static_cast<float>(placeOf(now, constants, memory[0]).angle);
  }

 private:
  struct Place {
    Vec3d point;  ///< world
    double x, y, z, r, angle;
  };
  static Place placeOf(std::span<const CustomBody> now, std::span<const float> constants, double counted) {
    Place at;
    at.point = (now[1].pose * Pose{{constants[2], constants[3], constants[4]}, {}}).position;
    const Vec3d p = rotate(conjugate(now[0].pose.rotation), at.point - now[0].pose.position);
    at.x = p.x, at.y = p.y, at.z = p.z, at.r = std::hypot(p.x, p.y);
    at.angle = counted + std::remainder(std::atan2(p.y, p.x) - counted, 2 * kPi);
    return at;
  }
};

constexpr float kRadius = 1, kPitch = 0.2f;

CustomJoint helixOn(BodyId a, BodyId b, Vec3 point, float bound) {
  CustomJoint def;
  def.family = std::make_shared<Helix>();
  def.bodies = {a, b};
  def.constants = {kRadius, kPitch, point.x, point.y, point.z, bound};
  def.memory = {0};
  return def;
}

/// Distance of a point to the helix of a frame, near the angle `counted`, which follows it.
double residual(const Pose& frame, Vec3d point, double& counted) {
  const Vec3d p = rotate(conjugate(frame.rotation), point - frame.position);
  const auto offset = [&](double q) {
    return p - Vec3d{kRadius * std::cos(q), kRadius * std::sin(q), static_cast<double>(kPitch) * q};
  };
  counted += std::remainder(std::atan2(p.y, p.x) - counted, 2 * kPi);
  double q = counted;
  for (int i = 0; i < 5; ++i) {  // Newton's method, the helix's curvature left out
    const Vec3d tangent{-kRadius * std::sin(q), kRadius * std::cos(q), kPitch};
    q += dot(offset(q), tangent) / dot(tangent, tangent);
  }
  return length(offset(q));
}

// A bead on a wire around the vertical (z of the frame): it slides down, s = g t^2 sin(slope) / 2.
std::vector<Figure> bead(const Settings& settings) {
  WorldDef gravity;
  gravity.gravity = {0, 0, -kGravity};
  Build build("bead", settings, gravity);
  build.filter(kGhost);
  const BodyId ball = build.ball("bead", 0.1f, {kRadius, 0, 0}, 1);
  build.world().create(helixOn({}, ball, {}, 0));
  Model model = build.take();
  const double seconds = 3;
  double worst = 0, counted = 0;
  for (int i = 0; i < stepsFor(seconds, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    worst = std::max(worst, residual({}, model.world.pose(ball).position, counted));
  }
  const double slope = kPitch / std::hypot(kRadius, kPitch), fallen = kGravity * seconds * seconds / 2 * slope * slope;
  return {atMost("residual", worst, 1e-4, "m", "bead=point"),
          within("fallen", -model.world.pose(ball).position.z, fallen, 0.02, "m", "bead=point")};
}

// A nut's point off its middle on the thread of a free body: both turn, nothing acts from outside.
std::vector<Figure> screw(const Settings& settings) {
  WorldDef def;
  def.gravity = {};
  Build build("screw", settings, def);
  build.filter(kGhost);
  const BodyId bolt = build.box("bolt", {1, 1, 1}, {0, 0, 0}, 5, {{}, {0.2f, 0.1f, 0.3f}});
  const BodyId nut = build.box("nut", {0.2f, 0.2f, 0.2f}, {kRadius + 0.1, 0, 0}, 1, {{0, 1, 0.2f}, {}});
  build.world().create(helixOn(bolt, nut, {-0.1f, 0, 0}, 0));
  Model model = build.take();
  const Momentum start = momentum(model.world);
  double worst = 0, counted = 0, linear = 0, angular = 0;
  for (int i = 0; i < stepsFor(5, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    const Vec3d point = (model.world.pose(nut) * Pose{{-0.1f, 0, 0}, {}}).position;
    worst = std::max(worst, residual(model.world.pose(bolt), point, counted));
    const Momentum now = momentum(model.world);
    linear = std::max(linear, length(now.linear - start.linear) / start.linearScale);
    angular = std::max(angular, length(now.angular - start.angular) / start.angularScale);
  }
  return {atMost("residual", worst, 1e-4, "m", "nut=free"),
          atMost("linear_momentum", linear, 1e-3, "of the magnitudes", "nut=free"),
          atMost("angular_momentum", angular, 1e-3, "of the magnitudes", "nut=free")};
}

// Pulled outwards by less than the bound the bead stays; by more it leaves with what is left of the force.
std::vector<Figure> bound(const Settings& settings) {
  constexpr float kBound = 5;
  std::vector<Figure> figures;
  for (const float pull : {4.0f, 7.0f}) {
    WorldDef def;
    def.gravity = {};
    Build build("bound", settings, def);
    build.filter(kGhost);
    const BodyId ball = build.ball("bead", 0.1f, {kRadius, 0, 0}, 1);
    build.world().create(helixOn({}, ball, {}, kBound));
    Model model = build.take();
    for (int i = 0; i < stepsFor(1, kDt); ++i) {
      model.world.addForce(ball, {pull, 0, 0});
      model.world.step(static_cast<float>(kDt));
    }
    const std::string params = "bound=" + text(kBound) + " pull=" + text(pull);
    double counted = 0;
    if (pull < kBound)
      figures.push_back(atMost("residual", residual({}, model.world.pose(ball).position, counted), 1e-4, "m", params));
    else
      figures.push_back(within("leaves_with", model.world.velocity(ball).linear.x, pull - kBound, 0.01, "m/s", params));
  }
  return figures;
}

// J against finite differences, and no force or torque left over, at ten places. The differences' step is large against
// the rounding of a pose, the places are off the axis, where the angle has no derivative.
std::vector<Figure> laws() {
  constexpr double kDifference = 3e-3;
  const Helix helix;
  Draws draws(7);
  double jacobian = 0, reaction = 0;
  for (int i = 0; i < 10; ++i) {
    const auto body = [&](Vec3d middle) {
      const Vec3d at = middle + Vec3d{draws.next(), draws.next(), draws.next()} * 0.3;
      const Quat turn = turned({0.6f, 0, 0.8f}, 0.3 * draws.next());
      return CustomBody{{at, turn}, at + rotate(turn, Vec3d{0.05, 0, 0})};
    };
    const CustomBody bodies[2] = {body({}), body({1.5, 0, 0})};
    const float constants[6] = {kRadius, kPitch, 0.2f, 0.4f, -0.1f, 10};
    const float memory[1] = {3 * draws.next()};
    jacobian = std::max(jacobian, jacobianError(helix, bodies, constants, memory, kDifference));
    reaction = std::max(reaction, reactionError(helix, bodies, constants, memory));
  }
  return {atMost("jacobian_error", jacobian, 1e-3, "of C's unit"),
          atMost("reaction_error", reaction, 1e-5, "N or N m")};
}

std::vector<Figure> custom(const Settings& settings) {
  std::vector<Figure> figures = laws();
  for (auto&& part : {bead(settings), screw(settings), bound(settings)})
    for (const Figure& f : part) figures.push_back(f);
  return figures;
}

}  // namespace

std::vector<Line> customLines() { return {{"J", "custom", custom, ""}}; }

}  // namespace avbd::scenes
