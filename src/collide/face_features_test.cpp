// Nearest points of points, faces and edges, and when they meet.
#include "collide/face_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace avbd {
namespace {

struct FaceFeatures : testing::Test {
  std::mt19937 generator{9};
  std::uniform_real_distribution<float> draw{-1, 1};
  Vec3 vector() { return {draw(generator), draw(generator), draw(generator)}; }
};

TEST_F(FaceFeatures, NoPointOfAFaceIsNearer) {
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 a = vector(), b = vector(), c = vector(), p = vector() * 2;
    const NearestOnFace nearest = nearestOnFace(p, a, b, c);
    const Vec3 w = nearest.weights;
    EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-5);
    EXPECT_GE(std::min({w.x, w.y, w.z}), -1e-5f);
    EXPECT_NEAR(length(a * w.x + b * w.y + c * w.z - nearest.point), 0, 1e-5);
    const float distance = length(p - nearest.point);
    for (int i = 0; i <= 20; ++i)
      for (int k = 0; i + k <= 20; ++k) {
        const float u = static_cast<float>(i) / 20, v = static_cast<float>(k) / 20;
        EXPECT_GE(length(p - (a * (1 - u - v) + b * u + c * v)), distance - 1e-5f);
      }
  }
}

TEST_F(FaceFeatures, NoPointsOfEdgesAreNearer) {
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = vector(), b = vector(), c = vector(), d = trial % 5 == 0 ? c + (b - a) * draw(generator) : vector();
    const NearestOnEdges nearest = nearestOnEdges(a, b, c, d);
    const float distance = length(nearest.first - nearest.second);
    EXPECT_NEAR(length(a + (b - a) * nearest.onFirst - nearest.first), 0, 1e-5);
    EXPECT_NEAR(length(c + (d - c) * nearest.onSecond - nearest.second), 0, 1e-5);
    for (int i = 0; i <= 20; ++i)
      for (int k = 0; k <= 20; ++k) {
        const float s = static_cast<float>(i) / 20, t = static_cast<float>(k) / 20;
        EXPECT_GE(length(a + (b - a) * s - c - (d - c) * t), distance - 2e-4f);
      }
  }
}

/// Against small steps of time: never late, and where it says so they are as near.
template <class Meets, class Distance>
void expectFirst(std::mt19937& generator, Meets&& meets, Distance&& distance) {
  std::uniform_real_distribution<float> draw(-1, 1);
  int met = 0;
  for (int trial = 0; trial < 400; ++trial) {
    FourPoints p;
    for (int i = 0; i < 4; ++i) {
      p.at[i] = {draw(generator), draw(generator), draw(generator)};
      p.way[i] = Vec3{draw(generator), draw(generator), draw(generator)} * 2;
    }
    const float least = 0.05f, start = distance(p, 0.0f);
    if (start <= 1.2f * least) continue;
    const float time = meets(p, Kept{least, 0.1f * least});
    for (float t = 0; t < std::min(time, 1.0f); t += 1.0f / 256) EXPECT_GT(distance(p, t), least * 0.99f) << trial;
    if (time <= 1) {
      ++met;
      EXPECT_LT(distance(p, time), least * 1.2f) << trial;
    }
  }
  EXPECT_GT(met, 20);
}

TEST_F(FaceFeatures, AFaceIsMetInTime) {
  expectFirst(generator, pointMeetsFace, [](const FourPoints& p, float t) {
    return length(p.when(0, t) - nearestOnFace(p.when(0, t), p.when(1, t), p.when(2, t), p.when(3, t)).point);
  });
}

TEST_F(FaceFeatures, AnEdgeIsMetInTime) {
  expectFirst(generator, edgesMeet, [](const FourPoints& p, float t) {
    const NearestOnEdges n = nearestOnEdges(p.when(0, t), p.when(1, t), p.when(2, t), p.when(3, t));
    return length(n.first - n.second);
  });
}

TEST_F(FaceFeatures, WhatSlidesPastIsSeenToInFewAdvances) {
  int advances = 0;
  const auto above = [&](float time) {
    ++advances;
    return Approach{0.011f + 0.0f * time, 0.002f};  // along a face, at a little more than what is kept
  };
  EXPECT_EQ(advanceUntil({0.01f, 0.0005f}, 100, above), 2);
  EXPECT_LT(advances, 4);
}

TEST_F(FaceFeatures, WhatGoesTogetherNeverMeets) {
  FourPoints p{{{0, 0.01f, 0}, {-1, 0, -1}, {1, 0, -1}, {0, 0, 1}}, {}};
  for (Vec3& way : p.way) way = {0, -50, 7};
  EXPECT_GT(pointMeetsFace(p, {0.005f, 0.0005f}), 1);
  p.way[0].y -= 0.1f;
  EXPECT_NEAR(pointMeetsFace(p, {0.005f, 0.0005f}), 0.05f, 0.006f);
}

}  // namespace
}  // namespace avbd
