// Sphere, capsule and box against a half-space (always the second shape): their lowest points.
#include "collide/collide_pairs.h"

namespace avbd {
namespace {

/// Adds the point of a ball about p (or of a corner, radius 0) if the plane is near.
void addLowest(const ShapePair& pair, Vec3 up, Vec3 p, uint32_t feature, Manifold& out) {
  const float radius = pair.a.radius, height = dot(up, p - pair.poseB.p), separation = height - radius;
  if (separation > pair.margin) return;
  out.normal = -up;
  addPoint(out, p - up * (radius + 0.5f * separation), separation, feature);
}

Vec3 upwards(const ShapePair& pair) { return rotate(pair.poseB.q, Vec3{0, 1, 0}); }

}  // namespace

void collideSphereHalfSpace(const ShapePair& pair, Manifold& out) {
  addLowest(pair, upwards(pair), pair.poseA.p, 0, out);
}

void collideCapsuleHalfSpace(const ShapePair& pair, Manifold& out) {
  const Vec3 up = upwards(pair), half = rotate(pair.poseA.q, pair.a.extent);
  addLowest(pair, up, pair.poseA.p - half, 0, out);
  if (pair.a.extent.y > 0) addLowest(pair, up, pair.poseA.p + half, 1, out);
}

void collideBoxHalfSpace(const ShapePair& pair, Manifold& out) {
  const Vec3 up = upwards(pair);
  const Mat3 box = matrix(pair.poseA.q);
  const Axes n = axes(mulT(box, up)), h = axes(pair.a.extent);
  // The four lowest corners are those of the face across the axis that would lift a corner most.
  Axes lift;
  for (int i = 0; i < 3; ++i) lift[i] = magnitude(n[i]) * h[i];
  const float lowest = dot(up, pair.poseA.p - pair.poseB.p) - (lift[0] + lift[1] + lift[2]);
  out.clear = lowest;
  if (lowest > pair.margin) return;
  out.carrier = Carrier::B;
  int across = lift[1] > lift[0] ? 1 : 0;
  if (lift[2] > lift[across]) across = 2;
  const int u = kNext[across], v = kLast[across];
  for (int k = 0; k < 4; ++k) {
    Axes corner;
    corner[across] = n[across] > 0 ? -h[across] : h[across];
    corner[u] = k == 0 || k == 3 ? -h[u] : h[u];
    corner[v] = k < 2 ? -h[v] : h[v];
    uint32_t name = 0;
    for (int i = 0; i < 3; ++i) name |= corner[i] > 0 ? 1u << i : 0u;
    addLowest(pair, up, pair.poseA.p + mul(box, vec(corner)), name, out);
  }
}

}  // namespace avbd
