// Soft bodies and cloth that fall.
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/crossings.h"

namespace avbd::scenes {
namespace {

constexpr int kCubes = 5;

std::shared_ptr<const SoftMeshData> cubeMesh() {
  static const auto mesh = makeTetBox({0.25f, 0.25f, 0.25f}, 5, 5, 4);
  return mesh;
}

std::shared_ptr<const SoftMeshData> sheetMesh() {
  static const auto mesh = makeClothGrid(1.5f, 1.5f, 99, 99);
  return mesh;
}

Model softCubes(const Settings& settings) {
  Build build("soft_cubes", settings);
  build.ground();
  for (int i = 0; i < kCubes; ++i)
    build.soft("cube" + std::to_string(i), {.mesh = cubeMesh(), .pose = {{0.02 * i, 0.4 + 0.6 * i, 0.01 * i}, {}}});
  return build.take();
}

Model clothOnBall(const Settings& settings) {
  Build build("cloth_on_ball", settings);
  build.ground();
  build.add("ball", BodyDef{.type = BodyType::Static, .position = {0, 1, 0}, .shape = Sphere{0.5f}});
  build.soft("cloth", {.mesh = sheetMesh(),
                       .pose = {{0, 1.6, 0}, {}},
                       .material = {.youngsModulus = 1e6f, .density = 300, .thickness = 0.001f, .bending = 1e-5f}});
  return build.take();
}

/// After the last step, how often so many bodies of this mesh, which are all that moves, pass through each other or
/// themselves.
auto observeCrossings(std::shared_ptr<const SoftMeshData> mesh, int count) {
  return [mesh, count](Evidence& e, const Layout& layout, std::span<const Pose> poses, int left) {
    if (left > 0) return;
    std::vector<Vec3d> points;
    for (size_t i = 0; i < poses.size(); ++i)
      if (layout.dynamic[i]) points.push_back(poses[i].position);
    std::vector<PlacedMesh> meshes(static_cast<size_t>(count), {mesh, {}});
    const size_t each = mesh->points().size();
    for (size_t k = 0; k < meshes.size(); ++k)
      meshes[k].points.assign(points.begin() + static_cast<std::ptrdiff_t>(k * each),
                              points.begin() + static_cast<std::ptrdiff_t>((k + 1) * each));
    e.own["crossings"] = crossings(meshes);
  };
}

/// A run that ended before its last step has no count: NaN passes nothing.
double crossingsIn(const Evidence& e) {
  const auto found = e.own.find("crossings");
  return found == e.own.end() ? std::nan("") : found->second;
}

std::vector<Figure> checkCubes(const Evidence& e) {
  return {holds("finite", e.finite), atMost("penetration", e.penetration.max, 0.01, "m"),
          atMost("crossings", crossingsIn(e), 0, ""), holds("fell", e.top < 2.6)};
}

std::vector<Figure> checkCloth(const Evidence& e) {
  return {holds("finite", e.finite), holds("lies_on_the_ball", e.top > 1.505 && e.top < 1.52),
          atMost("crossings", crossingsIn(e), 0, "")};
}

}  // namespace

std::vector<Scene> softScenes() {
  Watch cubes, cloth;
  cubes.observe = observeCrossings(cubeMesh(), kCubes);
  cloth.observe = observeCrossings(sheetMesh(), 1);
  return {
      {"soft_cubes", "", "five cubes of 900 particles and 2500 tetrahedra that fall on each other", softCubes, 0, 240,
       cubes, checkCubes},
      {"cloth_on_ball", "", "cloth of 10,000 points that falls over a ball", clothOnBall, 0, 120, cloth, checkCloth}};
}

}  // namespace avbd::scenes
