// Points, edges and faces of surfaces that bend: where they are nearest, and when they meet on straight ways.
#pragma once

#include <avbd/types.h>

#include <algorithm>

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

/// The least of the first `split` of four nodes less the most of the others; along(i): where node i is along a
/// direction.
template <class Along>
float leastApart(int split, Along&& along) {
  float first = 1e30f, second = -1e30f;
  for (int i = 0; i < 4; ++i) {
    if (i < split)
      first = std::min(first, along(i));
    else
      second = std::max(second, along(i));
  }
  return first - second;
}

/// What two things must keep: they meet when they are nearer than both together.
struct Kept {
  float least = 0;      ///< [m]
  float tolerance = 0;  ///< [m] > 0
  float aim = 0;        ///< [m] at which they surely do not meet: what keeps them apart leaves so much
};

/// How near two things are, and how fast they may come nearer along the direction in which they are parted now: their
/// distance is never less than what parts them along any direction.
struct Approach {
  float distance = 0;  ///< [m]
  float speed = 0;     ///< [m] in the whole time, at most
};

/// Conservative advancement: the first time 0 .. 1, within `advances` steps, at which approachAt(time) is down to
/// `kept`; where the steps end, that to which they led. More than 1: never.
template <class ApproachAt>
float advanceUntil(Kept kept, int advances, ApproachAt&& approachAt) {
  constexpr float kAdvance = 0.9f;  // of the distance, gone at once
  float time = 0;
  for (int i = 0; i < advances; ++i) {
    const Approach now = approachAt(time);
    const float left = now.distance - kept.least;
    if (left <= kept.tolerance) return time;
    if (!(now.speed > 0)) return 2;
    time += kAdvance * left / now.speed;
    if (time > 1) return 2;
  }
  return time;
}

/// The first time 0 .. 1 at which two features meet; more than 1: never.
float pointMeetsFace(const FourPoints& points, Kept kept);
float edgesMeet(const FourPoints& points, Kept kept);

}  // namespace avbd
