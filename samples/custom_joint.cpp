// A joint of the user's own: a point of a body stays on a helix about the world's y axis. Everything is in this file;
// the engine knows nothing of it.
#include <avbd/avbd.h>

#include <cmath>
#include <cstdio>
#include <memory>
using namespace avbd;

// The helix (r cos t, p t, r sin t), t = y / p: two conditions on the point, that it is above angle t and r from the
// axis. constants: radius r [m], rise per radian p [m], the point in the body's frame.
class Helix final : public CustomFamily {
 public:
  std::string name() const override { return "helix"; }
  int rowCount() const override { return 2; }
  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float> constants,
                std::span<const float>, std::span<CustomRow> rows) const override {
    const double r = constants[0], p = constants[1];
    const Vec3d point = (now[0].pose * Pose{{constants[2], constants[3], constants[4]}, {}}).position;
    const double t = point.y / p, c = std::cos(t), s = std::sin(t);
    // Distances along the radius and across it, of the helix turned to where the point should be.
    rows[0].C = c * point.x + s * point.z - r;
    rows[1].C = c * point.z - s * point.x;
    const Vec3 radial{static_cast<float>(c), static_cast<float>(rows[1].C / p), static_cast<float>(s)};
    const Vec3 across{static_cast<float>(-s), static_cast<float>(-(rows[0].C + r) / p), static_cast<float>(c)};
    rows[0].addPoint(0, now[0], point, radial);
    rows[1].addPoint(0, now[0], point, across);
  }
};

int main() {
  World world({.gravity = {0, -9.81f, 0}});
  const auto helix = std::make_shared<Helix>();
  const std::vector<float> constants{1, 0.2f, 0.1f, 0, 0};  // holds a point 0.1 m beside the centre

  // The law tests: J is the derivative of C. (The helix stands in the world, so the reaction goes there.)
  const CustomBody probe[] = {{{{0.7, 0.3, -0.2}, {}}, {0.7, 0.3, -0.2}}};
  std::printf("J differs from finite differences by %.1e\n", jacobianError(*helix, probe, constants, {}));

  const BodyId bead = world.create(BodyDef{.position = {0.9, 0, 0}, .shape = Sphere{0.2f}, .mass = 1});
  const JointId joint =
      world.create(CustomJoint{.family = helix, .bodies = {bead}, .bodyCount = 1, .constants = constants});
  double gap = 0;
  for (int i = 0; i < 300; ++i) {
    world.step(1.0f / 60);
    gap = std::max(gap, world.gap(joint));
  }
  const Vec3d at = world.pose(bead).position;
  std::printf("the bead slid to (%.2f, %.2f, %.2f), never more than %.1e m off the helix\n", at.x, at.y, at.z, gap);
  return gap < 1e-3 && at.y < -1 ? 0 : 1;
}
