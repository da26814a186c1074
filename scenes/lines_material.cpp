// Acceptance, what soft bodies are made of: damping, incompressibility, limits of strain, threads.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/soft_lines.h"

namespace avbd::scenes {
namespace {

// ---- Damping -----------------------------------------------------------------------------------------------------

constexpr double kRate = 6, kDamping = 0.05;  ///< [rad/s], [s]

/// A free body of 1 m along x that swings in its first longitudinal mode: how fast that decays, of w^2 damping / 2.
double decay(const Settings& settings, std::shared_ptr<const SoftMeshData> mesh, float dt) {
  const double e = double{kSoftDensity} * kRate * kRate / (std::numbers::pi * std::numbers::pi);
  Soft soft(settings, weightless(), std::move(mesh),
            {.youngsModulus = static_cast<float>(e),
             .poissonRatio = 0,
             .density = kSoftDensity,
             .bending = 0,
             .damping = static_cast<float>(kDamping)});
  const auto shape = [](Vec3 rest) { return std::sin(std::numbers::pi * double{rest.x}); };
  soft.each([&](BodyId p, Vec3 rest) {
    soft.world.setVelocity(p, {{static_cast<float>(0.03 * shape(rest)), 0, 0}, {}});
  });
  const auto mode = [&] {
    double sum = 0;
    soft.each([&](BodyId p, Vec3 rest) {
      sum += double{soft.world.mass(p)} * shape(rest) * (soft.at(p).x - double{rest.x});
    });
    return sum;
  };
  // Its extremes, by a parabola through three steps.
  std::vector<std::array<double, 2>> extremes;
  double before = 0, now = mode();
  for (int i = 0; extremes.size() < 3; ++i) {
    soft.world.step(dt);
    const double next = mode();
    if (i > 0 && (now - before) * (next - now) < 0) {
      const double slope = (next - before) / 2, bend = next - 2 * now + before;
      extremes.push_back({double{dt} * (i - slope / bend), now - slope * slope / (2 * bend)});
    }
    before = now, now = next;
  }
  const double rate = std::log(extremes[0][1] / extremes[2][1]) / (extremes[2][0] - extremes[0][0]);
  return rate / (kRate * kRate * kDamping / 2);
}

std::vector<Figure> damping(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float rate : {60.0f, 120.0f, 240.0f, 480.0f}) {
    const std::string dt = " dt=1/" + text(double{rate});
    const auto add = [&](const char* what, std::shared_ptr<const SoftMeshData> mesh) {
      figures.push_back(within("decay", decay(settings, std::move(mesh), 1 / rate), 1, 0.03, "of theory", what + dt));
    };
    add("bar", makeTetBox({0.5f, 0.05f, 0.05f}, 16, 2, 2));
    add("cloth", makeClothGrid(0.5f, 0.1f, 16, 3));
  }
  return figures;
}

// ---- Incompressibility -------------------------------------------------------------------------------------------

/// A beam that cannot be compressed is not much stiffer than one that hardly can.
std::vector<Figure> incompressible(const Settings& settings) {
  const double soft = sagOfBeam(settings, 4, 0.45), hard = sagOfBeam(settings, 4, 0.4999);
  return {within("of_theory", soft, 1, 0.05, "", "beam, nu=0.45"), within("of_theory", hard, 1, 0.05, "", "nu=0.4999"),
          atMost("stiffer", 1 - hard / soft, 0.05, "", "beam, nu=0.4999 against 0.45")};
}

// ---- Cloth -------------------------------------------------------------------------------------------------------

/// The largest stretch of a triangle in any direction.
double stretchOf(const Soft& soft) {
  double most = 0;
  for (const auto& t : soft.mesh->triangles()) {
    const auto rest = [&](size_t i) { return toDouble(soft.mesh->points()[t[i]]); };
    const auto now = [&](size_t i) { return soft.at(soft.particles[t[i]]); };
    const Vec3d b = rest(1) - rest(0), c = rest(2) - rest(0), u = now(1) - now(0), v = now(2) - now(0);
    // F in the frame along b.
    const double length = std::sqrt(dot(b, b)), along = dot(b, c) / length;
    const double height = std::sqrt(dot(c, c) - along * along);
    const Vec3d f0 = u * (1 / length), f1 = (v - u * (along / length)) * (1 / height);
    const double mean = (dot(f0, f0) + dot(f1, f1)) / 2, half = (dot(f0, f0) - dot(f1, f1)) / 2, off = dot(f0, f1);
    most = std::max(most, std::sqrt(mean + std::sqrt(half * half + off * off)));
  }
  return most;
}

/// 10 kg hang on a cloth of 0.4 x 0.4 m and 32 g that without a limit they would stretch to many times its length.
std::vector<Figure> strainLimit(const Settings& settings) {
  constexpr float kLimit = 0.05f;
  Soft soft(settings, {.gravity = {0, 0, kGravity}}, makeClothGrid(0.2f, 0.2f, 10, 10),
            {.youngsModulus = 1e4f, .density = 200, .thickness = 0.001f, .bending = 0, .maxStrain = kLimit});
  const BodyId bar = soft.world.create(
      BodyDef{.position = {0, 0, 0.2}, .shape = Box{0.2f, 0.01f, 0.01f}, .mass = 10, .filter = {.mask = 0}});
  soft.each([&](BodyId p, Vec3 rest) {
    if (rest.z < -0.1999f) soft.world.setLocks(p, kLockLinearX | kLockLinearY | kLockLinearZ);
    if (rest.z > 0.1999f)
      soft.world.create(BallJoint{.bodyA = bar, .bodyB = p, .frameA = {{double{rest.x}, 0, 0}, {}}});
  });
  double most = 0;
  for (int i = 0; i < 600; ++i) {
    soft.world.step(soft.dt);
    if (i >= 300) most = std::max(most, stretchOf(soft));
  }
  return {atMost("strain", most - 1, double{kLimit} + 0.01, "", "10 kg, after 5 s"),
          within("length", (soft.at(bar).z + 0.2) / 0.4, 1 + double{kLimit}, 0.02, "of rest")};
}

/// A free strip of 0.4 x 0.1 m pulled at both ends, its warp at an angle to the pull: how much longer it becomes, of
/// what an orthotropic sheet does: cos^4 / E1 + sin^4 / E2 + (1/G - 2 nu / E1) cos^2 sin^2.
double pulled(const Settings& settings, double cosine, double sine) {
  constexpr double kWarp = 2e6, kWeft = 5e5, kShear = 1e5, kNu = 0.3, kStrain = 0.01, kWide = 0.1, kThick = 0.001;
  Soft soft(settings, weightless(), makeClothGrid(0.2f, 0.05f, 16, 4),
            {.youngsModulus = static_cast<float>(kWarp),
             .poissonRatio = static_cast<float>(kNu),
             .density = 200,
             .thickness = static_cast<float>(kThick),
             .bending = 0,
             .damping = 0.1f,
             .warp = {static_cast<float>(cosine), 0, static_cast<float>(sine)},
             .weftModulus = static_cast<float>(kWeft),
             .shearModulus = static_cast<float>(kShear)});
  const double c = cosine * cosine, s = sine * sine;
  const double compliance = c * c / kWarp + s * s / kWeft + (1 / kShear - 2 * kNu / kWarp) * c * s;
  const double force = kStrain / compliance * kWide * kThick;
  for (int i = 0; i < 600; ++i) {
    soft.each([&](BodyId p, Vec3 rest) {
      if (std::fabs(rest.x) < 0.1999f) return;
      const double share = (std::fabs(rest.z) > 0.0499f ? 0.125 : 0.25) * std::min(1.0, i / 300.0);
      soft.world.addForce(p, {static_cast<float>(rest.x > 0 ? share * force : -share * force), 0, 0});
    });
    soft.world.step(soft.dt);
  }
  const auto end = [&](float sign) {
    return soft.mean([&](Vec3 rest) { return rest.x * sign > 0.0999f && rest.x * sign < 0.1001f; },
                     [](Vec3d now, Vec3) { return now.x; });
  };
  return ((end(1) - end(-1)) / 0.2 - 1) / kStrain;
}

std::vector<Figure> woven(const Settings& settings) {
  const double half = std::sqrt(0.5);
  return {within("stretch", pulled(settings, 1, 0), 1, 0.03, "of theory", "along the warp"),
          within("stretch", pulled(settings, 0, 1), 1, 0.03, "of theory", "along the weft"),
          within("stretch", pulled(settings, half, half), 1, 0.03, "of theory", "between them")};
}

}  // namespace

std::vector<Line> materialLines() {
  return {{"S", "damping", damping, ""},
          {"S", "incompressible", incompressible, ""},
          {"S", "strain_limit", strainLimit, ""},
          {"S", "woven", woven, ""}};
}

}  // namespace avbd::scenes
