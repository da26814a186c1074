// Acceptance, joints: pendulums and a slider-crank against exact motion and their energy.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kStep = 1.0 / 240;
constexpr Box kRod{0.05f, 0.5f, 0.05f};
const Quat kAlongZ = along({0, 0, 1}), kAlongX{};

/// About z, from hanging down.
double angleOf(const World& world, BodyId rod) {
  const Vec3d down = rotate(world.pose(rod).rotation, Vec3d{0, -1, 0});
  return std::atan2(down.x, -down.y);
}

/// A 1 kg rod of a metre on a hinge at `from`, turned by `angle` from hanging down; its lower end moves there.
BodyId hang(Build& build, BodyId parent, Vec3d& from, double angle) {
  const Quat turn = turned({0, 0, 1}, angle);
  const BodyId rod = build.box("rod", kRod, from + rotate(turn, Vec3d{0, -0.5, 0}), 1, {}, turn);
  build.join(HingeJoint{}, parent, rod, {from, kAlongZ});
  from = from + rotate(turn, Vec3d{0, -1, 0});
  return rod;
}

/// The rod's moment about its middle [kg m^2].
double rodInertia() { return (0.1 * 0.1 + 1.0) / 12; }

/// Worst of a run.
struct Worst {
  double gap = 0, loss = 0;
  void see(const Model& model, const Layout& layout, double start, double scale) {
    gap = std::max(gap, jointGapMax(layout, posesOf(model.world, layout)));
    loss = std::max(loss, (start - energy(model.world)) / scale);
  }
};

// Period of large swings: that of small ones over the arithmetic-geometric mean of 1 and cos(amplitude / 2).
double exactPeriod(double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  return 2 * kPi * std::sqrt((rodInertia() + 0.25) / (kGravity * 0.5)) / a;
}

std::vector<Figure> compound(const Settings& settings) {
  const double amplitude = kPi / 3;
  Build build("pendulum", settings);
  build.filter(kGhost);
  Vec3d from{};
  const BodyId rod = hang(build, {}, from, amplitude);
  Model model = build.take();
  const Layout layout = layoutOf(model.world);
  // The energy above the lowest place is what can be lost.
  const double start = energy(model.world), scale = kGravity * 0.5 * (1 - std::cos(amplitude));
  Worst worst;
  double before = amplitude, first = 0, last = 0;
  int crossings = 0;
  for (int i = 1; i <= stepsFor(10, kStep); ++i) {
    model.world.step(static_cast<float>(kStep));
    worst.see(model, layout, start, scale);
    const double angle = angleOf(model.world, rod);
    if ((before > 0) != (angle > 0)) {
      last = (i - angle / (angle - before)) * kStep;
      if (crossings++ == 0) first = last;
    }
    before = angle;
  }
  const double period = 2 * (last - first) / (crossings - 1);
  const std::string params = "pendulum=compound from=60 rate=240";
  return {within("period", period, exactPeriod(amplitude), 0.005, "s", params),
          atMost("energy_loss", worst.loss, 0.02, "relative", params), atMost("gap", worst.gap, 1e-4, "m", params)};
}

// A flywheel with a crank of 0.3 m, a rod of 1 m and a block on a slider; all pins are hinges.
std::vector<Figure> sliderCrank(const Settings& settings) {
  Build build("slider_crank", settings);
  build.filter(kGhost);
  BodyDef wheel;
  wheel.position = {0, 0, 0};
  wheel.rotation = turned({1, 0, 0}, kPi / 2);  // its axis along z
  wheel.angularVelocity = {0, 0, 10};
  wheel.shape = Cylinder{0.5f, 0.05f};
  wheel.mass = 8;
  const BodyId flywheel = build.add("flywheel", wheel);
  const Velocity rodMotion{{0, 3 * 0.5f, 0}, {0, 0, -3}};  // of the pins' speeds: 3 m/s upwards and none
  const BodyId rod = build.box("rod", {0.5f, 0.03f, 0.03f}, {0.8, 0, 0}, 1, rodMotion);
  const BodyId block = build.box("block", {0.1f, 0.1f, 0.1f}, {1.3, 0, 0}, 1);
  build.join(HingeJoint{}, {}, flywheel, {{0, 0, 0}, kAlongZ});
  build.join(HingeJoint{}, flywheel, rod, {{0.3, 0, 0}, kAlongZ});
  build.join(HingeJoint{}, rod, block, {{1.3, 0, 0}, kAlongZ});
  build.join(SliderJoint{}, {}, block, {{1.3, 0, 0}, kAlongX});
  Model model = build.take();
  const Layout layout = layoutOf(model.world);
  const double start = energy(model.world), scale = model.world.kineticEnergy();
  Worst worst;
  double nearest = 1e9, farthest = 0;
  for (int i = 0; i < stepsFor(10, kStep); ++i) {
    model.world.step(static_cast<float>(kStep));
    worst.see(model, layout, start, scale);
    nearest = std::min(nearest, model.world.pose(block).position.x);
    farthest = std::max(farthest, model.world.pose(block).position.x);
  }
  const std::string params = "slider_crank=10rad/s rate=240";
  return {atMost("energy_loss", worst.loss, 0.02, "relative", params), atMost("gap", worst.gap, 1e-4, "m", params),
          within("stroke", farthest - nearest, 0.6, 0.01, "m", params)};
}

std::vector<Figure> pendulum(const Settings& settings) {
  std::vector<Figure> figures = compound(settings);
  for (Figure& f : sliderCrank(settings)) figures.push_back(std::move(f));
  return figures;
}

/// Two rods a and b from hanging down, by the exact equations of motion and the classical Runge-Kutta rule in double:
/// what MuJoCo's RK4 integrates, at a step where its error is far below the bound.
class ExactDouble {
 public:
  ExactDouble(double a, double b) : state_{a, b, 0, 0} {}
  void advance(double seconds) {
    const int steps = static_cast<int>(std::round(seconds / kFine));
    for (int i = 0; i < steps; ++i) {
      const State k1 = rate(state_), k2 = rate(at(k1, kFine / 2)), k3 = rate(at(k2, kFine / 2)),
                  k4 = rate(at(k3, kFine));
      for (size_t n = 0; n < 4; ++n) state_[n] += kFine / 6 * (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]);
    }
  }
  double a() const { return state_[0]; }
  double b() const { return state_[1]; }

 private:
  using State = std::array<double, 4>;          // angles, then their speeds
  static constexpr double kFine = kStep / 400;  // about 1e-5 s, a whole number of them in a step

  State at(const State& k, double h) const {
    State s = state_;
    for (size_t n = 0; n < 4; ++n) s[n] += h * k[n];
    return s;
  }
  // Masses 1, lengths 1, middles at 0.5: (I + 1/4 + 1) a'' + c/2 b'' = -s/2 b'^2 - 3/2 g sin a,
  // (I + 1/4) b'' + c/2 a'' = s/2 a'^2 - 1/2 g sin b, with c and s of a - b.
  static State rate(const State& x) {
    const double c = std::cos(x[0] - x[1]) / 2, s = std::sin(x[0] - x[1]) / 2;
    const double m11 = rodInertia() + 1.25, m22 = rodInertia() + 0.25;
    const double fa = -s * x[3] * x[3] - 1.5 * kGravity * std::sin(x[0]);
    const double fb = s * x[2] * x[2] - 0.5 * kGravity * std::sin(x[1]);
    const double det = m11 * m22 - c * c;
    return {x[2], x[3], (m22 * fa - c * fb) / det, (m11 * fb - c * fa) / det};
  }

  State state_;
};

// From horizontal, stretched out, and from bent.
std::vector<Figure> tryDouble(const Settings& settings, double a, double b) {
  Build build("double_pendulum", settings);
  build.filter(kGhost);
  Vec3d from{};
  const BodyId upper = hang(build, {}, from, a), lower = hang(build, upper, from, b);
  Model model = build.take();
  const Layout layout = layoutOf(model.world);
  const double start = energy(model.world), scale = start + kGravity * 2;  // above the lowest place
  ExactDouble exact(a, b);
  Worst worst;
  double apart = 0;
  for (int i = 1; i <= stepsFor(5, kStep); ++i) {
    model.world.step(static_cast<float>(kStep));
    worst.see(model, layout, start, scale);
    if (i > stepsFor(2, kStep)) continue;
    exact.advance(kStep);
    apart = std::max({apart, std::abs(std::remainder(angleOf(model.world, upper) - exact.a(), 2 * kPi)),
                      std::abs(std::remainder(angleOf(model.world, lower) - exact.b(), 2 * kPi))});
  }
  const std::string params = "from=" + text(a * 180 / kPi) + "," + text(b * 180 / kPi) + " rate=240";
  return {atMost("angles", apart, 0.05, "rad", params + " seconds=2"),
          atMost("energy_loss", worst.loss, 0.02, "relative", params + " seconds=5")};
}

std::vector<Figure> doublePendulum(const Settings& settings) {
  std::vector<Figure> figures = tryDouble(settings, kPi / 2, kPi / 2);
  for (Figure& f : tryDouble(settings, kPi / 3, -kPi / 6)) figures.push_back(std::move(f));
  return figures;
}

}  // namespace

std::vector<Line> mechanismLines() {
  return {{"J", "pendulum", pendulum, ""}, {"J", "double_pendulum", doublePendulum, ""}};
}

}  // namespace avbd::scenes
