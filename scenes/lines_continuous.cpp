// Acceptance, fast bodies: nothing passes through anything.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr float kBall = 0.05f;

WorldDef weightless() {
  WorldDef def;
  def.gravity = {};
  return def;
}

// From ten places, so that the steps do not happen to end at the wall.
Figure ballAtWall(const Settings& settings, bool mesh) {
  double farthest = -1e9;
  for (int i = 0; i < 10; ++i) {
    Build build("bullet", settings, weightless());
    if (mesh) {
      const std::vector<Vec3> corners{{0, -2, -2}, {0, -2, 2}, {0, 2, 2}, {0, 2, -2}};
      const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
      build.add("wall", {.type = BodyType::Static,
                         .shape = Mesh{makeMesh({.vertices = corners, .triangles = triangles, .doubleSided = true})}});
    } else {
      build.fixedBox("wall", {0.01f, 2, 2}, {0, 0, 0});
    }
    const BodyId ball = build.ball("ball", kBall, {-10 - 0.37 * i, 0.1, 0}, 1, {{200, 0, 0}, {}});
    Model model = build.take();
    for (int k = 0; k < 30; ++k) {
      model.world.step(static_cast<float>(kDt));
      farthest = std::max(farthest, model.world.pose(ball).position.x);
    }
  }
  return {"ball_x", mesh ? "wall=triangles" : "wall=box", farthest, -100, 0, "m"};
}

// A rod of 2 m on a hinge at its middle; the post stands beside its end.
Figure rodAtPost(const Settings& settings) {
  double turned = -1e9;
  for (int i = 0; i < 10; ++i) {
    Build build("bullet", settings, weightless());
    const double angle = 0.3 + 0.25 * i;
    build.fixedBox("post", {0.02f, 1, 0.02f}, {0.9 * std::cos(angle), 0, -0.9 * std::sin(angle)});
    BodyDef def{.angularVelocity = {0, 60, 0}, .shape = Box{1, 0.03f, 0.03f}, .mass = 2};
    const BodyId rod = build.add("rod", def);
    build.join(HingeJoint{}, {}, rod, {{}, along({0, 1, 0})});
    Model model = build.take();
    double sum = 0;
    for (int k = 0; k < 30; ++k) {
      const Quat before = model.world.pose(rod).rotation;
      model.world.step(static_cast<float>(kDt));
      const Quat step = model.world.pose(rod).rotation * conjugate(before);
      // Of q and -q, which are the same turn, the one of less than half a turn.
      const double sign = step.w < 0 ? -1 : 1;
      sum += 2 * std::atan2(sign * double{step.y}, sign * double{step.w});
      turned = std::max(turned, sum - angle);
    }
  }
  return {"rod_beyond_post", "", turned, -100, 0, "rad"};
}

// What the ends of two bodies that fly at each other along x say.
Figure ballsHeadOn(const Settings& settings) {
  double least = 1e9;
  for (int i = 0; i < 10; ++i) {
    Build build("bullet", settings, weightless());
    const BodyId left = build.ball("left", kBall, {-5 - 0.21 * i, 0, 0}, 1, {{100, 0, 0}, {}});
    const BodyId right = build.ball("right", kBall, {5, 0, 0}, 1, {{-100, 0, 0}, {}});
    Model model = build.take();
    for (int k = 0; k < 30; ++k) {
      model.world.step(static_cast<float>(kDt));
      least = std::min(least, model.world.pose(right).position.x - model.world.pose(left).position.x);
    }
  }
  return {"balls_order", "", least, 0, 1e3, "m"};
}

std::vector<Figure> bullet(const Settings& settings) {
  return {ballAtWall(settings, false), ballAtWall(settings, true), rodAtPost(settings), ballsHeadOn(settings)};
}

/// Capsules of 0.4 m, jointed end to end; the joints are those between them.
struct Links {
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;
};
Links addLinks(Build& build, int count, Vec3d at, double angle, Velocity velocity) {
  const Quat turn = turned({0, 0, 1}, angle);
  const Vec3d step = rotate(turn, Vec3d{0, 0.4, 0});
  Links links;
  for (int i = 0; i < count; ++i) {
    links.bodies.push_back(build.add("link" + text(i), {.position = at + step * double(i),
                                                        .rotation = turn,
                                                        .linearVelocity = velocity.linear,
                                                        .shape = Capsule{0.05f, 0.15f},
                                                        .mass = 1}));
    const size_t n = links.bodies.size();
    if (n > 1)
      links.joints.push_back(build.joint(links.bodies[n - 2], links.bodies[n - 1], at + step * (double(i) - 0.5)));
  }
  return links;
}

// Fly at a wall from 24 places, each at another angle.
std::vector<Figure> chainAtWall(const Settings& settings, int count, float speed) {
  double farthest = -1e9, gap = 0;
  for (int i = 0; i < 24; ++i) {
    WorldDef def = weightless();
    def.continuousJointed = true;
    Build build("bullet_chain", settings, def);
    build.fixedBox("wall", {0.01f, 20, 20}, {0, 0, 0});
    const Links links = addLinks(build, count, {-5 - 0.37 * i, 0.1, 0}, 0.26 * i, {{speed, 3, -2}, {}});
    Model model = build.take();
    for (int k = 0; k < 40; ++k) {
      model.world.step(static_cast<float>(kDt));
      for (const BodyId link : links.bodies) farthest = std::max(farthest, model.world.pose(link).position.x);
      for (const JointId joint : links.joints) gap = std::max(gap, model.world.gap(joint));
    }
  }
  const std::string params = "links=" + text(count) + " speed=" + text(double{speed});
  return {{"link_x", params, farthest, -100, 0, "m"}, {"gap", params, gap, 0, 0.1, "m"}};
}

std::vector<Figure> bulletChain(const Settings& settings) {
  std::vector<Figure> figures = chainAtWall(settings, 2, 30);
  figures.push_back(chainAtWall(settings, 2, 100).front());
  figures.push_back(chainAtWall(settings, 10, 50).front());
  return figures;
}

}  // namespace

std::vector<Line> continuousLines() { return {{"R", "bullet", bullet, ""}, {"R", "bullet_chain", bulletChain, ""}}; }

}  // namespace avbd::scenes
