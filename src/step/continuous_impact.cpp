// When two shapes meet in a way that counts (continuous.h).
//
// Contacts that the step has solved leave bodies a little too deep, slides over curved ground and turning bodies more
// so; the next step mends that. What must not happen is that a body comes so deep that the way out is another one. So
// an impact counts only if the shapes come deeper than a share of the smaller half thickness, more where they were in
// contact already, and never before they are deeper than they were. The body then stops where they touch first, if they
// did not at the start.
#include <algorithm>

#include "step/contacts.h"
#include "step/step_data.h"

namespace avbd {

namespace {

// Of the smaller half thickness.
constexpr float kDeep = 0.25f;         ///< who comes deeper than this passes through
constexpr float kDeepTied = 0.5f;      ///< the same of tied ones
constexpr float kDeepTouching = 0.5f;  ///< the same of what touched before
constexpr float kDeeper = 0.25f;       ///< what may be added to a depth in one step
constexpr float kLeastDeep = 3;        ///< of the slop, which resting contacts keep
constexpr float kTolerance = 0.1f;     ///< of the slop

/// What is asked of a pair, and what is known of it.
struct Question {
  float from, deep, deepTouching, deeper, margin, tolerance;
  bool hooked;
};

/// Shapes of which one is convex, and the other, which may be a triangle, convex or a half-space.
class Pair {
 public:
  Pair(const ShapeGeom& a, const ShapeMotion& motionA, const ShapeGeom& b, const ShapeMotion& motionB)
      : a_(a), b_(b), motionA_(motionA), motionB_(motionB) {}

  Impact at(float distance, const Question& q, float to) const {
    return timeOfImpact(a_, motionA_, b_, motionB_, {distance, q.tolerance, q.from, to});
  }

  /// `before`: gives the distance at `from` of the whole of which b is a part.
  template <class Before>
  Impact counts(const Question& q, float to, Before before) const {
    Impact deep = at(-q.deep, q, to);
    if (!deep.happens) return deep;
    const float start = before(deep.before);
    if (start <= q.margin) {
      if (q.hooked) return {};  // the hook has had its say
      if (q.from == 0) {
        deep = at(-std::max(q.deepTouching, q.deeper - start), q, to);
        if (!deep.happens) return deep;
      }
    }
    if (deep.before > 0) return at(0, q, deep.time);
    if (q.from > 0) deep.time = q.from;  // the other has stopped in its way
    return deep;
  }

 private:
  const ShapeGeom &a_, &b_;
  const ShapeMotion &motionA_, &motionB_;
};

Question questionOf(const WorldData& world, const StepData& step, const std::array<uint32_t, 2>& shapes, float size,
                    bool tied) {
  const bool hooked = world.contactHook && (world.shapes[shapes[0]].contactHook || world.shapes[shapes[1]].contactHook);
  Question q{};
  q.deep = std::max((tied ? kDeepTied : kDeep) * size, kLeastDeep * step.slop);
  q.deepTouching = std::max(kDeepTouching * size, q.deep);
  q.deeper = kDeeper * size;
  q.margin = kSpeculative * world.def.lengthUnit;
  q.tolerance = kTolerance * step.slop;
  q.hooked = hooked;
  return q;
}

Impact onSurface(const ShapeGeom& a, const ShapeMotion& motionA, const ShapeGeom& surface, const ShapeMotion& motionB,
                 const Question& q) {
  Impact first;
  float start = 0;
  bool known = false;
  const auto before = [&](float) {
    if (!known) start = distanceToSurface(a, at(motionA, q.from), surface, at(motionB, q.from), q.margin + q.tolerance);
    known = true;
    return start;
  };
  forEachTriangleMet(a, motionA, surface, motionB, {-q.deep, q.tolerance, q.from, 1},
                     [&](const MovingTriangle& triangle, float to) {
                       const ShapeGeom geom = triangle.geom();
                       const Impact impact = Pair(a, motionA, geom, triangle.motion).counts(q, to, before);
                       if (!impact.happens || (first.happens && impact.time >= first.time)) return to;
                       if (!isInFront(a, motionA, triangle, impact.time)) return to;
                       first = impact;
                       return impact.time;
                     });
  return first;
}

}  // namespace

Impact impactOf(const WorldData& world, const StepData& step, const std::array<uint32_t, 2>& shapes,
                const std::array<const BodyMotion*, 2>& motions, float from, bool tied) {
  const ShapeData &shapeA = world.shapes[shapes[0]], &shapeB = world.shapes[shapes[1]];
  const BodyData &bodyA = world.bodies[shapeA.body], &bodyB = world.bodies[shapeB.body];
  const BodyMotion &a = *motions[0], &b = *motions[1];
  const float size = smallerSize(bodyA, bodyB);
  if (relativeWay(a, bodyA.radius, b, bodyB.radius) <= kFastWay * size) return {};
  const Vec3d origin = at(a, from).position;
  const ShapeMotion motionA = motionOf(a, shapeA, origin), motionB = motionOf(b, shapeB, origin);
  Question q = questionOf(world, step, shapes, size, tied);
  q.from = from;
  if (isSurface(shapeB.geom.type)) return onSurface(shapeA.geom, motionA, shapeB.geom, motionB, q);
  if (shapeB.geom.type == ShapeType::HalfSpace && motionB.turn != Vec3{}) return {};
  return Pair(shapeA.geom, motionA, shapeB.geom, motionB).counts(q, 1, [](float own) { return own; });
}

Impact impactOf(const WorldData& world, const StepData& step, const ShapesMeet& meet, float from) {
  const std::vector<MovedBody>& bodies = step.continuous.bodies;
  return impactOf(world, step, {meet.shape[0], meet.shape[1]},
                  {&bodies[meet.body[0]].motion, &bodies[meet.body[1]].motion}, from, false);
}

}  // namespace avbd
