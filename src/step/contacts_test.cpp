// Contacts in a running world: rest, the forces they carry, friction rules, filters.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr float kGravity = 9.81f;

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kDt);
}
BodyId makeGround(World& world, const Material& material = {}) {
  return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}, .material = material});
}
double deepest(const World& world) {
  double depth = 0;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i)
      depth = std::max(depth, -double(contact.points[static_cast<size_t>(i)].separation));
  return depth;
}
/// Sum over all contacts of a body: what it is pushed with.
Vec3 contactForceOn(const World& world, BodyId id) {
  Vec3 sum;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& point = contact.points[static_cast<size_t>(i)];
      const Vec3 onB = contact.normal * point.normalForce + point.frictionForce;
      if (contact.bodyB == id) sum = sum + onB;
      if (contact.bodyA == id) sum = sum - onB;
    }
  return sum;
}
/// Angle of the body's y axis to the world's [rad].
double tilt(const World& world, BodyId id) {
  const Vec3 up = rotate(world.pose(id).rotation, Vec3{0, 1, 0});
  return std::atan2(std::hypot(up.x, up.z), up.y);
}

// ---- Rest ------------------------------------------------------------------------------------------------------

struct Resting {
  const char* name;
  Geometry shape;
  Quat rotation;
  float height;  ///< of the centre over the plane
};
void PrintTo(const Resting& resting, std::ostream* out) { *out << resting.name; }

constexpr float kHalf = 0.70710678f;
const Resting kResting[] = {
    {"Sphere", Sphere{0.4f}, {}, 0.4f},
    {"LyingCapsule", Capsule{0.3f, 0.6f}, {kHalf, 0, 0, kHalf}, 0.3f},
    {"StandingCapsule", Capsule{0.3f, 0.6f}, {}, 0.9f},
    {"Box", Box{0.5f, 0.3f, 0.4f}, {}, 0.3f},
    {"BoxOnItsSide", Box{0.5f, 0.3f, 0.4f}, {kHalf, kHalf, 0, 0}, 0.4f},
    {"FlatBox", Box{0.5f, 0.02f, 0.5f}, {}, 0.02f},
};

class OnAHalfSpace : public testing::TestWithParam<Resting> {};

void expectRest(World& world, BodyId id, Vec3d start) {
  run(world, 180);
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    worst = std::max<double>(worst, length(world.velocity(id).linear) + length(world.velocity(id).angular));
  }
  EXPECT_LT(worst, 2e-3);
  EXPECT_LT(length(world.pose(id).position - start), 5e-3);
  EXPECT_LT(deepest(world), 3e-3);
  EXPECT_LT(length(contactForceOn(world, id) + world.definition().gravity * world.mass(id)),
            0.01f * kGravity * world.mass(id));
}

TEST_P(OnAHalfSpace, Rests) {
  World world;
  makeGround(world);
  const Vec3d start{0, GetParam().height, 0};
  const BodyId id =
      world.create(BodyDef{.position = start, .rotation = GetParam().rotation, .shape = GetParam().shape});
  expectRest(world, id, start);
}

// The plane may face anywhere: gravity and everything on it turned alike.
TEST_P(OnAHalfSpace, RestsOnAWallWhereThatIsDown) {
  const Quat turn{0.5f, 0.5f, 0.5f, 0.5f};
  World world({.gravity = rotate(turn, Vec3{0, -kGravity, 0})});
  world.create(BodyDef{.type = BodyType::Static, .rotation = turn, .shape = HalfSpace{}});
  const Vec3d start = rotate(turn, Vec3d{0, GetParam().height, 0});
  const BodyId id =
      world.create(BodyDef{.position = start, .rotation = turn * GetParam().rotation, .shape = GetParam().shape});
  expectRest(world, id, start);
}

INSTANTIATE_TEST_SUITE_P(Shapes, OnAHalfSpace, testing::ValuesIn(kResting),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(Compound, LShapeStandsOnItsFoot) {
  World world;
  makeGround(world);
  BodyDef def{.position = {0, 1, 0}};
  def.shapes.push_back({.geometry = Box{0.1f, 1, 0.2f}});
  def.shapes.push_back({.geometry = Box{0.5f, 0.1f, 0.2f}, .pose = {{0.6, -0.9, 0}, {}}});
  const BodyId id = world.create(def);
  run(world, 300);
  EXPECT_LT(tilt(world, id), 0.003);
  EXPECT_NEAR(world.pose(id).position.y, 1, 3e-3);
  EXPECT_LT(length(world.velocity(id).linear), 1e-3f);
  EXPECT_NEAR(contactForceOn(world, id).y, world.mass(id) * kGravity, 0.01f * world.mass(id) * kGravity);
}

TEST(Compound, UprightLTipsOverWhereItsCentreIsOutside) {
  World world;
  makeGround(world);
  BodyDef def{.position = {0, 1, 0}};
  def.shapes.push_back({.geometry = Box{0.1f, 1, 0.2f}});
  def.shapes.push_back({.geometry = Box{0.5f, 0.1f, 0.2f}, .pose = {{0.6, 0.9, 0}, {}}});
  const BodyId id = world.create(def);
  run(world, 180);
  EXPECT_GT(tilt(world, id), 1.0);
}

TEST(Compound, TableCarriesALoadOnFourLegs) {
  World world;
  makeGround(world);
  BodyDef def{.position = {0, 0.8, 0}};
  def.shapes.push_back({.geometry = Box{0.8f, 0.05f, 0.5f}});
  for (const double x : {-0.7, 0.7})
    for (const double z : {-0.4, 0.4})
      def.shapes.push_back({.geometry = Box{0.05f, 0.375f, 0.05f}, .pose = {{x, -0.425, z}, {}}});
  const BodyId table = world.create(def);
  const BodyId load = world.create(BodyDef{.position = {0.3, 1.05, 0.1}, .shape = Box{0.2f, 0.2f, 0.2f}, .mass = 400});
  run(world, 300);
  EXPECT_LT(tilt(world, table), 0.005);
  EXPECT_NEAR(world.pose(table).position.y, 0.8, 4e-3);
  EXPECT_NEAR(world.pose(load).position.y, 1.05, 6e-3);
  EXPECT_LT(length(world.velocity(load).linear), 1e-3f);
  const float weight = (world.mass(table) + 400) * kGravity;
  float onGround = 0;
  for (const Contact& contact : world.contacts())
    if (contact.bodyB != load)
      for (int i = 0; i < contact.pointCount; ++i) onGround += contact.points[static_cast<size_t>(i)].normalForce;
  EXPECT_NEAR(onGround, weight, 0.01f * weight);
}

// ---- Forces ----------------------------------------------------------------------------------------------------

TEST(ContactForce, StackCarriesTheWeightAbove) {
  World world;
  makeGround(world);
  std::vector<BodyId> boxes;
  const float mass[] = {1, 5, 2, 20};
  for (int i = 0; i < 4; ++i)
    boxes.push_back(world.create(BodyDef{.position = {0, 0.5 + i, 0}, .shape = Box{}, .mass = mass[i]}));
  run(world, 240);
  float above = 0;
  for (size_t i = 4; i-- > 0;) {
    above += mass[i];
    const BodyId under = i > 0 ? boxes[i - 1] : BodyId{};
    float pressed = 0;
    for (const Contact& contact : world.contacts()) {
      if (contact.bodyB != boxes[i] || (i > 0 && contact.bodyA != under)) continue;
      for (int k = 0; k < contact.pointCount; ++k) pressed += contact.points[static_cast<size_t>(k)].normalForce;
    }
    EXPECT_NEAR(pressed, above * kGravity, 0.01f * above * kGravity) << "box " << i;
  }
}

TEST(ContactForce, FrictionHoldsWhatIsPushedBelowTheCone) {
  World world;
  makeGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}, .mass = 10});
  const float push = 0.4f * 10 * kGravity;
  for (int i = 0; i < 180; ++i) {
    world.addForceAt(box, {push, 0, 0}, {0, 0, 0});
    world.step(kDt);
  }
  EXPECT_LT(length(world.velocity(box).linear), 1e-3f);
  EXPECT_LT(std::abs(world.pose(box).position.x), 5e-3);
  EXPECT_NEAR(contactForceOn(world, box).x, -push, 0.01f * push);
}

// ---- Friction and restitution rules ----------------------------------------------------------------------------

struct Rule {
  const char* name;
  Material ground, box;
  float expected;
};
void PrintTo(const Rule& rule, std::ostream* out) { *out << rule.name; }

class Sliding : public testing::TestWithParam<Rule> {};

TEST_P(Sliding, StopsWhereItsCoefficientSays) {
  World world;
  makeGround(world, GetParam().ground);
  const BodyId box = world.create(BodyDef{.position = {0, 0.2, 0},
                                          .linearVelocity = {3, 0, 0},
                                          .shape = Box{0.5f, 0.2f, 0.5f},
                                          .material = GetParam().box});
  run(world, 30);
  // The first steps settle the box; from here on it slides.
  const double v = world.velocity(box).linear.x, from = world.pose(box).position.x;
  run(world, 300);
  EXPECT_NEAR(world.pose(box).position.x - from, v * v / (2 * GetParam().expected * kGravity),
              0.04 * v * v / (2 * GetParam().expected * kGravity));
  EXPECT_NEAR(v, 3 - GetParam().expected * kGravity * 0.5, 0.1);
}

constexpr Combine kMean = Combine::GeometricMean, kAverage = Combine::Average, kMinimum = Combine::Minimum,
                  kMultiply = Combine::Multiply, kMaximum = Combine::Maximum;
const Rule kRules[] = {
    {"GeometricMean", {.friction = 0.1f, .frictionCombine = kMean}, {.friction = 0.4f}, 0.2f},
    {"Average", {.friction = 0.1f, .frictionCombine = kAverage}, {.friction = 0.4f}, 0.25f},
    {"Minimum", {.friction = 0.15f}, {.friction = 0.4f, .frictionCombine = kMinimum}, 0.15f},
    {"Multiply", {.friction = 0.5f, .frictionCombine = kMultiply}, {.friction = 0.4f}, 0.2f},
    {"Maximum", {.friction = 0.1f, .frictionCombine = kMaximum}, {.friction = 0.3f}, 0.3f},
    {"LargerRuleWins",
     {.friction = 0.1f, .frictionCombine = kAverage},
     {.friction = 0.3f, .frictionCombine = kMaximum},
     0.3f},
    {"PriorityAlone", {.friction = 0.3f, .frictionPriority = 2}, {.friction = 0.1f, .frictionPriority = 1}, 0.3f},
    {"PriorityOfTheBox", {.friction = 0.3f}, {.friction = 0.15f, .frictionPriority = 1}, 0.15f},
    {"StaticIsNotForSliding",
     {.friction = 0.2f, .staticFriction = 0.9f},
     {.friction = 0.2f, .staticFriction = 0.9f},
     0.2f},
};
INSTANTIATE_TEST_SUITE_P(Rules, Sliding, testing::ValuesIn(kRules),
                         [](const auto& rule) { return std::string(rule.param.name); });

/// A box at rest on the ground, which gravity then pulls sideways by `slope` of its size downwards.
struct Slope {
  World world;
  BodyId box;
  explicit Slope(const Material& material) {
    makeGround(world, material);
    box = world.create(BodyDef{.position = {0, 0.2, 0}, .shape = Box{0.5f, 0.2f, 0.5f}, .material = material});
    run(world, 60);
  }
  void pull(float slope) { world.setGravity({kGravity * slope, -kGravity, 0}); }
  float speed() const { return world.velocity(box).linear.x; }
};

TEST(Friction, StaticHoldsAndOnceBrokenDynamicDoesNot) {
  Slope slope({.friction = 0.3f, .staticFriction = 0.6f});
  slope.pull(0.45f);
  run(slope.world, 180);
  EXPECT_LT(std::abs(slope.speed()), 2e-3f) << "0.45 < 0.6: it sticks";
  EXPECT_LT(slope.world.pose(slope.box).position.x, 2e-3);
  slope.world.setVelocity(slope.box, {{1, 0, 0}, {}});
  run(slope.world, 60);
  EXPECT_NEAR(slope.speed(), 1 + (0.45 - 0.3) * kGravity, 0.1) << "0.45 > 0.3: it slides on";
}

TEST(Friction, StickingEndsAtTheStaticCoefficient) {
  for (const auto& [dynamic, limit] : {std::pair{0.3f, 0.6f}, {0.3f, 0.9f}, {0.4f, 0.4f}}) {
    Slope slope({.friction = dynamic, .staticFriction = limit});
    float at = 0.5f * limit;
    for (; at < 1 && slope.speed() < 0.05f; at += 0.001f) {
      slope.pull(at);
      slope.world.step(kDt);
    }
    EXPECT_NEAR(at, limit, 0.03f);
  }
}

TEST(Restitution, RulesAndPriorities) {
  struct Case {
    Material ground, ball;
    float expected;
  };
  const Case cases[] = {
      {{.restitution = 0.2f}, {.restitution = 0.8f}, 0.8f},
      {{.restitution = 0.4f, .restitutionCombine = kMinimum},
       {.restitution = 0.8f, .restitutionCombine = kMinimum},
       0.4f},
      {{.restitution = 0.5f, .frictionPriority = 1}, {.restitution = 0.9f}, 0.5f},
      {{}, {}, 0},
  };
  for (const Case& c : cases) {
    World world;
    makeGround(world, c.ground);
    const BodyId ball = world.create(BodyDef{.position = {0, 2.5, 0}, .shape = Sphere{0.5f}, .material = c.ball});
    float down = 0, up = 0;
    for (int i = 0; i < 80; ++i) {
      world.step(kDt);
      const float v = world.velocity(ball).linear.y;
      down = std::min(down, v);
      if (down < -5) up = std::max(up, v);
    }
    EXPECT_NEAR(up / -down, c.expected, 0.06) << c.expected;
  }
}

// ---- Filters ---------------------------------------------------------------------------------------------------

struct FilterCase {
  const char* name;
  Filter a, b;
  bool touch;
};

TEST(Filters, DecideWhoTouches) {
  const FilterCase cases[] = {
      {"defaults", {}, {}, true},
      {"category outside the other's mask", {.category = 2}, {.mask = 1}, false},
      {"one direction is not enough", {.category = 2, .mask = 1}, {.category = 1, .mask = 4}, false},
      {"one direction is enough with anyMask on both",
       {.category = 2, .mask = 1, .anyMask = true},
       {.category = 1, .mask = 4, .anyMask = true},
       true},
      {"anyMask on one alone changes nothing",
       {.category = 2, .mask = 1, .anyMask = true},
       {.category = 1, .mask = 4},
       false},
      {"shared negative group", {.group = -3}, {.group = -3}, false},
      {"shared positive group beats masks", {.mask = 0, .group = 5}, {.mask = 0, .group = 5}, true},
      {"different groups leave it to the masks", {.group = -1}, {.group = -2}, true},
      {"different groups and no mask", {.mask = 0, .group = 1}, {.group = 2}, false},
  };
  for (const FilterCase& c : cases) {
    World world;
    world.create(BodyDef{.type = BodyType::Static, .position = {0, -0.5, 0}, .shape = Box{2, 0.5f, 2}, .filter = c.a});
    const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}, .filter = c.b});
    run(world, 60);
    EXPECT_EQ(world.pose(box).position.y > 0.4, c.touch) << c.name;
  }
}

TEST(Filters, ExcludedPairsPassThroughEachOtherAndNobodyElse) {
  World world;
  makeGround(world);
  const BodyId low = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  const BodyId high = world.create(BodyDef{.position = {0, 1.6, 0}, .shape = Box{}});
  world.excludeCollision(high, low);
  run(world, 90);
  EXPECT_NEAR(world.pose(low).position.y, 0.5, 0.01);
  EXPECT_NEAR(world.pose(high).position.y, 0.5, 0.01) << "through the lower box, onto the ground";
}

TEST(Filters, JointedBodiesTouchOnlyIfAsked) {
  for (const bool touch : {false, true}) {
    World world;
    const BodyId post = world.create(BodyDef{.type = BodyType::Static, .shape = Box{0.2f, 1, 0.2f}});
    // Hinged at the post's top; hanging straight down it would be inside the post.
    const BodyId arm = world.create(BodyDef{.position = {0.9, 1, 0}, .shape = Box{0.5f, 0.1f, 0.1f}});
    world.create(BallJoint{.bodyA = post,
                           .bodyB = arm,
                           .frameA = {{0.2, 1, 0}, {}},
                           .frameB = {{-0.7, 0, 0}, {}},
                           .collideConnected = touch});
    double left = 1;
    for (int i = 0; i < 120; ++i) {
      world.step(kDt);
      left = std::min(left, world.pose(arm).position.x);
    }
    if (touch)
      EXPECT_GT(left, 0.2) << "it meets the post";
    else
      EXPECT_LT(left, 0.1) << "it swings through";
  }
}

}  // namespace
}  // namespace avbd
