// The scenes are the ones of the list, number by number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

Model make(const char* name) { return find(name)->make({}); }

size_t dynamicCount(const Model& m) {
  return static_cast<size_t>(std::count_if(
      m.bodies.begin(), m.bodies.end(), [&](const NamedBody& b) { return m.world.type(b.id) == BodyType::Dynamic; }));
}

Vec3d at(const Model& m, const std::string& name) {
  for (const NamedBody& b : m.bodies)
    if (b.name == name) return m.world.pose(b.id).position;
  ADD_FAILURE() << "no body " << name;
  return {};
}

void expectNear(Vec3d p, Vec3d q) {
  EXPECT_NEAR(p.x, q.x, 1e-6);
  EXPECT_NEAR(p.y, q.y, 1e-6);
  EXPECT_NEAR(p.z, q.z, 1e-6);
}

double startOverlap(const Model& m) {
  const Layout layout = layoutOf(m.world);
  return penetrationOf(layout, posesOf(m.world, layout)).max;
}

TEST(Scenes, NamesAreUniqueAndFound) {
  std::set<std::string> names;
  for (const Scene& s : all()) {
    EXPECT_TRUE(names.insert(s.name).second) << s.name;
    EXPECT_EQ(find(s.name), &s);
    if (!s.alias.empty()) {
      EXPECT_EQ(find(s.alias), &s);
    }
    EXPECT_TRUE(s.check) << s.name;
  }
  for (const char* letter : {"a", "b", "c", "c2", "c3", "d", "e", "f"}) EXPECT_NE(find(letter), nullptr) << letter;
  EXPECT_EQ(find("nothing"), nullptr);
  EXPECT_EQ(find(""), nullptr);
}

TEST(Scenes, EveryLineIsListedOnceAndRunsOrTellsWhyNot) {
  std::set<std::string> names;
  for (const Line& line : lines()) {
    EXPECT_TRUE(names.insert(line.list + "." + line.name).second) << line.name;
    EXPECT_NE(static_cast<bool>(line.run), !line.skipReason.empty()) << line.name;
  }
  const std::pair<const char*, size_t> counts[] = {{"R", 31}, {"J", 18}, {"A", 17}, {"S", 21}, {"D", 8}};
  for (const auto& [list, count] : counts)
    EXPECT_EQ(static_cast<size_t>(
                  std::count_if(lines().begin(), lines().end(), [&](const Line& l) { return l.list == list; })),
              count)
        << list;
}

TEST(Scenes, GroundTopIsZero) {
  const Model m = make("a");
  EXPECT_EQ(std::get<Box>(m.world.geometry(m.world.shapes(m.bodies[0].id)[0])).x, 100);
  expectNear(at(m, "ground"), {0, -1, 0});
  EXPECT_EQ(m.world.type(m.bodies[0].id), BodyType::Static);
  EXPECT_FLOAT_EQ(m.world.material(m.world.shapes(m.bodies[0].id)[0]).friction, 0.6f);
}

TEST(Scenes, Pyramid) {
  const Model m = make("a");
  EXPECT_EQ(dynamicCount(m), 465u);
  expectNear(at(m, "box_0_0"), {-14.5 * 1.1, 0.5, 0});
  expectNear(at(m, "box_29_0"), {0, 29.5, 0});
  EXPECT_FLOAT_EQ(m.world.mass(m.bodies[1].id), 1000);
  EXPECT_NEAR(m.world.inertia(m.bodies[1].id).xx, 1000.0 / 6, 1e-3);
  EXPECT_EQ(startOverlap(m), 0);
}

TEST(Scenes, Stacks) {
  const Model m = make("b");
  EXPECT_EQ(dynamicCount(m), 50u);
  expectNear(at(m, "box_0_0"), {-10, 0.5, 0});
  expectNear(at(m, "box_4_9"), {10, 9.5, 0});
}

TEST(Scenes, Pits) {
  const Model c = make("c"), c2 = make("c2"), c3 = make("c3");
  for (const Model* m : {&c, &c2, &c3}) {
    EXPECT_EQ(m->bodies.size(), 2005u);
    EXPECT_EQ(dynamicCount(*m), 2000u);
    EXPECT_EQ(startOverlap(*m), 0);
  }
  expectNear(at(c, "box_0_0_0"), {-4.95, 1, -4.95});
  expectNear(at(c, "box_19_9_0"), {-4.95, 21.9, 4.95});
  EXPECT_EQ(c.bodies[5 + 1].name, "box_0_0_1");
  EXPECT_EQ(c.bodies[5 + 10].name, "box_0_1_0");
  // j = 1: 7 mod 5 - 2 = 0 and 3 mod 5 - 2 = 1.
  expectNear(at(c2, "box_1_0_0"), {-4.95, 2.1, -4.95 + 0.15});
  expectNear(at(c2, "box_0_0_0"), {-4.95 - 0.3, 1, -4.95 - 0.3});
  expectNear(at(c3, "box_2_3_4"), {-0.55, 8, -1.65});
  expectNear(at(c, "wall_left"), {-7.5, 15, 0});
  expectNear(at(c3, "wall_front"), {0, 20, 7.5});
}

TEST(Scenes, PileStartsFromTheGenerator) {
  const Model m = make("c3");
  uint32_t s = 12345;
  const auto draw = [&] {
    s = s * 1664525u + 1013904223u;
    return 2 * static_cast<float>(s >> 8) / 16777216 - 1;
  };
  const float u0 = draw(), u1 = draw(), u2 = draw(), u3 = draw(), u4 = draw();
  const Velocity v = m.world.velocity(m.bodies[5].id);
  EXPECT_EQ(v.linear, (Vec3{u0, 0, u1}));
  EXPECT_EQ(v.angular, (Vec3{3 * u2, 3 * u3, 3 * u4}));
}

TEST(Scenes, Chain) {
  const Model m = make("d");
  EXPECT_EQ(dynamicCount(m), 51u);
  EXPECT_EQ(m.world.jointCount(), 51u);
  expectNear(at(m, "link_49"), {24.75, 40, 0});
  expectNear(at(m, "ball"), {26, 40, 0});
  EXPECT_FLOAT_EQ(m.world.mass(m.bodies.back().id), 1000);
  const Layout layout = layoutOf(m.world);
  EXPECT_LT(jointGapMax(layout, posesOf(m.world, layout)), 1e-6);
  // The ball is held at its surface.
  EXPECT_NEAR(layout.anchors.back().b.x, -1, 1e-6);
  // The links lie along x.
  const Vec3 axis = rotate(m.world.pose(m.bodies[0].id).rotation, Vec3{0, 1, 0});
  EXPECT_NEAR(std::abs(axis.x), 1, 1e-6);
  EXPECT_EQ(startOverlap(m), 0);
}

TEST(Scenes, HeavyOnLight) {
  const Model m = make("e");
  EXPECT_EQ(dynamicCount(m), 11u);
  expectNear(at(m, "heavy"), {0, 10.5, 0});
  EXPECT_FLOAT_EQ(m.world.mass(m.bodies[1].id), 1);
  EXPECT_FLOAT_EQ(m.world.mass(m.bodies.back().id), 1000);
  const Model heavier = make("heavy_on_light_10t");
  EXPECT_FLOAT_EQ(heavier.world.mass(heavier.bodies.back().id), 10000);
}

TEST(Scenes, Net) {
  const Model m = make("f");
  EXPECT_EQ(dynamicCount(m), 401u);
  EXPECT_EQ(m.world.jointCount(), 764u);
  expectNear(at(m, "node_0_19"), {-9.5 * 0.25, 10, 9.5 * 0.25});
  const Layout layout = layoutOf(m.world);
  EXPECT_LT(jointGapMax(layout, posesOf(m.world, layout)), 1e-6);
  // Nodes do not meet each other, the ball meets the nodes.
  EXPECT_FALSE(layout.mayTouch(0, 2));
  EXPECT_TRUE(layout.mayTouch(0, 400));
}

TEST(Scenes, Chainmail) {
  const Model m = make("chainmail");
  EXPECT_EQ(m.bodies.size(), 901u);
  EXPECT_EQ(dynamicCount(m), 897u);
  EXPECT_EQ(m.world.jointCount(), 1740u);
  EXPECT_EQ(m.world.shapeCount(), 900u + 1740u + 1u);
}

TEST(Scenes, Scissor) {
  for (const char* name : {"scissor", "scissor_heavy"}) {
    const Model m = make(name);
    EXPECT_EQ(dynamicCount(m), 18u + 8u);
    // A tree of 17 joints, and 8 that close loops.
    EXPECT_EQ(m.world.jointCount(), 17u + 8u);
    const double a = std::acos(0.9), top = 0.85 + 6 * std::sin(a);
    expectNear(at(m, "bar_left"), {0, top, -0.9});
    expectNear(at(m, "bar_right"), {0, top, 0.9});
    expectNear(at(m, "platform"), {0, top + 0.15, 0});
    const Layout layout = layoutOf(m.world);
    EXPECT_LT(jointGapMax(layout, posesOf(m.world, layout)), 1e-6);
    EXPECT_LT(jointAngleMax(layout, posesOf(m.world, layout)), 1e-6);
    EXPECT_LT(startOverlap(m), 1e-6);
  }
}

TEST(Scenes, ScissorIsLoadedAfter300Steps) {
  const Scene& scene = *find("scissor");
  Model m = scene.make({});
  scene.before(m, 299);
  EXPECT_NEAR(at(m, "box_0").x, 3, 1e-6);
  scene.before(m, 300);
  expectNear(at(m, "box_0"), at(m, "platform") + Vec3d{-0.25, 0.1 + 0.005 + 0.25, 0});
  expectNear(at(m, "box_7"), at(m, "platform") + Vec3d{0.25, 0.1 + 0.005 + 0.75, 0.5});
  // Half a period after the start the lift is at its highest.
  EXPECT_NEAR(m.world.sliderJoint(m.joints[0].id).drive.position, -1.2, 1e-6);
}

TEST(Scenes, Ragdolls) {
  const Model m = make("ragdolls");
  EXPECT_EQ(dynamicCount(m), 50u * 16u);
  EXPECT_EQ(m.world.jointCount(), 50u * 15u);
  EXPECT_EQ(startOverlap(m), 0);
  const Layout layout = layoutOf(m.world);
  EXPECT_LT(jointGapMax(layout, posesOf(m.world, layout)), 1e-6);
}

TEST(Measure, JointsByWhatTheyHold) {
  Build build("joints", {});
  const BodyId body = build.box("box", {0.5f, 0.5f, 0.5f}, {0, 0, 0}, 1);
  build.join(SliderJoint{}, {}, body, {{}, turned({0, 0, 1}, 0.5)});
  Model m = build.take();
  const Layout slider = layoutOf(m.world);
  const auto gap = [&](const Layout& layout) { return jointGapMax(layout, posesOf(m.world, layout)); };
  m.world.setPose(body, {{std::cos(0.5), std::sin(0.5), 0}, {}});
  EXPECT_NEAR(gap(slider), 0, 1e-6);
  m.world.setPose(body, {{-std::sin(0.5), std::cos(0.5), 0}, turned({0, 1, 0}, 0.1)});
  EXPECT_NEAR(gap(slider), 1, 1e-6);
  EXPECT_NEAR(jointAngleMax(slider, posesOf(m.world, slider)), 0.1, 1e-6);
  m.world.destroy(m.world.joints()[0]);
  m.world.create(DistanceJoint{.bodyB = body, .min = 0.2f, .max = 0.5f});
  m.world.create(PulleyJoint{.bodyB = body, .wheelA = {0, 3, 0}, .wheelB = {0, 3, 0}, .length = 5.5f});
  const Layout ropes = layoutOf(m.world);
  m.world.setPose(body, {{0, 0.4, 0}, {}});
  EXPECT_NEAR(gap(ropes), 0.1, 1e-6);  // 3 + 2.6 of 5.5
  m.world.setPose(body, {{0, 0.9, 0}, {}});
  EXPECT_NEAR(gap(ropes), 0.4, 1e-6);
}

TEST(Measure, TwistAndSwing) {
  const TwistSwing q = twistSwing(turned({0, 0.6f, 0.8f}, 2.0) * turned({1, 0, 0}, -0.7));
  EXPECT_NEAR(q.twist, -0.7, 1e-6);
  EXPECT_NEAR(q.y, 1.2, 1e-6);
  EXPECT_NEAR(q.z, 1.6, 1e-6);
}

TEST(Scenes, CardHouse) {
  const Model m = cardHouse({}, 0);
  EXPECT_EQ(dynamicCount(m), 40u);
  EXPECT_LT(startOverlap(m), 1e-6);
  // Every card of another order is a card of the first.
  std::multiset<double> first, second;
  const Model other = cardHouse({}, 4);
  for (const NamedBody& b : m.bodies) first.insert(m.world.pose(b.id).position.y);
  for (const NamedBody& b : other.bodies) second.insert(other.world.pose(b.id).position.y);
  EXPECT_EQ(first, second);
  EXPECT_NE(m.world.pose(m.bodies[1].id).position, other.world.pose(other.bodies[1].id).position);
}

TEST(Figures, PassOnlyWithinFiniteBounds) {
  EXPECT_TRUE(passes(atMost("x", 0.5, 1, "m")));
  EXPECT_FALSE(passes(atMost("x", 1.5, 1, "m")));
  EXPECT_FALSE(passes(atMost("x", NAN, 1, "m")));
  EXPECT_TRUE(passes(within("x", -1.01, -1, 0.02, "m")));
  EXPECT_FALSE(passes(within("x", -1.03, -1, 0.02, "m")));
  EXPECT_FALSE(passes(holds("x", false)));
}

TEST(Settings, ReplaceOnlyWhatIsSet) {
  WorldDef def;
  def.iterations = 7;
  Settings settings;
  settings.substeps = 3;
  const WorldDef changed = apply(settings, def);
  EXPECT_EQ(changed.iterations, 7);
  EXPECT_EQ(changed.substeps, 3);
}

}  // namespace
}  // namespace avbd::scenes
