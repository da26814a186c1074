// Control scripts: what they say, when it is due, what is refused.
#include "app/control_script.h"

#include <gtest/gtest.h>

#include "io/file_error.h"

namespace avbd::cli {
namespace {

std::vector<Actuator> actuatorsOf(const std::vector<std::string>& names) {
  std::vector<Actuator> out(names.size());
  for (size_t i = 0; i < names.size(); ++i) out[i].name = names[i];
  return out;
}
const std::vector<Actuator> kActuators = actuatorsOf({"shoulder", "elbow", "left, upper \"a\"", "12"});

TEST(ControlScript, RowsByNameAndByNumber) {
  const std::string text =
      "\xef\xbb\xbf# a comment\n"
      "time, actuator , value\r\n"
      "\n"
      "  # another\n"
      "0,elbow,1.5\n"
      "0 , 0 , -2e-3\r\n"
      "0.25,\"left, upper \"\"a\"\"\",+3\n"
      "0.25,12,4\n"
      "7,\"1\",5";
  const ControlScript script = parseControlScript(text, "c.csv", kActuators);
  const ControlRow expected[] = {{0, 1, 1.5, 5}, {0, 0, -2e-3, 6}, {0.25, 2, 3, 7}, {0.25, 3, 4, 8}, {7, 1, 5, 9}};
  ASSERT_EQ(script.rows().size(), std::size(expected));
  for (size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(script.rows()[i].time, expected[i].time) << i;
    EXPECT_EQ(script.rows()[i].actuator, expected[i].actuator) << i;
    EXPECT_EQ(script.rows()[i].value, expected[i].value) << i;
    EXPECT_EQ(script.rows()[i].line, expected[i].line) << i;
  }
}

TEST(ControlScript, MayBeEmpty) {
  EXPECT_TRUE(parseControlScript("", "c.csv", kActuators).rows().empty());
  EXPECT_TRUE(parseControlScript("time,actuator,value\n", "c.csv", kActuators).rows().empty());
}

struct Refused {
  const char* text;
  std::vector<std::string> parts;
};

TEST(ControlScript, MistakesAreRefusedInTheirPlace) {
  const Refused all[] = {
      {"0,sholder,1\n", {"c.csv:1: column 2 (actuator) = \"sholder\"", "one of the 4 actuators", "near: shoulder"}},
      {"0,elbow,1\n0,4,1\n", {"c.csv:2: column 2 (actuator) = \"4\"", "there are 4 actuators, numbered from 0"}},
      {"0,,1\n", {"c.csv:1: column 2 (actuator) = \"\""}},
      {"1,elbow,1\n# x\n0.5,elbow,1\n", {"c.csv:3: column 1 (time) = \"0.5\": must not be less than 1 of line 1"}},
      {"-1,elbow,1\n", {"c.csv:1: column 1 (time) = \"-1\": must be finite and >= 0"}},
      {"nan,elbow,1\n", {"c.csv:1: column 1 (time) = \"nan\": must be a finite number"}},
      {"0,elbow,1e999\n", {"c.csv:1: column 3 (value) = \"1e999\": must be a finite number"}},
      {"0,elbow,1,5\n", {"c.csv:1: 4 columns: must be 3, time,actuator,value"}},
      {"0,elbow\n", {"c.csv:1: 2 columns: must be 3, time,actuator,value"}},
      {"0;elbow;1\n", {"c.csv:1: 1 column: must be 3"}},
      {"0,elbow,\n", {"c.csv:1: column 3 (value) = \"\": must be a finite number"}},
      {"0,elbow,1x\n", {"column 3 (value) = \"1x\""}},
      {"time,value,actuator\n", {"c.csv:1: the header must be time,actuator,value"}},
      {"0,elbow,1\ntime,actuator,value\n", {"c.csv:2: column 1 (time) = \"time\": must be a finite number"}},
      {"0,\"elbow,1\n", {"c.csv:1: column 2: a quote without an end"}},
      {"0,\"elbow\"x,1\n", {"c.csv:1: column 2: text after a quote"}},
  };
  for (const Refused& r : all) {
    try {
      parseControlScript(r.text, "c.csv", kActuators);
      ADD_FAILURE() << r.text;
    } catch (const FileError& error) {
      for (const std::string& part : r.parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      }
      EXPECT_EQ(error.file(), "c.csv");
      EXPECT_GT(error.line(), 0);
    }
  }
}

// A wheel whose motor's torque is the control.
Model wheel() {
  Model model;
  model.world = World({.gravity = {}});
  const BodyId body = model.world.create(BodyDef{.shape = Sphere{0.5f}});
  HingeJoint hinge;
  hinge.bodyB = body;
  const JointId id = model.world.create(hinge);
  model.joints = {{.name = "axle", .id = id}};
  Actuator motor;
  motor.name = "motor";
  motor.joint = id;
  model.actuators = {motor};
  return model;
}

TEST(ControlScript, ValuesHoldUntilTheyChange) {
  Model model = wheel();
  ControlScript script = parseControlScript("0.1,motor,2\n0.2,motor,3\n0.2,motor,4\n", "c.csv", model.actuators);
  const double dt = 1.0 / 60;
  for (int i = 0; i < 20; ++i) {
    script.apply(model, i * dt, dt);
    EXPECT_EQ(model.actuators[0].control, i < 6 ? 0 : i < 12 ? 2 : 4) << i;
  }
}

TEST(ControlScript, WhatTheWorldRefusesHasItsPlaceToo) {
  Model model = wheel();
  ControlScript script = parseControlScript("0,motor,1e20\n", "c.csv", model.actuators);
  try {
    script.apply(model, 0, 0.01);
    ADD_FAILURE();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("c.csv:1: column 3 (value) = 1e+20"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace avbd::cli
