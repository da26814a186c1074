// Ragdolls: one, and a pit full of them.
#include "scenes/ragdolls.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/catalogue.h"
#include "scenes/large.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A part as it stands in the figure.
struct Part {
  const char* name;
  Geometry shape;
  Vec3d at;
  float mass;
};

// The left half is the right one mirrored: parts and joints from kPaired on exist twice.
constexpr size_t kPaired = 4;
const std::array<Part, 10> kParts{{{"pelvis", Box{0.15f, 0.09f, 0.10f}, {0, 1.00, 0}, 10},
                                   {"abdomen", Box{0.13f, 0.08f, 0.09f}, {0, 1.19, 0}, 8},
                                   {"chest", Box{0.17f, 0.14f, 0.11f}, {0, 1.43, 0}, 15},
                                   {"head", Sphere{0.11f}, {0, 1.71, 0}, 5},
                                   {"upper_arm", Capsule{0.045f, 0.10f}, {0.24, 1.37, 0}, 2},
                                   {"forearm", Capsule{0.04f, 0.10f}, {0.24, 1.07, 0}, 1.3f},
                                   {"hand", Box{0.02f, 0.07f, 0.04f}, {0.24, 0.85, 0}, 0.5f},
                                   {"thigh", Capsule{0.07f, 0.14f}, {0.09, 0.70, 0}, 8},
                                   {"shin", Capsule{0.05f, 0.15f}, {0.09, 0.28, 0}, 4},
                                   {"foot", Box{0.04f, 0.035f, 0.12f}, {0.09, 0.035, 0.05}, 1}}};

/// A joint between two parts, at a point: its x axis leads to the outer part, or is the hinge's, to the right.
struct Tie {
  size_t inner, outer;  ///< in kParts
  Vec3d at;
  Vec3 axis;
  enum class As : uint8_t { Cone, Hinge } as;
  float a, b, twist;  ///< cone: its two angles and the twist either way; hinge: lower and upper [rad]
};

constexpr Vec3 kUp{0, 1, 0}, kDown{0, -1, 0}, kRight{1, 0, 0};
const std::array<Tie, 9> kTies{{{0, 1, {0, 1.10, 0}, kUp, Tie::As::Cone, 0.4f, 0.4f, 0.3f},
                                {1, 2, {0, 1.28, 0}, kUp, Tie::As::Cone, 0.4f, 0.4f, 0.3f},
                                {2, 3, {0, 1.58, 0}, kUp, Tie::As::Cone, 0.7f, 0.7f, 0.8f},
                                {2, 4, {0.24, 1.52, 0}, kDown, Tie::As::Cone, 1.4f, 1.4f, 1.0f},
                                {4, 5, {0.24, 1.22, 0}, kRight, Tie::As::Hinge, -2.4f, 0, 0},
                                {5, 6, {0.24, 0.93, 0}, kDown, Tie::As::Cone, 0.8f, 0.4f, 0.2f},
                                {0, 7, {0.09, 0.91, 0}, kDown, Tie::As::Cone, 1.2f, 0.7f, 0.5f},
                                {7, 8, {0.09, 0.49, 0}, kRight, Tie::As::Hinge, 0, 2.4f, 0},
                                {8, 9, {0.09, 0.075, 0}, kRight, Tie::As::Hinge, -0.6f, 0.6f, 0}}};

Vec3d mirrored(Vec3d p, bool left) { return {left ? -p.x : p.x, p.y, p.z}; }

BodyId addPart(Build& build, const std::string& name, const Part& part, const Pose& at, bool left) {
  BodyDef def;
  const Pose pose = at * Pose{mirrored(part.at, left), {}};
  def.position = pose.position;
  def.rotation = pose.rotation;
  def.shape = part.shape;
  def.mass = part.mass;
  const char* side = part.at.x == 0 ? "" : left ? "_left" : "_right";
  return build.add(name + "_" + part.name + side, def);
}

// Without friction an arm that hangs free swings on for good.
constexpr float kJointFriction = 0.5f;  // [N m]

JointId addTie(Build& build, const Tie& tie, BodyId inner, BodyId outer, const Pose& at) {
  if (tie.as == Tie::As::Hinge)
    return build.join(HingeJoint{.limit = {.lower = tie.a, .upper = tie.b}, .friction = kJointFriction}, inner, outer,
                      at);
  D6Joint def = coneJoint({}, {}, {}, {}, {.y = tie.a, .z = tie.b}, {.lower = -tie.twist, .upper = tie.twist});
  for (size_t i = 3; i < 6; ++i) def.axes[i].friction = kJointFriction;
  return build.join(def, inner, outer, at);
}

// All parts move as one.
void setMotion(World& world, const Ragdoll& doll, Vec3d about, const Velocity& velocity) {
  for (const BodyId id : doll.bodies) {
    const Vec3 arm = toFloat(world.worldCenterOfMass(id) - about);
    world.setVelocity(id, {velocity.linear + cross(velocity.angular, arm), velocity.angular});
  }
}

constexpr int kLayers = 2;
constexpr double kWallHeight = 5;

void addPit(Build& build, double half) {
  build.ground();
  const float h = static_cast<float>(kWallHeight / 2), w = static_cast<float>(half);
  for (const double side : {-1.0, 1.0}) {
    build.fixedBox("wall", {0.5f, h, w + 1}, {side * (half + 0.5), kWallHeight / 2, 0});
    build.fixedBox("wall", {w + 1, h, 0.5f}, {0, kWallHeight / 2, side * (half + 0.5)});
  }
}

// Two layers of side x side, upright but tilted and turned at random, a metre apart.
Model pitOfRagdolls(const Settings& settings, const char* name, int side) {
  Build build(name, settings);
  addPit(build, 0.6 * side);
  Draws draws(2024);
  for (int n = 0; n < side * side * kLayers; ++n) {
    const int layer = n / (side * side), row = n / side % side, column = n % side;
    const double middleOf = (side - 1) / 2.0;
    // One after the other: which factor of a product is evaluated first is the compiler's affair.
    const Quat tilt = turned({1, 0, 0}, 0.2 * draws.next());
    const Quat turn = turned({0, 1, 0}, kPi * draws.next()) * tilt;
    const Vec3d middle{1.05 * (column - middleOf), 1.7 + 2.3 * layer, 1.05 * (row - middleOf)};
    const Pose at{middle + rotate(turn, Vec3d{0, -0.9, 0}), turn};
    addRagdoll(build, "doll_" + std::to_string(n), at, {});
  }
  return build.take();
}

std::vector<Figure> checkRagdolls(const Evidence& e) {
  return {atMost("gap", e.gapPeak, 0.005, "m"), atMost("speed", e.speed, 0.01, "m/s", "seconds=10"),
          holds("finite", e.finite)};
}

}  // namespace

Ragdoll addRagdoll(Build& build, const std::string& name, const Pose& at, const Velocity& velocity) {
  Ragdoll doll;
  // Parts in kParts' order on the right, then those of the left.
  const auto slot = [](size_t part, bool left) { return left ? part + kParts.size() - kPaired : part; };
  for (const bool left : {false, true})
    for (size_t i = left ? kPaired : 0; i < kParts.size(); ++i)
      doll.bodies[slot(i, left)] = addPart(build, name, kParts[i], at, left);
  size_t joint = 0;
  for (const bool left : {false, true})
    for (const Tie& tie : kTies) {
      if (left && tie.outer < kPaired) continue;
      const Pose here = at * Pose{mirrored(tie.at, left), along(tie.axis)};
      const BodyId inner = doll.bodies[slot(tie.inner, left && tie.inner >= kPaired)];
      doll.joints[joint++] = addTie(build, tie, inner, doll.bodies[slot(tie.outer, left)], here);
    }
  setMotion(build.world(), doll, at.position, velocity);
  return doll;
}

std::vector<Scene> ragdollScenes() {
  Watch gaps;
  gaps.gap = true;
  const auto make = [](const Settings& s) { return pitOfRagdolls(s, "ragdolls", 5); };
  return {{"ragdolls", "", "50 ragdolls of 16 bodies dropped into a pit", make, 0, 600, gaps, checkRagdolls}};
}

Scene manyRagdolls() {
  Watch watch;
  watch.gap = true;
  watch.escaped = [](Vec3d p) { return !(p.y > 0 && std::abs(p.x) < 6 && std::abs(p.z) < 6); };
  const auto make = [](const Settings& s) { return pitOfRagdolls(s, "ragdolls_200", 10); };
  // Gaps of the last five seconds: those of the first impacts are what `ragdolls` is about.
  return {
      "ragdolls_200", "", "200 ragdolls of 16 bodies dropped into a pit", make, 0, 600, watch, [](const Evidence& e) {
        return std::vector<Figure>{atMost("gap", e.gapLate, 0.005, "m"), atMost("escaped", e.escaped, 0, "bodies"),
                                   holds("finite", e.finite)};
      }};
}

std::vector<Line> ragdollLines() {
  return {{"A", "ragdolls", [](const Settings& s) { return checkRagdolls(run(ragdollScenes()[0], s)); }, ""}};
}

}  // namespace avbd::scenes
