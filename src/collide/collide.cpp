// Two shapes -> manifold: which function serves which pair.
//
//               | Sphere       | Capsule        | Box        | Cylinder .. Hull | HalfSpace         | Mesh, HeightField
//   ------------+--------------+----------------+------------+------------------+-------------------+------------------
//   Sphere      | SphereSphere | SphereCapsule  | SphereBox  | Convex           | SphereHalfSpace   | collideSurface()
//   Capsule     |              | CapsuleCapsule | CapsuleBox | Convex           | CapsuleHalfSpace  | collideSurface()
//   Box         |              |                | BoxBox     | Convex           | BoxHalfSpace      | collideSurface()
//   Cylinder .. |              |                |            | Convex           | ConvexHalfSpace   | collideSurface()
//      Hull     |              |                |            |                  |                   |
//   HalfSpace,  |              |                |            |                  | nothing: neither  | nothing
//     Mesh ..   |              |                |            |                  | moves             |
//
// "Cylinder .. Hull" are Cylinder, Cone, Ellipsoid, RoundedBox, Hull and, within collideSurface(), Triangle: any pair
// with one of them is served by collideConvex() (convex.h). A Mesh or HeightField gives several manifolds a pair and
// has its own door (collide_surface.h).
//
// Below the diagonal the two shapes change places and the normal turns round. On the diagonal an order that depends
// only on how the two lie relative to each other does the same, so that collide(a, b) and collide(b, a) agree in every
// bit. In that order the lower shape comes first where it can: of two equally good reference faces a stack then
// always takes the lower body's.
#include "collide/collide.h"

#include <avbd/hull.h>

#include "collide/collide_pairs.h"
#include "collide/convex.h"

namespace avbd {
namespace {

constexpr PairFunction kTable[3][3] = {
    {collideSphereSphere, collideSphereCapsule, collideSphereBox},
    {nullptr, collideCapsuleCapsule, collideCapsuleBox},
    {nullptr, nullptr, collideBoxBox},
};

PairFunction pairFunction(ShapeType first, ShapeType second) {
  if (!isConvex(first) || isSurface(second)) return nullptr;
  if (second == ShapeType::HalfSpace) {
    if (first == ShapeType::Sphere) return collideSphereHalfSpace;
    if (first == ShapeType::Capsule) return collideCapsuleHalfSpace;
    return first == ShapeType::Box ? collideBoxHalfSpace : collideConvexHalfSpace;
  }
  if (second <= ShapeType::Box) return kTable[static_cast<int>(first)][static_cast<int>(second)];
  return collideConvex;
}

/// Flat faces and corners: what touches one face rests on the same points while it hardly moves. Round ones roll on.
bool isAngular(const ShapeGeom& g) {
  return ((g.type == ShapeType::Box || g.type == ShapeType::Hull) && g.radius == 0) || g.type == ShapeType::HalfSpace;
}

/// -1, 0 or 1 as the data that a shape points to comes before, with or after another's: by content, not by address.
int compareData(const ShapeGeom& a, const ShapeGeom& b) {
  if (a.type == ShapeType::Hull) {
    const uint64_t left = a.hull().contentHash(), right = b.hull().contentHash();
    return left < right ? -1 : (left > right ? 1 : 0);
  }
  if (a.type != ShapeType::Triangle) return 0;
  for (int k = 0; k < 3; ++k) {
    const Axes left = axes(a.triangle()[k]), right = axes(b.triangle()[k]);
    for (int i = 0; i < 3; ++i) {
      if (left[i] != right[i]) return left[i] < right[i] ? -1 : 1;
    }
  }
  return 0;
}

/// Which of two shapes of the same kind at the same place comes first; any rule does.
bool comesLater(const ShapeGeom& a, Quat qa, const ShapeGeom& b, Quat qb) {
  const float left[] = {a.radius, a.extent.x, a.extent.y, a.extent.z, qa.w, qa.x, qa.y, qa.z};
  const float right[] = {b.radius, b.extent.x, b.extent.y, b.extent.z, qb.w, qb.x, qb.y, qb.z};
  for (int i = 0; i < 8; ++i) {
    if (left[i] != right[i]) return left[i] > right[i];
  }
  return compareData(a, b) > 0;
}

bool changePlaces(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB) {
  if (a.type != b.type) return a.type > b.type;
  const Vec3 d = poseB.p - poseA.p;
  // Not along any direction in which scenes are usually built, lest neighbours flicker.
  const float along = d.x * 0.3125f + d.y + d.z * 0.171875f;
  if (along != 0) return along < 0;
  if (d.x != 0) return d.x < 0;
  if (d.z != 0) return d.z < 0;
  return comesLater(a, poseA.q, b, poseB.q);
}

}  // namespace

void collide(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB, float margin,
             Manifold& out) {
  out.count = 0;
  out.clear = 0;
  out.carrier = Carrier::None;
  const bool swapped = changePlaces(a, poseA, b, poseB);
  const ShapeGeom &first = swapped ? b : a, &second = swapped ? a : b;
  const PairFunction function = pairFunction(first.type, second.type);
  if (!function) return;
  function({first, swapped ? poseB : poseA, second, swapped ? poseA : poseB, margin, swapped}, out);
  if (swapped) out.normal = -out.normal;
  if (out.count > 0) out.clear = margin;
  if (!isAngular(first) || !isAngular(second)) out.carrier = Carrier::None;
  if (swapped && out.carrier != Carrier::None) out.carrier = out.carrier == Carrier::A ? Carrier::B : Carrier::A;
}

}  // namespace avbd
