// The pair functions behind collide(): one file a family.
#pragma once

#include "collide/pair_math.h"
#include "geom/manifold.h"
#include "geom/shape.h"

namespace avbd {

/// Two shapes in the order that the table of collide.cpp asks for. `swapped`: the caller's A is b here; only feature
/// names may depend on it, so that they survive a change of order.
struct ShapePair {
  const ShapeGeom& a;
  const NearPose& poseA;
  const ShapeGeom& b;
  const NearPose& poseB;
  float margin;
  bool swapped;
};

/// They fill normal (from a to b) and points, and leave count = 0 where nothing is within the margin.
using PairFunction = void (*)(const ShapePair& pair, Manifold& out);

void collideSphereSphere(const ShapePair& pair, Manifold& out);
void collideSphereCapsule(const ShapePair& pair, Manifold& out);
void collideSphereBox(const ShapePair& pair, Manifold& out);
void collideCapsuleCapsule(const ShapePair& pair, Manifold& out);
void collideCapsuleBox(const ShapePair& pair, Manifold& out);
void collideBoxBox(const ShapePair& pair, Manifold& out);
void collideSphereHalfSpace(const ShapePair& pair, Manifold& out);
void collideCapsuleHalfSpace(const ShapePair& pair, Manifold& out);
void collideBoxHalfSpace(const ShapePair& pair, Manifold& out);

inline void addPoint(Manifold& out, Vec3 position, float separation, uint32_t feature) {
  out.points[out.count++] = {position, separation, feature};
}

}  // namespace avbd
