// Sphere against sphere, capsule and box: one point on the line between the sphere's centre and the nearest point.
#include "collide/collide_pairs.h"

namespace avbd {
namespace {

/// The point of two balls about p and q whose centres differ by d; `instead` is the normal where d has no direction.
void touchBalls(const ShapePair& pair, Vec3 p, Vec3 d, float radiusB, Vec3 instead, Manifold& out) {
  const float reach = pair.a.radius + radiusB, distance = length(d), separation = distance - reach;
  if (separation > pair.margin) return;
  out.normal = distance > kNoDirection * reach ? d * (1 / distance) : instead;
  addPoint(out, p + out.normal * (pair.a.radius + 0.5f * separation), separation, 0);
}

}  // namespace

void collideSphereSphere(const ShapePair& pair, Manifold& out) {
  touchBalls(pair, pair.poseA.p, pair.poseB.p - pair.poseA.p, pair.b.radius, {0, 1, 0}, out);
}

void collideSphereCapsule(const ShapePair& pair, Manifold& out) {
  const Vec3 half = rotate(pair.poseB.q, pair.b.extent), d = pair.poseB.p - pair.poseA.p;
  const float hh = dot(half, half);
  const float t = hh > 0 ? clampTo(-dot(d, half) / hh, -1, 1) : 0;
  touchBalls(pair, pair.poseA.p, d + half * t, pair.b.radius, rotate(pair.poseB.q, Vec3{1, 0, 0}), out);
}

void collideSphereBox(const ShapePair& pair, Manifold& out) {
  const Mat3 box = matrix(pair.poseB.q);
  const Vec3 h = pair.b.extent, c = mulT(box, pair.poseA.p - pair.poseB.p), away = c - clampTo(c, h);
  const float r = pair.a.radius, distance = length(away);
  Vec3 normal;  // out of the box
  float separation;
  if (distance > kNoDirection * (h.x + h.y + h.z + r)) {
    normal = away * (1 / distance);
    separation = distance - r;
  } else {  // the centre is inside: out through the nearest face
    const Axes centre = axes(c), extent = axes(h);
    int best = 0;
    for (int i = 1; i < 3; ++i) {
      if (magnitude(centre[i]) - extent[i] > magnitude(centre[best]) - extent[best]) best = i;
    }
    Axes n{};
    n[best] = centre[best] < 0 ? -1.0f : 1.0f;
    normal = vec(n);
    separation = magnitude(centre[best]) - extent[best] - r;
  }
  if (separation > pair.margin) return;
  out.normal = -mul(box, normal);
  addPoint(out, pair.poseA.p + out.normal * (r + 0.5f * separation), separation, 0);
}

}  // namespace avbd
