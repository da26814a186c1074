// The points, edges and faces of two near faces that may touch, each two once.
#pragma once

#include <algorithm>

#include "collide/face_features.h"
#include "geom/soft_mesh_parts.h"
#include "step/soft_surfaces.h"

namespace avbd {

/// A point before a face, or two edges.
struct NearFeatures : FeatureNames {
  FourPoints points;  ///< of its nodes in their order, from the first body's origin; ways beyond its drift
};

/// How many of four nodes are the first side's.
inline int firstNodes(TouchKind kind) { return kind == TouchKind::EdgeEdge ? 2 : 1; }

/// Where the features of four nodes are nearest.
struct NearestFeatures {
  Vec3 place;  ///< as SoftTouch::anchor
  Vec3 off;    ///< from the second's nearest point to the first's
};
NearestFeatures nearestFeatures(TouchKind kind, const Vec3 (&p)[4]);

/// The features of two bodies, or of one.
class FeaturePairs {
 public:
  FeaturePairs(const WorldData& world, const SoftSurfaces& surfaces, uint32_t a, uint32_t b)
      : softs_{&world.softs[a], &world.softs[b]},
        places_{&surfaces.places[a], &surfaces.places[b]},
        slots_{a, b},
        shift_(shiftOf(*places_[0], *places_[1])),
        around_(shift_.of({})) {}

  /// The features by their names, of which the first body is a, the second b.
  NearFeatures features(const FeatureNames& names) const {
    NearFeatures near{names, {}};
    if (near.kind == TouchKind::EdgeEdge)
      putEdges(near);
    else
      putFace(near, 0);
    return near;
  }

  template <class F>
  void forEach(uint32_t faceA, uint32_t faceB, F&& f) const {
    points(0, faceA, faceB, f);
    points(1, faceB, faceA, f);
    edges(faceA, faceB, f);
  }

 private:
  struct Moving {
    Vec3 at, way;
  };
  const SurfaceFeatures& features(int side) const { return softs_[side]->mesh->parts().features; }
  const std::array<uint32_t, 3>& corners(int side, uint32_t face) const { return softs_[side]->mesh->surface()[face]; }
  /// In the frame of the body of `base`.
  Moving moving(int side, uint32_t point, int base) const {
    const Moving own{places_[side]->points[point], places_[side]->ways[point]};
    if (side == base) return own;
    return side == 1 ? Moving{own.at + shift_.start, own.way + shift_.drift}
                     : Moving{own.at - shift_.start, own.way - shift_.drift};
  }
  void put(NearFeatures& near, int i, int side, uint32_t point, int base) const {
    const Moving moving = this->moving(side, point, base);
    near.points.at[i] = moving.at, near.points.way[i] = moving.way;
  }

  void putFace(NearFeatures& near, int side) const {
    const auto& of = corners(1 - side, near.secondPart);
    put(near, 0, side, near.firstPart, side);
    for (int i = 0; i < 3; ++i) put(near, i + 1, 1 - side, of[static_cast<size_t>(i)], side);
  }
  void putEdges(NearFeatures& near) const {
    const auto &a = features(0).edges[near.firstPart], &b = features(1).edges[near.secondPart];
    put(near, 0, 0, a[0], 0), put(near, 1, 0, a[1], 0), put(near, 2, 1, b[0], 0), put(near, 3, 1, b[1], 0);
  }
  /// Of a box of the first body and one of the second.
  bool pass(const Aabb& a, const Aabb& b) const {
    return overlaps(a, {b.lower + around_.lower, b.upper + around_.upper});
  }

  template <class F>
  void points(int side, uint32_t pointFace, uint32_t face, F&& f) const {
    const int other = 1 - side;
    const auto& of = corners(other, face);
    for (uint32_t k = 0; k < 3; ++k) {
      if (!features(side).ownsCorner(pointFace, k)) continue;
      const uint32_t point = corners(side, pointFace)[k];
      if (slots_[0] == slots_[1] && (point == of[0] || point == of[1] || point == of[2])) continue;
      const Aabb &ball = places_[side]->pointBoxes[point], &box = places_[other]->faces[face];
      if (side == 0 ? !pass(ball, box) : !pass(box, ball)) continue;
      NearFeatures near{{TouchKind::PointFace, slots_[side], point, slots_[other], face}, {}};
      putFace(near, side);
      f(near);
    }
  }

  template <class F>
  void edges(uint32_t faceA, uint32_t faceB, F&& f) const {
    const SurfaceFeatures &a = features(0), &b = features(1);
    for (uint32_t i = 0; i < 3; ++i) {
      if (!a.ownsEdge(faceA, i)) continue;
      for (uint32_t k = 0; k < 3; ++k)
        if (b.ownsEdge(faceB, k)) edge(a.faceEdges[faceA][i], b.faceEdges[faceB][k], f);
    }
  }

  template <class F>
  void edge(uint32_t edgeA, uint32_t edgeB, F&& f) const {
    const auto &a = features(0).edges[edgeA], &b = features(1).edges[edgeB];
    // Within one body the lower edge is the first, whatever face found them.
    const bool within = slots_[0] == slots_[1];
    if (within && (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1])) return;
    if (within && edgeB < edgeA) return edge(edgeB, edgeA, f);
    if (!pass(places_[0]->edgeBoxes[edgeA], places_[1]->edgeBoxes[edgeB])) return;
    NearFeatures near{{TouchKind::EdgeEdge, slots_[0], edgeA, slots_[1], edgeB}, {}};
    putEdges(near);
    f(near);
  }

  const SoftData* softs_[2];
  const SoftPlace* places_[2];
  uint32_t slots_[2];
  PlaceShift shift_;
  Aabb around_;  ///< what to add to b's boxes in a's frame
};

/// Calls f(features) for all of the near faces.
template <class F>
void forEachNear(const WorldData& world, const SoftSurfaces& surfaces, F&& f) {
  for (size_t i = 0; i < surfaces.near.size();) {
    const uint32_t a = surfaces.near[i].softA, b = surfaces.near[i].softB;
    const FeaturePairs pairs(world, surfaces, a, b);
    for (; i < surfaces.near.size() && surfaces.near[i].softA == a && surfaces.near[i].softB == b; ++i)
      pairs.forEach(surfaces.near[i].faceA, surfaces.near[i].faceB, f);
  }
}

}  // namespace avbd
