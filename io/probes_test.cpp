// Readings of probes by hand (mujoco_sensors_oracle.cpp compares with MuJoCo itself).
#include "io/probes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/mjcf.h"
#include "io/probe_zone.h"

namespace avbd {
namespace {

Model modelOf(const std::string& inside, const std::string& sensors) {
  return readMjcfText(
      "<mujoco><compiler angle='radian' autolimits='true'/>" + inside + "<sensor>" + sensors + "</sensor></mujoco>",
      "t.xml");
}

std::vector<double> valuesOf(const Probes& probes, const Model& model, const std::string& name) {
  for (size_t i = 0; i < model.probes.size(); ++i) {
    if (model.probes[i].name == name) return {probes.values(i).begin(), probes.values(i).end()};
  }
  ADD_FAILURE() << name;
  return {};
}

void expectNear(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(Probes, WithoutAnyThereIsNothing) {
  const Model model = modelOf("", "");
  Probes probes(model);
  probes.read();
  EXPECT_TRUE(probes.values().empty());
  EXPECT_TRUE(probes.columns().empty());
}

TEST(Probes, ColumnsFollowTheValues) {
  const Model model =
      modelOf("<worldbody><site name='s'/></worldbody>",
              "<clock name='t'/><gyro name='g' site='s'/><framequat name='q' objtype='site' objname='s'/>");
  const Probes probes(model);
  const std::vector<std::string> expected{"t", "g.x", "g.y", "g.z", "q.w", "q.x", "q.y", "q.z"};
  EXPECT_EQ(probes.columns(), expected);
  EXPECT_EQ(probes.values().size(), expected.size());
}

TEST(Probes, WhatNeedsAStepIsNoNumberWithoutOne) {
  Model model =
      modelOf("<worldbody><body name='b' pos='0 0 9'><freejoint/><geom size='1'/><site name='s'/></body></worldbody>",
              "<accelerometer name='a' site='s'/><touch name='t' site='s'/><clock name='c'/>");
  Probes probes(model);
  EXPECT_TRUE(std::isnan(valuesOf(probes, model, "a")[2]));
  EXPECT_TRUE(std::isnan(valuesOf(probes, model, "t")[0]));
  EXPECT_EQ(valuesOf(probes, model, "c")[0], 0);
  model.world.step(0.002f);
  probes.read();
  expectNear(valuesOf(probes, model, "a"), {0, 0, 0}, 1e-4);  // it falls freely
  EXPECT_EQ(valuesOf(probes, model, "t")[0], 0);
  probes.read();
  EXPECT_TRUE(std::isnan(valuesOf(probes, model, "a")[2])) << "no time since the last reading";
}

// A site on a turntable that turns at w: w^2 r inward, and against gravity.
TEST(Probes, AnAccelerometerFeelsTurningAndWeight) {
  Model model = modelOf(
      "<option gravity='0 0 -10'/><worldbody><body><joint name='j'/><geom size='.1' mass='1'/><site name='s' pos='2 0 "
      "0'/>"
      "</body></worldbody><keyframe><key qvel='3'/></keyframe>",
      "<accelerometer name='a' site='s'/><frameangacc name='w' objtype='site' objname='s'/><velocimeter name='v' "
      "site='s'/>"
      "<velocimeter name='cut' site='s' cutoff='1'/>");
  Probes probes(model);
  for (int i = 0; i < 100; ++i) {
    model.world.step(0.005f);
    probes.read();
    expectNear(valuesOf(probes, model, "a"), {-18, 0, 10}, 0.05);
    expectNear(valuesOf(probes, model, "w"), {0, 0, 0}, 0.05);
  }
  expectNear(valuesOf(probes, model, "v"), {0, 6, 0}, 1e-3);
  expectNear(valuesOf(probes, model, "cut"), {0, 1, 0}, 1e-3);
}

// A scale: a box of 2 kg on a welded plate of 3 kg on a post of 4 kg, all of one body that stands still; and the same
// hanging from a joint.
TEST(Probes, AForceIsWhatTheParentHolds) {
  const char* parts =
      "<geom type='box' size='.1 .1 .1' mass='4'/><site name='NAME_all'/><body pos='.5 0 .2'><geom type='box' size='.3 "
      ".3 .1' "
      "mass='3'/><site name='NAME_plate'/><body pos='0 0 .3'><geom size='.1' mass='2'/><site name='NAME_top' "
      "euler='0 1.5707963267948966 0'/></body></body>";
  const auto named = [&](const std::string& name) {
    std::string out = parts;
    for (size_t at = out.find("NAME"); at != std::string::npos; at = out.find("NAME")) out.replace(at, 4, name);
    return out;
  };
  std::string sensors;
  for (const std::string site : {"still_all", "still_plate", "still_top", "held_all", "held_plate", "held_top"}) {
    sensors += "<force name='f_" + site + "' site='" + site + "'/><torque name='t_" + site + "' site='" + site + "'/>";
  }
  Model model = modelOf("<option gravity='0 0 -10'/><worldbody><body>" + named("still") +
                            "</body><body pos='9 0 0'>"
                            "<joint type='slide' axis='0 0 1' stiffness='1e4'/>" +
                            named("held") + "</body></worldbody>",
                        sensors);
  Probes probes(model);
  for (int i = 0; i < 4000; ++i) {
    model.world.step(0.002f);
    probes.read();
  }
  for (const std::string which : {"still", "held"}) {
    SCOPED_TRACE(which);
    const double tolerance = which == "still" ? 1e-3 : 0.5;  // it goes on swinging a little
    expectNear(valuesOf(probes, model, "f_" + which + "_all"), {0, 0, 90}, tolerance);
    expectNear(valuesOf(probes, model, "f_" + which + "_plate"), {0, 0, 50}, tolerance);
    expectNear(valuesOf(probes, model, "f_" + which + "_top"), {-20, 0, 0}, tolerance);
    expectNear(valuesOf(probes, model, "t_" + which + "_all"), {0, -25, 0}, tolerance);
    expectNear(valuesOf(probes, model, "t_" + which + "_plate"), {0, 0, 0}, tolerance);
  }
}

TEST(Probes, SubtreesOfBodiesThatAreOne) {
  Model model = modelOf(
      "<worldbody><body name='a' pos='0 0 5'><freejoint/><geom size='.1' mass='1'/><body name='b' pos='2 0 0'>"
      "<geom size='.1' mass='3'/></body></body></worldbody><keyframe><key qvel='1 0 0 0 0 2'/></keyframe>",
      "<subtreecom name='all' body='a'/><subtreecom name='b' body='b'/><subtreelinvel name='v' body='b'/>"
      "<subtreeangmom name='l' body='a'/><subtreecom name='w' body='world'/>");
  const Probes probes(model);
  expectNear(valuesOf(probes, model, "all"), {1.5, 0, 5}, 1e-6);
  expectNear(valuesOf(probes, model, "w"), {1.5, 0, 5}, 1e-6);
  expectNear(valuesOf(probes, model, "b"), {2, 0, 5}, 1e-6);
  expectNear(valuesOf(probes, model, "v"), {1, 4, 0}, 1e-5);
  expectNear(valuesOf(probes, model, "l"), {0, 0, 2 * (4 * 0.4 * 0.01 + 1 * 2.25 + 3 * 0.25)}, 1e-4);
}

TEST(Probes, ActuatorsOfAJointAddUp) {
  Model model = modelOf(
      "<worldbody><body><joint name='j' ref='.5'/><geom size='.1' mass='1'/></body></worldbody>"
      "<actuator><motor name='m' joint='j' gear='3'/><position name='p' joint='j' kp='10' gear='2' forcerange='-6 6'/>"
      "</actuator><keyframe><key qpos='.7' qvel='.2' ctrl='2 1'/></keyframe>",
      "<actuatorfrc name='m' actuator='m'/><actuatorfrc name='p' actuator='p'/><jointactuatorfrc name='all' joint='j'/>"
      "<actuatorpos name='l' actuator='p'/><actuatorvel name='v' actuator='p'/>");
  Probes probes(model);
  EXPECT_NEAR(valuesOf(probes, model, "m")[0], 2, 1e-6);
  EXPECT_NEAR(valuesOf(probes, model, "p")[0], 10 * (1 - 2 * 0.7), 1e-5);
  EXPECT_NEAR(valuesOf(probes, model, "all")[0], 3 * 2 + 2 * -4, 1e-5);
  EXPECT_NEAR(valuesOf(probes, model, "l")[0], 1.4, 1e-6);
  EXPECT_NEAR(valuesOf(probes, model, "v")[0], 0.4, 1e-6);
  setControl(model, 1, 5);
  probes.read();
  EXPECT_NEAR(valuesOf(probes, model, "p")[0], 6, 1e-6) << "at its bound";
}

TEST(Probes, LimitsTellHowFarTheyArePassed) {
  const Model model = modelOf(
      "<worldbody><body><joint name='a' type='slide' range='-1 1'/><geom size='.1' mass='1'/></body>"
      "<body><joint name='b' type='slide' range='-1 1'/><geom size='.1' mass='1'/></body></worldbody>"
      "<keyframe><key qpos='1.5 .5' qvel='2 3'/></keyframe>",
      "<jointlimitpos name='ap' joint='a'/><jointlimitvel name='av' joint='a'/><jointlimitpos name='bp' joint='b'/>"
      "<jointlimitvel name='bv' joint='b'/>");
  const Probes probes(model);
  EXPECT_NEAR(valuesOf(probes, model, "ap")[0], -0.5, 1e-6);
  EXPECT_NEAR(valuesOf(probes, model, "av")[0], -2, 1e-6);
  EXPECT_EQ(valuesOf(probes, model, "bp")[0], 0);
  EXPECT_EQ(valuesOf(probes, model, "bv")[0], 0);
}

TEST(Probes, ZonesAndRays) {
  using Kind = ProbeZone::Kind;
  struct Case {
    ProbeZone zone;
    Vec3d outside, inside;  // of the solid, with a ray of z through the one and not the other
  };
  const Case cases[] = {
      {{Kind::Sphere, {1, 0, 0}}, {.9, .9, -3}, {.6, .6, -3}},
      {{Kind::Capsule, {1, 2, 0}}, {.9, .9, -9}, {.6, .6, -9}},
      {{Kind::Ellipsoid, {1, 2, 3}}, {.9, 1, -9}, {.6, 1, -9}},
      {{Kind::Cylinder, {1, 2, 0}}, {.9, .9, -9}, {.6, .6, -9}},
      {{Kind::Box, {1, 2, 3}}, {1.1, 0, -9}, {.9, 1.9, -9}},
  };
  for (const Case& c : cases) {
    EXPECT_FALSE(meets(c.zone, c.outside, {0, 0, 1}));
    EXPECT_TRUE(meets(c.zone, c.inside, {0, 0, 1}));
    EXPECT_FALSE(meets(c.zone, c.inside, {0, 0, -1})) << "behind";
    EXPECT_TRUE(meets(c.zone, {}, {1, 1, 1})) << "from inside";
    EXPECT_TRUE(meets(c.zone, {-20, .1, .1}, {1, 0, 0}));
    EXPECT_FALSE(meets(c.zone, {-20, .1, 30}, {1, 0, 0}));
  }
  EXPECT_TRUE(meets({Kind::Capsule, {1, 2, 0}}, {-9, 0, 2.9}, {1, 0, 0}));
  EXPECT_FALSE(meets({Kind::Cylinder, {1, 2, 0}}, {-9, 0, 2.9}, {1, 0, 0}));
}

TEST(Probes, ABodyThatIsGoneIsAnError) {
  Model model =
      modelOf("<worldbody><body name='b' pos='0 0 9'><freejoint/><geom size='1'/><site name='s'/></body></worldbody>",
              "<gyro site='s'/>");
  Probes probes(model);
  model.world.destroy(model.bodies.back().id);
  EXPECT_THROW(probes.read(), Error);
}

}  // namespace
}  // namespace avbd
