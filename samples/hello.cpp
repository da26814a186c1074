#include <avbd/avbd.h>

#include <cstdio>
using namespace avbd;

int main() {
  World world({.gravity = {0, -9.81f, 0}});
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  BodyId box = world.create(BodyDef{.position = {0, 3, 0}, .shape = Box{0.5f, 0.5f, 0.5f}});
  BodyId ball = world.create(BodyDef{.position = {4, 5, 0}, .shape = Sphere{0.25f}});
  JointId rope = world.create(BallJoint{.bodyB = ball, .frameA = {{2, 5, 0}}, .frameB = {{-2, 0, 0}}});
  for (int i = 0; i < 180; ++i) world.step(1.0f / 60);
  Vec3d b = world.pose(box).position, p = world.pose(ball).position;
  std::printf("box at (%.3f, %.3f, %.3f)\n", b.x, b.y, b.z);
  std::printf("ball at (%.2f, %.2f, %.2f), rope %.4f m apart\n", p.x, p.y, p.z, world.gap(rope));
}
