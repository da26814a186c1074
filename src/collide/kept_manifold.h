// A manifold kept in the frame of the body whose face carries it: while the two bodies hardly move against each other
// its points are carried along with the other body instead of being found anew.
//
// The points are places on the other body's surface, so heights over the face stay exact; only which places touch is as
// old as the manifold. Where nothing touched, how far apart the two were says for how long nothing can: that only saves
// time and is no state, as nothing would be found anew either.
#pragma once

#include <avbd/rows/math3.h>

#include "collide/pair_math.h"
#include "geom/manifold.h"
#include "geom/shape.h"
#include "lane/wide.h"

namespace avbd {

struct KeptManifold {
  enum class What : uint8_t { Nothing, Apart, PointsOnA, PointsOnB };  ///< whose face carries the points

  What what = What::Nothing;
  bool aroundBase = false;  ///< what of the other body is near the base counts, not all of it
  Vec3 offset;              ///< the base is the carrier, or A; the other's centre in its frame then
  Quat turn;                ///< the other's rotation in it then
  float clear = 0;          ///< [m] what is not among the points was at least so far away
  float reach = 0;          ///< [m] no part that counts is farther from the point that turns are about
  Vec3 normal;              ///< from the base to the other
  float x[kMaxManifoldPoints] = {}, y[kMaxManifoldPoints] = {}, z[kMaxManifoldPoints] = {};  ///< on the other body
  float height[kMaxManifoldPoints] = {};
};

/// Otherwise it is no state.
inline bool keepsPoints(const KeptManifold& kept) {
  return kept.what == KeptManifold::What::PointsOnA || kept.what == KeptManifold::What::PointsOnB;
}

/// A body as collision sees it.
struct NearBody {
  NearPose pose;     ///< of its centre of mass
  float radius = 0;  ///< of a ball about it that holds the shape; infinite for a HalfSpace
};

/// Keeps what collide() found, if it can be kept.
void keep(const Manifold& found, const NearBody& a, const NearBody& b, KeptManifold& kept);

/// Where the points are now: lanes are points.
struct CarriedPoints {
  using Lanes = lane::Wide<kMaxManifoldPoints>;
  Vec3 normal;  ///< from A to B
  Lanes separation;
  rows::V3<Lanes> position;  ///< halfway between the surfaces, relative to the pair's origin
  rows::V3<Lanes> onBase;    ///< the same in the base's frame
  Vec3 offset;               ///< the other body as the base sees it
  Quat turn;
  bool ofB = false;  ///< the base is B
};

/// Where the base is, and the other body as it sees it.
struct OtherPlace {
  bool ofB;  ///< the base is B
  Vec3 base;
  Mat3 frame;
  Vec3 offset;
  Quat turn;
};
OtherPlace otherPlace(KeptManifold::What what, const NearPose& a, const NearPose& b);

/// However far the two have moved.
void carryPoints(const KeptManifold& kept, const OtherPlace& now, CarriedPoints& out);

/// The positions in each body's frame, relative to its centre.
struct PlacesOnBodies {
  rows::V3<CarriedPoints::Lanes> a, b;
};
PlacesOnBodies placesOnBodies(const CarriedPoints& points);

/// How far the two may have moved against each other.
struct KeepLimits {
  float margin;   ///< [m] within which contacts are looked for
  float slack;    ///< [m] of that, what may be missed
  float allowed;  ///< [m]
};

enum class Carry : uint8_t { Anew, Apart, Points };  ///< find it anew; still nothing; points

Carry carry(const KeptManifold& kept, const NearPose& a, const NearPose& b, const KeepLimits& limits,
            CarriedPoints& out);

}  // namespace avbd
