// The D6 joint's rows: J is the derivative of C, action equals reaction, and what a coordinate means.
#include <gtest/gtest.h>

#include "avbd/rows/d6_joint.h"
#include "solve/rows_oracle.h"

namespace avbd::oracle {
namespace {

using rows::D6Axes;
using rows::D6Joint;
using rows::Twist;

constexpr D6Axes kAllDriven{.driven = 0x3f};

/// Frames anywhere, the swing up to `most`.
D6Joint<float> randomJoint(Random& random, float most) {
  D6Joint<float> joint{};
  joint.offset = randomVector(random, 1), joint.armA = randomVector(random, 1), joint.armB = randomVector(random, 1);
  joint.qA = randomTurn(random, 2);
  const V3<float> swing =
      rows::normalised(V3<float>{0, random.number(1), random.number(1)}) * (most * random.number(1));
  const V3<float> twist{random.number(3), 0, 0};
  joint.qB = joint.qA * rows::expQuat(swing) * rows::expQuat(twist);
  joint.tau = std::fabs(random.number(0.5f));
  const Twist<float> still = rows::zeroTwist<float>();
  float q[6];
  joint.coordinates(still, still, q);
  q[3] = joint.twistAtStart();
  for (int i = 0; i < 6; ++i) {
    joint.axis[i].start = q[i];
    joint.axis[i].kDrive = joint.axis[i].k = 100, joint.axis[i].s = 1;
    joint.axis[i].driveMost = rows::kInfinity;
  }
  return joint;
}

template <class R>
using Probe = rows::ProbeSink<R, 40>;

template <class R>
Twist<R> motionAt(const double* d) {
  return {{R(d[0]), R(d[1]), R(d[2])}, {R(d[3]), R(d[4]), R(d[5])}};
}

template <class From>
D6Joint<Precise> precise(const From& joint) {
  constexpr size_t kCount = sizeof(From) / sizeof(float);
  float from[kCount];
  Precise to[kCount];
  std::memcpy(from, &joint, sizeof(from));
  std::copy(std::begin(from), std::end(from), to);
  D6Joint<Precise> out;
  std::memcpy(&out, to, sizeof(to));
  return out;
}

Probe<Precise> rowsAt(D6Joint<Precise>& joint, const D6Axes& axes, const double (&d)[12]) {
  Probe<Precise> probe;
  joint.rows(axes, motionAt<Precise>(d), motionAt<Precise>(d + 6), probe);
  return probe;
}

void expectDerivative(const D6Joint<float>& of, const D6Axes& axes) {
  D6Joint<Precise> joint = precise(of);
  double d[12] = {};
  const Probe<Precise> here = rowsAt(joint, axes, d);
  for (int u = 0; u < 12; ++u) {
    constexpr double kStep = 1e-4;
    d[u] = kStep;
    const Probe<Precise> up = rowsAt(joint, axes, d);
    d[u] = -kStep;
    const Probe<Precise> down = rowsAt(joint, axes, d);
    d[u] = 0;
    for (int i = 0; i < here.count; ++i) {
      const V3<Precise>& arm = u < 6 ? here.armA : here.armB;
      const V3<Precise> lin = here.row[i].lin, ang = cross(arm, lin) + here.row[i].ang;
      const Precise j[6] = {lin.x, lin.y, lin.z, ang.x, ang.y, ang.z};
      const double side = u < 6 ? 1 : -1;
      ASSERT_NEAR(side * j[u % 6].v, (up.row[i].C.v - down.row[i].C.v) / (2 * kStep), 1e-4) << "row " << i << " d" << u;
    }
  }
}

TEST(D6Rows, JacobianIsTheDerivative) {
  Random random(1);
  for (int round = 0; round < 300 && !HasFatalFailure(); ++round)
    expectDerivative(randomJoint(random, 2.5f), kAllDriven);
}

// A locked swing is measured by its sine; locked angles all three by their rotation vector, where the frames coincide.
TEST(D6Rows, JacobianOfLocksIsTheDerivative) {
  Random random(2);
  for (int round = 0; round < 100 && !HasFatalFailure(); ++round) {
    expectDerivative(randomJoint(random, 1), D6Axes{.locked = 0b010111, .driven = 0b101000});
    expectDerivative(randomJoint(random, 1), D6Axes{.locked = 0b100111, .driven = 0b011000});
    D6Joint<float> still = randomJoint(random, 1);
    still.qB = still.qA;
    expectDerivative(still, D6Axes{.locked = 0b111111});
  }
}

// With the axes of J held at the start of the step, the force of an elliptic cone turns as its row without force says.
TEST(D6Rows, AConesNormalTurnsAsItsSecondRowSays) {
  Random random(5);
  for (int round = 0; round < 100; ++round) {
    D6Joint<float> of = randomJoint(random, 1.5f);
    of.tau = 0;
    of.cone = {.inverseY = 1 / randomSize(random, 0.1f, 2), .inverseZ = 1 / randomSize(random, 0.1f, 2), .upper = 1};
    of.cone.scale = 0.5f, of.cone.k = 100, of.cone.s = 1, of.cone.lambda = 20;
    D6Joint<Precise> joint = precise(of);
    double d[12] = {};
    const Probe<Precise> here = rowsAt(joint, {.cone = true}, d);
    ASSERT_EQ(here.count, 2);
    EXPECT_EQ(here.row[1].C.v * here.row[1].k.v + here.row[1].s.v, 0) << "it has no force";
    const V3<Precise>& t = here.row[1].ang;
    const Precise along[3] = {t.x, t.y, t.z};
    for (int u = 0; u < 3; ++u) {
      constexpr double kStep = 1e-6;
      d[3 + u] = kStep;
      const Probe<Precise> up = rowsAt(joint, {.cone = true}, d);
      d[3 + u] = -kStep;
      const Probe<Precise> down = rowsAt(joint, {.cone = true}, d);
      d[3 + u] = 0;
      const V3<Precise> change = (up.row[0].ang - down.row[0].ang) * (joint.cone.lambda / Precise(2 * kStep));
      const V3<Precise> expected = t * (here.row[1].k * along[u]);
      ASSERT_NEAR(length(change - expected).v, 0, 1e-5 * (1 + length(change).v)) << "round " << round;
    }
  }
}

TEST(D6Rows, CoordinatesMeanWhatTheySay) {
  Random random(3);
  for (int round = 0; round < 100; ++round) {
    D6Joint<float> joint = randomJoint(random, 0);
    const float twist = random.number(3), y = random.number(1), z = random.number(1);
    joint.qB = joint.qA * rows::expQuat(V3<float>{0, y, z}) * rows::expQuat(V3<float>{twist, 0, 0});
    joint.axis[3].start = joint.twistAtStart();
    const Twist<float> dA = {randomVector(random, 1), randomVector(random, 1)};
    float q[6];
    // Moving both bodies as one changes nothing.
    Twist<float> dB = dA;
    const V3<float> between = joint.armA + joint.offset - joint.armB;
    dB.lin = dA.lin + rotate(rows::expQuat(dA.ang), between) - between;
    joint.coordinates(dA, dB, q);
    const V3<float> offset = rotate(conjugate(joint.qA), joint.offset);
    const float expected[6] = {offset.x, offset.y, offset.z, twist, y, z};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(q[i], expected[i], 1e-5) << i;
  }
}

// What a stiff drive feels: the twist that a step adds, but for the rounding of the sum.
TEST(D6Rows, ATwistGrowsAsExactlyAsAFloatTells) {
  Random random(6);
  for (int round = 0; round < 1000; ++round) {
    D6Joint<float> joint = randomJoint(random, 0);
    joint.qB = rows::normalised(joint.qA * rows::expQuat(V3<float>{1.6f * random.number(1), 0, 0}));
    joint.axis[3].start = joint.twistAtStart();
    const V3<float> turn = rotate(joint.qA, V3<float>{0.01f * random.number(1), 0, 0});
    D6Joint<Precise> exact = precise(joint);
    float q[6];
    Precise expected[6];
    joint.coordinates(rows::zeroTwist<float>(), {{0, 0, 0}, turn}, q);
    const double motion[6] = {0, 0, 0, turn.x, turn.y, turn.z}, still[6] = {};
    exact.coordinates(motionAt<Precise>(still), motionAt<Precise>(motion), expected);
    ASSERT_NEAR(q[3], expected[3].v, 7e-8);
  }
}

TEST(D6Rows, ATwistPassesHalfATurnWithoutAJump) {
  Random random(4);
  D6Joint<float> joint = randomJoint(random, 0);
  joint.qB = joint.qA * rows::expQuat(V3<float>{3.1f, 0, 0});
  joint.axis[3].start = 3.1f + 4 * rows::kPi;
  const V3<float> about = rotate(joint.qA, V3<float>{1, 0, 0});
  float q[6];
  joint.coordinates(rows::zeroTwist<float>(), {{0, 0, 0}, about * 0.2f}, q);
  EXPECT_NEAR(q[3], 3.3f + 4 * rows::kPi, 1e-5);
}

}  // namespace
}  // namespace avbd::oracle
