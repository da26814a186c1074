// The URDF reader against MuJoCo's own: masses, inertias and poses of the same robots.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>

#include "io/mjcf_mass.h"
#include "io/mujoco_compare.h"
#include "io/simbody_robots.h"
#include "io/urdf.h"
#include "io/urdf_parse.h"

namespace avbd {
namespace {

namespace fs = std::filesystem;

using mjcf::Mass;
using mjcf::Posed;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Loaded {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data{nullptr, mj_deleteData};
};

// MuJoCo merges fixed links into their parents unless it is told not to.
Loaded load(std::string text) {
  mju_user_warning = [](const char*) {};
  const size_t robot = text.find('>', text.find("<robot"));
  text.insert(robot + 1, "<mujoco><compiler fusestatic=\"false\" discardvisual=\"true\"/></mujoco>");
  const std::string path = mjcf::folder() + "/robot.urdf";
  std::ofstream(path) << text;
  Loaded out;
  char error[1000] = "";
  out.model.reset(mj_loadXML(path.c_str(), nullptr, error, sizeof error));
  EXPECT_TRUE(out.model) << error;
  if (!out.model) return out;
  out.data.reset(mj_makeData(out.model.get()));
  mj_kinematics(out.model.get(), out.data.get());
  return out;
}

Posed poseIn(const Loaded& mj, int body) {
  const mjtNum *p = mj.data->xpos + 3 * body, *q = mj.data->xquat + 4 * body;
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

// In the body's frame.
Mass massIn(const Loaded& mj, int body) {
  const mjModel* m = mj.model.get();
  const mjtNum *p = m->body_ipos + 3 * body, *q = m->body_iquat + 4 * body, *d = m->body_inertia + 3 * body;
  return {m->body_mass[body], {p[0], p[1], p[2]}, mjcf::rotated({d[0], d[1], d[2]}, {q[0], q[1], q[2], q[3]})};
}

void expectSame(const Mass& ours, const Mass& theirs, double tolerance, const std::string& what) {
  EXPECT_NEAR(ours.mass, theirs.mass, tolerance * theirs.mass) << what;
  EXPECT_NEAR(length(ours.center - theirs.center), 0, tolerance) << what;
  const mjcf::Sym3d &a = ours.inertia, &b = theirs.inertia;
  const double scale = tolerance * (std::abs(b.xx) + std::abs(b.yy) + std::abs(b.zz));
  EXPECT_NEAR(a.xx, b.xx, scale) << what;
  EXPECT_NEAR(a.yy, b.yy, scale) << what;
  EXPECT_NEAR(a.zz, b.zz, scale) << what;
  EXPECT_NEAR(a.xy, b.xy, scale) << what;
  EXPECT_NEAR(a.xz, b.xz, scale) << what;
  EXPECT_NEAR(a.yz, b.yz, scale) << what;
}

// Link by link, then the whole as one rigid body.
void compare(const std::string& text, const std::string& name) {
  const Loaded mj = load(text);
  ASSERT_TRUE(mj.model) << name;
  const urdf::Description d = urdf::parseText(text, name);
  const std::vector<Posed> poses = urdf::linkPoses(d);
  std::vector<Mass> parts;
  size_t compared = 0;
  for (size_t i = 0; i < d.links.size(); ++i) {
    const urdf::Link& link = d.links[i];
    const int body = mj_name2id(mj.model.get(), mjOBJ_BODY, link.name.c_str());
    if (link.joint < 0 && body < 0) continue;  // a root that stands still is MuJoCo's world
    ASSERT_GE(body, 0) << link.name;
    ++compared;
    const Posed theirs = poseIn(mj, body);
    EXPECT_NEAR(length(poses[i].position - theirs.position), 0, 1e-9) << link.name;
    const mjcf::Quatd &a = poses[i].rotation, &b = theirs.rotation;
    EXPECT_NEAR(std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z), 1, 1e-12) << link.name;
    if (!link.mass || !link.inertiaKnown) continue;
    expectSame(*link.mass, massIn(mj, body), 1e-6, link.name);
    parts.push_back(mjcf::moved(massIn(mj, body), theirs));
  }
  EXPECT_GE(compared + 1, d.links.size());
  if (compared < d.links.size() && d.links[static_cast<size_t>(d.order[0])].mass) {
    parts.push_back(*d.links[static_cast<size_t>(d.order[0])].mass);  // which MuJoCo drops
  }
  const std::regex movable("type=\"(revolute|continuous|prismatic)\"");
  const std::string fixed = std::regex_replace(text, movable, "type=\"fixed\"");
  const Model model = readUrdfText(fixed, name, {.floating = true, .badMesh = BadMesh::Note});
  ASSERT_EQ(model.bodies.size(), 1u);
  const BodyId id = model.bodies[0].id;
  const SymMat3 s = model.world.inertia(id);
  const Mass whole{model.world.mass(id), toDouble(model.world.centerOfMass(id)), {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}};
  expectSame(whole, mjcf::sum(parts), 1e-5, name);
}

TEST(UrdfOracle, Arm) {
  std::string text = textOf(fs::path(__FILE__).parent_path() / "corpus/urdf/good/arm.urdf");
  // MuJoCo knows no capsules in URDF.
  const size_t capsule = text.find("<capsule"), end = text.find("/>", capsule);
  ASSERT_NE(capsule, std::string::npos);
  text.replace(capsule, end - capsule, "<sphere radius=\"0.03\"");
  // Nor mimics, whose offset moves where the robot starts.
  compare(std::regex_replace(text, std::regex("<mimic[^>]*/>"), ""), "arm.urdf");
}

TEST(UrdfOracle, Turns) {
  std::string text = "<robot name=\"r\"><link name=\"l0\"/>";
  const char* const turns[] = {"0.1 0 0", "0 0.2 0", "0 0 0.3", "1 2 3", "-1 4 -2.5", "3.14159 1.5708 -1.5708"};
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i + 1);
    text += "<link name=\"l" + n + "\"><inertial><origin xyz=\"0.1 0.2 " + n + "\" rpy=\"" + turns[5 - i] +
            "\"/><mass value=\"" + n +
            "\"/><inertia ixx=\"3\" ixy=\"0.1\" ixz=\"-0.2\" iyy=\"4\" iyz=\"0.3\" izz=\"5\"/>" +
            "</inertial></link><joint name=\"j" + n + "\" type=\"" + (i % 2 ? "fixed" : "continuous") +
            "\"><parent link=\"l" + std::to_string(i) + "\"/><child link=\"l" + n + "\"/><origin xyz=\"1 2 3\" rpy=\"" +
            turns[i] + "\"/><axis xyz=\"0 0 1\"/></joint>";
  }
  compare(text + "</robot>", "turns.urdf");
}

std::string unpacked(const std::string& file) {
  const std::string to = mjcf::folder() + "/unpacked.urdf";
  EXPECT_EQ(std::system(("gzip -dc '" + file + "' > '" + to + "'").c_str()), 0);
  return textOf(to);
}

std::string without(std::string text, const std::string& element, const std::string& holding) {
  const std::string open = "<" + element, close = "</" + element + ">";
  size_t at = text.find(open);
  while (at != std::string::npos) {
    const size_t end = text.find(close, at) + close.size();
    const bool erase = text.substr(at, end - at).find(holding) != std::string::npos;
    if (erase) text.erase(at, end - at);
    at = text.find(open, erase ? at : end);
  }
  return text;
}

// Everything but the meshes, whose files neither reader is given.
std::string withoutMeshes(std::string text) {
  return without(without(without(std::move(text), "gazebo", ""), "visual", ""), "collision", "<mesh");
}

TEST(UrdfOracle, Robots) {
  if (const char* why = simbodyRobotsMissing()) GTEST_SKIP() << why;
  const std::string source = (kSimbodyExamples / "TaskSpaceControl-").string();
  compare(withoutMeshes(unpacked(source + "UR10/models/ur10_robot.urdf.gz")), "ur10_robot.urdf");
  std::string atlas = withoutMeshes(unpacked(source + "Atlas/models/atlas_v4.urdf.gz"));
  // No body can have the head's inertia: MuJoCo refuses it, and ours is repaired.
  const std::string impossible = "ixx=\"0.0036053766\"";
  ASSERT_NE(atlas.find(impossible), std::string::npos);
  atlas.replace(atlas.find(impossible), impossible.size(), "ixx=\"0.0025\"");
  compare(atlas, "atlas_v4.urdf");
}

// Without what MuJoCo has not (mimics, bounds of velocity) or has softer (bounds).
std::string withoutBounds(std::string text) {
  text = std::regex_replace(text, std::regex("<mimic[^>]*/>"), "");
  text = std::regex_replace(text, std::regex("<limit[^>]*/>"), "");
  return std::regex_replace(text, std::regex("type=\"revolute\""), "type=\"continuous\"");
}

// [rad, m] Largest difference of a joint's position from MuJoCo's by Runge-Kutta over the time.
struct Strayed {
  double ours = 0, theirs = 0;  // theirs: of MuJoCo by Euler with the same step
};

// The robot is limp, and nothing collides.
Strayed compareMotion(const std::string& text, const std::string& name, double time, double dt) {
  const Loaded exact = load(text), euler = load(text);
  EXPECT_TRUE(exact.model && euler.model) << name;
  if (!exact.model || !euler.model) return {1, 0};
  for (mjModel* m : {exact.model.get(), euler.model.get()}) {
    m->opt.timestep = dt;
    m->opt.disableflags |= mjDSBL_CONTACT;
  }
  exact.model->opt.integrator = mjINT_RK4;
  Model model = readUrdfText(text, name, {.limp = true, .badMesh = BadMesh::Note, .selfCollision = false});
  EXPECT_EQ(static_cast<int>(model.joints.size()), exact.model->njnt) << name;
  Strayed out;
  double turned = 0;
  for (int i = 0; i < time / dt; ++i) {
    mj_step(exact.model.get(), exact.data.get());
    mj_step(euler.model.get(), euler.data.get());
    model.world.step(static_cast<float>(dt));
    for (const NamedJoint& joint : model.joints) {
      const int at = exact.model->jnt_qposadr[mj_name2id(exact.model.get(), mjOBJ_JOINT, joint.name.c_str())];
      const double q = exact.data->qpos[at];
      const double ours = model.world.coordinate(joint.id, joint.axis).position + joint.offset;
      out.ours = std::max(out.ours, std::abs(ours - q));
      out.theirs = std::max(out.theirs, std::abs(euler.data->qpos[at] - q));
      turned = std::max(turned, std::abs(q));
    }
  }
  std::printf("%-16s %.1f s of %g s: turned %.2f, strays %.5f; MuJoCo by Euler %.5f\n", name.c_str(), time, dt, turned,
              out.ours, out.theirs);
  return out;
}

void expectMotion(const std::string& text, const std::string& name) {
  const Strayed coarse = compareMotion(text, name, 1, 0.002), fine = compareMotion(text, name, 1, 0.001);
  EXPECT_LT(coarse.ours, 0.02) << name;
  EXPECT_LT(coarse.ours, coarse.theirs) << name;
  EXPECT_LT(fine.ours, 0.6 * coarse.ours) << name;
}

TEST(UrdfOracle, ALimpArmMovesAsTheirs) {
  std::string text = textOf(fs::path(__FILE__).parent_path() / "corpus/urdf/good/arm.urdf");
  const size_t capsule = text.find("<capsule"), end = text.find("/>", capsule);
  text.replace(capsule, end - capsule, "<sphere radius=\"0.03\"");
  text = std::regex_replace(withoutBounds(text), std::regex("friction=\"0.1\""), "friction=\"0\"");
  expectMotion(text, "arm.urdf");
}

TEST(UrdfOracle, LimpRobotsMoveAsTheirs) {
  if (const char* why = simbodyRobotsMissing()) GTEST_SKIP() << why;
  const std::string source = (kSimbodyExamples / "TaskSpaceControl-").string();
  const std::string ur10 = withoutBounds(withoutMeshes(unpacked(source + "UR10/models/ur10_robot.urdf.gz")));
  expectMotion(ur10, "ur10_robot.urdf");
  std::string atlas = withoutBounds(withoutMeshes(unpacked(source + "Atlas/models/atlas_v4.urdf.gz")));
  const std::string impossible = "ixx=\"0.0036053766\"";
  ASSERT_NE(atlas.find(impossible), std::string::npos);
  atlas.replace(atlas.find(impossible), impossible.size(), "ixx=\"0.0025\"");
  expectMotion(atlas, "atlas_v4.urdf");
}

}  // namespace
}  // namespace avbd
