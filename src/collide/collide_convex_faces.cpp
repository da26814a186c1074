// Any two convex shapes: a resting contact found from the faces alone (collide_convex_parts.h).
//
// Shapes at rest mostly touch with a face, and the face that separates the cores most carries the contact. Finding it
// takes a few support points, since a bound from the other core's inner ball leaves out most faces. What has to be
// shown is that no other direction separates better.
//
// Apart, the face's separation is a lower bound of the distance and a point of the cut face at that height an upper
// one. Overlapping by a depth d, in the difference b - a with the face's normal upwards and the origin in it: the
// lowest point of the cut face is an apex straight below the origin at depth d. The middle of the cut face, at height m
// and inside the sides of the reference by r, is the middle of a level disk of radius r at height m straight above or
// below the origin. The inner balls are a ball of the sum of their radii R about c. The depth along any direction is no
// less than that of the hull of apex, disk and ball:
//  - downwards, the distance of the cone's mantle: d cos t with tan t = (m + d) / r;
//  - up to 60 degrees above the horizon: r / 2 - max(-m, 0);
//  - steeper: 0.866 c_up - |c_level| / 2 + R.
#include <avbd/hull.h>

#include "collide/collide_convex_parts.h"

namespace avbd {
namespace {

/// A face's plane in its shape's frame.
struct FacePlane {
  Vec3d normal;
  double offset;
};

int faceCount(const ShapeGeom& g) {
  switch (g.type) {
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      return 6;
    case ShapeType::Cylinder:
    case ShapeType::Triangle:
      return 2;
    case ShapeType::Cone:
      return 1;
    case ShapeType::Hull:
      return static_cast<int>(g.hull().faces().size());
    default:
      return 0;
  }
}

Vec3d triangleNormal(const Vec3* v) {
  const Vec3d n = cross3(toDouble(v[1]) - v[0], toDouble(v[2]) - v[0]);
  const double l = length(n);
  return l > 0 ? n * (1 / l) : Vec3d{};
}

FacePlane facePlane(const ShapeGeom& g, int i) {
  const double sign = i & 1 ? 1 : -1;
  switch (g.type) {
    case ShapeType::Cylinder:
      return {{0, sign, 0}, g.extent.y};
    case ShapeType::Cone:
      return {{0, -1, 0}, g.extent.y};
    case ShapeType::Triangle: {
      const Vec3d n = triangleNormal(g.triangle()) * sign;
      return {n, dot3(n, toDouble(g.triangle()[0]))};
    }
    case ShapeType::Hull: {
      const HullData::Face& face = g.hull().faces()[static_cast<size_t>(i)];
      return {toDouble(face.normal), face.offset};
    }
    default:
      break;
  }
  const int axis = i >> 1;
  const Vec3d n{axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
  return {n, axis == 0 ? g.extent.x : (axis == 1 ? g.extent.y : g.extent.z)};
}

/// One of the shapes and how the other one lies in its frame.
struct View {
  const ShapeGeom& shape;
  const ShapeGeom& other;
  const CorePair& pair;
  bool ofB;

  Vec3d toOther(Vec3d n) const { return ofB ? mul(pair.turn, n) : mulT(pair.turn, n); }
  Vec3d fromOther(Vec3d p) const { return ofB ? mulT(pair.turn, p - pair.offset) : mul(pair.turn, p) + pair.offset; }
  double separation(const FacePlane& face) const {
    const Vec3d p = supportPoint(other, toOther(face.normal) * -1.0);
    return dot3(face.normal, fromOther(p)) - face.offset;
  }
};

/// Index of the face that separates most, -1 if there is none. Ends once it separates by more than beyond.
int bestFace(const View& view, double beyond, double& separation) {
  const int count = faceCount(view.shape);
  if (count == 0) return -1;
  const Vec3d center = view.fromOther(innerPoint(view.other));
  const double ball = innerBall(view.other);
  const auto bound = [&](int i) {
    const FacePlane face = facePlane(view.shape, i);
    return dot3(face.normal, center) - ball - face.offset;
  };
  int best = 0;
  double top = bound(0);
  for (int i = 1; i < count; ++i) {
    const double x = bound(i);
    best = x > top ? i : best;
    top = x > top ? x : top;
  }
  const int first = best;
  separation = view.separation(facePlane(view.shape, best));
  for (int i = 0; i < count && !(separation > beyond); ++i) {
    if (i == first || !(bound(i) > separation)) continue;
    const double x = view.separation(facePlane(view.shape, i));
    best = x > separation ? i : best;
    separation = x > separation ? x : separation;
  }
  return best;
}

bool fill(const View& view, double beyond, CarrierFace& out) {
  const int best = bestFace(view, beyond, out.separation);
  out.isFace = best >= 0;
  if (!out.isFace) return true;
  if (out.separation > beyond) return false;
  const Vec3d n = facePlane(view.shape, best).normal, unit = n * (1 / length(n));
  out.normal = view.ofB ? view.toOther(unit) * -1.0 : unit;
  return true;
}

}  // namespace

bool bestFaces(const CoreContact& c, CarrierFace& a, CarrierFace& b) {
  return fill({c.pair.a, c.pair.b, c.pair, false}, c.beyond, a) &&
         fill({c.pair.b, c.pair.a, c.pair, true}, c.beyond, b);
}

bool isProven(const CoreContact& c, const CarrierFace& face, const ClipResult& found) {
  if (face.separation >= 0) return found.lowest <= face.separation + c.tolerance;
  const double slack = slackOf(c, face.separation);
  const double d = -face.separation, r = found.inside, m = found.middle;
  if (found.lowest > slack - d || !(r > 0)) return false;
  const double rise = m + d, cosine = r / std::sqrt(r * r + rise * rise);
  if (d * (1 - cosine) > slack || 0.5 * r - (m < 0 ? -m : 0) < d) return false;
  // The normal of either shape's face looks from a to b: up is the way that b - a grows.
  const Vec3d center = mul(c.pair.turn, innerPoint(c.pair.b)) + c.pair.offset - innerPoint(c.pair.a);
  const double up = dot3(face.normal, center), balls = innerBall(c.pair.a) + innerBall(c.pair.b);
  return 0.866 * up - 0.5 * length(center - face.normal * up) + balls >= d;
}

}  // namespace avbd
