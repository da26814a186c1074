// Acceptance, cloth: hanging, draped; and what ties soft bodies to others.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

/// The longest edge of cloth against rest.
double strainOf(const World& world, SoftId id) {
  const auto mesh = world.mesh(id);
  std::vector<Vec3d> at(mesh->points().size());
  world.getPoints(id, at);
  double strain = 0;
  for (const auto& t : mesh->triangles())
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 rest = mesh->points()[t[k]] - mesh->points()[t[(k + 1) % 3]];
      const Vec3d now = at[t[k]] - at[t[(k + 1) % 3]];
      strain = std::max(strain, std::sqrt(dot(now, now)) / double{length(rest)} - 1);
    }
  return strain;
}

double lowestOf(const World& world, SoftId id) {
  double y = 1e9;
  for (const BodyId p : world.particles(id)) y = std::min(y, world.pose(p).position.y);
  return y;
}

const SoftMaterial kCanvas{.youngsModulus = 2e7f, .poissonRatio = 0, .density = 500, .thickness = 0.001f, .bending = 0};

/// A rope 1 m long that hangs over 0.8 m, from a V as long as it is, since pressed together it would crumple: its sag
/// against 2 a sinh(0.4 / a) = 1, depth a (cosh(0.4 / a) - 1).
Figure rope(const Settings& settings) {
  World world(apply(settings, {}));
  const auto strip = makeClothGrid(0.5f, 0.01f, 50, 1);
  const SoftId id = world.create(SoftDef{.mesh = strip, .material = kCanvas, .radius = 0.002f});
  const std::vector<BodyId> beads = world.particles(id);
  for (size_t i = 0; i < beads.size(); ++i) {
    const Vec3 p = strip->points()[i];
    world.setPose(beads[i], {{double{p.x} * 0.8, (std::fabs(double{p.x}) - 0.5) * 0.6, double{p.z}}, {}});
    if (std::fabs(p.x) < 0.499f) continue;
    world.setLocks(beads[i], kLockLinearX | kLockLinearY | kLockLinearZ);
  }
  for (int i = 0; i < 1200; ++i) world.step(1.0f / 60);
  double low = 0.1, high = 10;
  while (high - low > 1e-12) {
    const double a = (low + high) / 2;
    (2 * a * std::sinh(0.4 / a) > 1 ? low : high) = a;
  }
  return within("sag", -lowestOf(world, id) / (low * (std::cosh(0.4 / low) - 1)), 1, 0.02, "of the catenary", "rope");
}

std::vector<Figure> curtain(const Settings& settings) {
  World world(apply(settings, {}));
  const auto mesh = makeClothGrid(0.5f, 0.5f, 20, 20);
  const SoftId id = world.create(SoftDef{.mesh = mesh, .material = kCanvas});
  const std::vector<BodyId> particles = world.particles(id);
  for (size_t i = 0; i < particles.size(); ++i)
    if (mesh->points()[i].z < -0.499f) world.setLocks(particles[i], kLockLinearX | kLockLinearY | kLockLinearZ);
  for (int i = 0; i < 900; ++i) world.step(1.0f / 60);
  return {atMost("strain", strainOf(world, id), 0.02, "", "curtain"),
          within("length", -lowestOf(world, id), 1, 0.02, "m", "curtain"), rope(settings)};
}

/// A cloth of 3 x 3 m falls over a box or a ball; how deep a point of it is below the surface, along its edges too.
template <class Depth>
Figure drape(const Settings& settings, Geometry geometry, Vec3d at, Depth&& depth, const char* what) {
  constexpr int kSteps = 240, kSamples = 4;
  Build build("drape", settings);
  build.ground();
  build.add("support", BodyDef{.type = BodyType::Static, .position = at, .shape = geometry});
  World& world = build.world();
  const auto mesh = makeClothGrid(1.5f, 1.5f, 60, 60);
  const SoftId id =
      world.create(SoftDef{.mesh = mesh,
                           .pose = {{0, 1.2, 0}, {}},
                           .material = {.youngsModulus = 1e6f, .density = 300, .thickness = 0.001f, .bending = 1e-5f}});
  std::vector<Vec3d> points(mesh->points().size());
  double deepest = -1;
  for (int i = 0; i < kSteps; ++i) {
    world.step(1.0f / 60);
    if (i % 8 != 7) continue;
    world.getPoints(id, points);
    for (const auto& t : mesh->triangles())
      for (size_t k = 0; k < 3; ++k)
        for (int s = 0; s < kSamples; ++s)
          deepest = std::max(
              deepest, depth(points[t[k]] + (points[t[(k + 1) % 3]] - points[t[k]]) * (double{1} * s / kSamples)));
  }
  return atMost("below_surface", std::max(deepest, 0.0), 0.0005, "m", what);
}

std::vector<Figure> drapes(const Settings& settings) {
  const auto inBall = [](Vec3d p) {
    const Vec3d off = p - Vec3d{0, 0.5, 0};
    return 0.5 - std::sqrt(dot(off, off));
  };
  const auto inBox = [](Vec3d p) {
    return std::min({0.5 - std::fabs(p.x), 0.4 - std::fabs(p.y - 0.4), 0.5 - std::fabs(p.z)});
  };
  return {drape(settings, Sphere{0.5f}, {0, 0.5, 0}, inBall, "ball"),
          drape(settings, Box{0.5f, 0.4f, 0.5f}, {0, 0.4, 0}, inBox, "box")};
}

/// A soft cube hung by its corners: from a kinematic body that swings, with a box and another soft cube below it.
std::vector<Figure> attach(const Settings& settings) {
  World world(apply(settings, {}));
  const auto cube = makeTetBox({0.2f, 0.2f, 0.2f}, 3, 3, 3);
  const auto make = [&](double y) {
    return world.create(SoftDef{
        .mesh = cube, .pose = {{0, y, 0}, {}}, .material = {.youngsModulus = 1e6f, .density = 300}, .filter = kGhost});
  };
  const SoftId upper = make(0), lower = make(-0.5);
  const BodyId carrier = world.create(BodyDef{.type = BodyType::Kinematic, .position = {0, 0.4, 0}});
  const BodyId box =
      world.create(BodyDef{.position = {0, -0.9, 0}, .shape = Box{0.1f, 0.1f, 0.1f}, .mass = 20, .filter = kGhost});
  std::vector<JointId> ties;
  const auto corner = [&](SoftId id, size_t i) { return world.particles(id)[i]; };
  const auto tie = [&](BodyId particle, BodyId to) {
    const Pose pose = world.pose(to);
    ties.push_back(world.create(
        BallJoint{.bodyA = particle, .bodyB = to, .frameB = {world.pose(particle).position - pose.position, {}}}));
  };
  // The upper four corners of a cube of 4 x 4 x 4 points, and the lower ones.
  const size_t top[] = {12, 15, 60, 63}, bottom[] = {0, 3, 48, 51};
  for (const size_t i : top) tie(corner(upper, i), carrier);
  for (size_t k = 0; k < 4; ++k) tie(corner(lower, top[k]), corner(upper, bottom[k]));
  for (const size_t i : bottom) tie(corner(lower, i), box);
  double gap = 0, force = 0;
  double mass = 20;
  for (const SoftId id : {upper, lower})
    for (const BodyId p : world.particles(id)) mass += double{world.mass(p)};
  constexpr int kSwing = 120, kRest = 480;
  for (int i = 0; i < kSwing + kRest; ++i) {
    // To and fro, evenly accelerated.
    const float speed = i < kSwing ? 0.05f * static_cast<float>(i % 40 < 20 ? i % 40 - 10 : 30 - i % 40) : 0.0f;
    world.setVelocity(carrier, {{speed, 0, 0}, {}});
    world.step(1.0f / 60);
    for (const JointId joint : ties) gap = std::max(gap, world.gap(joint));
  }
  for (int i = 0; i < 4; ++i) force += double{world.reaction(ties[static_cast<size_t>(i)]).force.y};
  for (const JointId joint : ties) world.setBreakLimits(joint, {.force = 1});
  for (int i = 0; i < 60; ++i) world.step(1.0f / 60);
  const bool cut = std::none_of(ties.begin(), ties.begin() + 4, [&](JointId joint) { return world.isEnabled(joint); });
  return {atMost("gap", gap, 0.001, "m"),
          within("carried", std::fabs(force) / (mass * double{kGravity}), 1, 0.01, "of all"),
          holds("cut_off", cut && world.pose(box).position.y < -2)};
}

}  // namespace

std::vector<Line> clothLines() {
  return {{"S", "drape", drapes, ""}, {"S", "curtain", curtain, ""}, {"S", "attach", attach, ""}};
}

}  // namespace avbd::scenes
