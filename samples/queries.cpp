// Questions to a small world: what a ray, a moving ball, a box and a point meet, and what is near. Nothing is stepped.
#include <avbd/avbd.h>

#include <cmath>
#include <cstdio>
using namespace avbd;

namespace {

int failures = 0;

/// Prints an answer beside the one that geometry gives.
void show(const char* question, double answer, double expected) {
  const bool good = std::abs(answer - expected) < 1e-4;
  std::printf("%-58s %8.4f%s\n", question, answer, good ? "" : "  WRONG");
  if (!good) ++failures;
}

}  // namespace

int main() {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId wall = world.create(BodyDef{.type = BodyType::Static, .position = {5, 1, 0}, .shape = Box{0.5f, 1, 4}});
  const BodyId ball = world.create(BodyDef{.position = {0, 3, 0}, .shape = Sphere{0.5f}});
  const BodyId zone = world.create(BodyDef{
      .type = BodyType::Static, .position = {2, 1, 0}, .shapes = {{.geometry = Box{0.5f, 1, 1}, .isTrigger = true}}});

  // A ray along x: triggers are not seen unless the filter asks for them.
  const Ray ray{.origin = {-2, 1, 0}, .direction = {1, 0, 0}, .length = 20};
  const CastHit seen = world.rayClosest(ray);
  show("ray along x meets the wall after", seen.distance, 6.5);
  show("  its normal along x", seen.normal.x, -1);
  QueryFilter withTriggers;
  withTriggers.triggers = true;
  show("  with triggers it meets the zone after", world.rayClosest(ray, withTriggers).distance, 3.5);
  show("  in all it meets", double(world.rayAll(ray, withTriggers).size()), 2);

  // Straight down on the ball, and the same without it.
  const Ray down{.origin = {0, 10, 0}, .direction = {0, -1, 0}, .length = 20};
  QueryFilter notBall;
  notBall.ignore = ball;
  show("ray downwards meets the ball after", world.rayClosest(down).distance, 6.5);
  show("  without the ball the ground after", world.rayClosest(down, notBall).distance, 10);

  // A ball of 0.25 m thrown at the wall stops that much before it.
  const CastHit stop = world.castClosest(Sphere{0.25f}, {{0, 1, 0}, {}}, {20, 0, 0});
  show("a ball moved along x touches the wall after", stop.distance, 4.25);
  QueryFilter dynamicsOnly;
  dynamicsOnly.statics = false;
  show("  among dynamic bodies it meets nothing",
       world.castAny({Sphere{0.25f}, {{0, 1, 0}, {}}, {20, 0, 0}}, dynamicsOnly), 0);

  // What a box overlaps: ground, ball and wall, in the order of their ids.
  const std::vector<ShapeId> inside = world.overlaps(Box{5, 3, 1}, {{0, 2, 0}, {}});
  show("shapes in a box of 10 x 6 x 2 m", double(inside.size()), 3);

  // What is near a point; negative distances are depths.
  const NearHit near = world.nearestClosest(Sphere{0.1f}, {{3.9, 1, 0}, {}}, 2);
  show("nearest to a ball of 0.1 m at x = 3.9: the wall at", near.distance, 0.5);
  show("  the wall's nearest point has x =", near.onShape.x, 4.5);
  show("shapes that hold the point (5, 1.5, 0)", double(world.containing({5, 1.5, 0}).size()), 1);
  show("  it is the wall", world.body(world.containing({5, 1.5, 0}).front()) == wall, 1);

  // Many rays at once: a fan from above, every metre.
  std::vector<Ray> fan;
  for (int i = 0; i < 100; ++i) fan.push_back({.origin = {-50.0 + i, 10, 0}, .direction = {0, -1, 0}, .length = 20});
  std::vector<CastHit> hits(fan.size());
  world.raysClosest(fan, hits);
  int ground = 0;
  for (const CastHit& hit : hits) ground += hit && hit.distance == 10;
  show("of a hundred rays downwards meet the ground", ground, 98);

  // Queries follow every change at once.
  world.setPose(ball, {{0, 8, 0}, {}});
  show("the ball moved up: the ray downwards meets it after", world.rayClosest(down).distance, 1.5);
  world.destroy(zone);
  show("the zone is gone: with triggers the ray meets", double(world.rayAll(ray, withTriggers).size()), 1);
  return failures == 0 ? 0 : 1;
}
