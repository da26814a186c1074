// Controls as drives, by hand-computed figures.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/file_error.h"
#include "io/model.h"

namespace avbd {
namespace {

// A hinge about z with inertia 2 about it, without gravity.
struct Wheel {
  Model model;
  JointId hinge;
  Wheel() {
    model.world = World({.gravity = {}});
    const BodyId body =
        model.world.create(BodyDef{.massProperties = MassProperties{.mass = 1, .inertia = {2, 2, 2, 0, 0, 0}}});
    Pose frame;
    frame.rotation = {std::sqrt(0.5f), 0, -std::sqrt(0.5f), 0};  // x to z
    hinge = model.world.create(HingeJoint{.bodyB = body, .frameA = frame, .frameB = frame});
  }
  void add(const Actuator& actuator) { model.actuators.push_back(actuator); }
  JointDrive drive() const { return model.world.hingeJoint(hinge).drive; }
};

TEST(Control, AMotorIsAForceTimesItsGear) {
  Wheel wheel;
  wheel.add({.name = "m0", .joint = wheel.hinge, .gear = -3, .gain = 2});
  setControl(wheel.model, 0, 5);
  EXPECT_FLOAT_EQ(wheel.drive().force, -30);
  EXPECT_EQ(wheel.drive().stiffness, 0);
  EXPECT_EQ(wheel.drive().maxForce, std::numeric_limits<float>::infinity());
  wheel.model.world.step(0.01f);
  EXPECT_NEAR(wheel.model.world.coordinate(wheel.hinge).velocity, -30.0 / 2 * 0.01, 1e-5);
  // The file's coordinate the other way round.
  wheel.model.actuators[0].sign = -1;
  setControl(wheel.model, 0, 5);
  EXPECT_FLOAT_EQ(wheel.drive().force, 30);
}

TEST(Control, AServoPullsToTheFilesCoordinate) {
  Wheel wheel;
  // length = gear q: at rest where gear q = control, q = 1.5; ours = -(q - 0.5)
  wheel.add({.name = "m0",
             .joint = wheel.hinge,
             .sign = -1,
             .offset = 0.5,
             .gear = 2,
             .gain = 10,
             .bias = {0, -10, -3},
             .maxForce = 7});
  setControl(wheel.model, 0, 3);
  const JointDrive drive = wheel.drive();
  EXPECT_FLOAT_EQ(drive.stiffness, 40);
  EXPECT_FLOAT_EQ(drive.damping, 12);
  EXPECT_FLOAT_EQ(drive.position, -1);
  EXPECT_FLOAT_EQ(drive.maxForce, 14);
  EXPECT_EQ(drive.force, 0);
}

TEST(Control, AVelocityServoIsDampingAndForce) {
  Wheel wheel;
  wheel.add({.name = "m0", .joint = wheel.hinge, .gain = 4, .bias = {1, 0, -4}});
  setControl(wheel.model, 0, 3);
  EXPECT_FLOAT_EQ(wheel.drive().damping, 4);
  EXPECT_FLOAT_EQ(wheel.drive().force, 13);
  for (int i = 0; i < 500; ++i) wheel.model.world.step(0.02f);
  EXPECT_NEAR(wheel.model.world.coordinate(wheel.hinge).velocity, 13.0 / 4, 1e-3);
}

TEST(Control, ActuatorsOfOneCoordinateAddUp) {
  Wheel wheel;
  wheel.add({.name = "m0", .joint = wheel.hinge, .gain = 10, .bias = {0, -10, 0}, .maxForce = 5});
  wheel.add({.name = "m0", .joint = wheel.hinge, .gear = 2, .gain = 1, .maxForce = 3});
  wheel.add({.name = "m0", .joint = wheel.hinge, .gain = 1, .bias = {0, 0, -6}, .maxForce = 1});
  setControl(wheel.model, 0, 2);
  setControl(wheel.model, 1, 4);
  setControl(wheel.model, 2, 1);
  const JointDrive drive = wheel.drive();
  EXPECT_FLOAT_EQ(drive.stiffness, 10);
  EXPECT_FLOAT_EQ(drive.damping, 6);
  EXPECT_FLOAT_EQ(drive.position, (20 + 8 + 1) / 10.0f);
  EXPECT_FLOAT_EQ(drive.maxForce, 5 + 6 + 1);
}

TEST(Control, StaysWithinItsRange) {
  Wheel wheel;
  wheel.add({.name = "m0", .joint = wheel.hinge, .controlRange = std::array{-1.0, 2.0}});
  setControl(wheel.model, 0, 9);
  EXPECT_EQ(wheel.model.actuators[0].control, 2);
  EXPECT_FLOAT_EQ(wheel.drive().force, 2);
  setControl(wheel.model, 0, -9);
  EXPECT_FLOAT_EQ(wheel.drive().force, -1);
}

TEST(Control, DrivesACoupling) {
  Wheel wheel;
  Coupling coupling{.terms = {{.joint = wheel.hinge, .factor = 0.5f}}};
  coupling.axis.motion = AxisMotion::Free;
  const JointId id = wheel.model.world.create(coupling);
  wheel.model.actuators.push_back({.name = "t", .joint = id, .gear = 2, .gain = 3});
  setControl(wheel.model, 0, 4);
  EXPECT_FLOAT_EQ(wheel.model.world.coupling(id).axis.drive.force, 24);
  wheel.model.world.step(0.01f);
  EXPECT_NEAR(wheel.model.world.coordinate(wheel.hinge).velocity, 24 * 0.5 / 2 * 0.01, 1e-5);
}

std::string refusal(Model& model, size_t index, double control) {
  try {
    setControl(model, index, control);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Control, RefusesWhatIsNoControl) {
  Wheel wheel;
  wheel.add({.name = "m0", .joint = wheel.hinge});
  EXPECT_EQ(refusal(wheel.model, 0, std::nan("")), "actuator \"m0\": control = nan: must be finite");
  EXPECT_EQ(refusal(wheel.model, 1, 0), "actuator = 1: must be below 1");
  EXPECT_EQ(wheel.model.actuators[0].control, 0);
}

}  // namespace
}  // namespace avbd
