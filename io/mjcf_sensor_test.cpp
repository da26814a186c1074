// Sensors of MJCF files: which become probes, which are left out and why, which are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "io/mjcf.h"
#include "io/mjcf_cases.h"

namespace avbd {
namespace {

constexpr const char* kBodies = R"(<compiler autolimits="true"/><worldbody><site name="w"/><body name="a" pos="0 0 1">
  <joint name="h" range="-90 90"/><joint name="s" type="slide" axis="1 0 0"/><geom name="g" size=".1"/><site name="p"/>
  <body name="b"><joint name="q" type="ball"/><geom size=".1"/><geom size=".2" pos="1 2 3"/>
  <body name="r"><joint name="ranged" type="ball" range="0 40"/><geom size=".1"/></body></body></body></worldbody>
  <tendon><fixed name="t"><joint joint="h" coef="1"/></fixed>
  <spatial name="c"><site site="w"/><site site="p"/></spatial>
  <spatial name="round"><site site="w"/><geom geom="g"/><site site="p"/></spatial></tendon>
  <actuator><motor name="m" joint="h"/><muscle name="u" joint="h"/></actuator>)";

Model modelOf(const std::string& sensors, const std::string& more = "") {
  return readMjcfText("<mujoco><sensor>\n" + sensors + "</sensor>" + more + kBodies + "</mujoco>", "t.xml");
}

TEST(MjcfSensors, BecomeProbesInTheirOrder) {
  const Model model = modelOf(
      "<jointpos name='a' joint='h'/><jointvel joint='s' cutoff='2'/><tendonpos tendon='t'/>"
      "<actuatorfrc actuator='m'/><framequat name='sensor_6' objtype='site' objname='p'/><clock/><gyro site='p'/>");
  const std::pair<const char*, const char*> expected[] = {
      {"a", "rad"},     {"sensor_2", "m/s"}, {"sensor_3", "rad"},  {"sensor_4", "N m"},
      {"sensor_6", ""}, {"sensor_6_", "s"},  {"sensor_7", "rad/s"}};
  ASSERT_EQ(model.probes.size(), std::size(expected));
  for (size_t i = 0; i < model.probes.size(); ++i) {
    EXPECT_EQ(model.probes[i].name, expected[i].first);
    EXPECT_EQ(model.probes[i].unit, expected[i].second) << model.probes[i].name;
  }
  EXPECT_EQ(model.probes[1].cutoff, 2);
  EXPECT_EQ(model.probeTree.bodies.size(), 4u);
  EXPECT_FALSE(hasNote(model, "sensor"));
  EXPECT_TRUE(modelOf("").probes.empty());
  EXPECT_TRUE(modelOf("").probeTree.bodies.empty());
}

TEST(MjcfSensors, WhatDoesNotMapIsNotedByName) {
  struct Case {
    const char* sensor;
    const char* note;
  };
  const Case cases[] = {
      {"<jointlimitfrc name='x' joint='h'/>", "t.xml:2: jointlimitfrc \"x\": left out: the force of a limit"},
      {"<user name='x' objtype='body'/>", "user \"x\": left out: its value is computed"},
      {"<plugin name='x' plugin='p'/>", "plugin \"x\": left out: plugins"},
      {"<camprojection name='x' site='p' camera='c'/>", "camprojection \"x\": left out: cameras"},
      {"<framepos name='x' objtype='camera' objname='c'/>", "framepos \"x\": left out: cameras"},
      {"<rangefinder name='x' camera='c'/>", "rangefinder \"x\": left out: cameras"},
      {"<distance name='x' geom1='g' geom2='g'/>", "distance \"x\": left out: distances"},
      {"<tactile name='x'/>", "tactile \"x\": left out: sensors of this kind"},
      {"<framequat name='x' objtype='body' objname='b'/>", "framequat \"x\": left out: objtype body asks for axes"},
      {"<framepos name='x' objtype='site' objname='p' reftype='body' refname='b'/>", "reftype body asks for axes"},
      {"<jointlimitpos name='x' joint='ranged'/>", "jointlimitpos \"x\": left out: the range of a ball joint"},
      {"<tendonpos name='x' tendon='round'/>", "tendonpos \"x\": left out: the length of a tendon around geoms"},
      {"<actuatorpos name='x' actuator='u'/>", "actuatorpos \"x\": left out: its actuator is left out"},
      {"<nonsense name='x'/>", "nonsense \"x\": unknown element"},
  };
  for (const Case& c : cases) {
    const Model model = modelOf(c.sensor);
    EXPECT_TRUE(model.probes.empty()) << c.sensor;
    EXPECT_TRUE(hasNote(model, c.note)) << c.sensor << "\n" << (model.notes.empty() ? "" : model.notes.back());
  }
  const Model off = modelOf("<clock name='x'/>", "<option><flag sensor='disable'/></option>");
  EXPECT_TRUE(off.probes.empty());
  EXPECT_TRUE(hasNote(off, "clock \"x\": left out: sensors are disabled"));
}

TEST(MjcfSensors, NotesOnWhatIsReadOtherwise) {
  EXPECT_TRUE(hasNote(modelOf("<clock noise='.1'/>"), "attribute noise is not used"));
  EXPECT_FALSE(hasNote(modelOf("<clock noise='0'/>"), "noise"));
  const Model acceleration = modelOf("<framelinacc objtype='site' objname='p' reftype='site' refname='w'/>");
  EXPECT_EQ(acceleration.probes.size(), 1u);
  EXPECT_TRUE(hasNote(acceleration, "reference frame of an acceleration is not used"));
  const std::string hidden =
      "<worldbody><geom size='1' contype='0' conaffinity='0'/><site name='z'/></worldbody><sensor><rangefinder "
      "site='z'/>"
      "</sensor>";
  const Model unseen = readMjcfText("<mujoco>" + hidden + "</mujoco>", "t.xml");
  EXPECT_TRUE(hasNote(unseen, "does not see geoms that collide with nothing"));
}

TEST(MjcfSensors, MistakesAreRefusedInTheirPlace) {
  struct Case {
    const char* sensor;
    std::initializer_list<const char*> parts;
  };
  const Case cases[] = {
      {"<jointpos name='x' joint='none'/>", {"t.xml:2: jointpos \"x\": joint = \"none\": no joint has this name"}},
      {"<jointpos name='x'/>", {"jointpos \"x\": joint is missing: must be given"}},
      {"<jointvel joint='q'/>", {"joint = \"q\": must name a hinge or slide"}},
      {"<ballquat joint='h'/>", {"joint = \"h\": must name a ball joint"}},
      {"<ballangvel joint='none'/>", {"joint = \"none\": no joint has this name"}},
      {"<jointlimitpos joint='s'/>", {"joint = \"s\": must name a joint with a range"}},
      {"<jointlimitfrc joint='none'/>", {"joint = \"none\": no joint has this name"}},
      {"<tendonlimitvel tendon='t'/>", {"tendon = \"t\": must name a tendon with a range"}},
      {"<tendonvel tendon='none'/>", {"tendon = \"none\": no tendon has this name"}},
      {"<actuatorfrc actuator='none'/>", {"actuator = \"none\": no actuator has this name"}},
      {"<touch site='none'/>", {"touch: site = \"none\": no site has this name"}},
      {"<subtreecom body='none'/>", {"body = \"none\": no body has this name"}},
      {"<framepos objname='p'/>", {"objtype is missing: must be one of body, xbody, geom, site, camera"}},
      {"<framepos objtype='joint' objname='h'/>", {"objtype = \"joint\": must be one of body, xbody, geom, site"}},
      {"<framepos objtype='geom' objname='none'/>", {"objname = \"none\": no geom has this name"}},
      {"<framepos objtype='site' objname='p' refname='w'/>", {"reftype is missing: must be given beside refname"}},
      {"<framepos objtype='site' objname='p' reftype='site'/>", {"refname is missing: must be given"}},
      {"<framepos objtype='site' objname='p' reftype='xbody' refname='none'/>", {"refname = \"none\": no body"}},
      {"<clock cutoff='-1'/>", {"cutoff = \"-1\": must be finite and >= 0"}},
      {"<clock cutoff='a'/>", {"cutoff = \"a\"", "is not a number"}},
      {"<clock noise='-1'/>", {"noise = \"-1\": must be finite and >= 0"}},
      {"<ballquat joint='q' cutoff='1'/>", {"cutoff = \"1\": not allowed for a rotation or an axis"}},
      {"<clock name='x'/><gyro name='x' site='p'/>", {"gyro \"x\": name = \"x\": another element of this kind"}},
  };
  for (const Case& c : cases) {
    std::string message;
    try {
      modelOf(c.sensor);
    } catch (const FileError& error) {
      message = error.what();
    }
    EXPECT_NE(message, "") << "accepted: " << c.sensor;
    for (const char* part : c.parts)
      EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks " << part;
  }
}

TEST(MjcfSensors, SizesOfSites) {
  const auto sizeOf = [](const std::string& site) {
    const Model model = readMjcfText(
        "<mujoco><worldbody><site name='s' " + site + "/></worldbody><sensor><touch site='s'/></sensor></mujoco>",
        "t.xml");
    return model.probes.at(0).zone.size;
  };
  EXPECT_EQ(sizeOf(""), (Vec3d{0.005, 0.005, 0.005}));
  EXPECT_EQ(sizeOf("type='box' size='1 2'"), (Vec3d{1, 2, 0.005}));
  EXPECT_EQ(sizeOf("type='capsule' size='.1' fromto='0 0 0 0 0 4'"), (Vec3d{.1, 2, 2}));
  EXPECT_EQ(sizeOf("type='box' size='.1' fromto='0 0 0 0 0 4'"), (Vec3d{.1, .1, 2}));
  EXPECT_THROW(sizeOf("size='0'"), FileError);
  EXPECT_THROW(sizeOf("type='plane'"), FileError);
}

}  // namespace
}  // namespace avbd
