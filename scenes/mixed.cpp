// Boxes, ragdolls, cloth and soft bodies together (mixed.h), and the showcase of them.
#include "scenes/mixed.h"

#include "scenes/catalogue.h"
#include "scenes/crossings.h"
#include "scenes/ragdolls.h"

namespace avbd::scenes {
namespace {

const SoftMaterial kCloth{.youngsModulus = 1e6f, .density = 400, .thickness = 0.001f, .bending = 1e-4f};
const SoftMaterial kFoam{.youngsModulus = 3e5f, .density = 150};
constexpr float kClothRadius = 0.006f, kFoamRadius = 0.01f;

/// Places in layers of n x n.
class Layers {
 public:
  Layers(int n, float half, double from, double apart) : n_(n), half_(half), y_(from), apart_(apart) {}
  Vec3d next() {
    const int i = count_ % n_, k = count_ / n_ % n_;
    const Vec3d at{place(i), y_ + apart_ * (count_ / (n_ * n_)), place(k)};
    ++count_;
    return at;
  }
  double top() const { return y_ + apart_ * ((count_ + n_ * n_ - 1) / (n_ * n_)); }

 private:
  double place(int i) const { return double{half_} * ((2.0 * i + 1) / n_ - 1); }
  int n_;
  float half_;
  double y_, apart_;
  int count_ = 0;
};

}  // namespace

void addPit(Build& build, float half, float height) {
  const float thick = 0.5f, y = height / 2, out = half + thick;
  build.fixedBox("floor", {out + thick, 0.5f, out + thick}, {0, -0.5, 0});
  build.fixedBox("wall0", {thick, y, out + thick}, {double{out}, double{y}, 0});
  build.fixedBox("wall1", {thick, y, out + thick}, {-double{out}, double{y}, 0});
  build.fixedBox("wall2", {half, y, thick}, {0, double{y}, double{out}});
  build.fixedBox("wall3", {half, y, thick}, {0, double{y}, -double{out}});
}

void addMixture(Build& build, const Mixture& mixture, float half, double from) {
  const auto cube = makeTetBox({0.16f, 0.16f, 0.16f}, 4, 4, 4);
  const auto cloth = makeClothGrid(0.6f, 0.6f, 20, 20);
  Layers softs(3, half * 0.8f, from, 0.5);
  for (int i = 0; i < mixture.softs; ++i)
    build.soft("soft" + std::to_string(i),
               {.mesh = cube, .pose = {softs.next(), {}}, .material = kFoam, .radius = kFoamRadius});
  Layers boxes(7, half * 0.9f, softs.top(), 0.25);
  for (int i = 0; i < mixture.boxes; ++i) build.box("box" + std::to_string(i), {0.08f, 0.08f, 0.08f}, boxes.next(), 4);
  Layers cloths(1, half, boxes.top(), 0.1);
  for (int i = 0; i < mixture.cloths; ++i)
    build.soft("cloth" + std::to_string(i),
               {.mesh = cloth, .pose = {cloths.next(), {}}, .material = kCloth, .radius = kClothRadius});
  Layers dolls(4, half * 0.8f, cloths.top(), 2.0);
  for (int i = 0; i < mixture.ragdolls; ++i)
    addRagdoll(build, "ragdoll" + std::to_string(i), {dolls.next(), turned({0, 1, 0}, 0.7 * i)});
}

namespace {

Model showcase(const Settings& settings) {
  Build build("soft_showcase", settings);
  addPit(build, 1.5f, 2);
  addMixture(build, {.boxes = 30, .ragdolls = 4, .cloths = 3, .softs = 9}, 1.5f, 0.3);
  return build.take();
}

std::vector<Figure> checkShowcase(const Evidence& e) {
  return {holds("finite", e.finite), atMost("penetration", e.penetrationLate, 0.01, "m"),
          atMost("joint_gap", e.gapLate, 0.005, "m")};
}

}  // namespace

std::vector<Scene> mixedScenes() {
  return {{"soft_showcase",
           "",
           "ragdolls and boxes that fall through cloth onto soft bodies in a pit",
           showcase,
           0,
           360,
           {.penetration = false, .gap = true, .escaped = {}, .observe = {}},
           checkShowcase}};
}

}  // namespace avbd::scenes
