// A convex shape against a surface: which triangles it touches, and how (collide_surface.h).
#include "collide/collide_surface.h"

#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <algorithm>

#include "collide/collide_surface_parts.h"
#include "geom/height_field_parts.h"

namespace avbd {
namespace {

/// Distances below this part of the convex shape's size do not part places.
constexpr float kTouch = 1e-4f;
/// A contact deeper than another by this part of the size may come from entering a triangle through another.
constexpr float kEntered = 1e-3f;

/// A direction in which shallower contacts move the convex shape, and the separation of the deepest of them.
struct Escape {
  Vec3 normal;
  float lowest;  ///< of the convex shape, along the normal
  float separation;
};

struct Scratch {
  std::vector<NearTriangle> triangles;
  NearAlong along;
  std::vector<Touch> touches;
  std::vector<uint32_t> order;
  std::vector<Escape> escapes;
  FaceRoom room;
};

/// How far below the surface of a height field a point is: <= 0 above, outside or over a hole.
float depthBelow(const ShapeGeom& surface, Vec3 p) {
  const HeightFieldData::Parts& field = surface.heights().parts();
  const float x = p.x / surface.scale.x, z = p.z / surface.scale.z;
  const float u = (x - field.x(0)) / field.spacingX, v = (z - field.z(0)) / field.spacingZ;
  if (!(u >= 0 && v >= 0 && u <= static_cast<float>(field.cellColumns()) &&
        v <= static_cast<float>(field.cellRows()))) {
    return 0;
  }
  const int c = std::min(static_cast<int>(u), field.cellColumns() - 1);
  const int r = std::min(static_cast<int>(v), field.cellRows() - 1);
  if (!field.isClosed(c, r)) return 0;
  const float s = u - static_cast<float>(c), t = v - static_cast<float>(r);
  const float first = field.height(c, r), last = field.height(c + 1, r + 1);
  // The half that holds the point, cut along the diagonal from first to last.
  const float beside = t > s ? field.height(c, r + 1) : field.height(c + 1, r);
  const float low = smaller(s, t), high = larger(s, t);
  return (first + (beside - first) * (high - low) + (last - first) * low) * surface.scale.y - p.y;
}

/// Borders of a height field, along which it does not end for those who walk from one tile to the next.
struct Border {
  bool any;
  Vec3 lower, upper;

  explicit Border(const ShapeGeom& surface) : any(surface.type == ShapeType::HeightField) {
    if (!any) return;
    const Vec3 s = surface.scale, a = surface.heights().lower(), b = surface.heights().upper();
    lower = {a.x * s.x, 0, a.z * s.z};
    upper = {b.x * s.x, 0, b.z * s.z};
  }
  bool holds(Vec3 a, Vec3 b) const {
    if (!any) return false;
    return (a.x == b.x && (a.x == lower.x || a.x == upper.x)) || (a.z == b.z && (a.z == lower.z || a.z == upper.z));
  }
};

/// Copies the triangle relative to `origin`, turned over if `back`.
void take(const SurfaceTriangle& t, Vec3 origin, bool back, NearTriangle& to) {
  // Turned over, the corners run the other way.
  for (int i = 0; i < 3; ++i) to.v[i] = t.v[back ? (3 - i) % 3 : i] - origin;
  to.normal = back ? -t.normal : t.normal;
  to.element = t.element;
  to.material = t.material;
}

void takeEdges(const SurfaceTriangle& t, const Border& border, bool back, NearTriangle& to) {
  for (int i = 0; i < 3; ++i) {
    const int edge = back ? 2 - i : i;
    to.across[i] = back ? -t.across[edge] : t.across[edge];
    to.isRim[i] = t.isRim[edge];
    bool ridge = t.isConvex[edge];
    if (back) {
      const Vec3 along = t.v[(edge + 1) % 3] - t.v[edge], out = cross(along, t.normal);
      ridge = !t.isRim[edge] && dot(t.across[edge], out) < -1e-4f * length(out);
    }
    to.isSharp[i] = ridge || (t.isRim[edge] && !border.holds(t.v[edge], t.v[(edge + 1) % 3]));
  }
}

void gather(const ConvexView& convex, const ShapeGeom& surface, Vec3 origin, std::vector<NearTriangle>& all) {
  all.clear();
  const Border border(surface);
  const Pose pose{toDouble(origin), convex.pose.q};
  Aabb box = bounds(convex.geom, pose, convex.margin);
  if (convex.sunk) box.upper.y += surface.heights().thickness() * surface.scale.y;
  forEachBareTriangle(surface, box, [&](const SurfaceTriangle& t) {
    if (t.normal == Vec3{}) return true;
    const bool back = dot(t.normal, convex.center - (t.v[0] - origin)) < 0;
    const bool turn = back && t.doubleSided;
    NearTriangle& to = all.emplace_back();
    take(t, origin, turn, to);
    to.isBehind = back && !t.doubleSided && !convex.sunk;
    to.isNear = !to.isBehind && convex.lowest(to.normal) - dot(to.normal, to.v[0]) <= convex.margin;
    if (to.isNear) {
      SurfaceTriangle whole = t;
      findNeighbours(surface, whole);
      takeEdges(whole, border, turn, to);
    }
    return true;
  });
}

/// Whether no direction over an edge is shorter than the face's own. Moving a point of the shape that lies d deep and
/// L inside an edge out along a direction at the angle x from the normal takes d cos x + L sin x, which is least at one
/// end of the angles that the edge offers.
bool isFaceNearest(const ConvexView& convex, const NearTriangle& t, const Touch* touches, uint32_t count) {
  if (count == 0) return false;
  float least = touches[0].separation;
  for (uint32_t k = 1; k < count; ++k) least = smaller(least, touches[k].separation);
  if (least > convex.lowest(t.normal) - dot(t.normal, t.v[0]) + convex.touch) return false;
  if (least >= 0) return true;
  Vec3 mean;
  float number = 0;
  for (uint32_t k = 0; k < count; ++k) {
    if (touches[k].separation > least + convex.touch) continue;
    mean = mean + touches[k].onSurface;
    number += 1;
  }
  mean = mean * (1 / number);
  for (int i = 0; i < 3; ++i) {
    if (!t.isSharp[i]) continue;
    const Vec3 along = t.v[(i + 1) % 3] - t.v[i];
    const float inside = dot(cross(t.normal, along), mean - t.v[i]) / length(along);
    const float cosine = t.isRim[i] ? 0 : clampTo(dot(t.normal, t.across[i]), -1, 1);
    if (-least * cosine + inside * std::sqrt(1 - cosine * cosine) < -least) return false;
  }
  return true;
}

/// Takes out the touches from `first` on that lie in the surface: not by the face's normal are they out of it.
void dropDeep(std::vector<Touch>& touches, uint32_t first) {
  touches.erase(std::remove_if(touches.begin() + first, touches.end(), [](const Touch& t) { return t.separation < 0; }),
                touches.end());
}

/// Whether the shape is farther than the margin outside one of the triangle's sides.
bool isBeside(const ConvexView& convex, const NearTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 along = t.v[(i + 1) % 3] - t.v[i], side = cross(along, t.normal) * (1 / length(along));
    if (convex.lowest(side) > dot(side, t.v[i]) + convex.margin) return true;
  }
  return false;
}

void touchTriangle(const ConvexView& convex, Scratch& scratch, uint32_t index) {
  NearTriangle& t = scratch.triangles[index];
  std::vector<Touch>& touches = scratch.touches;
  t.first = static_cast<uint32_t>(touches.size());
  t.isFace = true;
  if (!t.isNear) return;
  touchFace(convex, t, index, scratch.room, touches);
  if (convex.sunk || !(t.isSharp[0] || t.isSharp[1] || t.isSharp[2])) return;
  if (isFaceNearest(convex, t, touches.data() + t.first, static_cast<uint32_t>(touches.size()) - t.first)) return;
  if (isBeside(convex, t)) return;
  const Nearest nearest = nearestOnTriangle(convex, t);
  if (nearest.apart) return dropDeep(touches, t.first);
  const Vec3 u = -nearest.normal;
  if (dot(u, t.normal) > kSameCosine) {
    if (touches.size() > t.first) return;
    // At a slight ridge the support face may lie just beyond both sides: the nearest point stands for it.
    const Vec3 x = nearest.pointA;
    const float height = dot(t.normal, x - t.v[0]);
    if (height > convex.margin) return;
    touches.push_back({t.normal, x, x - t.normal * height, height, mixed(t.element, 7), index, true});
    return;
  }
  const Offer offer = offerAt(convex, scratch.triangles, scratch.along, index, nearest);
  if (offer == Offer::Refused) return;
  dropDeep(touches, t.first);
  if (offer == Offer::Covered) return;
  t.isFace = false;
  touchEdge(convex, t, index, nearest, touches);
}

/// Drops spare touches at places of other triangles that have touches by the same normal.
void dropSpare(const ConvexView& convex, Scratch& scratch) {
  // The points of nearest() on round shapes are less exact than their distances.
  const float reach = 50 * convex.touch;
  const auto isHad = [&](const Touch& touch) {
    if (!touch.spare) return false;
    for (uint32_t j = 0; j < scratch.triangles.size(); ++j) {
      const NearTriangle& t = scratch.triangles[j];
      if (j == touch.triangle || t.count == 0 || scratch.touches[t.first].spare) continue;
      if (dot(scratch.touches[t.first].normal, touch.normal) < kSameCosine) continue;
      const Vec3 off = closestOnTriangle(touch.onSurface, t.v) - touch.onSurface;
      if (dot(off, off) <= reach * reach) return true;
    }
    return false;
  };
  std::vector<uint32_t>& had = scratch.order;
  had.clear();
  for (uint32_t i = 0; i < scratch.touches.size(); ++i) {
    if (isHad(scratch.touches[i])) had.push_back(i);
  }
  // All are found before one goes: which is spare does not depend on the order.
  for (const uint32_t touch : had) scratch.triangles[scratch.touches[touch].triangle].count = 0;
}

/// Drops deep touches on triangles that the convex shape reaches only through others: those from which the move that
/// a shallower contact asks for frees it.
void dropEntered(const ConvexView& convex, Scratch& scratch) {
  std::vector<uint32_t>& order = scratch.order;
  std::vector<NearTriangle>& all = scratch.triangles;
  std::vector<Escape>& escapes = scratch.escapes;
  order.clear();
  escapes.clear();
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].count > 0) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return all[a].separation != all[b].separation ? all[a].separation > all[b].separation : a < b;
  });
  const float least = kEntered * convex.size;
  const auto addEscape = [&](const NearTriangle& t) {
    const Vec3 u = scratch.touches[t.first].normal;
    // One of an older direction's may be there twice, which takes time and no more.
    const size_t few = escapes.size() < 8 ? escapes.size() : 8;
    for (size_t i = escapes.size() - few; i < escapes.size(); ++i) {
      if (escapes[i].normal == u) return static_cast<void>(escapes[i].separation = t.separation);
    }
    escapes.push_back({u, convex.lowest(u), t.separation});
  };
  // The deeper, the more are shallower by enough: they are the first of the order, and are decided on before.
  size_t shallower = 0;
  for (size_t k = 1; k < order.size(); ++k) {
    NearTriangle& deep = all[order[k]];
    if (!deep.isFace || deep.separation > -least) continue;
    for (; shallower < k && deep.separation <= 2 * all[order[shallower]].separation - least; ++shallower) {
      if (all[order[shallower]].count > 0) addEscape(all[order[shallower]]);
    }
    for (const Escape& e : escapes) {
      const float top = larger(dot(e.normal, deep.v[0]), larger(dot(e.normal, deep.v[1]), dot(e.normal, deep.v[2])));
      if (e.lowest - top < e.separation - convex.touch) continue;
      deep.count = 0;
      break;
    }
  }
}

void removeDropped(Scratch& scratch) {
  const std::vector<NearTriangle>& all = scratch.triangles;
  std::vector<Touch>& touches = scratch.touches;
  touches.erase(
      std::remove_if(touches.begin(), touches.end(), [&](const Touch& t) { return all[t.triangle].count == 0; }),
      touches.end());
}

Vec3 innerPoint(const ShapeGeom& geom) { return geom.type == ShapeType::Hull ? geom.hull().center() : Vec3{}; }

}  // namespace

ConvexView::ConvexView(const ShapeGeom& g, Quat rotation, float contactMargin)
    : geom(g),
      pose{{}, rotation},
      turn(matrix(rotation)),
      center(mul(turn, innerPoint(g))),
      margin(contactMargin),
      sunk(false) {
  const Aabb box = bounds(g, {{}, rotation}, 0);
  const Vec3 extent = (box.upper - box.lower) * 0.5f;
  size = larger(extent.x, larger(extent.y, extent.z));
  touch = kTouch * size;
}

void collideSurface(const ShapeGeom& convex, const NearPose& poseConvex, const ShapeGeom& surface,
                    const NearPose& poseSurface, float margin, std::vector<SurfacePatch>& out) {
  out.clear();
  thread_local Scratch scratch;
  const Quat back = conjugate(poseSurface.q);
  const Vec3 origin = rotate(back, poseConvex.p - poseSurface.p);
  ConvexView view(convex, back * poseConvex.q, margin);
  if (surface.type == ShapeType::HeightField) {
    const float depth = depthBelow(surface, origin + view.center);
    const float thickness = surface.heights().thickness() * surface.scale.y;
    if (depth > thickness) return;
    view.sunk = depth > 0;
  }
  gather(view, surface, origin, scratch.triangles);
  scratch.along.clear();
  scratch.touches.clear();
  scratch.room.normal = {};
  for (uint32_t i = 0; i < scratch.triangles.size(); ++i) {
    touchTriangle(view, scratch, i);
    NearTriangle& t = scratch.triangles[i];
    t.count = static_cast<uint32_t>(scratch.touches.size()) - t.first;
    t.separation = 0;
    for (uint32_t k = t.first; k < t.first + t.count; ++k) {
      const float s = scratch.touches[k].separation;
      if (k == t.first || s < t.separation) t.separation = s;
    }
  }
  dropSpare(view, scratch);
  dropEntered(view, scratch);
  removeDropped(scratch);
  makePatches(view, scratch.triangles, scratch.touches, out);
  for (SurfacePatch& patch : out) {
    patch.manifold.normal = rotate(poseSurface.q, patch.manifold.normal);
    for (int k = 0; k < patch.manifold.count; ++k) {
      Vec3& p = patch.manifold.points[k].position;
      p = poseConvex.p + rotate(poseSurface.q, p);
    }
  }
}

}  // namespace avbd
