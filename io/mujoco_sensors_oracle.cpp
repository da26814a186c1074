// Probes against MuJoCo's sensors: the same file, the same state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/mjcf.h"
#include "io/mujoco_compare.h"
#include "io/probes.h"

namespace avbd {
namespace {

using namespace mjcf;

// Hinges, slides and a ball in several stages, a welded hand, fixed and spatial tendons, limits passed at the start.
constexpr const char* kArm = R"(
  <compiler angle="radian" autolimits="true"/>
  <option gravity="1 -2 -9" magnetic=".3 -.4 .5" timestep="0.0005"><flag contact="disable"/></option>
  <worldbody>
    <site name="post" pos="0 0 2" euler=".3 .1 -.2"/>
    <geom name="ground" type="plane" size="20 20 1" pos="0 0 -4"/>
    <body name="arm" pos="0 0 1" euler=".2 .3 .1">
      <joint name="shoulder" axis="0 1 .2" ref=".1" damping=".1"/>
      <geom name="upper" type="capsule" size=".06" fromto="0 0 0 .6 0 .1" mass="2"/>
      <site name="armSite" pos=".2 .1 .3" euler=".5 -.4 1"/>
      <body name="fore" pos=".6 0 .1" euler="0 .4 0">
        <joint name="reach" type="slide" axis="1 0 .3" range="-.1 .2" stiffness="40" damping="1"/>
        <joint name="elbow" axis="0 1 0" range="-2 2" damping=".1"/>
        <joint name="twist" axis="1 0 0"/>
        <inertial pos=".2 .05 0" mass="1.5" diaginertia=".02 .03 .04" euler=".1 .2 .3"/>
        <geom name="foreGeom" type="box" size=".2 .05 .04" pos=".2 0 0"/>
        <site name="wrist" pos=".4 .02 0" euler="0 0 .7"/>
        <body name="hand" pos=".4 0 0" euler=".1 0 .5">
          <geom name="palm" type="ellipsoid" size=".1 .05 .07" pos=".1 0 .02" mass=".7" euler=".2 0 0"/>
          <site name="palmSite" pos=".05 0 .1" euler="1 0 0"/>
          <body name="ball" pos=".2 0 0" euler="0 0 .3">
            <joint name="socket" type="ball" pos="0 .02 0"/>
            <geom name="weight" type="box" size=".05 .08 .1" pos="0 0 -.1" mass=".4"/>
            <site name="tip" pos=".03 .02 -.2" euler=".2 1 .3"/>
          </body>
        </body>
      </body>
    </body>
    <body name="free" pos="2 1 1" euler=".4 .2 0"><freejoint name="root"/>
      <geom name="shell" type="sphere" size=".2" pos=".1 0 0" mass="1"/><geom type="box" size=".1 .2 .3" mass="2"/>
      <site name="freeSite" pos=".2 .3 -.1" euler="1 2 3"/>
      <body name="tail" pos="0 0 .4"><joint name="tailJoint" axis="1 0 0"/>
        <geom size=".1" pos="0 .2 0" mass=".5"/></body>
    </body>
    <body name="shelf" pos="-2 0 1"><geom name="plank" type="box" size=".5 .5 .1" mass="3"/>
      <site name="shelfSite"/></body>
  </worldbody>
  <tendon>
    <fixed name="sum" range="-1 .3"><joint joint="elbow" coef=".5"/><joint joint="reach" coef="2"/></fixed>
    <spatial name="cord"><site site="post"/><site site="armSite"/><site site="tip"/></spatial>
  </tendon>
  <actuator>
    <motor name="motor" joint="elbow" gear="3"/>
    <position name="servo" joint="shoulder" kp="30" gear="2"/>
    <velocity name="brake" joint="reach" kv="5" forcerange="-1 1"/>
    <motor name="puller" tendon="sum" gear="-2"/>
  </actuator>)";

constexpr const char* kScalars = R"(
    <jointpos name="jp1" joint="shoulder"/><jointpos name="jp2" joint="reach"/><jointpos name="jp3" joint="twist"/>
    <jointvel name="jv1" joint="shoulder"/><jointvel name="jv2" joint="reach"/><jointvel name="jv3" joint="twist"/>
    <jointpos name="jpCut" joint="twist" cutoff=".2"/><jointvel name="jvCut" joint="shoulder" cutoff=".5"/>
    <tendonpos name="tp1" tendon="sum"/><tendonvel name="tv1" tendon="sum"/>
    <tendonpos name="tp2" tendon="cord"/><tendonvel name="tv2" tendon="cord"/>
    <actuatorpos name="ap1" actuator="servo"/><actuatorvel name="av1" actuator="servo"/>
    <actuatorpos name="ap2" actuator="puller"/><actuatorvel name="av2" actuator="puller"/>
    <actuatorfrc name="af1" actuator="motor"/><actuatorfrc name="af2" actuator="servo"/>
    <actuatorfrc name="af3" actuator="brake"/><actuatorfrc name="af4" actuator="puller"/>
    <jointlimitpos name="lp1" joint="reach"/><jointlimitvel name="lv1" joint="reach"/>
    <jointlimitpos name="lp2" joint="elbow"/><jointlimitvel name="lv2" joint="elbow"/>
    <tendonlimitpos name="lp3" tendon="sum"/><tendonlimitvel name="lv3" tendon="sum"/>
    <clock name="now"/><ballquat name="bq" joint="socket"/><ballangvel name="bv" joint="socket"/>)";

// Of every kind of frame, against the world and against every kind of reference.
std::string frameSensors() {
  const char* frames[][2] = {{"body", "fore"}, {"xbody", "fore"},  {"body", "hand"},     {"xbody", "ball"},
                             {"geom", "palm"}, {"geom", "plank"},  {"site", "tip"},      {"site", "palmSite"},
                             {"site", "post"}, {"xbody", "world"}, {"site", "freeSite"}, {"xbody", "free"}};
  const char* references[][2] = {{"", ""}, {"site", "wrist"}, {"xbody", "free"}, {"body", "fore"}, {"geom", "palm"}};
  std::string out;
  for (const auto& [kind, name] : frames) {
    for (const auto& [refKind, refName] : references) {
      for (const char* sensor :
           {"framepos", "framequat", "framexaxis", "frameyaxis", "framezaxis", "framelinvel", "frameangvel"}) {
        const std::string what = std::string(kind) + name + refName;
        out += std::string("<") + sensor + " name='" + sensor + "_" + what + "' objtype='" + kind + "' objname='" +
               name + "'";
        if (*refKind) out += std::string(" reftype='") + refKind + "' refname='" + refName + "'";
        out += "/>";
      }
    }
  }
  for (const char* site : {"tip", "palmSite", "wrist", "freeSite", "post", "shelfSite"}) {
    for (const char* sensor : {"velocimeter", "gyro", "magnetometer"}) {
      out += std::string("<") + sensor + " name='" + sensor + "_" + site + "' site='" + site + "'/>";
    }
  }
  out += "<velocimeter name='cut' site='tip' cutoff='.3'/>";
  for (const char* body : {"arm", "fore", "hand", "ball", "free", "tail", "world", "shelf"}) {
    for (const char* sensor : {"subtreecom", "subtreelinvel", "subtreeangmom"}) {
      out += std::string("<") + sensor + " name='" + sensor + "_" + body + "' body='" + body + "'/>";
    }
  }
  return out;
}

std::string stepSensors(const std::vector<const char*>& sites) {
  std::string out;
  for (const char* site : sites) {
    for (const char* sensor : {"accelerometer", "force", "torque"}) {
      out += std::string("<") + sensor + " name='" + sensor + "_" + site + "' site='" + site + "'/>";
    }
    for (const char* sensor : {"framelinacc", "frameangacc"}) {
      out += std::string("<") + sensor + " name='" + sensor + "_" + site + "' objtype='site' objname='" + site + "'/>";
    }
  }
  return out;
}

std::string fileOf(const std::string& model, const std::string& sensors, const std::string& keyframe = "") {
  return write("<mujoco>" + model + "<sensor>" + sensors + "</sensor>" + keyframe + "</mujoco>");
}

/// How far a probe is from MuJoCo's sensor of the same name, and how large that is.
struct Off {
  double by = 0, size = 0;
};

Off compared(const Probes& probes, size_t index, const Probe& probe, const mjModel* m, const mjtNum* data) {
  const int id = mj_name2id(m, mjOBJ_SENSOR, probe.name.c_str());
  EXPECT_GE(id, 0) << probe.name;
  const auto ours = probes.values(index);
  EXPECT_EQ(static_cast<int>(ours.size()), m->sensor_dim[id]) << probe.name;
  const mjtNum* theirs = data + m->sensor_adr[id];
  double sign = 1;
  if (ours.size() == 4) {  // a rotation has two
    double along = 0;
    for (size_t k = 0; k < 4; ++k) along += ours[k] * theirs[k];
    sign = along < 0 ? -1 : 1;
  }
  Off off;
  for (size_t k = 0; k < ours.size(); ++k) {
    off.by = std::hypot(off.by, sign * ours[k] - theirs[k]);
    off.size = std::hypot(off.size, theirs[k]);
  }
  if (!std::isfinite(off.by)) off.by = 1e300;
  return off;
}

// Coordinates, velocities and controls: four scalars, a ball, a free body, a hinge.
const char* const kStates[] = {
    "<key qpos='.1 0 0 0 1 0 0 0 2 1 1 1 0 0 0 0' qvel='0 0 0 0 0 0 0 0 0 0 0 0 0 0' ctrl='0 0 0 0'/>",
    "<key qpos='.7 .25 .4 -.6 .8 .2 -.4 .3 2 -1 .5 .5 .5 -.5 .5 .3' qvel='1 -.5 .7 -2 .5 1 -1.5 .3 -.2 .6 1 -2 .5 .9'"
    " ctrl='.5 .7 1 -.4'/>",
    "<key qpos='-1.2 -.15 -1.6 2 .3 -.7 .2 .5 -3 2 4 .1 .2 .3 .9 -1' qvel='-3 .2 2 1 -.5 2 .5 -4 1 2 3 1 -1 -2'"
    " ctrl='-1 -2 -.3 2'/>",
    "<key qpos='2.1 .05 2.1 -.2 1 1 1 1 0 0 9 1 0 0 1 2' qvel='.4 1 -.5 .2 3 -2 1 0 0 0 .1 .2 .3 4'"
    " ctrl='2 .1 .05 1'/>"};

TEST(Sensors, PlacesAndVelocitiesAreMujocos) {
  size_t compares = 0;
  double worst = 0;
  for (const char* state : kStates) {
    SCOPED_TRACE(state);
    const std::string file = fileOf(kArm, kScalars + frameSensors(), std::string("<keyframe>") + state + "</keyframe>");
    const Loaded mj = load(file);
    ASSERT_TRUE(mj.model) << mj.error;
    mj_resetDataKeyframe(mj.model.get(), mj.data.get(), 0);
    mj_forward(mj.model.get(), mj.data.get());
    const Model model = readMjcf(file);
    ASSERT_EQ(model.probes.size(), static_cast<size_t>(mj.model->nsensor));
    const Probes probes(model);
    for (size_t i = 0; i < model.probes.size(); ++i) {
      const Off off = compared(probes, i, model.probes[i], mj.model.get(), mj.data->sensordata);
      // Rotations of the world are floats, and a swing's rate is worth less where the swing is wide.
      const double relative = off.by / (1 + off.size);
      EXPECT_LT(relative, 1e-5) << model.probes[i].name << " " << off.by << " of " << off.size;
      worst = std::max(worst, relative);
      ++compares;
    }
  }
  std::printf("%zu readings: at most %.2g off\n", compares, worst);
}

// Ours are means over a step of 1/500 s; so are MuJoCo's here, over twenty steps of a fourth-order method. Of the fifth
// step: in the first, joints hold the velocities given as they are. Within 3 % of the reading (the two runs have come
// apart a little, drives are implicit) and 0.1 of its unit: rotations are floats, 1e-7 rad at an arm of 1 m over the
// step squared.
TEST(Sensors, AccelerationsAndForcesAreMujocosOverAStep) {
  const char* const states[] = {
      "<key qpos='.1 0 0 0 1 0 0 0 2 1 1 1 0 0 0 0' qvel='0 0 0 0 0 0 0 0 0 0 0 0 0 0' ctrl='0 0 0 0'/>",
      "<key qpos='.7 -.05 .4 -.6 .8 .2 -.4 .3 2 -1 .5 .5 .5 -.5 .5 .3' qvel='1 -.5 .7 -2 .5 1 -1.5 .3 -.2 .6 1 -2 .5 "
      ".9'"
      " ctrl='.5 .7 1 -.4'/>",
      "<key qpos='-1.2 .05 -.6 2 .3 -.7 .2 .5 -3 2 4 .1 .2 .3 .9 -1' qvel='-3 .2 2 1 -.5 2 .5 -2 1 2 3 1 -1 -2'"
      " ctrl='-1 -2 -.3 2'/>"};
  constexpr double kStep = 1.0 / 500;
  constexpr int kParts = 20, kSteps = 5;
  double worst = 0;
  for (const char* state : states) {
    SCOPED_TRACE(state);
    const std::string sensors =
        stepSensors({"tip", "palmSite", "wrist", "armSite", "freeSite", "shelfSite"}) + kScalars;
    const std::string file = fileOf(kArm, sensors, std::string("<keyframe>") + state + "</keyframe>");
    const Loaded mj = load(file);
    ASSERT_TRUE(mj.model) << mj.error;
    mj_resetDataKeyframe(mj.model.get(), mj.data.get(), 0);
    mj.model->opt.integrator = mjINT_RK4;
    mj.model->opt.timestep = kStep / kParts;
    std::vector<mjtNum> mean;
    Model model = readMjcf(file);
    Probes probes(model);
    for (int step = 0; step < kSteps; ++step) {
      mean.assign(static_cast<size_t>(mj.model->nsensordata), 0);
      for (int k = 0; k < kParts; ++k) {
        mj_step(mj.model.get(), mj.data.get());
        for (size_t i = 0; i < mean.size(); ++i) mean[i] += mj.data->sensordata[i] / kParts;
      }
      model.world.step(static_cast<float>(kStep));
      probes.read();
    }
    for (size_t i = 0; i < model.probes.size(); ++i) {
      if (!factsOf(model.probes[i].kind).needsStep) continue;
      const Off off = compared(probes, i, model.probes[i], mj.model.get(), mean.data());
      EXPECT_LT(off.by, 0.1 + 0.03 * off.size) << model.probes[i].name << " " << off.by << " of " << off.size;
      worst = std::max(worst, off.by / (0.1 + 0.03 * off.size));
    }
  }
  std::printf("accelerations and forces: at most %.2g of the tolerance\n", worst);
}

// Bodies at rest on the ground, on a loop that closes and on a spring, and one that friction holds against a push: what
// both engines must agree on is the balance.
constexpr const char* kResting = R"(
  <compiler angle="radian" autolimits="true"/><option timestep="0.002"/>
  <worldbody><geom type="plane" size="9 9 1" friction=".3"/>
    <body name="crate" pos="0 0 .1"><freejoint/><geom type="box" size=".4 .3 .1" mass="4"/>
      <site name="all" type="box" size="1 1 .15"/>
      <site name="right" type="box" pos=".4 0 -.1" size=".1 1 .1"/>
      <site name="below" type="sphere" pos=".4 .3 -.5" size=".05"/>
      <site name="above" type="capsule" pos=".4 .3 .5" size=".1 .2"/>
      <site name="corner" type="ellipsoid" pos="-.4 -.3 -.1" size=".1 .1 .1"/>
      <site name="front" type="cylinder" pos=".4 0 -.1" size=".35 .1"/></body>
    <body name="load" pos="0 0 .25"><freejoint/><geom type="box" size=".1 .1 .05" mass="1"/>
      <site name="loadSite" size=".2"/></body>
    <body name="table" pos="0 3 .3"><freejoint/><geom type="box" size=".4 .3 .1" mass="4"/>
      <site name="tableTouch" size="9"/>
      <body name="foot" pos=".05 0 -.1"><geom name="sole" type="box" size=".35 .25 .1" mass="1"/>
        <site name="ankle" euler=".3 .2 0"/><site name="footTouch" type="box" size="1 1 1"/></body></body>
    <body name="roller" pos="3 0 .2"><freejoint/><geom size=".2" mass="2"/>
      <site name="bottom" pos="0 0 -.2" size=".05"/></body>
    <body name="bar" pos="-3 0 1"><joint type="slide" axis="1 0 0"/><joint name="pivot" type="ball"/>
      <geom type="capsule" size=".05" fromto="0 0 0 1 0 0" mass="3"/><site name="barSite"/>
      <body name="end" pos="1 0 0"><geom size=".1" mass="1"/><site name="endSite" euler="0 .5 0"/></body></body>
    <body name="cart" pos="-5 6 .5"><joint type="slide" axis="1 0 0" name="drive"/><joint type="slide" axis="0 0 1"/>
      <geom type="box" size=".2 .2 .2" mass="2"/><body name="runner" pos=".3 0 -.4">
        <geom size=".1" mass="1" friction=".4"/>
        <site name="pushed" pos="0 0 .05" euler="0 .3 0" size=".2"/></body></body>
    <body name="hung" pos="-3 3 1"><joint type="slide" axis="0 0 1" stiffness="500" damping="20"/>
      <geom size=".1" mass="2"/>
      <site name="hungSite"/></body>
  </worldbody>
  <equality><connect body1="end" body2="world" anchor=".1 0 0"/></equality>
  <actuator><motor name="push" joint="drive"/></actuator>)";

TEST(Sensors, TouchAndForcesAtRestAreMujocos) {
  std::string sensors = stepSensors({"all", "loadSite", "ankle", "barSite", "endSite", "hungSite", "pushed"});
  for (const char* site : {"all", "loadSite", "right", "below", "above", "corner", "front", "tableTouch", "footTouch",
                           "bottom", "pushed"}) {
    sensors += std::string("<touch name='touch_") + site + "' site='" + site + "'/>";
  }
  sensors += "<touch name='cut' site='bottom' cutoff='5'/><actuatorfrc name='push' actuator='push'/>";
  const std::string file = fileOf(kResting, sensors);
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  Model model = readMjcf(file);
  Probes probes(model);
  model.world.setIterations(30);
  setControl(model, 0, 5);
  mj.data->ctrl[0] = 5;
  for (int i = 0; i < 2000; ++i) {
    mj_step(mj.model.get(), mj.data.get());
    model.world.step(0.002f);
    probes.read();
  }
  mj_forward(mj.model.get(), mj.data.get());
  double worst = 0;
  for (size_t i = 0; i < model.probes.size(); ++i) {
    const Off off = compared(probes, i, model.probes[i], mj.model.get(), mj.data->sensordata);
    EXPECT_LT(off.by, 0.01 + 0.005 * off.size) << model.probes[i].name << ": " << off.by << " off of " << off.size;
    worst = std::max(worst, off.by);
  }
  std::printf("at rest: at most %.2g off\n", worst);
}

// Rays: against every shape, from inside the own body, past what is invisible, into nothing.
TEST(Sensors, RangesAreMujocos) {
  const std::string bodies = R"(<worldbody><geom type="plane" size="0 0 1"/>
    <body pos="0 0 2"><geom type="box" size=".3 .2 .1" euler="10 20 30"/></body>
    <body pos="1 0 2"><geom size=".3"/></body>
    <body pos="2 0 2" euler="0 40 0"><geom type="capsule" size=".2 .3"/></body>
    <body pos="3 0 2" euler="50 0 0"><geom type="cylinder" size=".2 .3"/></body>
    <body pos="4 0 2" euler="0 0 50"><geom type="ellipsoid" size=".2 .3 .4"/></body>
    <body pos="5 0 2"><geom size=".3" rgba="1 0 0 0"/></body>
    <body name="moving" pos="6 0 1.5" euler="0 10 0"><freejoint/><geom size=".3"/><site name="m6" pos=".02 .01 0"
      euler="180 0 0"/></body>)";
  std::string sites, sensors;
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i);
    sites += "<site name='d" + n + "' pos='" + n + ".05 .04 4' euler='180 3 0'/><site name='u" + n + "' pos='" + n +
             ".02 -.05 .5'/>";
    for (const char* way : {"d", "u"}) {
      const std::string name = way + n;
      sensors += "<rangefinder name='" + name + "' site='" + name + "'/>";
    }
  }
  sensors +=
      "<rangefinder name='m6' site='m6'/><rangefinder name='cut' site='d0' cutoff='1'/>"
      "<rangefinder name='none' site='far' cutoff='1'/>";
  sites += "<site name='far' pos='50 0 1'/></worldbody>";
  const std::string file = fileOf(bodies + sites, sensors);
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  mj_forward(mj.model.get(), mj.data.get());
  const Model model = readMjcf(file);
  const Probes probes(model);
  for (size_t i = 0; i < model.probes.size(); ++i) {
    const Off off = compared(probes, i, model.probes[i], mj.model.get(), mj.data->sensordata);
    EXPECT_LT(off.by, 2e-5) << model.probes[i].name << ": " << probes.values(i)[0];
  }
}

}  // namespace
}  // namespace avbd
