// From URDF text to a world: kinematics, masses, shapes and what is kept for later.
#include "io/urdf.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <regex>

#include "io/urdf_parse.h"

namespace avbd {
namespace {

using std::numbers::pi;

const std::filesystem::path kCorpus = std::filesystem::path(__FILE__).parent_path() / "corpus" / "urdf";

// An independent reckoning with matrices.
struct Mat {
  std::array<std::array<double, 3>, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};
Mat operator*(const Mat& a, const Mat& b) {
  Mat out;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) out.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
  return out;
}
Mat transposed(const Mat& a) {
  Mat out;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) out.m[i][j] = a.m[j][i];
  return out;
}
Vec3d operator*(const Mat& a, Vec3d v) {
  const auto row = [&](size_t i) { return a.m[i][0] * v.x + a.m[i][1] * v.y + a.m[i][2] * v.z; };
  return {row(0), row(1), row(2)};
}
Mat rpy(double r, double p, double y) {
  const Mat x{{{{1, 0, 0}, {0, std::cos(r), -std::sin(r)}, {0, std::sin(r), std::cos(r)}}}};
  const Mat yy{{{{std::cos(p), 0, std::sin(p)}, {0, 1, 0}, {-std::sin(p), 0, std::cos(p)}}}};
  const Mat z{{{{std::cos(y), -std::sin(y), 0}, {std::sin(y), std::cos(y), 0}, {0, 0, 1}}}};
  return z * (yy * x);
}
struct Frame {
  Vec3d p;
  Mat r;
};
Frame operator*(const Frame& a, const Frame& b) { return {a.p + a.r * b.p, a.r * b.r}; }

void expectSame(const mjcf::Posed& pose, const Frame& frame, const std::string& what) {
  EXPECT_NEAR(length(pose.position - frame.p), 0, 1e-12) << what;
  for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    EXPECT_NEAR(length(rotate(pose.rotation, axis) - frame.r * axis), 0, 1e-12) << what;
  }
}

// The links of arm.urdf: written here once more, from the file's numbers.
struct ArmPart {
  const char* name;
  Frame frame;  // in the base
  double mass;
  Vec3d center;
  Mat turn;     // of the inertia's frame
  Mat inertia;  // in that frame
};
// `slide`: position of the joint of that name, whose mimic starts it at 0.02 m.
std::vector<ArmPart> armParts(double slide = 0.02) {
  const Frame base;
  const Frame upper = base * Frame{{0, 0, 0.1}, rpy(0.1, -0.4, 0.9)};
  const Frame fore = upper * Frame{{0.3, 0.02, -0.01}, rpy(-2.5, 0.3, 1.7)};
  const Frame tool = fore * Frame{{0, 0.2, 0}, rpy(0, 0, -3)} * Frame{{slide, 0, 0}, {}};
  const Frame camera = tool * Frame{{0, 0, 0.03}, rpy(0.5, 0, 0)};
  const auto diagonal = [](double a, double b, double c) { return Mat{{{{a, 0, 0}, {0, b, 0}, {0, 0, c}}}}; };
  const Mat full{{{{0.01, 0.001, -0.0005}, {0.001, 0.03, 0.002}, {-0.0005, 0.002, 0.025}}}};
  return {{"base", base, 4, {0, 0, 0.05}, {}, diagonal(0.02, 0.02, 0.03)},
          {"upper", upper, 2, {0.1, 0, 0}, rpy(0.3, -0.2, 0.7), full},
          {"fore", fore, 1, {0, 0.1, 0}, {}, diagonal(0.005, 0.001, 0.005)},
          {"tool", tool, 0.3, {0, 0, 0.02}, {}, diagonal(0.0002, 0.0002, 0.0001)},
          {"camera_frame", camera, 0, {}, {}, {}}};
}

TEST(Urdf, LinksStandWhereTheMatricesSay) {
  const urdf::Description d = urdf::parseFile(kCorpus / "good/arm.urdf");
  const std::vector<mjcf::Posed> poses = urdf::linkPoses(d);
  const std::vector<ArmPart> expected = armParts();
  ASSERT_EQ(poses.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(d.links[i].name, expected[i].name);
    expectSame(poses[i], expected[i].frame, expected[i].name);
  }
}

// The robot with all joints fixed.
std::string welded(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return std::regex_replace(text, std::regex("type=\"(revolute|continuous|prismatic)\""), "type=\"fixed\"");
}

TEST(Urdf, MassAndInertiaAreThoseOfAllLinksTogether) {
  const Model model = readUrdfText(welded(kCorpus / "good/arm.urdf"), "arm.urdf", {.floating = true});
  ASSERT_EQ(model.bodies.size(), 1u);
  const BodyId body = model.bodies[0].id;
  const std::vector<ArmPart> parts = armParts(0);
  double mass = 0;
  Vec3d center;
  for (const ArmPart& part : parts) mass += part.mass;
  for (const ArmPart& part : parts) {
    center = center + (part.frame * Frame{part.center, {}}).p * (part.mass / mass);
  }
  Mat inertia{};
  inertia.m = {};
  for (const ArmPart& part : parts) {
    if (part.mass == 0) continue;
    const Mat turn = part.frame.r * part.turn;
    const Mat own = turn * (part.inertia * transposed(turn));
    const Vec3d d = (part.frame * Frame{part.center, {}}).p - center;
    const double v[3] = {d.x, d.y, d.z};
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) {
        inertia.m[i][j] += own.m[i][j] + part.mass * ((i == j ? dot(d, d) : 0) - v[i] * v[j]);
      }
    }
  }
  EXPECT_NEAR(model.world.mass(body), mass, 1e-6);
  EXPECT_NEAR(length(toDouble(model.world.centerOfMass(body)) - center), 0, 1e-7);
  const SymMat3 got = model.world.inertia(body);
  EXPECT_NEAR(got.xx, inertia.m[0][0], 1e-6);
  EXPECT_NEAR(got.yy, inertia.m[1][1], 1e-6);
  EXPECT_NEAR(got.zz, inertia.m[2][2], 1e-6);
  EXPECT_NEAR(got.xy, inertia.m[0][1], 1e-6);
  EXPECT_NEAR(got.xz, inertia.m[0][2], 1e-6);
  EXPECT_NEAR(got.yz, inertia.m[1][2], 1e-6);
}

TEST(Urdf, ShapesStandWhereTheirLinksDo) {
  const Model model = readUrdf(kCorpus / "good/arm.urdf");
  ASSERT_EQ(model.bodies.size(), 4u);
  EXPECT_EQ(model.world.type(model.bodies[0].id), BodyType::Static);
  std::vector<ShapeId> shapes;
  for (const NamedBody& body : model.bodies) {
    for (const ShapeId shape : model.world.shapes(body.id)) shapes.push_back(shape);
  }
  ASSERT_EQ(shapes.size(), 5u);
  const std::vector<ArmPart> parts = armParts();
  // Of each shape: its link, its origin, and the direction of its long axis, z in the file.
  const Frame expected[] = {
      parts[0].frame * Frame{{0, 0, 0.05}, {}}, parts[1].frame * Frame{{0.15, 0, 0}, rpy(0, pi / 2, 0)},
      parts[1].frame * Frame{{0.3, 0, 0}, {}}, parts[2].frame * Frame{{0, 0.1, 0}, rpy(pi / 2, 0, 0)},
      parts[3].frame * Frame{{}, rpy(0.1, 0.2, 0.3)}};
  for (size_t i = 0; i < 5; ++i) {
    const Pose pose = model.world.pose(model.world.body(shapes[i])) * model.world.localPose(shapes[i]);
    EXPECT_NEAR(length(pose.position - expected[i].p), 0, 1e-7) << i;
    const bool isLong = i != 2 && i != 4;
    const Vec3 got = rotate(pose.rotation, isLong ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
    EXPECT_NEAR(length(toDouble(got) - expected[i].r * Vec3d{0, 0, 1}), 0, 1e-6) << i;
  }
  const auto tube = std::get<Cylinder>(model.world.geometry(shapes[1]));
  EXPECT_FLOAT_EQ(tube.radius, 0.03f);
  EXPECT_FLOAT_EQ(tube.halfHeight, 0.15f);
  const auto box = std::get<Box>(model.world.geometry(shapes[4]));
  EXPECT_FLOAT_EQ(box.x, 0.05f);
  EXPECT_FLOAT_EQ(box.z, 0.02f);
  EXPECT_FLOAT_EQ(std::get<Capsule>(model.world.geometry(shapes[3])).halfHeight, 0.1f);
}

TEST(Urdf, JointDataIsKept) {
  const urdf::Description d = urdf::parseFile(kCorpus / "good/arm.urdf");
  ASSERT_EQ(d.joints.size(), 4u);
  const urdf::Joint& shoulder = d.joints[0];
  EXPECT_EQ(shoulder.kind, urdf::JointKind::Revolute);
  EXPECT_EQ(shoulder.axis, (Vec3d{0, 0, 1}));
  EXPECT_EQ(shoulder.limit->lower, -2);
  EXPECT_EQ(shoulder.limit->effort, 50);
  EXPECT_EQ(shoulder.limit->velocity, 3);
  EXPECT_EQ(shoulder.damping, 0.5);
  EXPECT_EQ(shoulder.friction, 0.1);
  EXPECT_EQ(shoulder.safety->softLower, -1.9);
  EXPECT_EQ(shoulder.calibration->rising, 0.1);
  EXPECT_FALSE(shoulder.calibration->falling);
  const urdf::Joint& slide = d.joints[2];
  EXPECT_EQ(slide.mimic->joint, 1);
  EXPECT_EQ(slide.mimic->multiplier, 0.01);
  EXPECT_EQ(slide.mimic->offset, 0.02);
  EXPECT_EQ(d.links[1].children, (std::vector<int>{1}));
  EXPECT_EQ(d.links[0].joint, -1);
  EXPECT_EQ(d.order, (std::vector<int>{0, 1, 2, 3, 4}));
  ASSERT_EQ(d.transmissions.size(), 1u);
  ASSERT_EQ(d.transmissions[0].driven.size(), 1u);
  EXPECT_EQ(d.transmissions[0].driven[0].joint, 0);
  EXPECT_EQ(d.transmissions[0].driven[0].actuator, "m");
  EXPECT_EQ(d.transmissions[0].type, "SimpleTransmission");
}

TEST(Urdf, FallsFreelyWhereNothingHoldsIt) {
  Model model = readUrdf(kCorpus / "good/arm.urdf", {.floating = true});
  EXPECT_EQ(model.up, (Vec3{0, 0, 1}));
  const double start = model.world.worldCenterOfMass(model.bodies[0].id).z;
  const int steps = 60;
  for (int i = 0; i < steps; ++i) model.world.step(1.0f / 60);
  // Between the two Euler sums of g t^2 / 2 at t = 1 s.
  EXPECT_NEAR(start - model.world.worldCenterOfMass(model.bodies[0].id).z, 9.81 / 2, 9.81 / 2 / steps + 1e-4);
}

TEST(Urdf, GroundTouchesTheLowestPoint) {
  // A box on its edge under a tilted link: its lowest point is known.
  const std::string xml = R"(<robot name="r"><link name="ground"/><link name="b"><collision><geometry>
    <box size="2 2 2"/></geometry></collision></link><joint name="j" type="fixed"><parent link="ground"/><child link="b"/>
    <origin xyz="0 0 5" rpy="0.7853981633974483 0 0"/></joint></robot>)";
  const Model model = readUrdfText(xml, "t.urdf", {.floating = true, .ground = 0.25});
  ASSERT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.bodies[0].name, "ground");
  EXPECT_EQ(model.bodies[1].name, "ground_");
  EXPECT_NEAR(model.world.pose(model.bodies[1].id).position.z, 5 - std::sqrt(2.0) - 0.25, 1e-12);
  EXPECT_EQ(model.world.type(model.bodies[1].id), BodyType::Static);
  EXPECT_THROW(readUrdfText(xml, "t.urdf", {.ground = std::nan("")}), Error);
  EXPECT_THROW(readUrdfText(xml, "t.urdf", {.ground = -1}), Error);
}

TEST(Urdf, RestsOnTheGround) {
  const std::string xml =
      R"(<robot name="r"><link name="b"><collision><geometry><box size="1 1 1"/></geometry></collision>
    <inertial><mass value="5"/><inertia ixx="0.8333" ixy="0" ixz="0" iyy="0.8333" iyz="0" izz="0.8333"/></inertial></link>
    </robot>)";
  Model model = readUrdfText(xml, "t.urdf", {.floating = true, .ground = 0.5});
  for (int i = 0; i < 120; ++i) model.world.step(1.0f / 60);
  EXPECT_NEAR(model.world.pose(model.bodies[0].id).position.z, -0.5, 0.01);
  EXPECT_LT(model.world.kineticEnergy(), 1e-3);
}

TEST(Urdf, FloatingAndBallJointsPartBodies) {
  Model model = readUrdf(kCorpus / "good/floating.urdf");
  ASSERT_EQ(model.bodies.size(), 4u);
  EXPECT_EQ(model.bodies[0].name, "world");
  EXPECT_EQ(model.world.type(model.bodies[0].id), BodyType::Static);
  EXPECT_EQ(model.bodies[1].name, "ball");
  EXPECT_EQ(model.bodies[2].name, "pole");
  EXPECT_NEAR(model.world.mass(model.bodies[1].id), 1000 * 4 * pi / 3 * 1e-3, 1e-3);
  EXPECT_FLOAT_EQ(model.world.mass(model.bodies[2].id), 1);
  EXPECT_EQ(model.world.pose(model.bodies[2].id).position, (Vec3d{0, 0, 1.5}));
  ASSERT_EQ(model.world.jointCount(), 2u);
  const JointId joint = model.world.joints()[0];
  EXPECT_EQ(model.world.type(joint), JointType::Ball);
  for (int i = 0; i < 60; ++i) model.world.step(1.0f / 60);
  EXPECT_LT(model.world.gap(joint), 1e-3);
  EXPECT_LT(model.world.pose(model.bodies[1].id).position.z, -3.5);
}

TEST(Urdf, MassesOfLinksWithoutThem) {
  const auto massOf = [](const char* file, size_t body = 0) {
    const Model model = readUrdf(kCorpus / "good" / file, {.floating = true});
    return model.world.mass(model.bodies.at(body).id);
  };
  const float box = 1000 * 0.2f * 0.2f * 0.2f;
  EXPECT_FLOAT_EQ(massOf("missing_inertial.urdf"), 1);
  EXPECT_FLOAT_EQ(massOf("missing_inertial.urdf", 1), box);  // the arm moves: 1000 kg/m^3
  EXPECT_FLOAT_EQ(massOf("fixed_without_mass.urdf"), 1);     // the plate does not move by itself: nothing
  EXPECT_FLOAT_EQ(massOf("zero_mass.urdf"), box);
  const auto inertiaOf = [](const char* file) {
    const Model model = readUrdf(kCorpus / "good" / file, {.floating = true});
    return model.world.inertia(model.bodies.at(0).id);
  };
  EXPECT_FLOAT_EQ(inertiaOf("zero_inertia.urdf").xx, 2 * 0.2f * 0.2f / 6);  // of its box
  // Of a ball of 2 kg at 1000 kg/m^3.
  const double radius = std::cbrt(2 / (1000 * 4 * pi / 3));
  EXPECT_NEAR(inertiaOf("no_inertia.urdf").yy, 0.4 * 2 * radius * radius, 1e-8);
}

TEST(Urdf, FrictionOfGazeboAndContact) {
  const Model model = readUrdf(kCorpus / "good/gazebo.urdf", {.floating = true});
  ASSERT_EQ(model.bodies.size(), 2u);
  const ShapeId shapes[] = {model.world.shapes(model.bodies[0].id).at(0), model.world.shapes(model.bodies[1].id).at(0)};
  EXPECT_FLOAT_EQ(model.world.material(shapes[0]).friction, 0.9f);
  EXPECT_FLOAT_EQ(model.world.material(shapes[1]).friction, 1.2f);
  EXPECT_FLOAT_EQ(model.world.material(shapes[1]).rollingFriction, 0.01f);
}

TEST(Urdf, NamesInLatin1AndUtf16BecomeUtf8) {
  EXPECT_EQ(readUrdf(kCorpus / "good/latin1.urdf").name, "h\xc3\xa4nd");
  EXPECT_EQ(readUrdf(kCorpus / "good/utf16.urdf").name, "h\xc3\xa4nd");
}

TEST(Urdf, VisualsCollideWhereAsked) {
  const std::string xml = R"(<robot name="r"><link name="b"><visual><geometry><sphere radius="1"/></geometry></visual>
    </link></robot>)";
  EXPECT_EQ(readUrdfText(xml, "t.urdf").world.shapeCount(), 0u);
  EXPECT_EQ(readUrdfText(xml, "t.urdf", {.collideVisuals = true}).world.shapeCount(), 1u);
}

TEST(Urdf, AWorldThatIsNoLinkHoldsTheRobot) {
  const Model model = readUrdf(kCorpus / "good/world_holds_foot.urdf");
  ASSERT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.bodies[0].name, "pelvis");
  EXPECT_EQ(model.world.type(model.bodies[0].id), BodyType::Dynamic);
  EXPECT_EQ(model.bodies[1].name, "foot");
  EXPECT_EQ(model.world.type(model.bodies[1].id), BodyType::Static);
  const Pose pose = model.world.pose(model.bodies[0].id);
  EXPECT_NEAR(length(pose.position - Vec3d{1, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(length(toDouble(rotate(pose.rotation, Vec3{1, 0, 0})) - Vec3d{0, -1, 0}), 0, 1e-6);
}

TEST(Urdf, ShapesHaveTheColorsOfTheirLinksVisuals) {
  const std::string ball = "<geometry><sphere radius='1'/></geometry>";
  const auto link = [&](const std::string& name, const std::string& material) {
    return "<link name='" + name + "'><visual>" + ball + "</visual><visual>" + ball + material +
           "</visual><collision>" + ball + "</collision></link>";
  };
  std::string xml = "<robot name='r'>";
  const char* const materials[] = {"<material name='blue'/>",
                                   "<material name=''><color rgba='1 0 0 0.5'/></material>",
                                   "<material name='own'><color rgba='0 1 0'/></material>",
                                   "<material name='own'/>",
                                   "<material name='blue'><color rgba='0 1 0 1'/></material>",
                                   "<material name='nowhere'/>",
                                   "<material name=''><color rgba='51 0 255 1'/></material>",
                                   "<material name=''><color rgba='red'/></material>",
                                   ""};
  for (size_t i = 0; i < std::size(materials); ++i) {
    xml += link("l" + std::to_string(i), materials[i]);
    if (i > 0) {
      xml += "<joint name='j" + std::to_string(i) + "' type='fixed'><parent link='l0'/><child link='l" +
             std::to_string(i) + "'/></joint>";
    }
  }
  xml += "<material name='blue'><color rgba='0 0 1 1'/></material></robot>";
  const Model model = readUrdfText(xml, "t.urdf");
  const std::optional<Color> expected[] = {Color{0, 0, 255},  Color{255, 0, 0, 128}, Color{0, 255, 0},
                                           Color{0, 255, 0},  Color{0, 0, 255},      std::nullopt,
                                           Color{51, 0, 255}, std::nullopt,          std::nullopt};
  const NamedBody& body = model.bodies.at(0);
  ASSERT_EQ(body.colors.size(), std::size(expected));
  ASSERT_EQ(model.world.shapes(body.id).size(), std::size(expected));
  for (size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(body.colors[i], expected[i]) << i;
  std::string notes;
  for (const std::string& note : model.notes) notes += note + "\n";
  for (const char* part : {"no material has this name", "taken for 0 .. 255", "rgba must be 4 numbers"}) {
    EXPECT_NE(notes.find(part), std::string::npos) << notes;
  }
}

// A body that moves and has nothing is refused only where that leaves a shape without mass.
TEST(Urdf, AFrameThatFloatsIsNoBody) {
  const Model model = readUrdfText("<robot name='r'><link name='a'/></robot>", "t.urdf", {.floating = true});
  EXPECT_TRUE(model.bodies.empty());
}

TEST(Urdf, DeepAndWideTreesAreRead) {
  std::string xml = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i <= 20000; ++i) {
    const std::string n = std::to_string(i), parent = std::to_string(i % 2 == 0 ? i - 1 : i / 2);
    xml += "<link name='l" + n + "'/><joint name='j" + n + "' type='continuous'><parent link='l" + parent +
           "'/><child link='l" + n + "'/><axis xyz='0 0 1'/></joint>";
  }
  const Model model = readUrdfText(xml + "</robot>", "t.urdf");
  EXPECT_EQ(model.bodies.size(), 1u);
  EXPECT_LT(model.notes.size(), 10u);
}

}  // namespace
}  // namespace avbd
