// Soft bodies and cloth that fall.
#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

Model softCubes(const Settings& settings) {
  Build build("soft_cubes", settings);
  build.ground();
  const auto cube = makeTetBox({0.25f, 0.25f, 0.25f}, 5, 5, 4);
  for (int i = 0; i < 5; ++i)
    build.soft("cube" + std::to_string(i), {.mesh = cube, .pose = {{0.02 * i, 0.4 + 0.6 * i, 0.01 * i}, {}}});
  return build.take();
}

Model clothOnBall(const Settings& settings) {
  Build build("cloth_on_ball", settings);
  build.ground();
  build.add("ball", BodyDef{.type = BodyType::Static, .position = {0, 1, 0}, .shape = Sphere{0.5f}});
  build.soft("cloth", {.mesh = makeClothGrid(1.5f, 1.5f, 99, 99),
                       .pose = {{0, 1.6, 0}, {}},
                       .material = {.youngsModulus = 1e6f, .density = 300, .thickness = 0.001f, .bending = 1e-5f}});
  return build.take();
}

std::vector<Figure> checkCubes(const Evidence& e) {
  return {holds("finite", e.finite), atMost("penetration", e.penetration.max, 0.01, "m")};
}

/// It touches nothing of itself, so that folds lie within each other.
std::vector<Figure> checkCloth(const Evidence& e) {
  return {holds("finite", e.finite), holds("lies_on_the_ball", e.top > 1.505 && e.top < 1.52)};
}

}  // namespace

std::vector<Scene> softScenes() {
  return {{"soft_cubes",
           "",
           "five cubes of 900 particles and 2500 tetrahedra that fall on each other",
           softCubes,
           0,
           240,
           {},
           checkCubes},
          {"cloth_on_ball", "", "cloth of 10,000 points that falls over a ball", clothOnBall, 0, 120, {}, checkCloth}};
}

}  // namespace avbd::scenes
