// A loaded lift of scissors: 18 links, 8 joints that close loops.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"
#include "scenes/trig.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLevels = 3, kUnloaded = 300, kLoaded = 10000, kBoxes = 8;
constexpr double kPeriod = 10;  // [s] of the lift
const double kAngle = 0.45102681179626236 /* acos 0.9 */, kRise = sine(kAngle);
constexpr float kBoxHalf = 0.25f;
constexpr Box kPlatform{0.5f, 0.1f, 1.5f}, kBar{0.5f, 0.05f, 0.05f};
constexpr double kColumn = 0.5;  // x of the columns, either way

// Links do not collide with each other, except for the platform, which rests on the right bar: nothing else keeps it
// from turning about the left one, on which it is fixed.
constexpr uint32_t kLoose = 1, kBase = 2, kTop = 4, kRightBar = 8;
constexpr Filter only(uint32_t category, uint32_t mask) { return {.category = category, .mask = mask}; }

/// What a variant changes.
struct Load {
  float box;                 ///< [kg]
  float stiffness, damping;  ///< of the drive
};
constexpr Load kLight{0.0625f, 1e5f, 1e3f}, kHeavy{50, 1e7f, 1e5f};

class Lift {
 public:
  Lift(Build& build, const Load& load) : build_(build), load_(load) {}

  void make() {
    makeBase();
    std::array<Side, 2> front = climb(kColumn), back = climb(-kColumn);
    makeTop(front);
    for (size_t side = 0; side < 2; ++side)
      ties_.push_back({back[side].link, bars_[side], {-kColumn, topHeight(), back[side].z}});
    for (const Tie& tie : ties_) build_.join(looseBall(), tie.a, tie.b, {tie.at, {}});
    makePlatform();
  }

 private:
  /// Where a chain of arms has come to: its last link, which ends on this side.
  struct Side {
    BodyId link;
    double z;
  };
  /// Closes a loop.
  struct Tie {
    BodyId a, b;
    Vec3d at;
  };
  static constexpr double kReach = 0.9;  // of an arm to either side, where the lift starts

  static double topHeight() { return 0.55 + 0.1 * kLevels + 2 * kLevels * kRise; }
  static D6Joint looseBall() {
    D6Joint def;
    for (size_t i = 3; i < 6; ++i) def.axes[i].motion = AxisMotion::Free;
    return def;
  }
  static HingeJoint armHinge(bool left) {
    const float a = static_cast<float>(kAngle), half = static_cast<float>(kPi);
    HingeJoint def;
    def.limit.lower = left ? -half : -a;
    def.limit.upper = left ? a : half;
    return def;
  }

  void makeBase() {
    build_.filter(only(kBase, kLoose));
    const BodyId base = build_.box("base", {0.5f, 0.25f, 1.5f}, {0, 0.25, 0}, 4.5f);
    build_.filter(kGhost);
    const Pose at[2] = {{{0, 0.5, -kReach}, {}}, {{0, 0.5, kReach}, along({0, 0, 1})}};
    for (size_t side = 0; side < 2; ++side)
      roots_[side] = build_.box(side == 0 ? "root_left" : "root_right", kBar, {0, 0.55, at[side].position.z}, 0.01f);
    build_.join(FixedJoint{}, base, roots_[0], at[0]);
    SliderJoint slider;
    slider.limit = {.lower = -1.4f, .upper = 0.2f};
    slider.drive = {.stiffness = load_.stiffness, .damping = load_.damping};
    build_.name("lift", build_.join(slider, base, roots_[1], at[1]), JointAxis::LinearX);
  }

  // At each level the arm that stands left crosses to the right, and the other way about.
  std::array<Side, 2> climb(double x) {
    std::array<Side, 2> now{Side{roots_[0], -kReach}, Side{roots_[1], kReach}};
    for (int level = 0; level < kLevels; ++level) {
      const double foot = 0.55 + 0.1 * (level + 1) + 2 * level * kRise, middle = foot + kRise;
      std::array<BodyId, 2> arms;
      for (size_t side = 0; side < 2; ++side) {
        const Quat turn = turned({1, 0, 0}, side == 0 ? -kAngle : kAngle);
        arms[side] = build_.box("arm", {0.05f, 0.05f, 1}, {x, middle, 0}, 0.02f, {}, turn);
        build_.join(armHinge(side == 0), now[side].link, arms[side], {{x, foot, now[side].z}, {}});
      }
      ties_.push_back({arms[0], arms[1], {x, middle, 0}});
      now[0].link = arms[1], now[1].link = arms[0];
    }
    return now;
  }

  void makeTop(const std::array<Side, 2>& front) {
    for (size_t side = 0; side < 2; ++side) {
      const Vec3d middle{0, topHeight(), front[side].z};
      if (side == 0) {
        bars_[side] = build_.box("bar_left", kBar, middle, 0.01f);
      } else {
        BodyDef def;
        def.position = middle;
        def.rotation = turned({0, 0, 1}, -kPi / 2);
        def.shape = Capsule{0.05f, 0.8f};
        def.mass = 0.01f;
        build_.filter(only(kRightBar, kTop));
        bars_[side] = build_.add("bar_right", def);
      }
      build_.join(HingeJoint{}, front[side].link, bars_[side], {{kColumn, middle.y, middle.z}, {}});
    }
  }

  void makePlatform() {
    build_.filter(only(kTop, kLoose | kRightBar));
    const Vec3d at{0, topHeight() + 0.15, 0};
    const BodyId platform = build_.box("platform", kPlatform, at, 0.6f);
    build_.join(FixedJoint{}, bars_[0], platform, {{0, topHeight(), -kReach}, {}});
  }

  Build& build_;
  Load load_;
  std::array<BodyId, 2> roots_, bars_;  // left, right
  std::vector<Tie> ties_;
};

/// Of box i when the platform's middle is there: two layers of four.
Vec3d onPlatform(int i, Vec3d platform) {
  const double x = i & 1 ? 0.25 : -0.25, z = i & 2 ? 0.5 : 0, layer = i / 4;
  return {x, platform.y + kPlatform.y + 0.005 + kBoxHalf + 2 * kBoxHalf * layer, z};
}

// The boxes wait beside the lift until they are put on it.
Model scissor(const Settings& settings, const Load& load) {
  Build build("scissor", settings);
  build.friction(0.5f).filter(only(kLoose, kLoose | kBase | kTop));
  build.ground();
  Lift(build, load).make();
  build.filter(only(kLoose, kLoose | kBase | kTop));
  for (int i = 0; i < kBoxes; ++i)
    build.box("box_" + std::to_string(i), {kBoxHalf, kBoxHalf, kBoxHalf}, {3 + 0.7 * (i / 4), kBoxHalf, 0.7 * (i % 4)},
              load.box);
  Model model = build.take();
  model.duration = 30;
  return model;
}

// The last bodies are the platform and the boxes.
size_t platformOf(size_t bodies) { return bodies - kBoxes - 1; }

// The lift's target is smooth, so that the platform does not jump where the arms turn about.
void drive(Model& model, int64_t step, const Load& load) {
  const double travel = -0.6 + 0.6 * cosine(2 * kPi * static_cast<double>(step) * model.dt / kPeriod);
  model.world.setDrive(model.joints[0].id,
                       {.stiffness = load.stiffness, .damping = load.damping, .position = static_cast<float>(travel)});
  if (step != kUnloaded) return;
  const size_t platform = platformOf(model.bodies.size());
  const Vec3d at = model.world.pose(model.bodies[platform].id).position;
  for (int i = 0; i < kBoxes; ++i) {
    const BodyId box = model.bodies[platform + 1 + static_cast<size_t>(i)].id;
    model.world.setPose(box, {onPlatform(i, at), {}});
    model.world.setVelocity(box, {});
  }
}

/// How many boxes stand over the platform, no lower than on it and no higher than on another box.
int boxesOn(std::span<const Pose> poses) {
  const Pose& platform = poses[platformOf(poses.size())];
  return static_cast<int>(std::count_if(poses.end() - kBoxes, poses.end(), [&](const Pose& box) {
    const Vec3d p = rotate(conjugate(platform.rotation), box.position - platform.position);
    const double above = p.y - kPlatform.y;
    return std::abs(p.x) <= kPlatform.x && std::abs(p.z) <= kPlatform.z && above > 0.8 * kBoxHalf &&
           above < 4 * kBoxHalf;
  }));
}

std::string cycleName(const char* end, int cycle) { return std::string(end) + std::to_string(cycle); }
constexpr int kCycle = 600;                              // steps
constexpr int kCycles = (kUnloaded + kLoaded) / kCycle;  // whole ones; the first is the one that loads it

Watch watchLift() {
  Watch watch;
  watch.gap = true;
  watch.observe = [](Evidence& e, const Layout&, std::span<const Pose> poses, int left) {
    const int cycle = (kUnloaded + kLoaded - 1 - left) / kCycle;
    const double height = poses[platformOf(poses.size())].position.y;
    double& low = e.own.try_emplace(cycleName("low", cycle), height).first->second;
    double& high = e.own.try_emplace(cycleName("high", cycle), height).first->second;
    low = std::min(low, height), high = std::max(high, height);
    if (left == 0) e.own["boxes_on"] = boxesOn(poses);
  };
  return watch;
}

double ownOf(const Evidence& e, const std::string& name) {
  const auto found = e.own.find(name);
  return found == e.own.end() ? NAN : found->second;
}

double strokeOf(const Evidence& e, int cycle) {
  return ownOf(e, cycleName("high", cycle)) - ownOf(e, cycleName("low", cycle));
}

double strokeDrift(const Evidence& e) {
  double worst = 0;
  for (int cycle = 2; cycle < kCycles; ++cycle) {
    const double drift = std::abs(strokeOf(e, cycle) / strokeOf(e, 1) - 1);
    if (!(drift <= worst)) worst = drift;  // a NaN is kept
  }
  return worst;
}

// The stroke itself: the arms' angles follow from the travel alone.
double stroke() { return 2 * kLevels * (std::sqrt(1 - 0.3 * 0.3) - kRise); }

std::vector<Figure> checkLift(const Evidence& e) {
  return {{"boxes_on_platform", "", ownOf(e, "boxes_on"), kBoxes, kBoxes, "boxes"},
          atMost("gap", e.gapPeak, 0.001, "m"),
          atMost("stroke_drift", strokeDrift(e), 0.01, "relative"),
          within("stroke", strokeOf(e, 1), stroke(), 0.05, "m"),
          holds("finite", e.finite)};
}

Scene liftScene(const char* name, const char* description, const Load& load) {
  Scene scene{name,      "",      description, [load](const Settings& s) { return scissor(s, load); },
              kUnloaded, kLoaded, watchLift(), checkLift};
  scene.before = [load](Model& model, int64_t step) { drive(model, step, load); };
  return scene;
}

// What each count of iterations gives; only the default one must pass.
std::vector<Figure> floorOf(const Settings& settings) {
  constexpr double kAny = 1e9;
  const Scene scene = scissorScenes()[0];
  std::vector<Figure> figures;
  for (const int iterations : {1, 2, 3, 4, 8}) {
    Settings with = settings;
    with.iterations = iterations;
    const Evidence e = run(scene, with);
    const std::vector<Figure> check = checkLift(e);
    const bool passed = std::all_of(check.begin(), check.end(), passes);
    const std::string params = "iterations=" + std::to_string(iterations);
    const auto report = [&](const Figure& f) {
      const double seen = std::isfinite(f.measured) ? f.measured : kAny;
      figures.push_back({f.name, params, seen, -kAny, kAny, f.unit});
    };
    figures.push_back({"passes", params, passed ? 1.0 : 0.0, iterations == 4 ? 1.0 : 0.0, 1, "yes/no"});
    for (const Figure& f : check)
      if (f.name != "finite") report(f);
  }
  return figures;
}

}  // namespace

std::vector<Scene> scissorScenes() {
  return {liftScene("scissor", "lift of scissors with closed loops, loaded with 0.5 kg", kLight),
          liftScene("scissor_heavy", "the lift loaded with 400 kg", kHeavy)};
}

std::vector<Line> scissorLines() {
  std::vector<Line> lines;
  for (const Scene& scene : scissorScenes())
    lines.push_back({"A", scene.name, [scene](const Settings& s) { return checkLift(run(scene, s)); }, ""});
  lines.push_back({"A", "scissor_floor", floorOf, ""});
  return lines;
}

}  // namespace avbd::scenes
