// Real robots: every URDF of Debian's libsimbody-dev, with its meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>

#include "io/simbody_robots.h"
#include "io/urdf.h"
#include "io/urdf_parse.h"

namespace avbd {
namespace {

namespace fs = std::filesystem;

// The robots unpacked, and their meshes where their package paths point to.
class Robots : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (simbodyRobotsMissing()) return;
    std::string pattern = (fs::temp_directory_path() / "avbd_robots_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    const fs::path atlas = kSimbodyExamples / "TaskSpaceControl-Atlas",
                   ur10 = kSimbodyExamples / "TaskSpaceControl-UR10";
    unpack(atlas / "models", folder_ / "atlas_description/urdf");
    unpack(atlas / "geometry", folder_ / "atlas_description/meshes_v3");
    unpack(atlas / "geometry", folder_ / "multisense_sl_description/meshes");
    unpack(ur10 / "models", folder_ / "ur_description/urdf");
    unpack(ur10 / "geometry", folder_ / "ur_description/meshes/ur10/collision");
    unpack(ur10 / "geometry", folder_ / "ur_description/meshes/ur10/visual");
  }
  static void TearDownTestSuite() {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  void SetUp() override {
    if (const char* why = simbodyRobotsMissing()) GTEST_SKIP() << why;
  }

  static void unpack(const fs::path& from, const fs::path& to) {
    fs::create_directories(to);
    for (const auto& entry : fs::directory_iterator(from)) {
      const fs::path file = entry.path();
      if (file.extension() != ".gz") {
        fs::copy_file(file, to / file.filename());
        continue;
      }
      const std::string command = "gzip -dc '" + file.string() + "' > '" + (to / file.stem()).string() + "'";
      ASSERT_EQ(std::system(command.c_str()), 0) << command;
    }
  }
  static fs::path atlas(const char* name) { return folder_ / "atlas_description/urdf" / name; }
  static fs::path ur10(const char* name) { return folder_ / "ur_description/urdf" / name; }

  static fs::path folder_;
};
fs::path Robots::folder_;

struct Expected {
  const char* file;
  size_t links, joints, moving, shapes, meshes;
  double mass;  // [kg] of all <mass> elements
};

size_t meshesIn(const Model& model) {
  size_t count = 0;
  for (const NamedBody& body : model.bodies) {
    for (const ShapeId shape : model.world.shapes(body.id)) {
      count += std::holds_alternative<Hull>(model.world.geometry(shape)) ? 1 : 0;
    }
  }
  return count;
}

double massOf(const Model& model) {
  double mass = 0;
  for (const NamedBody& body : model.bodies) mass += static_cast<double>(model.world.mass(body.id));
  return mass;
}

void expectRead(const fs::path& file, const Expected& e, const UrdfOptions& options) {
  const urdf::Description d = urdf::parseFile(file);
  EXPECT_EQ(d.links.size(), e.links) << e.file;
  EXPECT_EQ(d.joints.size(), e.joints) << e.file;
  for (const bool floating : {false, true}) {
    UrdfOptions with = options;
    with.floating = floating;
    const Model model = readUrdf(file, with);
    EXPECT_EQ(model.world.shapeCount(), e.shapes) << e.file;
    EXPECT_EQ(meshesIn(model), e.meshes) << e.file;
    std::string notes;
    for (const std::string& note : model.notes) notes += note + "\n";
    EXPECT_LT(model.notes.size(), 60u) << notes;
    EXPECT_EQ(model.joints.size(), e.moving) << e.file;
    EXPECT_EQ(model.actuators.size(), e.moving) << e.file;
    if (floating) {
      EXPECT_NEAR(massOf(model), e.mass, 1e-6 * e.mass) << e.file;
    }
  }
}

TEST_F(Robots, AreRead) {
  const Expected atlases[] = {{"atlas_v4.urdf", 47, 46, 29, 80, 1, 159.854574},
                              {"atlas_v4_free_pelvis.urdf", 48, 47, 29, 80, 1, 159.854574},
                              {"atlas_v4_grounded.urdf", 47, 47, 29, 80, 1, 159.854574},
                              {"atlas_v4_locked_pelvis.urdf", 48, 47, 29, 80, 1, 159.854574},
                              {"atlas_v4_upper.urdf", 36, 35, 17, 50, 1, 123.100574}};
  for (const Expected& e : atlases) expectRead(atlas(e.file), e, {});
  for (const char* name : {"ur10_robot.urdf", "ur10_joint_limited_robot.urdf"}) {
    expectRead(ur10(name), {name, 9, 8, 6, 7, 7, 32.7}, {});
  }
}

// The package of this robot's hands is not in Debian.
TEST_F(Robots, WithMeshesMissingNeedsToBeAskedFor) {
  const fs::path file = atlas("atlas_v4_robotiq_hands.urdf");
  try {
    readUrdf(file);
    ADD_FAILURE() << "read without its hands";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("robotiq_hand_description"), std::string::npos) << error.what();
  }
  UrdfOptions options;
  options.badMesh = BadMesh::Note;
  expectRead(file, {"atlas_v4_robotiq_hands.urdf", 73, 72, 53, 82, 1, 163.734854}, options);
}

double lowestPoint(const Model& model, BodyId body) {
  double lowest = 1e9;
  const Pose pose = model.world.pose(body);
  for (const ShapeId id : model.world.shapes(body)) {
    const Pose at = pose * model.world.localPose(id);
    const Vec3d z = rotate(conjugate(at.rotation), Vec3d{0, 0, 1});
    double depth = 0;
    if (const Geometry g = model.world.geometry(id); const Box* box = std::get_if<Box>(&g)) {
      depth = std::abs(z.x) * box->x + std::abs(z.y) * box->y + std::abs(z.z) * box->z;
    } else if (const Cylinder* c = std::get_if<Cylinder>(&g)) {
      depth = c->radius * std::sqrt(z.x * z.x + z.z * z.z) + c->halfHeight * std::abs(z.y);
    } else if (const Sphere* s = std::get_if<Sphere>(&g)) {
      depth = s->radius;
    } else {
      for (const Vec3& v : std::get<Hull>(g).data->vertices()) depth = std::max(depth, -dot(toDouble(v), z));
    }
    lowest = std::min(lowest, at.position.z - depth);
  }
  return lowest;
}

// Of all bodies but the last, the ground.
double lowestOfRobot(const Model& model) {
  double lowest = 1e9;
  for (size_t i = 0; i + 1 < model.bodies.size(); ++i) {
    lowest = std::min(lowest, lowestPoint(model, model.bodies[i].id));
  }
  return lowest;
}

TEST_F(Robots, AtlasDroppedLandsOnItsFeetAndStands) {
  UrdfOptions options;
  options.floating = true;
  options.ground = 0.3;
  Model model = readUrdf(atlas("atlas_v4.urdf"), options);
  ASSERT_EQ(model.bodies.size(), 31u);
  const double ground = model.world.pose(model.bodies.back().id).position.z;
  EXPECT_NEAR(lowestOfRobot(model) - ground, 0.3, 1e-4);
  double deepest = 0;
  for (int i = 0; i < 4 * 240; ++i) {
    model.world.step(static_cast<float>(model.dt));  // throws where the numbers end
    deepest = std::max(deepest, ground - lowestOfRobot(model));
  }
  EXPECT_LT(deepest, 0.011);  // as it lands at 2.4 m/s, 10 mm a step
  EXPECT_NEAR(lowestOfRobot(model), ground, 0.005);
  const auto isPelvis = [](const NamedBody& body) { return body.name == "pelvis"; };
  const auto pelvis = std::find_if(model.bodies.begin(), model.bodies.end(), isPelvis);
  ASSERT_NE(pelvis, model.bodies.end());
  EXPECT_GT(rotate(model.world.pose(pelvis->id).rotation, Vec3{0, 0, 1}).z, 0.999f);
  EXPECT_LT(model.world.kineticEnergy(), 0.01);
}

struct Held {
  double gap = 0, angle = 0;      // [m], [rad] of the joints, the largest of any step
  double turned = 0, excess = 0;  // [rad] from the start; beyond the bounds
};
Held holdFor(Model& model, double seconds) {
  std::vector<double> start;
  for (const NamedJoint& joint : model.joints) start.push_back(model.world.coordinate(joint.id, joint.axis).position);
  Held out;
  for (int i = 0; i < seconds * 60; ++i) {
    model.world.step(1.0f / 60);
    for (size_t k = 0; k < model.joints.size(); ++k) {
      const JointId id = model.joints[k].id;
      const double q = model.world.coordinate(id, model.joints[k].axis).position;
      const JointLimit limit = model.world.hingeJoint(id).limit;
      out.gap = std::max(out.gap, model.world.gap(id));
      out.angle = std::max(out.angle, model.world.angleError(id));
      out.turned = std::max(out.turned, std::abs(q - start[k]));
      out.excess = std::max({out.excess, static_cast<double>(limit.lower) - q, q - static_cast<double>(limit.upper)});
    }
  }
  return out;
}

void print(const fs::path& file, const Held& held) {
  std::printf("%-34s gap %.4f mm, angle %.4f mrad, turned %.2f mrad, beyond bounds %.4f mrad\n",
              file.filename().c_str(), held.gap * 1e3, held.angle * 1e3, held.turned * 1e3, held.excess * 1e3);
}

TEST_F(Robots, AreHeldWhereTheyStart) {
  for (const fs::path& file : {atlas("atlas_v4.urdf"), atlas("atlas_v4_upper.urdf"), ur10("ur10_robot.urdf"),
                               ur10("ur10_joint_limited_robot.urdf")}) {
    Model model = readUrdf(file);
    const Held held = holdFor(model, 2);
    EXPECT_LT(held.gap, 1e-3) << file;
    EXPECT_LT(held.angle, 1e-3) << file;
    EXPECT_LT(held.turned, 0.02) << file;
    EXPECT_LT(held.excess, 1e-3) << file;
    print(file, held);
  }
}

// 160 kg beside one foot: more than its ankle's 45 N m hold.
TEST_F(Robots, AtlasOnOneFootTipsAsItsEffortsSay) {
  Model model = readUrdf(atlas("atlas_v4_grounded.urdf"));
  const Held held = holdFor(model, 2);
  EXPECT_LT(held.gap, 1e-3);
  EXPECT_LT(held.excess, 1e-3);
  EXPECT_GT(held.turned, 0.5);
  print("atlas_v4_grounded.urdf", held);
}

TEST_F(Robots, LimpTheyHangFromTheirRootWithinTheirBounds) {
  for (const fs::path& file : {atlas("atlas_v4.urdf"), ur10("ur10_joint_limited_robot.urdf")}) {
    UrdfOptions options;
    options.limp = true;
    Model model = readUrdf(file, options);
    const Held hung = holdFor(model, 2);
    EXPECT_LT(hung.gap, 1e-3) << file;
    EXPECT_GT(hung.turned, 0.5) << file;
    EXPECT_LT(hung.excess, 2e-3) << file;
    print(file, hung);
  }
}

TEST_F(Robots, TruncatedAndMutatedEndInAModelOrAFileError) {
  UrdfOptions options;
  options.badMesh = BadMesh::Note;
  options.floating = true;
  for (const fs::path& file : {atlas("atlas_v4.urdf"), ur10("ur10_robot.urdf")}) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::mt19937 random(7);
    for (int i = 0; i < 150; ++i) {
      std::string other = text.substr(0, i < 50 ? random() % text.size() : text.size());
      for (int k = 0; i >= 50 && k < 3; ++k) other[random() % other.size()] = static_cast<char>(32 + random() % 95);
      try {
        readUrdfText(other, "t.urdf", options);
      } catch (const FileError&) {
      }
    }
  }
}

}  // namespace
}  // namespace avbd
