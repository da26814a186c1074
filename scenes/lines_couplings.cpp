// Acceptance, joints: gears, racks and mimics.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/rig.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr Box kCube{0.5f, 0.5f, 0.5f};
constexpr double kMinute = 60;

/// An angle about frame A's x axis, counted over full turns from the poses seen.
class Turns {
 public:
  double see(double angle) {
    constexpr double kTwoPi = 2 * 3.14159265358979323846;
    total_ += std::remainder(angle - last_, kTwoPi);
    last_ = angle;
    return total_;
  }

 private:
  double last_ = 0, total_ = 0;
};

/// Cubes of 1 kg side by side on the world's hinges or sliders, all along one axis. Twisted by `twist` at the start.
class Bench {
 public:
  Bench(const Settings& settings, const Placing& placing, WorldDef def = {})
      : build_("couplings", settings, def), placing_(placing) {
    build_.filter(kGhost);
  }
  World& world() { return build_.world(); }
  Quat frame() const { return placing_.frame(); }

  template <class Joint>
  JointId put(Joint joint, double twist = 0) {
    const Vec3d at{0, 0, 3.0 * static_cast<double>(bodies_.size())};
    const Quat turn = turned(rotate(frame(), Vec3{1, 0, 0}), twist);
    const BodyId body = build_.box("cube", kCube, at, 1, {}, placing_.body());
    joint.bodyB = body;
    joint.frameA = {at, frame()};
    joint.frameB = build_.inBody(body, joint.frameA);
    const JointId id = world().create(joint);
    world().setPose(body, {at, turn * placing_.body()});
    bodies_.push_back({body, at, joint.frameB.rotation});
    return id;
  }
  void spin(size_t i, float speed) { world().setVelocity(bodies_[i].body, {{}, axis() * speed}); }
  void twist(size_t i, float torque) { world().addTorque(bodies_[i].body, axis() * torque); }
  void push(size_t i, float force) { world().addForce(bodies_[i].body, axis() * force); }
  double speed(size_t i) { return dot(world().velocity(bodies_[i].body).angular, axis()); }
  double angle(size_t i) {
    const Quat b = world().pose(bodies_[i].body).rotation * bodies_[i].frameB;
    return twistSwing(conjugate(frame()) * b).twist;
  }
  double travel(size_t i) { return dot(world().pose(bodies_[i].body).position - bodies_[i].at, toDouble(axis())); }

 private:
  struct Held {
    BodyId body;
    Vec3d at;
    Quat frameB;
  };
  Vec3 axis() const { return rotate(frame(), Vec3{1, 0, 0}); }

  Build build_;
  Placing placing_;
  std::vector<Held> bodies_;
};

std::vector<Figure> tryGear(const Settings& settings, const Placing& placing, float ratio, float speed) {
  Bench bench(settings, placing);
  const JointId a = bench.put(HingeJoint{}), b = bench.put(HingeJoint{});
  bench.world().create(gear(a, b, ratio));
  bench.spin(0, speed);
  Turns turnsA, turnsB;
  double drift = 0, speeds[2] = {0, 0};
  for (int i = 0; i < stepsFor(kMinute, kDt); ++i) {
    bench.world().step(static_cast<float>(kDt));
    const double qA = turnsA.see(bench.angle(0)), qB = turnsB.see(bench.angle(1));
    drift = std::max(drift, std::abs(ratio * qA + qB));
    if (i + 1 == stepsFor(1, kDt)) speeds[0] = bench.speed(0), speeds[1] = bench.speed(1);
  }
  // Equal inertias: the impulse along (ratio, 1) that ends ratio wA + wB.
  const double scale = static_cast<double>(ratio) * ratio + 1;
  const std::string params = "ratio=" + text(ratio) + "," + placing.name;
  return {within("speed_a", speeds[0], speed / scale, 0.01, "rad/s", params),
          within("speed_b", speeds[1], -ratio * speed / scale, 0.01, "rad/s", params),
          atMost("drift", drift, 1e-3, "rad", params + ",seconds=" + text(kMinute))};
}

std::vector<Figure> gears(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Placing& placing : kPlacings)
    for (const auto& [ratio, speed] : {std::pair{0.5f, 4.0f}, std::pair{-1.0f, 3.0f}})
      for (Figure& f : tryGear(settings, placing, ratio, speed)) figures.push_back(std::move(f));
  return figures;
}

// Driven to and fro by a motor on either side, for five seconds each way, against the stops of the other side.
std::vector<Figure> tryRack(const Settings& settings, const Placing& placing, bool fromPinion) {
  constexpr float kRadius = 0.2f, kTravel = 0.5f, kAngle = kTravel / kRadius;
  JointDrive drive{.damping = 100, .velocity = fromPinion ? 1.0f : 0.2f, .maxForce = 20};
  WorldDef def;
  def.gravity = {};
  Bench bench(settings, placing, def);
  HingeJoint pinion;
  SliderJoint rack;
  if (fromPinion) {
    rack.limit = {.lower = -kTravel, .upper = kTravel};
  } else {
    pinion.limit = {.lower = -kAngle, .upper = kAngle};
  }
  const JointId hinge = bench.put(pinion), slider = bench.put(rack);
  bench.world().create(rackAndPinion(hinge, slider, kRadius));
  Turns turns;
  double apart = 0, overshoot = -1, q = 0, x = 0;
  for (int i = 0; i < stepsFor(kMinute, kDt); ++i) {
    if (i % stepsFor(5, kDt) == 0) {
      bench.world().setDrive(fromPinion ? hinge : slider, drive);
      drive.velocity = -drive.velocity;
    }
    bench.world().step(static_cast<float>(kDt));
    q = turns.see(bench.angle(0)), x = bench.travel(1);
    apart = std::max(apart, std::abs(x - kRadius * q));
    overshoot = std::max(overshoot, std::abs(x) - kTravel);
  }
  const std::string params = std::string(fromPinion ? "from=pinion," : "from=rack,") + placing.name;
  return {within("ratio_at_the_end", x / q, kRadius, 1e-3, "m/rad", params),
          atMost("apart", apart / kTravel, 1e-3, "of the travel", params),
          {"overshoot", params, overshoot, -0.005, 0.005, "m"}};
}

std::vector<Figure> racks(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Placing& placing : kPlacings)
    for (const bool fromPinion : {true, false})
      for (Figure& f : tryRack(settings, placing, fromPinion)) figures.push_back(std::move(f));
  return figures;
}

// Joint 1 follows a sine of half a radian; joint 0 bears 5 N m, to and fro.
Figure tryMimic(const Settings& settings, const Placing& placing, float ratio, bool driven) {
  constexpr float kOffset = 0.3f, kTorque = 5;
  Bench bench(settings, placing);
  const JointId joint0 = bench.put(HingeJoint{}, -kOffset), joint1 = bench.put(HingeJoint{});
  bench.world().create(mimic(joint0, joint1, ratio, kOffset));
  JointDrive drive{.stiffness = driven ? 200.0f : 0, .damping = driven ? 20.0f : 2.0f};
  double worst = 0, moved = 0;
  Turns turns0, turns1;
  for (int i = 0; i < stepsFor(10, kDt); ++i) {
    const double t = i * kDt;
    if (driven) drive.position = static_cast<float>(0.5 * std::sin(2 * t));
    bench.world().setDrive(joint1, drive);
    bench.twist(0, t < 5 ? kTorque : -kTorque);
    bench.world().step(static_cast<float>(kDt));
    const double q0 = turns0.see(bench.angle(0)), q1 = turns1.see(bench.angle(1));
    worst = std::max(worst, std::abs(q0 + ratio * q1 + kOffset));
    moved = std::max(moved, std::abs(q1));
  }
  if (moved < 0.1) worst = NAN;  // nothing was tried
  return atMost("error", worst, 1e-3, "rad",
                "r=" + text(ratio) + (driven ? ",driven_and_loaded," : ",loaded,") + placing.name);
}

// A free trunk with two arms, one driven, the other mimicking it: nothing from outside, so momentum stays.
std::vector<Figure> mimicMomentum(const Settings& settings, const Placing& placing, float ratio) {
  WorldDef def;
  def.gravity = {};
  Build build("mimic", settings, def);
  build.filter(kGhost);
  const BodyId trunk = build.box("trunk", {1, 0.3f, 0.3f}, {}, 3, {{}, {0.3f, 0.2f, 0.5f}});
  std::array<JointId, 2> joints;
  for (size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1;
    const BodyId arm = build.box("arm", {0.1f, 0.5f, 0.1f}, {side, -0.5, 0}, 1, {}, placing.body());
    joints[i] = build.join(HingeJoint{}, trunk, arm, {{side, 0, 0}, placing.frame() * along({0, 0, 1})});
  }
  build.world().create(mimic(joints[0], joints[1], ratio, 0));
  Model model = build.take();
  const Momentum start = momentum(model.world);
  double linear = 0, angular = 0, moved = 0, linearScale = 0, angularScale = 0;
  for (int i = 0; i < stepsFor(5, kDt); ++i) {
    const float target = static_cast<float>(0.5 * std::sin(3 * i * kDt));
    model.world.setDrive(joints[1], {.stiffness = 100, .damping = 10, .position = target});
    model.world.step(static_cast<float>(kDt));
    const Momentum now = momentum(model.world);
    linear = std::max(linear, length(now.linear - start.linear));
    angular = std::max(angular, length(now.angular - start.angular));
    linearScale = std::max(linearScale, now.linearScale);
    angularScale = std::max(angularScale, now.angularScale);
    moved = std::max(moved, std::abs(model.world.coordinate(joints[0]).position));
  }
  const std::string params = "r=" + text(ratio) + ",free_trunk," + placing.name;
  return {atMost("linear_momentum", linear / linearScale, 1e-3, "of the magnitudes", params),
          atMost("angular_momentum", angular / angularScale, 1e-3, "of the magnitudes", params),
          holds("follows", moved > 0.1 * std::abs(ratio), params)};
}

std::vector<Figure> mimics(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Placing& placing : kPlacings)
    for (const float ratio : {-1.0f, 0.5f, 3.0f}) {
      for (const bool driven : {true, false}) figures.push_back(tryMimic(settings, placing, ratio, driven));
      for (Figure& f : mimicMomentum(settings, placing, ratio)) figures.push_back(std::move(f));
    }
  return figures;
}

}  // namespace

std::vector<Line> couplingLines() {
  return {{"J", "gear", gears, ""}, {"J", "rack", racks, ""}, {"J", "mimic", mimics, ""}};
}

}  // namespace avbd::scenes
