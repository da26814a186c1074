// Acceptance, articulations: closed loops.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

const Quat kAlongZ = along({0, 0, 1});

/// A 1 kg bar between two points of the x-y plane.
BodyId bar(Build& build, Vec3d from, Vec3d to) {
  const Vec3d way = to - from;
  const float half = static_cast<float>(length(way) / 2);
  return build.box("bar", {half, 0.05f, 0.05f}, (from + to) * 0.5, 1, {}, turned({0, 0, 1}, std::atan2(way.y, way.x)));
}

void hinge(Build& build, BodyId a, BodyId b, Vec3d at) { build.join(HingeJoint{}, a, b, {at, kAlongZ}); }

/// Bars from point to point, hinged to each other and to the world at both ends.
Model ringOf(const Settings& settings, std::span<const Vec3d> points) {
  Build build("loop", settings);
  build.filter(kGhost);
  BodyId previous;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const BodyId link = bar(build, points[i], points[i + 1]);
    hinge(build, previous, link, points[i]);
    previous = link;
  }
  hinge(build, previous, {}, points.back());
  return build.take();
}

// Ground, crank, coupler, rocker: it falls from where the crank stands up.
Model fourBar(const Settings& settings) {
  const Vec3d points[] = {{0, 0, 0}, {0.1, 0.5, 0}, {1.6, 1.0, 0}, {1.5, 0, 0}};
  return ringOf(settings, points);
}

// Six bars of half a metre and the ground as the seventh: from a bow above it they fall through and hang.
Model sevenBar(const Settings& settings) {
  std::vector<Vec3d> points{{0, 0, 0}};
  const double angles[] = {80, 60, 20, -20, -60, -80};
  for (const double degrees : angles) {
    const double a = degrees * 3.14159265358979323846 / 180;
    points.push_back(points.back() + Vec3d{0.5 * std::cos(a), 0.5 * std::sin(a), 0});
  }
  return ringOf(settings, points);
}

// A stem that hangs by a hinge and ends in a crossbar; two branches of two bars hang from the crossbar's ends, and a
// ball joint closes their tips. All of it starts on its side.
Model closedY(const Settings& settings) {
  Build build("loop", settings);
  build.filter(kGhost);
  BodyDef def;
  def.position = {1, 0, 0};
  ShapeDef stem, crossbar;
  stem.geometry = Box{0.5f, 0.05f, 0.05f};
  stem.pose.position = {-0.5, 0, 0};
  crossbar.geometry = Box{0.05f, 0.5f, 0.05f};
  stem.filter = crossbar.filter = kGhost;
  def.shapes = {stem, crossbar};
  def.mass = 2;
  const BodyId top = build.add("stem", def);
  hinge(build, {}, top, {0, 0, 0});
  BodyId tips[2];
  const Vec3d tip{2, 0, 0};
  for (const int side : {0, 1}) {
    const double y = side == 0 ? 0.5 : -0.5;
    const Vec3d shoulder{1, y, 0}, elbow{1.6, y, 0};
    const BodyId upper = bar(build, shoulder, elbow);
    tips[side] = bar(build, elbow, tip);
    hinge(build, top, upper, shoulder);
    hinge(build, upper, tips[side], elbow);
  }
  build.joint(tips[0], tips[1], tip);
  return build.take();
}

/// 10 s: the largest gap of all joints, those that close the loop among them.
void tryLoop(std::vector<Figure>& figures, Model model, const char* name) {
  const Layout layout = layoutOf(model.world);
  const std::vector<Pose> start = posesOf(model.world, layout);
  double gap = 0, moved = 0;
  for (int i = 0; i < stepsFor(10, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    const std::vector<Pose> poses = posesOf(model.world, layout);
    gap = std::max(gap, jointGapMax(layout, poses));
    moved = std::max(moved, displacement(layout, start, poses).total);
  }
  const std::string params = std::string("loop=") + name;
  figures.push_back(atMost("gap", gap, 1e-4, "m", params));
  figures.push_back(holds("moves", moved > 0.3, params));
  figures.push_back(holds("finite", isFinite(model.world), params));
}

std::vector<Figure> loops(const Settings& settings) {
  std::vector<Figure> figures;
  tryLoop(figures, fourBar(settings), "four_bar");
  tryLoop(figures, closedY(settings), "y");
  tryLoop(figures, sevenBar(settings), "seven_bar");
  return figures;
}

}  // namespace

std::vector<Line> loopLines() { return {{"A", "loop", loops, ""}}; }

}  // namespace avbd::scenes
