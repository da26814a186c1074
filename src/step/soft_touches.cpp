// Finding which points of soft bodies touch faces of others.
//
// A point has the nearest face of another body, if its ball and the face's thickness are nearer than the margin, or the
// point is behind the face by less than the faces are wide: deeper in a body than that nothing tells which way is out.
// Bodies whose bounds overlap are found by a sweep along x, faces by a tree whose bounds follow the points.
#include "step/soft_touches.h"

#include <algorithm>
#include <tuple>

#include "avbd/rows/math.h"
#include "geom/face_tree.h"
#include "step/contacts.h"
#include "world/pairs.h"
#include "world/soft.h"

namespace avbd {

NearestOnFace nearestOnFace(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto at = [&](float v, float w) { return NearestOnFace{{1 - v - w, v, w}, a + ab * v + ac * w}; };
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
              d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const float bc = d4 - d3, cb = d5 - d6;
  if (va <= 0 && bc >= 0 && cb >= 0) return at(1 - bc / (bc + cb), bc / (bc + cb));
  const float sum = va + vb + vc;
  return sum > 0 ? at(vb / sum, vc / sum) : at(0, 0);
}

namespace {

using Place = StepData::SoftPlace;

void place(const WorldData& world, const SoftData& soft, Place& out) {
  out.origin = world.bodies[soft.bodies[0]].position;
  out.points.resize(soft.bodies.size());
  float fastest = 0;
  for (size_t i = 0; i < soft.bodies.size(); ++i) {
    const BodyData& body = world.bodies[soft.bodies[i]];
    out.points[i] = toFloat(body.position - out.origin);
    fastest = std::max(fastest, dot(body.linearVelocity, body.linearVelocity));
  }
  out.fastest = rows::sqrt(fastest);
  const SoftMeshData& mesh = *soft.mesh;
  mesh.faceTree().refit(
      mesh.surface(), [&](uint32_t i) { return out.points[i]; }, out.bounds);
}

/// How far from a body's faces points are looked for.
float reachOf(const WorldData& world, const SoftData& soft) {
  return soft.mesh->faceSize() + kSpeculative * world.def.lengthUnit;
}

/// The bounds of a body, its thickness and reach around it, in the frame of another origin.
Aabb boundsFrom(const Place& place, Vec3d origin, float grown) {
  const Vec3 shift = toFloat(place.origin - origin), around{grown, grown, grown};
  return {place.bounds[0].lower + shift - around, place.bounds[0].upper + shift + around};
}

/// The face nearest to a point. Where two are as near, as at an edge, the one that the point is most in front or
/// behind.
struct Search {
  Vec3 p;
  uint32_t face = kNone;
  NearestOnFace nearest;
  Vec3 normal;
  float distance2 = 0, upright = 0;

  void meet(uint32_t index, Vec3 a, Vec3 b, Vec3 c) {
    constexpr float kAsNear = 1e-5f;
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

class PairSearch {
 public:
  PairSearch(const WorldData& world, StepData& step, uint32_t pointSoft, uint32_t faceSoft)
      : world_(world),
        step_(step),
        slots_{pointSoft, faceSoft},
        points_(world.softs[pointSoft]),
        faces_(world.softs[faceSoft]),
        pointPlace_(step.softPlaces[pointSoft]),
        facePlace_(step.softPlaces[faceSoft]) {}

  void run() {
    thickness_ = points_.radius + faces_.radius;
    const Vec3 shift = toFloat(pointPlace_.origin - facePlace_.origin);
    const float reach = thickness_ + reachOf(world_, faces_);
    const Aabb all = boundsFrom(facePlace_, facePlace_.origin, reach);
    for (uint32_t i = 0; i < points_.bodies.size(); ++i) {
      const Vec3 p = pointPlace_.points[i] + shift;
      if (world_.bodies[points_.bodies[i]].firstShape != kNone && overlaps(all, {p, p})) look(i, p, reach);
    }
  }

 private:
  void look(uint32_t point, Vec3 p, float reach) {
    const Vec3 around{reach, reach, reach};
    Search search{p, kNone, {}, {}};
    faces_.mesh->faceTree().query(facePlace_.bounds, {p - around, p + around}, [&](uint32_t face) {
      const auto& corner = faces_.mesh->surface()[face];
      search.meet(face, facePlace_.points[corner[0]], facePlace_.points[corner[1]], facePlace_.points[corner[2]]);
    });
    if (search.face == kNone) return;
    const float distance = rows::sqrt(search.distance2);
    const Vec3 off = p - search.nearest.point;
    const bool inside = faces_.mesh->isCloth() ? isBeyond(point, off) : dot(search.normal, off) < 0;
    const float speed = length(world_.bodies[points_.bodies[point]].linearVelocity) + facePlace_.fastest;
    const float margin = kSpeculative * world_.def.lengthUnit + std::min(speed * step_.h, faces_.mesh->faceSize());
    const float separation = (inside ? -distance : distance) - thickness_;
    if (separation > margin || (inside && distance > faces_.mesh->faceSize()) || !mayMeet(point, search.face)) return;
    const float sign = inside ? -1.0f : 1.0f;
    const bool apart = distance > 1e-3f * thickness_;
    add(point, search, apart ? off * (sign / distance) : search.normal, separation);
  }

  /// Cloth has no inside: what touched it from one side and is on the other one by now has passed.
  bool isBeyond(uint32_t point, Vec3 off) const {
    const SoftTouch* old = remembered(point);
    return old && dot(old->normal, off) < 0;
  }
  const SoftTouch* remembered(uint32_t point) const {
    SoftTouch key;
    key.pointSoft = slots_[0], key.point = point, key.faceSoft = slots_[1];
    const auto& all = world_.softTouches;
    const auto old = std::lower_bound(all.begin(), all.end(), key);
    return old == all.end() || key < *old ? nullptr : &*old;
  }

  bool mayMeet(uint32_t point, uint32_t face) const {
    const uint32_t a = world_.bodies[points_.bodies[point]].firstShape,
                   b = world_.bodies[faces_.bodies[faces_.mesh->surface()[face][0]]].firstShape;
    return b != kNone && filtersMeet(world_.shapes[a].filter, world_.shapes[b].filter);
  }

  void add(uint32_t point, const Search& search, Vec3 normal, float separation) {
    StepData::FoundTouch found;
    found.touch.pointSoft = slots_[0], found.touch.faceSoft = slots_[1];
    found.touch.point = point, found.touch.face = search.face;
    found.touch.normal = normal;
    found.touch.anchor = found.weights = search.nearest.weights;
    found.separation = separation;
    found.awake = true;
    remember(found.touch);
    step_.softTouches.push_back(found);
  }

  /// Multipliers, and the place of sticking while the face is the same.
  void remember(SoftTouch& touch) const {
    const SoftTouch* old = remembered(touch.point);
    if (!old || dot(old->normal, touch.normal) <= kSameNormal) return;
    const TouchBasis before = basisOf(old->normal), now = basisOf(touch.normal);
    const Vec3 tangential = before.t1 * old->lambda.y + before.t2 * old->lambda.z;
    touch.lambda = {old->lambda.x, dot(tangential, now.t1), dot(tangential, now.t2)};
    touch.sticks = old->sticks, touch.slides = old->slides;
    if (old->face == touch.face && old->sticks) touch.anchor = old->anchor;
  }

  const WorldData& world_;
  StepData& step_;
  uint32_t slots_[2];
  const SoftData &points_, &faces_;
  const Place &pointPlace_, &facePlace_;
  float thickness_ = 0;
};

/// Bodies by their lower ends along x, in the frame of the first of them.
void sweep(const WorldData& world, StepData& step) {
  using End = StepData::SoftEnds;
  std::vector<End>& ends = step.softEnds;
  ends.clear();
  world.softIds.forEach([&](uint32_t slot) {
    const Place& place = step.softPlaces[slot];
    const float grown = 2 * world.softs[slot].radius + reachOf(world, world.softs[slot]);
    ends.push_back({place.origin.x + double{place.bounds[0].lower.x - grown},
                    place.origin.x + double{place.bounds[0].upper.x + grown}, slot});
  });
  std::sort(ends.begin(), ends.end(),
            [](const End& a, const End& b) { return std::tie(a.lower, a.slot) < std::tie(b.lower, b.slot); });
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t k = i + 1; k < ends.size() && ends[k].lower <= ends[i].upper; ++k) {
      const uint32_t a = ends[i].slot, b = ends[k].slot;
      if (isAsleep(world, world.softs[a]) && isAsleep(world, world.softs[b])) continue;
      const Vec3d origin = step.softPlaces[a].origin;
      const float grownA = 2 * world.softs[a].radius + reachOf(world, world.softs[a]),
                  grownB = 2 * world.softs[b].radius + reachOf(world, world.softs[b]);
      if (!overlaps(boundsFrom(step.softPlaces[a], origin, grownA), boundsFrom(step.softPlaces[b], origin, grownB)))
        continue;
      PairSearch(world, step, a, b).run();
      PairSearch(world, step, b, a).run();
    }
}

}  // namespace

void findSoftTouches(const WorldData& world, StepData& step) {
  step.softTouches.clear();
  bool awake = false;
  world.softIds.forEach([&](uint32_t slot) { awake = awake || !isAsleep(world, world.softs[slot]); });
  for (const SoftTouch& touch : world.softTouches)
    if (isAsleep(world, world.softs[touch.pointSoft]) && isAsleep(world, world.softs[touch.faceSoft]))
      step.softTouches.push_back({touch, {}, 0, false});
  if (!awake || world.softIds.count() < 2) return;
  step.softPlaces.resize(world.softs.size());
  world.softIds.forEach([&](uint32_t slot) { place(world, world.softs[slot], step.softPlaces[slot]); });
  sweep(world, step);
  std::sort(step.softTouches.begin(), step.softTouches.end(),
            [](const StepData::FoundTouch& a, const StepData::FoundTouch& b) { return a.touch < b.touch; });
}

}  // namespace avbd
