// Shapes near faces of soft bodies (near_shapes.h).
#include "step/near_shapes.h"

#include <algorithm>

#include "collide/face_features.h"
#include "geom/triangles.h"
#include "step/contacts.h"
#include "step/free_motion.h"
#include "world/soft.h"

namespace avbd {

NearPose ShapePiece::when(float time) const {
  const Quat by = quatFromVector(turn * time);
  return {center + linear * time + rotate(by, pose.p - center), unit(by * pose.q)};
}

namespace {

/// Bounds of a box in the frame of a pose.
Aabb boxIn(const NearPose& pose, const Aabb& box) {
  const Quat back = conjugate(pose.q);
  const Vec3 half = (box.upper - box.lower) * 0.5f, middle = rotate(back, (box.upper + box.lower) * 0.5f - pose.p);
  const auto size = [](Vec3 v) { return Vec3{v.x < 0 ? -v.x : v.x, v.y < 0 ? -v.y : v.y, v.z < 0 ? -v.z : v.z}; };
  const Vec3 around = size(rotate(back, Vec3{half.x, 0, 0})) + size(rotate(back, Vec3{0, half.y, 0})) +
                      size(rotate(back, Vec3{0, 0, half.z}));
  return {middle - around, middle + around};
}

class NearSearch {
 public:
  NearSearch(const WorldData& world, StepData& step, uint32_t soft, bool solved)
      : world_(world), step_(step), soft_(world.softs[soft]), place_(step.softs.places[soft]), solved_(solved) {}

  void run(FunctionRef<void(const ShapePiece&, uint32_t)> f) {
    const bool asleep = isAsleep(world_, soft_);
    std::vector<uint32_t>& shapes = step_.softs.shapes;
    shapes.clear();
    world_.tree.query(worldBounds(), [&](uint32_t shape) {
      const ShapeData& data = world_.shapes[shape];
      if (data.isTrigger || isParticle(world_, data.body) || data.geom.type == ShapeType::HalfSpace) return;
      if (!asleep || !world_.bodies[data.body].asleep) shapes.push_back(shape);
    });
    std::sort(shapes.begin(), shapes.end());
    for (const uint32_t shape : shapes) meetShape(shape, f);
  }

 private:
  Aabb worldBounds() const {
    const Aabb box = swept(place_.bounds[0], place_.drift);
    const auto at = [](double origin, float offset) { return static_cast<float>(origin + double{offset}); };
    const Vec3d o = place_.origin;
    return {{at(o.x, box.lower.x), at(o.y, box.lower.y), at(o.z, box.lower.z)},
            {at(o.x, box.upper.x), at(o.y, box.upper.y), at(o.z, box.upper.z)}};
  }

  void setWay(const BodyData& body, uint32_t slot, ShapePiece& piece) const {
    if (body.asleep) return;
    if (solved_ && body.type == BodyType::Dynamic) {
      const uint32_t end = step_.endOf[slot];
      const float* d = step_.d.data() + size_t(8) * step_.rowOfEnd[end];
      piece.linear = solvedWay(world_, step_, slot);
      piece.turn = {d[4], d[5], d[6]};
      return;
    }
    piece.linear = body.linearVelocity * step_.h, piece.turn = body.angularVelocity * step_.h;
  }

  void meetShape(uint32_t slot, FunctionRef<void(const ShapePiece&, uint32_t)> f) {
    const ShapeData& data = world_.shapes[slot];
    const BodyData& body = world_.bodies[data.body];
    ShapePiece piece{slot,
                     0,
                     data.geom,
                     nearPose(body, data, place_.origin),
                     toFloat(body.position - place_.origin),
                     {},
                     {},
                     {},
                     body.radius,
                     body.minExtent};
    setWay(body, data.body, piece);
    const bool surface = isSurface(data.geom.type);
    const float margin = 0.5f * touchMargin(world_) + std::min(length(piece.turn), 2.0f) * body.radius;
    Aabb box = surface ? place_.bounds[0] : bounds(data.geom, {toDouble(piece.pose.p), piece.pose.q}, margin);
    if (!surface) box = swept(box, piece.linear - place_.drift);
    soft_.mesh->faceTree().query(place_.bounds, box, [&](uint32_t face) {
      if (!overlaps(place_.faces[face], box)) return;
      if (surface)
        meetTriangles(piece, margin, face, f);
      else
        f(piece, face);
    });
  }

  void meetTriangles(const ShapePiece& whole, float margin, uint32_t face,
                     FunctionRef<void(const ShapePiece&, uint32_t)> f) const {
    const Aabb box = grown(swept(place_.faces[face], place_.drift - whole.linear), margin);
    forEachBareTriangle(whole.geom, boxIn(whole.pose, box), [&](const SurfaceTriangle& triangle) {
      ShapePiece piece = whole;
      piece.part = triangle.element, piece.thin = 0;
      piece.geom = {ShapeType::Triangle, 0, {}};
      piece.geom.data = triangle.v;
      if (!triangle.doubleSided) piece.front = rotate(whole.pose.q, triangle.normal);
      f(piece, face);
      return true;
    });
  }

  const WorldData& world_;
  StepData& step_;
  const SoftData& soft_;
  const SoftPlace& place_;
  bool solved_;
};

}  // namespace

void forEachNearShape(const WorldData& world, StepData& step, uint32_t soft, bool solved,
                      FunctionRef<void(const ShapePiece&, uint32_t face)> f) {
  NearSearch(world, step, soft, solved).run(f);
}

Nearest nearestToFace(const ShapePiece& piece, const NearPose& pose, const Vec3 (&face)[3], float beyond) {
  if (piece.geom.type != ShapeType::Sphere) {
    ShapeGeom triangle{ShapeType::Triangle, 0, {}};
    triangle.data = face;
    return nearest(piece.geom, pose, triangle, {}, beyond);
  }
  Nearest near;
  near.pointB = nearestOnFace(pose.p, face[0], face[1], face[2]).point;
  const Vec3 off = near.pointB - pose.p;
  const float distance = length(off), radius = piece.geom.radius;
  near.distance = distance - radius;
  near.apart = near.distance >= beyond || !(distance > 1e-6f * radius);
  if (!near.apart) near.normal = off * (1 / distance), near.pointA = pose.p + near.normal * radius;
  return near;
}

float fastestApproach(const ShapePiece& piece, const MovingFace& face) {
  float fastest = 0;
  for (const Vec3& way : face.way) fastest = std::max(fastest, length(way - piece.linear));
  return fastest + length(piece.turn) * piece.reach;
}

float pieceMeetsFace(const ShapePiece& piece, const MovingFace& face, Kept kept) {
  constexpr int kMostAdvances = 256;  ///< each asks a search for the nearest points of two convex shapes
  const float fastest = fastestApproach(piece, face), far = kept.least + kept.tolerance + fastest;
  return advanceUntil(kept, kMostAdvances, [&](float time) -> Approach {
    const Vec3 v[3] = {face.when(0, time), face.when(1, time), face.when(2, time)};
    const Nearest near = nearestToFace(piece, piece.when(time), v, far);
    if (near.apart) return {near.distance >= far ? far + fastest : near.distance, fastest};
    float speed = -1e30f;
    for (const Vec3& way : face.way) speed = std::max(speed, dot(near.normal, piece.linear - way));
    // Whatever of the body is foremost as it turns.
    return {near.distance, speed + length(cross(near.normal, piece.turn)) * piece.reach};
  });
}

}  // namespace avbd
