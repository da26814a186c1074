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

/// The first time 0 .. 1 at which two features are as near as `least`; more than 1: never. They start farther apart.
float pointMeetsFace(const FourPoints& points, float least);
float edgesMeet(const FourPoints& points, float least);

}  // namespace avbd
