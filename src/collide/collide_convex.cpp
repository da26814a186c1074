// Any two convex shapes -> manifold (convex.h).
//
// The direction of least depth, or of the distance, says which features touch. Where a face of one of them shows as
// much, up to a tolerance, its normal is taken: exact, without the noise of an iteration, and the same as long as the
// shapes rest on it. Then the other core's face is cut by it. Two nearly parallel edges share a stretch. Everything
// else touches in one point.
#include "collide/collide_convex_parts.h"

namespace avbd {
namespace {

constexpr double kTolerance = 1e-3;    // of the thinnest half extent: what a face may show less
constexpr double kRelative = 0.02;     // of the separation: the same
constexpr float kParallel = 0.03f;     // sine between edges that touch along a stretch
constexpr uint32_t kPoint = 1u << 31;  // in names: a single point

Vec3d unit(Vec3d v) { return v * (1 / length(v)); }

void turnInto(const CorePair& pair, bool ofB, Vec3d normal, SupportFace& out) {
  // Directions in the other shape's own frame.
  if (ofB) {
    supportFace(pair.b, toFloat(mulT(pair.turn, normal) * -1.0), out);
  } else {
    supportFace(pair.a, toFloat(normal), out);
  }
}

void candidate(const CoreContact& c, bool ofB, Vec3d normal, CarrierFace& out) {
  turnInto(c.pair, ofB, normal, out.face);
  out.isFace = out.face.count > 2;
  if (!out.isFace) return;
  const Vec3d n = unit(toDouble(out.face.normal));
  out.normal = ofB ? mul(c.pair.turn, n) * -1.0 : n;
  out.separation = dot3(out.normal, lowest(c.pair, out.normal).w);
}

/// Moves a face from b's frame to a's, or back.
void change(const CorePair& pair, bool toB, SupportFace& face) {
  for (int i = 0; i < face.count; ++i) {
    const Vec3d p = toDouble(face.point[i]);
    face.point[i] = toFloat(toB ? mulT(pair.turn, p - pair.offset) : mul(pair.turn, p) + pair.offset);
  }
  const Vec3d n = toDouble(face.normal);
  face.normal = toFloat(toB ? mulT(pair.turn, n) : mul(pair.turn, n));
}

/// Points found in the reference's frame, as the manifold wants them.
void place(const CoreContact& c, bool referenceIsB, Vec3 normal, const ClipResult& found, Manifold& out) {
  const ShapeGeom& reference = referenceIsB ? c.shapes.b : c.shapes.a;
  const Mat3d frame = exactMatrix(referenceIsB ? c.shapes.poseB.q : c.shapes.poseA.q);
  const Vec3 center = referenceIsB ? c.shapes.poseB.p : c.shapes.poseA.p;
  const float radii = c.shapes.a.radius + c.shapes.b.radius;
  const Vec3 n = toFloat(mul(frame, toDouble(normal)));
  out.normal = referenceIsB ? -n : n;
  out.count = 0;
  for (int i = 0; i < found.count; ++i) {
    const float separation = found.point[i].height - radii;
    const Vec3 p = found.point[i].onReference + normal * (reference.radius + 0.5f * separation);
    addPoint(out, center + toFloat(mul(frame, toDouble(p))), separation, found.point[i].feature);
  }
}

/// The other core's face cut by a reference face.
void cutBy(const CoreContact& c, bool ofB, const CarrierFace& reference, ClipResult& found) {
  SupportFace incident;
  turnInto(c.pair, !ofB, reference.normal, incident);
  change(c.pair, ofB, incident);
  clipFaces({reference.face, incident, reference.face.normal, static_cast<float>(c.tolerance),
             static_cast<float>(c.beyond), ofB != c.shapes.swapped},
            found);
}

/// Points on a reference face; false if they do not show the separation.
bool touchFace(const CoreContact& c, bool ofB, const CarrierFace& reference, Manifold& out) {
  ClipResult found;
  cutBy(c, ofB, reference, found);
  if (found.count == 0 || found.lowest > reference.separation + slackOf(c, reference.separation)) return false;
  place(c, ofB, reference.face.normal, found, out);
  out.carrier = ofB ? Carrier::B : Carrier::A;
  return true;
}

/// The cores are apart: a lower bound of their distance.
void setClear(const CoreContact& c, double distance, Manifold& out) {
  out.clear = static_cast<float>(distance) - (c.shapes.a.radius + c.shapes.b.radius);
}

/// The manifold from the faces that separate most, if that is shown to be right; also if there is none.
bool touchBestFaces(const CoreContact& c, Manifold& out) {
  CarrierFace a, b;
  if (!bestFaces(c, a, b)) {
    setClear(c, a.separation > b.separation ? a.separation : b.separation, out);
    return true;
  }
  if (!a.isFace && !b.isFace) return false;
  const bool ofB = b.separation > a.separation + c.tolerance;
  CarrierFace& best = ofB ? b : a;
  turnInto(c.pair, ofB, best.normal, best.face);
  ClipResult found;
  cutBy(c, ofB, best, found);
  if (found.count == 0 || !isProven(c, best, found)) return false;
  place(c, ofB, best.face.normal, found, out);
  out.carrier = ofB ? Carrier::B : Carrier::A;
  return true;
}

/// The manifold from the face of either shape that looks along the normal, if it shows as much.
bool touchFaces(const CoreContact& c, const CoreNearest& near, Manifold& out) {
  CarrierFace a, b;
  candidate(c, false, near.normal, a);
  candidate(c, true, near.normal, b);
  const double enough = near.distance - slackOf(c, near.distance);
  const bool first = a.isFace && a.separation >= enough, second = b.isFace && b.separation >= enough;
  const bool bBetter = second && (!first || b.separation > a.separation + c.tolerance);
  if (first && !bBetter && touchFace(c, false, a, out)) return true;
  if (second && touchFace(c, true, b, out)) return true;
  return first && bBetter && touchFace(c, false, a, out);
}

/// Keeps the points of a face that lie farthest along n, up to a length.
void trim(SupportFace& face, Vec3 n, float length) {
  float top = dot(n, face.point[0]);
  for (int i = 1; i < face.count; ++i) top = larger(top, dot(n, face.point[i]));
  int kept = 0;
  for (int i = 0; i < face.count; ++i) {
    if (dot(n, face.point[i]) < top - length) continue;
    face.point[kept] = face.point[i];
    face.feature[kept++] = face.feature[i];
  }
  face.count = kept;
}

/// Two nearly parallel edges.
bool touchEdges(const CoreContact& c, const CoreNearest& near, SupportFace& a, SupportFace& b, Manifold& out) {
  const Vec3 n = toFloat(near.normal), ea = a.point[1] - a.point[0], eb = b.point[1] - b.point[0];
  const Vec3 across = cross(ea, eb);
  if (dot(across, across) > kParallel * kParallel * dot(ea, ea) * dot(eb, eb)) return false;
  ClipResult found;
  clipFaces({a, b, n, static_cast<float>(c.tolerance), static_cast<float>(c.beyond), c.shapes.swapped}, found);
  if (found.count == 0 || found.lowest > near.distance + slackOf(c, near.distance)) return false;
  place(c, false, n, found, out);
  return true;
}

void touchPoint(const CoreContact& c, const CoreNearest& near, const SupportFace& a, const SupportFace& b,
                Manifold& out) {
  const ShapePair& s = c.shapes;
  const double separation = near.distance - s.a.radius - s.b.radius;
  if (!(separation <= s.margin)) return;
  const Vec3d middle = near.onA + near.normal * (s.a.radius + 0.5 * separation);
  out.normal = toFloat(mul(c.pair.frameA, near.normal));
  const uint32_t na = a.feature[0], nb = b.feature[0];
  const uint32_t name = s.swapped ? (nb & 255u) << 8 | (na & 255u) : (na & 255u) << 8 | (nb & 255u);
  addPoint(out, toFloat(mul(c.pair.frameA, middle)) + s.poseA.p, static_cast<float>(separation), kPoint | name);
}

/// Half of the thinnest part of the two shapes.
double thinnest(const ShapeGeom& a, const ShapeGeom& b) {
  const double ta = innerBall(a) + a.radius, tb = innerBall(b) + b.radius;
  if (!(ta > 0) || !(tb > 0)) return ta > tb ? ta : tb;
  return ta < tb ? ta : tb;
}

}  // namespace

void collideConvex(const ShapePair& s, Manifold& out) {
  const CorePair pair = corePair(s.a, s.poseA, s.b, s.poseB);
  const double beyond = double{s.a.radius} + s.b.radius + s.margin;
  const CoreContact c{s, pair, kTolerance * thinnest(s.a, s.b), beyond};
  if (touchBestFaces(c, out)) return;
  CoreNearest near = coreNearest(pair, beyond);
  if (near.apart || near.distance > beyond) return setClear(c, near.distance, out);
  if (touchFaces(c, near, out)) return;
  if (!near.sharp) {
    // Without its noise a normal may be a face's after all.
    sharpen(pair, near);
    if (touchFaces(c, near, out)) return;
  }
  SupportFace faceA, faceB;
  turnInto(pair, false, near.normal, faceA);
  turnInto(pair, true, near.normal, faceB);
  const Vec3 n = toFloat(near.normal);
  change(pair, false, faceB);
  trim(faceA, n, static_cast<float>(c.tolerance));
  trim(faceB, -n, static_cast<float>(c.tolerance));
  if (faceA.count == 2 && faceB.count == 2 && touchEdges(c, near, faceA, faceB, out)) return;
  touchPoint(c, near, faceA, faceB, out);
}

void collideConvexHalfSpace(const ShapePair& s, Manifold& out) {
  const Mat3d frame = exactMatrix(s.poseA.q);
  const Vec3d up = mulT(frame, toDouble(rotate(s.poseB.q, Vec3{0, 1, 0})));
  SupportFace ground, face;
  ground.normal = toFloat(up);
  ground.point[0] = toFloat(mulT(frame, toDouble(s.poseB.p) - s.poseA.p));
  supportFace(s.a, -ground.normal, face);
  ClipResult found;
  clipFaces({ground, face, ground.normal, 0, s.margin + s.a.radius, s.swapped}, found);
  out.normal = toFloat(mul(frame, up) * -1.0);
  out.carrier = Carrier::B;
  for (int i = 0; i < found.count; ++i) {
    const float separation = found.point[i].height - s.a.radius;
    const Vec3 p = found.point[i].onReference + ground.normal * (0.5f * separation);
    addPoint(out, s.poseA.p + toFloat(mul(frame, toDouble(p))), separation, found.point[i].feature);
  }
}

}  // namespace avbd
