// A character walks up a ramp and stairs, rides a platform across a gap, pushes a crate over an edge and follows it
// down a slope; a block of 5 t and a slope of 60 degrees stop it. Prints what happens.
#include <avbd/avbd.h>

#include <array>
#include <cmath>
#include <cstdio>
using namespace avbd;

namespace {

constexpr float kStep = 1.0f / 60, kPace = 2;

/// What there is to stand on: the body's userData.
enum Place : uint64_t { Air, Floor, Ramp, Landing, Stairs, Platform, FarSide, Slope, Yard, Crate };
constexpr std::array kWords{"falls",
                            "on the floor",
                            "up a ramp of 25 degrees",
                            "on the landing",
                            "up the stairs",
                            "rides the platform",
                            "on the far side, where a crate stands in the way",
                            "the crate fell, and down a slope of 30 degrees after it",
                            "in the yard",
                            "on the crate"};

struct Course {
  World world;
  BodyId platform, crate, block;

  /// A box whose top runs from `from` along x, turned up by `degrees`.
  void ground(Place place, Vec3d from, float length, float degrees = 0) {
    const float half = degrees * 3.14159265f / 360;
    const Quat turn{std::cos(half), 0, 0, std::sin(half)};
    world.create(BodyDef{.type = BodyType::Static,
                         .position = from + rotate(turn, Vec3{0.5f * length, -0.25f, 0}),
                         .rotation = turn,
                         .shape = Box{0.5f * length, 0.25f, 3},
                         .userData = place});
  }

  Course() {
    ground(Floor, {-5, 0, 0}, 6);
    ground(Ramp, {1, 0, 0}, 3, 25);
    ground(Landing, {3.65, 1.27, 0}, 2.35f);
    for (int i = 0; i < 6; ++i) ground(Stairs, {6 + 0.4 * i, 1.51 + 0.25 * i, 0}, 0.4f);
    ground(Landing, {8.4, 2.76, 0}, 1.6f);
    ground(FarSide, {15, 2.76, 0}, 6);
    ground(Slope, {21, 2.7, 0}, 5.4f, -30);
    ground(Yard, {25.5, 0, 0}, 10);
    ground(Air, {34, 0, 0}, 6, 60);
    platform = world.create(BodyDef{
        .type = BodyType::Kinematic, .position = {11.1, 2.66, 0}, .shape = Box{1, 0.1f, 2}, .userData = Platform});
    crate =
        world.create(BodyDef{.position = {17, 3.16, 0}, .shape = Box{0.4f, 0.4f, 0.4f}, .mass = 30, .userData = Crate});
    block = world.create(BodyDef{.position = {31, 0.75, 0}, .shape = Box{0.75f, 0.75f, 0.75f}, .mass = 5000});
  }

  double crateAt() const { return world.pose(crate).position.x; }
  double blockAt() const { return world.pose(block).position.x; }
};

/// Where the character wants to go.
class Walker {
 public:
  explicit Walker(Course& course) : course_(course), mover_({.position = {-3, 0.02, 0}}) {}

  /// One frame; false once it has seen everything.
  bool frame(double time) {
    time_ = time;
    World& world = course_.world;
    // The platform waits for the character, who waits while it is carried across.
    const double platformAt = world.pose(course_.platform).position.x;
    const bool rides = mover_.ground().body == course_.platform && at().x > platformAt - 0.3 && platformAt < 13.9;
    world.setVelocity(course_.platform, {{rides ? 1.5f : 0.0f, 0, 0}, {}});
    world.step(kStep);

    Vec3 velocity = rides ? Vec3{} : wanted();
    if (!mover_.ground()) velocity.y = mover_.velocity().y - 9.81f * kStep;
    mover_.move(world, velocity, kStep);
    tellWhere();
    return !done_;
  }

  bool arrived() const { return at().x > 33 && mover_.ground().onGround; }

 private:
  Vec3d at() const { return mover_.position(); }
  void tell(const char* what) const {
    std::printf("%5.1f s  x %6.2f  y %5.2f  z %5.2f  %s\n", time_, at().x, at().y, at().z, what);
  }

  void tellWhere() {
    const MoverGround& ground = mover_.ground();
    const uint64_t place = ground ? course_.world.userData(ground.body) : uint64_t{Air};
    if (place == place_) return;
    place_ = place;
    tell(kWords[place]);
    if (place == Slope) std::printf("         the crate of 30 kg has come %.2f m\n", course_.crateAt() - 17);
  }

  Vec3 wanted() {
    const bool stopped = place_ == Yard && std::abs(mover_.velocity().x) < 0.1f * kPace;
    waited_ = stopped ? waited_ + kStep : 0;
    const bool beforeBlock = at().x < 31.75 && at().z < 1.2;
    if (waited_ > 1.5f && at().x > 33) {
      tell("a slope of 60 degrees is too steep");
      done_ = true;
    } else if (waited_ > 1.5f && !around_) {
      tell("the crate lies at a block of 5 t, and that does not move: around it");
      around_ = true;
    }
    if (around_ && beforeBlock) return {0, 0, kPace};
    return {kPace, 0, 0};
  }

  Course& course_;
  Mover mover_;
  double time_ = 0;
  uint64_t place_ = Air;
  float waited_ = 0;
  bool around_ = false, done_ = false;
};

}  // namespace

int main() {
  Course course;
  Walker walker(course);
  for (int frame = 0; frame < 3000 && walker.frame(frame * double(kStep)); ++frame) {
  }
  std::printf("the block of 5 t moved by %.3f m\n", course.blockAt() - 31);
  std::printf("%s\n", walker.arrived() ? "arrived" : "did not arrive");
  return walker.arrived() ? 0 : 1;
}
