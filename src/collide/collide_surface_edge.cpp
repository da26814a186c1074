// Contact on a triangle's edges and corners: which directions the surface offers there, and the points.
#include <algorithm>

#include "collide/collide_surface_parts.h"

namespace avbd {
namespace {

/// Rise per length from which on a triangle is in the way of a direction.
constexpr float kRise = 0.5f * kSameDirection;
/// Difference of height per length up to which corners are equally far: what a direction's rounding comes to.
constexpr float kLevel = 2e-3f;

/// Where on the triangle's edge or corner a contact is.
Vec3 placeOn(const NearTriangle& t, int corners, Vec3 near) {
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    if (corners == 1 << i) return t.v[i];
    if (corners != (1 << i | 1 << next)) continue;
    const Vec3 along = t.v[next] - t.v[i];
    return t.v[i] + along * clampTo(dot(near - t.v[i], along) / dot(along, along), 0, 1);
  }
  return near;
}

/// The edge whose two ends are given, or -1.
int edgeOf(int corners) {
  if (corners == 3) return 0;
  if (corners == 6) return 1;
  return corners == 5 ? 2 : -1;
}

Offer offerAcross(const NearTriangle& t, int edge, Vec3 u) {
  if (!t.isSharp[edge]) return Offer::Refused;
  if (t.isRim[edge]) return Offer::Given;
  const Vec3 along = t.v[(edge + 1) % 3] - t.v[edge];
  const float rise = dot(u, cross(along, t.across[edge])), slack = kSameDirection * length(along);
  if (rise > slack) return Offer::Refused;
  return rise > -slack ? Offer::Covered : Offer::Given;
}

/// A corner between valleys alone is a pit.
Offer offerAtCorner(const NearTriangle& t, int corners) {
  for (int i = 0; i < 3; ++i) {
    if ((corners & 1 << i) && (t.isSharp[i] || t.isSharp[(i + 2) % 3])) return Offer::Given;
  }
  return Offer::Refused;
}

constexpr float kPi = 3.14159265f;

/// Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 4.4.45: error below 7e-5.
float angleOf(float cosine) {
  const float x = smaller(magnitude(cosine), 1);
  const float angle = std::sqrt(1 - x) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - x * 0.0187293f)));
  return cosine < 0 ? kPi - angle : angle;
}

/// How much of the surface's way round a point on it the triangle is.
float angleAt(const NearTriangle& t, Vec3 point, float touch) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = point - t.v[i];
    if (dot(d, d) > touch * touch) continue;
    const Vec3 a = t.v[(i + 1) % 3] - t.v[i], b = t.v[(i + 2) % 3] - t.v[i];
    return angleOf(dot(a, b) / (length(a) * length(b)));
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3 along = t.v[(i + 1) % 3] - t.v[i];
    if (dot(cross(t.normal, along), point - t.v[i]) <= touch * length(along)) return kPi;
  }
  return 2 * kPi;
}

/// What a triangle says if it holds the point. `front` gathers its normal by its angle there.
Offer offerBeside(const ConvexView& convex, const NearTriangle& t, Vec3 u, Vec3 point, Vec3& front) {
  if (magnitude(dot(t.normal, point - t.v[0])) > convex.touch) return Offer::Given;
  const Vec3 off = closestOnTriangle(point, t.v) - point;
  if (dot(off, off) > convex.touch * convex.touch) return Offer::Given;
  for (const Vec3 v : t.v) {
    const Vec3 d = v - point;
    if (dot(u, d) > kRise * length(d) + convex.touch) return Offer::Refused;
  }
  front = front + t.normal * angleAt(t, point, convex.touch);
  return !t.isBehind && dot(u, t.normal) > kSameCosine ? Offer::Covered : Offer::Given;
}

void addTouch(const ConvexView& convex, const Touch& touch, std::vector<Touch>& out) {
  if (touch.separation <= convex.margin) out.push_back(touch);
}

/// The part of the triangle's edge that lies under a face of the convex shape. False: nothing there.
bool touchEdgeOnFace(const ConvexView& convex, const Vec3* edge, const SupportFace& face, Touch& model,
                     std::vector<Touch>& out) {
  const Vec3 u = model.normal, normal = mul(convex.turn, face.normal);
  const float look = dot(normal, u);
  if (look > -0.9f) return false;
  const Vec3 along = edge[1] - edge[0];
  float low = 0, high = 1;
  for (int k = 0; k < face.count; ++k) {
    const Vec3 a = mul(convex.turn, face.point[k]), b = mul(convex.turn, face.point[k + 1 == face.count ? 0 : k + 1]);
    // Out of the face's side, level with u: so that looking along u decides.
    const Vec3 side = cross(u, b - a);
    const float slack = convex.touch * length(side), rate = dot(side, along), at = dot(side, edge[0] - a);
    if (magnitude(rate) <= 1e-6f * length(side) * length(along)) {
      if (at > slack) return false;
      continue;
    }
    const float t = -at / rate;
    if (rate > 0) {
      high = smaller(high, t + slack / rate);
    } else {
      low = larger(low, t + slack / rate);
    }
  }
  if (low > high) return false;
  const Vec3 origin = mul(convex.turn, face.point[0]);
  const uint32_t name = model.feature;
  for (int k = 0; k < 2; ++k) {
    const Vec3 y = edge[0] + along * clampTo(k == 0 ? low : high, 0, 1);
    const float height = dot(normal, origin - y) / look;
    model.separation = height - convex.geom.radius;
    model.onSurface = y;
    model.onConvex = y + u * model.separation;
    model.feature = mixed(name, static_cast<uint32_t>(k)) & ~kCorner;
    addTouch(convex, model, out);
  }
  return true;
}

/// An edge of the convex shape along one of the triangle's: both ends of what they share. False: not along.
bool touchEdgeOnEdge(const ConvexView& convex, const Vec3* edge, const SupportFace& face, Touch& model,
                     std::vector<Touch>& out) {
  const Vec3 a = mul(convex.turn, face.point[0]), b = mul(convex.turn, face.point[1]);
  const Vec3 own = b - a, along = edge[1] - edge[0], turn = cross(own, along);
  constexpr float kAlong = 0.05f;
  if (dot(turn, turn) > kAlong * kAlong * dot(own, own) * dot(along, along)) return false;
  const float square = dot(along, along), ta = dot(a - edge[0], along) / square, tb = dot(b - edge[0], along) / square;
  const float low = larger(0, smaller(ta, tb)), high = smaller(1, larger(ta, tb));
  if (low > high || tb == ta) return false;
  const uint32_t name = model.feature;
  for (int k = 0; k < 2; ++k) {
    const float t = k == 0 ? low : high;
    const Vec3 y = edge[0] + along * t, x = a + own * ((t - ta) / (tb - ta));
    model.separation = dot(model.normal, x - y) - convex.geom.radius;
    model.onConvex = x - model.normal * convex.geom.radius;
    model.onSurface = y;
    model.feature = mixed(name, static_cast<uint32_t>(k)) & ~kCorner;
    addTouch(convex, model, out);
  }
  return true;
}

}  // namespace

int farthestCorners(const NearTriangle& t, Vec3 u) {
  const float h[3] = {dot(u, t.v[0]), dot(u, t.v[1]), dot(u, t.v[2])};
  int top = h[1] > h[0] ? 1 : 0;
  if (h[2] > h[top]) top = 2;
  int corners = 0;
  for (int i = 0; i < 3; ++i) {
    if (h[top] - h[i] <= kLevel * length(t.v[top] - t.v[i])) corners |= 1 << i;
  }
  return corners;
}

const std::vector<uint32_t>& NearAlong::at(const std::vector<NearTriangle>& all, Vec3 point, float reach) {
  const auto lowest = [](const NearTriangle& t) { return smaller(t.v[0].x, smaller(t.v[1].x, t.v[2].x)); };
  const auto highest = [](const NearTriangle& t) { return larger(t.v[0].x, larger(t.v[1].x, t.v[2].x)); };
  if (starts_.size() != all.size()) {
    starts_.clear();
    widest_ = 0;
    for (uint32_t i = 0; i < all.size(); ++i) {
      starts_.push_back({lowest(all[i]), i});
      widest_ = larger(widest_, highest(all[i]) - lowest(all[i]));
    }
    std::sort(starts_.begin(), starts_.end(),
              [](Start a, Start b) { return a.x != b.x ? a.x < b.x : a.triangle < b.triangle; });
  }
  found_.clear();
  const auto begin = std::lower_bound(starts_.begin(), starts_.end(), point.x - reach - 1.001f * widest_,
                                      [](Start s, float x) { return s.x < x; });
  for (auto s = begin; s != starts_.end() && s->x <= point.x + reach; ++s) {
    const NearTriangle& t = all[s->triangle];
    const float low = smaller(t.v[0].z, smaller(t.v[1].z, t.v[2].z));
    const float high = larger(t.v[0].z, larger(t.v[1].z, t.v[2].z));
    if (highest(t) >= point.x - reach && low <= point.z + reach && high >= point.z - reach) {
      found_.push_back(s->triangle);
    }
  }
  // In the order of all of them: sums of normals depend on it.
  std::sort(found_.begin(), found_.end());
  return found_;
}

Offer offerAt(const ConvexView& convex, const std::vector<NearTriangle>& all, NearAlong& along, uint32_t index,
              const Nearest& nearest) {
  const NearTriangle& t = all[index];
  const Vec3 u = -nearest.normal;
  const int corners = farthestCorners(t, u), edge = edgeOf(corners);
  const Vec3 point = placeOn(t, corners, nearest.pointB);
  // Not so that the shape's middle would go through.
  if (dot(u, convex.center - point) < 0) return Offer::Refused;
  Offer offer = edge >= 0 ? offerAcross(t, edge, u) : offerAtCorner(t, corners);
  Vec3 front = t.normal * angleAt(t, point, convex.touch);
  if (offer == Offer::Refused) return offer;
  for (const uint32_t j : along.at(all, point, 2 * convex.touch)) {
    if (j == index) continue;
    const Offer beside = offerBeside(convex, all[j], u, point, front);
    if (beside != Offer::Given) offer = beside;
    if (offer == Offer::Refused) return offer;
  }
  // Not from behind: Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal (2005).
  return dot(u, front) > 0 ? offer : Offer::Refused;
}

void touchEdge(const ConvexView& convex, const NearTriangle& t, uint32_t index, const Nearest& nearest,
               std::vector<Touch>& out) {
  const Vec3 u = -nearest.normal;
  const int corners = farthestCorners(t, u), edge = edgeOf(corners);
  const uint32_t name = mixed(mixed(t.element, 0x5eedu), static_cast<uint32_t>(corners)) & ~kCorner;
  Touch touch{u, nearest.pointA, nearest.pointB, nearest.distance, name, index};
  if (edge >= 0) {
    SupportFace face;
    supportFace(convex.geom, mulT(convex.turn, -u), face);
    const Vec3 ends[2] = {t.v[edge], t.v[(edge + 1) % 3]};
    if (face.count > 2 && touchEdgeOnFace(convex, ends, face, touch, out)) return;
    if (face.count == 2 && touchEdgeOnEdge(convex, ends, face, touch, out)) return;
  }
  addTouch(convex, touch, out);
}

}  // namespace avbd
