// Points of soft bodies and faces of solids.
//
// A point has the nearest face of another body, if its ball and the face's thickness are nearer than the margin, or the
// point is behind the face by less than the faces are wide: deeper in a body than that nothing tells which way is out.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/soft_touches.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr float kAsNear = 1e-5f;  ///< share of the square of a distance

/// The face nearest to a point. Where two are as near, as at an edge, the one that the point is most in front or
/// behind.
struct Search {
  Vec3 p;
  uint32_t face = kNone;
  NearestOnFace nearest;
  Vec3 normal;
  float distance2 = 0, upright = 0;

  void meet(uint32_t index, Vec3 a, Vec3 b, Vec3 c) {
    const NearestOnFace here = nearestOnFace(p, a, b, c);
    const Vec3 off = p - here.point, n = cross(b - a, c - a);
    const float d2 = dot(off, off), size = length(n);
    if (!(size > 0) || (face != kNone && d2 > distance2 * (1 + kAsNear))) return;
    const Vec3 unit = n * (1 / size);
    const float along = dot(unit, off), most = along < 0 ? -along : along;
    if (face != kNone && d2 >= distance2 * (1 - kAsNear) && most <= upright) return;
    face = index, nearest = here, normal = unit, distance2 = d2, upright = most;
  }
};

class PointSearch {
 public:
  PointSearch(const WorldData& world, StepData& step, uint32_t pointSoft, uint32_t faceSoft)
      : world_(world),
        step_(step),
        slots_{pointSoft, faceSoft},
        points_(world.softs[pointSoft]),
        faces_(world.softs[faceSoft]),
        pointPlace_(step.softs.places[pointSoft]),
        facePlace_(step.softs.places[faceSoft]) {}

  void run() {
    thickness_ = points_.radius + faces_.radius;
    const Vec3 shift = toFloat(pointPlace_.origin - facePlace_.origin);
    const float reach = thickness_ + faces_.mesh->faceSize() + touchMargin(world_);
    const Vec3 around{reach, reach, reach};
    const Aabb& bounds = facePlace_.bounds[0];
    const Aabb all{bounds.lower - around, bounds.upper + around};
    for (uint32_t i = 0; i < points_.bodies.size(); ++i) {
      const Vec3 p = pointPlace_.points[i] + shift;
      if (world_.bodies[points_.bodies[i]].firstShape != kNone && overlaps(all, {p, p})) look(i, p, reach);
    }
  }

 private:
  void look(uint32_t point, Vec3 p, float reach) {
    Search search{p, kNone, {}, {}};
    faces_.mesh->faceTree().nearest(facePlace_.bounds, p, reach, [&](uint32_t face) {
      const auto& corner = faces_.mesh->surface()[face];
      search.meet(face, facePlace_.points[corner[0]], facePlace_.points[corner[1]], facePlace_.points[corner[2]]);
      return search.face == kNone ? reach * reach : search.distance2 * (1 + 2 * kAsNear);
    });
    if (search.face == kNone) return;
    const float distance = rows::sqrt(search.distance2), size = faces_.mesh->faceSize();
    const Vec3 off = p - search.nearest.point;
    const bool inside = dot(search.normal, off) < 0;
    const float way = length(pointPlace_.ways[point] + pointPlace_.drift) + facePlace_.fastest;
    const float separation = (inside ? -distance : distance) - thickness_;
    if (separation > touchMargin(world_) + std::min(way, size) || (inside && distance > size)) return;
    const float sign = inside ? -1.0f : 1.0f;
    const bool apart = distance > 1e-3f * thickness_;
    FoundTouch found;
    found.touch = FeatureNames{TouchKind::PointFace, slots_[0], point, slots_[1], search.face}.touch();
    found.touch.normal = apart ? off * (sign / distance) : search.normal;
    found.touch.anchor = search.nearest.weights;
    found.separation = separation;
    found.off = off;
    if (mayTouchSoft(world_, found.touch)) addTouch(world_, step_, found);
  }

  const WorldData& world_;
  StepData& step_;
  uint32_t slots_[2];
  const SoftData &points_, &faces_;
  const SoftPlace &pointPlace_, &facePlace_;
  float thickness_ = 0;
};

}  // namespace

void findPointTouches(const WorldData& world, StepData& step) {
  for (const auto& [a, b] : step.softs.pairs) {
    if (!world.softs[b].mesh->isCloth()) PointSearch(world, step, a, b).run();
    if (!world.softs[a].mesh->isCloth()) PointSearch(world, step, b, a).run();
  }
}

}  // namespace avbd
