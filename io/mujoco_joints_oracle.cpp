// Mechanisms side by side with MuJoCo: how far joint coordinates come apart in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/mjcf.h"
#include "io/mujoco_compare.h"

namespace avbd {
namespace {

using namespace mjcf;

/// Of two runs of the same model: the largest difference of a joint's coordinate at any time [rad, m].
struct Apart {
  double hinge = 0, slide = 0;
  double moved = 0;  ///< how far the farthest coordinate came from its start: nothing is shown by standing still
};

// MuJoCo goes by fourth-order steps a tenth as long, so that the difference is ours.
Apart runBoth(const std::string& xml, double seconds, double dt) {
  const std::string file = write("<mujoco>" + xml + "</mujoco>");
  const Loaded mj = load(file);
  EXPECT_TRUE(mj.model) << mj.error;
  if (!mj.model) return {};
  mjModel* m = mj.model.get();
  mjData* d = mj.data.get();
  m->opt.integrator = mjINT_RK4;
  m->opt.timestep = dt / 10;
  if (m->nkey > 0) {
    mj_resetDataKeyframe(m, d, 0);
  } else {
    mj_resetData(m, d);
  }
  Model model = readMjcf(file);
  std::vector<double> starts;
  const auto coordinate = [&](const NamedJoint& joint) {
    return joint.sign * model.world.coordinate(joint.id, joint.axis).position + joint.offset;
  };
  for (const Actuator& actuator : model.actuators) {
    const int id = mj_name2id(m, mjOBJ_ACTUATOR, actuator.name.c_str());
    if (id >= 0) d->ctrl[id] = actuator.control;
  }
  for (const NamedJoint& joint : model.joints) starts.push_back(coordinate(joint));
  Apart apart;
  for (int step = 0; step * dt < seconds; ++step) {
    model.world.step(static_cast<float>(dt));
    for (int k = 0; k < 10; ++k) mj_step(m, d);
    for (size_t i = 0; i < model.joints.size(); ++i) {
      const NamedJoint& joint = model.joints[i];
      const int id = mj_name2id(m, mjOBJ_JOINT, joint.name.c_str());
      EXPECT_GE(id, 0) << joint.name;
      const double ours = coordinate(joint), difference = std::abs(ours - d->qpos[m->jnt_qposadr[id]]);
      double& worst = m->jnt_type[id] == mjJNT_HINGE ? apart.hinge : apart.slide;
      worst = std::max(worst, difference);
      apart.moved = std::max(apart.moved, std::abs(ours - starts[i]));
    }
  }
  return apart;
}

constexpr const char* kOff = "<option><flag contact='disable'/></option><compiler angle='radian' autolimits='true'/>";

struct Mechanism {
  const char* name;
  const char* xml;
  double most;  ///< [rad, m] apart within the first second at 1/500 s
};

const Mechanism kMechanisms[] = {
    {"double pendulum",
     "<worldbody><body pos='0 0 2'><joint name='a' axis='0 1 0'/><geom type='capsule' size='.05' fromto='0 0 0 1 0 0'/>"
     "<body pos='1 0 0'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.05' fromto='0 0 0 1 0 0'/></body>"
     "</body></worldbody>",
     0.015},
    {"cart and pole",
     "<worldbody><body><joint name='x' type='slide' axis='1 0 0'/><geom type='box' size='.2 .1 .1' mass='2'/>"
     "<body><joint name='pole' axis='0 1 0'/><geom type='capsule' size='.03' fromto='0 0 0 .1 0 .8' mass='.5'/></body>"
     "</body></worldbody>",
     0.02},
    {"tree",
     "<worldbody><body pos='0 0 2'><joint name='root' axis='0 1 0'/><geom type='box' size='.3 .1 .1' pos='.2 0 0'/>"
     "<body pos='.5 .1 0'><joint name='left' axis='1 0 0'/><geom type='capsule' size='.04' fromto='0 0 0 0 .5 .1'/>"
     "<body pos='0 .5 .1'><joint name='leftLower' axis='0 0 1'/><geom type='capsule' size='.03' fromto='0 0 0 .1 .4 "
     "0'/>"
     "</body></body><body pos='.5 -.1 0'><joint name='right' axis='1 1 0'/>"
     "<geom type='capsule' size='.04' fromto='0 0 0 .2 -.5 .1'/></body></body></worldbody>",
     0.03},
    {"two hinges of one body",
     "<worldbody><body><joint name='first' axis='0 1 0' range='-2.5 2.5'/><joint name='second' axis='1 0 0'/>"
     "<geom type='capsule' size='.05' fromto='0 0 0 .2 .3 -.5'/></body></worldbody>",
     0.005},
    {"two hinges, the second with limits",
     "<worldbody><body><joint name='first' axis='0 1 0'/><joint name='second' axis='1 0 0' range='-2.5 2.5'/>"
     "<geom type='capsule' size='.05' fromto='0 0 0 .2 .3 -.5'/></body></worldbody>",
     0.005},
    {"two hinges without limits",
     "<worldbody><body><joint name='first' axis='0 1 0'/><joint name='second' axis='1 0 0'/>"
     "<geom type='capsule' size='.05' fromto='0 0 0 .5 .3 0'/></body></worldbody>",
     0.03},
    {"three hinges of one body",
     "<worldbody><body><joint name='first' axis='1 0 0' range='-2 2'/><joint name='second' axis='0 0 1' range='-2 2'/>"
     "<joint name='third' axis='0 1 0' range='-2 2'/><geom type='capsule' size='.05' fromto='0 0 0 .2 .3 -.5'/>"
     "</body></worldbody>",
     0.01},
    {"two hinges at different places",
     "<worldbody><body><joint name='first' axis='0 1 0' pos='0 0 .08'/><joint name='second' axis='1 0 .5' pos='0 0 "
     ".04'/>"
     "<geom type='box' size='.3 .1 .05' pos='.2 .1 0'/></body></worldbody>",
     0.01},
    {"two slides and a hinge",
     "<worldbody><body><joint name='x' type='slide' axis='1 0 0' stiffness='200'/>"
     "<joint name='z' type='slide' axis='0 0 1' stiffness='300'/><joint name='turn' axis='0 1 0' pos='.1 0 .05'/>"
     "<geom type='box' size='.3 .1 .05' mass='2' pos='.2 0 0'/></body></worldbody>",
     0.03},
    {"springs, dampers, armature",
     "<worldbody><body><joint name='a' axis='0 1 0' stiffness='20' springref='.5' damping='.5' armature='.2'/>"
     "<geom type='capsule' size='.05' fromto='0 0 0 .6 0 0' mass='2'/><body pos='.6 0 0'>"
     "<joint name='b' type='slide' axis='1 0 1' stiffness='100' springref='.1' damping='2' armature='.5'/>"
     "<geom size='.1' mass='1'/></body></body></worldbody>",
     0.04},
    {"references and a keyframe",
     "<worldbody><body pos='0 0 1' euler='0 .3 0'><joint name='x' type='slide' axis='1 1 0' ref='.2' stiffness='50'/>"
     "<joint name='h' axis='0 1 1' ref='-.4' pos='0 .1 0'/><geom type='box' size='.2 .1 .1' mass='1'/>"
     "<body pos='.4 0 0'><joint name='k' axis='0 1 0' ref='1'/><geom type='box' size='.2 .05 .05' pos='.2 0 0'/></body>"
     "</body></worldbody><keyframe><key qpos='.3 .5 4' qvel='-.2 1 -3'/></keyframe>",
     0.06},
    {"servos",
     "<worldbody><body><joint name='a' axis='0 1 0' damping='.2'/><geom type='capsule' size='.05' fromto='0 0 0 .6 0 "
     "0'/>"
     "<body pos='.6 0 0'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.04' fromto='0 0 0 .5 0 0'/></body>"
     "</body></worldbody><actuator><position name='p' joint='a' kp='300' gear='2'/><velocity name='v' joint='b' "
     "kv='3'/>"
     "<motor name='m' joint='b' gear='5'/></actuator>"
     "<keyframe><key qpos='.2 .1' ctrl='1 .5 .4'/></keyframe>",
     0.06},
    {"a tendon over two hinges",
     "<worldbody><body><joint name='a' axis='0 1 0'/><geom type='capsule' size='.05' fromto='0 0 0 .6 0 0'/>"
     "<body pos='.6 0 0'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.04' fromto='0 0 0 .5 0 0'/></body>"
     "</body></worldbody><tendon><fixed name='t' stiffness='60' springlength='.3' damping='1'><joint joint='a' "
     "coef='.5'/>"
     "<joint joint='b' coef='-1'/></fixed></tendon><actuator><motor name='m' tendon='t' gear='3'/></actuator>"
     "<keyframe><key ctrl='.5'/></keyframe>",
     0.03},
};

class Mechanisms : public testing::TestWithParam<Mechanism> {};

TEST_P(Mechanisms, MoveAsInMujoco) {
  const Apart apart = runBoth(std::string(kOff) + GetParam().xml, 1, 1.0 / 500);
  const Apart finer = runBoth(std::string(kOff) + GetParam().xml, 1, 1.0 / 4000);
  std::printf("%-36s %.5f rad %.5f m apart, %.5f rad %.5f m at 1/4000 s; moved %.2f\n", GetParam().name, apart.hinge,
              apart.slide, finer.hinge, finer.slide, apart.moved);
  EXPECT_LT(apart.hinge, GetParam().most);
  EXPECT_LT(apart.slide, GetParam().most);
  // What is left is the step's: it shrinks with it, but for the share of bodies between.
  EXPECT_LT(finer.hinge, 0.3 * apart.hinge + 0.01);
  EXPECT_LT(finer.slide, 0.3 * apart.slide + 0.01);
  EXPECT_GT(apart.moved, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Mjcf, Mechanisms, testing::ValuesIn(kMechanisms), [](const auto& each) {
  std::string name = each.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

// Poses, coordinates and velocities that a keyframe gives, through all kinds and numbers of joints.
TEST(Oracle, KeyframesOfAllJoints) {
  const std::string file = write(R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody>
    <body name="a" pos="1 2 3" euler=".1 .2 .3"><joint name="a1" type="slide" axis="1 2 3"/><joint name="a2" axis="1 0 1" pos=".1 0 .2" ref="3"/>
      <joint name="a3" axis="1 1 -1" pos=".3 .1 0"/><geom size=".1" pos=".3 .2 .1"/>
      <body name="b" pos="0 1 0" quat="1 2 0 1"><joint name="b1" axis="0 1 0" range="-2 2" ref=".5"/><joint name="b2" axis="1 0 0"/>
        <joint name="b3" axis="0 0 1"/><geom size=".2" pos="0 0 .4"/>
        <body name="c" pos=".4 0 0"><joint name="c1" axis="0 1 0"/><joint name="c2" axis="0 0 1" range="-2 2"/><geom size=".1" pos=".3 0 0"/>
          <body name="d" pos=".4 0 .2" euler="0 1 0"><joint name="d1" axis="2 1 0"/><joint type="ball" pos=".1 0 0"/>
            <joint name="d2" type="slide" axis="1 1 1"/><geom type="box" size=".1 .2 .3" pos="0 .1 0"/></body></body></body></body>
    <body name="e"><joint name="e1" type="slide" axis="0 0 -1"/><joint name="e2" type="slide" axis="1 0 0"/><joint name="e3" axis="0 1 0"/>
      <geom size=".1" pos=".5 0 0"/></body></worldbody>
    <keyframe><key qpos=".3 7 -4 1.2 3 -.5 9 1.1 .8 .5 -.5 .5 .5 .7 -.3 .4 -5"
      qvel="1 -2 3 -1 2 -3 .5 -.6 .7 1 2 -1 .4 2 -1 .6"/></keyframe></mujoco>)");
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  const mjModel* m = mj.model.get();
  mj_resetDataKeyframe(m, mj.data.get(), 0);
  mj_forward(m, mj.data.get());
  const Model model = readMjcf(file);
  EXPECT_EQ(model.joints.size(), 13u);
  for (const NamedJoint& joint : model.joints) {
    const int id = mj_name2id(m, mjOBJ_JOINT, joint.name.c_str());
    const JointCoordinate now = model.world.coordinate(joint.id, joint.axis);
    EXPECT_NEAR(joint.sign * now.position + joint.offset, mj.data->qpos[m->jnt_qposadr[id]], 1e-5) << joint.name;
    EXPECT_NEAR(joint.sign * now.velocity, mj.data->qvel[m->jnt_dofadr[id]], 1e-4) << joint.name;
    EXPECT_LT(model.world.gap(joint.id), 1e-5) << joint.name;
    EXPECT_LT(model.world.angleError(joint.id), 1e-3) << joint.name;
  }
  for (const NamedBody& body : model.bodies) {
    const int id = mj_name2id(m, mjOBJ_BODY, body.name.c_str());
    if (id < 0) continue;  // one that stands between joints
    mjtNum v[6];
    mj_objectVelocity(m, mj.data.get(), mjOBJ_XBODY, id, v, 0);
    // At the frame: the centre of mass is elsewhere where light bodies took a part.
    const Velocity ours = model.world.velocity(body.id);
    const Pose pose = model.world.pose(body.id);
    const Vec3d arm = toDouble(rotate(pose.rotation, model.world.centerOfMass(body.id)));
    expectNear(toDouble(ours.angular), v, 1e-5, body.name);
    expectNear(toDouble(ours.linear) - cross(toDouble(ours.angular), arm), v + 3, 1e-5, body.name);
    expectNear(pose.position, mj.data->xpos + 3 * id, 1e-6, body.name);
  }
}

TEST(Oracle, EverySampleRunsForTwoSeconds) {
  const std::filesystem::path samples = "/usr/share/mujoco/model";
  if (!std::filesystem::exists(samples)) GTEST_SKIP() << "libmujoco-samples is not installed";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(samples)) {
    if (entry.path().extension() != ".xml") continue;
    SCOPED_TRACE(entry.path());
    Model model = readMjcf(entry.path());
    const float dt = static_cast<float>(model.dt);
    for (int i = 0; static_cast<float>(i) * dt < 2; ++i) model.world.step(dt);
    double gap = 0, fastest = 0;
    for (const JointId joint : model.world.joints()) gap = std::max(gap, model.world.gap(joint));
    for (const NamedBody& body : model.bodies) {
      fastest = std::max(fastest, static_cast<double>(length(model.world.velocity(body.id).linear)));
    }
    std::printf("%-28s %4zu bodies %4zu joints %3zu actuators: gap %.5f, %.2f m/s\n", entry.path().filename().c_str(),
                model.world.bodyCount(), model.world.jointCount(), model.actuators.size(), gap, fastest);
    EXPECT_LT(gap, 0.05);
    EXPECT_LT(fastest, 50);
  }
}

}  // namespace
}  // namespace avbd
