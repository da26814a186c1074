// Points, edges and faces of surfaces that bend: where they are nearest, and when they meet on straight ways.
#pragma once

#include <avbd/types.h>

namespace avbd {

/// The nearest point of a triangle, by its corners' weights.
struct NearestOnFace {
  Vec3 weights, point;
};
NearestOnFace nearestOnFace(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

/// The nearest points of two segments, by the shares 0 .. 1 of their ways.
struct NearestOnEdges {
  float onFirst, onSecond;
  Vec3 first, second;
};
NearestOnEdges nearestOnEdges(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// Where four points start and how far they go: a point and a face, or the ends of two edges.
struct FourPoints {
  Vec3 at[4], way[4];
  Vec3 when(int i, float time) const { return at[i] + way[i] * time; }
};

/// Conservative advancement: the first time 0 .. 1, within `advances` steps, at which distanceAt(time) is down to
/// `least`, if it shrinks by no more than `fastest` in the whole time; where the steps end, that to which they led.
/// More than 1: never.
template <class Distance>
float advanceUntil(float least, float fastest, int advances, Distance&& distanceAt) {
  constexpr float kAdvance = 0.9f;  // of the distance, gone at once
  if (!(fastest > 0)) return 2;
  float time = 0;
  for (int i = 0; i < advances; ++i) {
    const float left = distanceAt(time) - least;
    if (left <= 0.1f * least) return time;
    time += kAdvance * left / fastest;
    if (time > 1) return 2;
  }
  return time;
}

/// The first time 0 .. 1 at which two features are as near as `least`; more than 1: never. They start farther apart.
float pointMeetsFace(const FourPoints& points, float least);
float edgesMeet(const FourPoints& points, float least);

}  // namespace avbd
