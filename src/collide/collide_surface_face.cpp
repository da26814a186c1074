// The convex shape's support face cut by a triangle's sides: contact by the triangle's own normal.
#include "collide/collide_surface_parts.h"

namespace avbd {
namespace {

constexpr int kMaxCorners = SupportFace::kMax + 3;
constexpr uint32_t kSide = 0x80000000u;  // lines named so are the triangle's

/// How far a point lies outside a side of the triangle, less what is still taken as inside. Points high above the
/// plane get more: between two faces of a slight ridge no face would see them otherwise.
struct Side {
  Vec3 out, start, normal;
  float slack;
  float beyond(Vec3 x) const { return dot(out, x - start); }
  float allowed(Vec3 x) const {
    const float height = dot(normal, x - start);
    return slack + (height > 0 ? kSameDirection * height : 0);
  }
};

bool isInside(const CutPolygon& polygon, const Side& side) {
  for (int k = 0; k < polygon.count; ++k) {
    if (side.beyond(polygon.corner[k].x) > 0) return false;
  }
  return true;
}

void cut(const CutPolygon& from, const Side& side, uint32_t name, CutPolygon& to) {
  to.count = 0;
  to.closed = from.closed;
  const int edges = from.count == 1 ? 0 : (from.closed ? from.count : from.count - 1);
  for (int a = 0; a < from.count; ++a) {
    const CutPolygon::Corner& ca = from.corner[a];
    const float da = side.beyond(ca.x);
    const bool keepA = da <= side.allowed(ca.x);
    if (keepA && to.count < kMaxCorners) to.corner[to.count++] = ca;
    if (a >= edges) break;
    const CutPolygon::Corner& cb = from.corner[a + 1 == from.count ? 0 : a + 1];
    const float db = side.beyond(cb.x);
    const bool keepB = db <= side.allowed(cb.x);
    if (keepA == keepB || to.count >= kMaxCorners) continue;
    // From the corner inside, so that the point does not depend on which way round the edge is seen.
    const Vec3 inside = keepA ? ca.x : cb.x, outside = keepA ? cb.x : ca.x;
    const float di = keepA ? da : db, d = keepA ? db : da;
    const float t = d != di ? clampTo(di / (di - d), 0, 1) : 0;
    CutPolygon::Corner& c = to.corner[to.count++];
    c.x = inside + (outside - inside) * t;
    c.in = keepA ? ca.out : name;
    c.out = keepA ? name : ca.out;
    c.name = 0;
  }
}

void findFace(const ConvexView& convex, Vec3 normal, FaceRoom& room) {
  if (room.normal == normal) return;
  room.normal = normal;
  SupportFace& face = room.face;
  supportFace(convex.geom, mulT(convex.turn, -normal), face);
  room.whole.count = face.count;
  room.whole.closed = face.count > 2;
  for (int k = 0; k < face.count; ++k) {
    const uint32_t before = face.feature[k == 0 ? face.count - 1 : k - 1];
    room.whole.corner[k] = {mul(convex.turn, face.point[k]), before & ~kSide, face.feature[k] & ~kSide,
                            mixed(face.feature[k], 1) | kCorner};
  }
}

}  // namespace

void touchFace(const ConvexView& convex, const NearTriangle& t, uint32_t index, FaceRoom& room,
               std::vector<Touch>& out) {
  findFace(convex, t.normal, room);
  const CutPolygon* polygon = &room.whole;
  int next = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const Vec3 along = t.v[(i + 1) % 3] - t.v[i];
    const Side side{cross(along, t.normal) * (1 / length(along)), t.v[i], t.normal, convex.touch};
    if (isInside(*polygon, side)) continue;
    CutPolygon& to = room.part[next];
    cut(*polygon, side, kSide | i, to);
    if (to.count == 0) return;
    polygon = &to;
    next = 1 - next;
  }
  for (int k = 0; k < polygon->count; ++k) {
    const CutPolygon::Corner& c = polygon->corner[k];
    const float height = dot(t.normal, c.x - t.v[0]), separation = height - convex.geom.radius;
    if (separation > convex.margin) continue;
    const uint32_t feature = c.name != 0 ? c.name : mixed(mixed(c.in, c.out), t.element) & ~kCorner;
    out.push_back({t.normal, c.x - t.normal * convex.geom.radius, c.x - t.normal * height, separation, feature, index});
  }
}

}  // namespace avbd
