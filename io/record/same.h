// For tests: that what was read is what was written, to the bit.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "io/record/recording.h"

namespace avbd::record {

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expectSameJoints(const RecordedFrame& a, const RecordedFrame& b) {
  EXPECT_TRUE(sameBits<double>({a.limitExcessMax, a.limitExcessAngleMax}, {b.limitExcessMax, b.limitExcessAngleMax}));
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (size_t i = 0; i < a.joints.size(); ++i) {
    EXPECT_EQ(a.joints[i].reaction.force, b.joints[i].reaction.force);
    EXPECT_EQ(a.joints[i].reaction.torque, b.joints[i].reaction.torque);
    EXPECT_EQ(a.joints[i].enabled, b.joints[i].enabled);
  }
  EXPECT_EQ(a.residuals, b.residuals);
}

inline void expectSameJoint(const RecordedJoint& a, const RecordedJoint& b) {
  EXPECT_EQ(a.bodyA, b.bodyA);
  EXPECT_EQ(a.bodyB, b.bodyB);
  EXPECT_EQ(a.frameA, b.frameA);
  EXPECT_EQ(a.frameB, b.frameB);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.freeAxes, b.freeAxes);
  EXPECT_EQ(a.limits, b.limits);
  EXPECT_EQ(a.coneY, b.coneY);
  EXPECT_EQ(a.coneZ, b.coneZ);
  EXPECT_EQ(a.wheels, b.wheels);
  EXPECT_EQ(a.ratio, b.ratio);
  EXPECT_EQ(a.terms, b.terms);
  EXPECT_EQ(a.rest, b.rest);
  EXPECT_EQ(a.family, b.family);
  EXPECT_EQ(a.moreBodies, b.moreBodies);
  EXPECT_EQ(a.residuals, b.residuals);
}

inline void expectSame(const RecordedFrame& a, const RecordedFrame& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_TRUE(sameBits(a.poses, b.poses)) << "at time " << a.time;
  EXPECT_TRUE(sameBits(a.velocities, b.velocities)) << "at time " << a.time;
  EXPECT_EQ(a.kineticEnergy, b.kineticEnergy);
  EXPECT_EQ(a.penetrationMax, b.penetrationMax);
  EXPECT_EQ(a.jointGapMax, b.jointGapMax);
  expectSameJoints(a, b);
  EXPECT_EQ(a.contactsLeftOut, b.contactsLeftOut);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].force, b.contacts[i].force);
    EXPECT_EQ(a.contacts[i].normal, b.contacts[i].normal);
    EXPECT_EQ(a.contacts[i].separation, b.contacts[i].separation);
    EXPECT_EQ(a.contacts[i].shapeA, b.contacts[i].shapeA);
    EXPECT_EQ(a.contacts[i].shapeB, b.contacts[i].shapeB);
    // A float about the body, wherever the body is.
    EXPECT_LT(length(a.contacts[i].position - b.contacts[i].position), 1e-7);
  }
  ASSERT_EQ(a.events.size(), b.events.size());
  for (size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].kind, b.events[i].kind);
    EXPECT_EQ(a.events[i].position, b.events[i].position);
    EXPECT_EQ(a.events[i].normal, b.events[i].normal);
    EXPECT_EQ(a.events[i].speed, b.events[i].speed);
    EXPECT_EQ(a.events[i].impulse, b.events[i].impulse);
  }
}

}  // namespace avbd::record
