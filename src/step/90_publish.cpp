// Publication: poses, velocities, multipliers and reactions go back to the world.
#include <algorithm>
#include <array>

#include "solve/body_rows.h"
#include "step/begin_rows.h"
#include "step/check_forces.h"
#include "step/contacts.h"
#include "step/coordinate_rows.h"
#include "step/free_motion.h"
#include "step/publish_events.h"
#include "step/soft_events.h"
#include "step/soft_touches.h"

namespace avbd {

namespace {

void publishBodies(WorldData& world, const StepData& step) {
  world.lastSubstep = step.h;
  step.jobs->forRange(static_cast<uint32_t>(step.order.size()), 256, [&](uint32_t begin, uint32_t end, int) {
    for (size_t i = begin; i < end; ++i) {
      BodyData& body = world.bodies[step.order[i]];
      body.last = {body.position, body.rotation};
      body.position = step.end[i].position;
      body.rotation = step.end[i].rotation;
      body.acceleration = (step.end[i].linearVelocity - body.linearVelocity) * (1 / step.h);
      body.linearVelocity = step.end[i].linearVelocity;
      body.angularVelocity = step.end[i].angularVelocity;
    }
  });
  for (const uint32_t slot : step.kinematic) {
    BodyData& body = world.bodies[slot];
    body.last = {body.position, body.rotation};
    body.position = body.position + body.linearVelocity * step.h;
    body.rotation = unit(quatFromVector(body.angularVelocity * step.h) * body.rotation);
  }
}

/// What is published of a contact's rows.
struct Forces {
  PointForces normal;
  float t1[kMaxManifoldPoints], t2[kMaxManifoldPoints], mu[kMaxManifoldPoints];
};

AVBD_INLINE Forces forcesOf(const rows::Contact<float>& c) {
  Forces forces;
  for (int i = 0; i < kMaxManifoldPoints; ++i) {
    forces.normal[static_cast<size_t>(i)] = c.point[i].lambdaN;
    forces.t1[i] = c.point[i].lambda1, forces.t2[i] = c.point[i].lambda2, forces.mu[i] = c.point[i].mu;
  }
  return forces;
}

/// The velocity pass pushes too. `next`: in step.bounces, which has the contacts in the order in which they come here.
void addBounces(const StepData& step, uint32_t pair, size_t& next, PointForces& normal) {
  for (; next < step.bounces.size() && step.bounces[next].pair == pair; ++next) {
    const Bounce& bounce = step.bounces[next];
    float& whole = normal[static_cast<size_t>(bounce.point)];
    // Nothing but rounding would be left of what was taken back.
    whole = bounce.impulse > bounce.least ? whole + bounce.impulse / step.h : 0;
  }
}

void publishPoints(PairData& pair, const Forces& forces) {
  bool slides = true;
  for (int i = 0; i < pair.pointCount; ++i) {
    PointMemory& point = pair.points[i];
    point.lambda = {forces.normal[static_cast<size_t>(i)], forces.t1[i], forces.t2[i]};
    point.sticks = insideCone(point.lambda, forces.mu[i]) ? 1 : 0;
    if (point.sticks) slides = false;
  }
  pair.slides = slides ? static_cast<uint8_t>(std::min(pair.slides + 1, 255)) : uint8_t{0};
  pair.landedSliding = pair.landedSliding && slides;
}

/// `turned`: of A against B in this step. What slips forgets how far it has turned.
void publishTurning(PairData& pair, const rows::FullContact<float>& full, Vec3 turned) {
  float load = 0;
  for (int i = 0; i < pair.pointCount; ++i) load += full.contact.point[i].lambdaN;
  const Vec3 torque{full.lambdaTorsion, full.lambda1, full.lambda2};
  const float torsion = kSlipping * full.torsional * load, rolling = kSlipping * full.rolling * load;
  const bool torsionSticks = torque.x * torque.x < torsion * torsion;
  const bool rollingSticks = torque.y * torque.y + torque.z * torque.z < rolling * rolling;
  pair.torque = torque;
  pair.turn.x = torsionSticks ? pair.turn.x + dot(turned, pair.normal) : 0;
  pair.turn.y = rollingSticks ? pair.turn.y + dot(turned, pair.t1) : 0;
  pair.turn.z = rollingSticks ? pair.turn.z + dot(turned, pair.t2) : 0;
}

/// Of a body row over all batches, in this step.
Vec3 turnOf(const StepData& step, uint32_t row) {
  const float* d = step.d.data() + size_t(8) * row;
  return {d[4], d[5], d[6]};
}

void publishMeans(WorldData& world, PairData& pair, const PointForces& whole) {
  const float share = 1 / static_cast<float>(world.def.substeps);
  PointMeans& means = meansOf(world, pair);
  for (size_t i = 0; i < static_cast<size_t>(pair.pointCount); ++i)
    means[i] = means[i] + Vec3{whole[i], pair.points[i].lambda.y, pair.points[i].lambda.z} * share;
}

void publishContact(WorldData& world, StepData& step, uint32_t pair, const Forces& forces, size_t& bounce) {
  const bool bounces = bounce < step.bounces.size() && step.bounces[bounce].pair == pair;
  if (!bounces && world.def.substeps == 1) {
    noteContact(world, step, pair, forces.normal);
    publishPoints(world.pairs[pair], forces);
    return;
  }
  PointForces whole = forces.normal;
  addBounces(step, pair, bounce, whole);
  noteContact(world, step, pair, whole);
  publishPoints(world.pairs[pair], forces);
  publishMeans(world, world.pairs[pair], whole);
}

/// What is left to tell of a contact.
enum Told : uint8_t { kAll = 0, kToWhole = 1, kNothing = 2 };

/// A contact that begins and ends nothing, and whose forces are all that there is to tell, is published at once; what a
/// particle touches is still to be told to its soft body.
Told publishQuietly(WorldData& world, const StepData& step, uint32_t index, const Forces& forces) {
  PairData& pair = world.pairs[index];
  const bool quiet = world.def.substeps == 1 && pair.restitution == 0 && !pair.hasSurface && !pair.wantsHits;
  bool touches = false;
  for (int i = 0; i < pair.pointCount; ++i) touches = touches || forces.normal[static_cast<size_t>(i)] > 0;
  if (!quiet || touches != pair.wasTouching) return kAll;
  pair.touching = touches;
  publishPoints(pair, forces);
  return touches && step.found[index].isSoft ? kToWhole : kNothing;
}

Forces forcesOfLane(const StepData& step, size_t lane) {
  return forcesOf(step.contacts[lane / kTile].get(lane % kTile));
}

void publishContacts(WorldData& world, StepData& step) {
  step.told.resize(step.contactPair.size());
  step.jobs->forRange(static_cast<uint32_t>(step.told.size()), 1024, [&](uint32_t begin, uint32_t end, int) {
    for (size_t lane = begin; lane < end; ++lane) {
      prefetchAhead(world, step.contactPair, lane);
      const uint32_t pair = step.contactPair[lane];
      step.told[lane] = pair != kNone ? publishQuietly(world, step, pair, forcesOfLane(step, lane)) : kNothing;
    }
  });
  size_t bounce = 0;
  for (size_t lane = 0; lane < step.told.size(); ++lane) {
    const uint32_t pair = step.contactPair[lane];
    if (step.told[lane] == kAll) publishContact(world, step, pair, forcesOfLane(step, lane), bounce);
    if (step.told[lane] == kToWhole) noteSoftContact(world, step, world.pairs[pair], forcesOfLane(step, lane).normal);
  }
  for (const BatchRange& batch : step.batches)
    for (size_t lane = size_t(batch.fullTile) * kTile; lane < size_t(batch.fullTile + batch.fullTiles) * kTile;
         ++lane) {
      if (step.fullPair[lane] == kNone) continue;
      const rows::FullContact<float> full = step.full[lane / kTile].get(lane % kTile);
      publishContact(world, step, step.fullPair[lane], forcesOf(full.contact), bounce);
      publishTurning(
          world.pairs[step.fullPair[lane]], full,
          turnOf(step, batch.rowBegin + step.fullRow[0][lane]) - turnOf(step, batch.rowBegin + step.fullRow[1][lane]));
    }
  AVBD_ASSERT(bounce == step.bounces.size());
}

void publishJoint(JointData& joint, const rows::BallJoint<float>& ball, rows::V3<float> torque) {
  const float lambda[6] = {ball.lambda.x, ball.lambda.y, ball.lambda.z, torque.x, torque.y, torque.z};
  for (int i = 0; i < 6; ++i) joint.lambda[i] = lambda[i];
  joint.reaction = {fromRow(-ball.lambda), fromRow(-torque)};
}

void publishCoordinates(D6Data& d6, const BatchView& view, const ScalarJoint& scalar) {
  float q[6];
  scalar.rows.coordinates(readTwist(view.d, scalar.rowA), readTwist(view.d, scalar.rowB), q);
  d6.twist = q[3], d6.twistKnown = true;
  for (int i = 0; i < 6; ++i) d6.lambda[i] = multipliersOf(scalar.rows.axis[i]);
  d6.coneLambda = scalar.rows.cone.lambda;
  d6.slerpLambda = fromRow(scalar.rows.slerp.lambda);
}

/// The whole force at frame A's origin, and multipliers; of a D6 joint those of each coordinate and the twist with its
/// full turns.
void publishScalarJoint(WorldData& world, const BatchView& view, ScalarJoint& scalar) {
  JointData& joint = world.joints[scalar.slot];
  const rows::V3<float> force = scalar.reaction.lin, torque = scalar.reaction.ang;
  const float lambda[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  for (int i = 0; i < 6; ++i) joint.lambda[i] = lambda[i];
  joint.reaction = {fromRow(-force), fromRow(-torque)};
  if (scalar.kind == ScalarJoint::Kind::Distance) {
    world.links[scalar.slot].lambda.lower = scalar.distance.lambdaLower;
    world.links[scalar.slot].lambda.upper = scalar.distance.lambdaUpper;
    world.links[scalar.slot].lambda.lock = 0;
    return;
  }
  publishCoordinates(world.d6[scalar.slot], view, scalar);
}

void publishScalarJoints(WorldData& world, StepData& step, uint32_t batch) {
  const BatchView view = step.view(batch);
  for (uint32_t i = 0; i < view.scalar.count; ++i) publishScalarJoint(world, view, view.scalar.joint[i]);
}

void publishLinked(WorldData& world, const BatchView& view, LinkedJoint& linked) {
  JointData& joint = world.joints[linked.slot];
  LinkData& link = world.links[linked.slot];
  if (linked.kind == LinkedJoint::Kind::Coupling) {
    float force = 0;
    for (int i = 0; i < linked.stamped.count; ++i) {
      const LinkedRow& row = linked.stamped.row[i];
      force += row.k > 0 ? *row.lambda : row.lower;  // a given force is its own bound
    }
    link.lambda = multipliersOf(linked.coupling.axis);
    joint.reaction = {{}, {-force, 0, 0}};
    return;
  }
  const rows::Twist<float> on = reactionOf(linked);
  joint.reaction = {fromRow(-on.lin), fromRow(-on.ang)};
  if (linked.kind == LinkedJoint::Kind::Pulley) {
    joint.reaction.torque = {};  // about its point
    joint.lambda[0] = linked.pulley.lambda;
    return;
  }
  CustomRows& custom = linked.custom;
  for (int i = 0; i < custom.rows; ++i) joint.lambda[i] = custom.lambda[i];
  std::array<CustomBody, 4> now;
  for (int i = 0; i < custom.bodies; ++i)
    now[static_cast<size_t>(i)] = customBody(custom, i, readTwist(view.d, linked.row[i]));
  custom.family->remember({now.data(), static_cast<size_t>(custom.bodies)}, link.constants, link.memory);
}

void publishLinkedJoints(WorldData& world, StepData& step, uint32_t batch) {
  const BatchView view = step.view(batch);
  for (uint32_t i = 0; i < view.linked.count; ++i) publishLinked(world, view, view.linked.joint[i]);
}

void publishJoints(WorldData& world, StepData& step) {
  const rows::V3<float> none{0, 0, 0};
  for (size_t lane = 0; lane < step.ballJoint.size(); ++lane)
    if (step.ballJoint[lane] != kNone)
      publishJoint(world.joints[step.ballJoint[lane]], step.balls[lane / kTile].get(lane % kTile), none);
  for (size_t lane = 0; lane < step.fixedJoint.size(); ++lane) {
    if (step.fixedJoint[lane] == kNone) continue;
    const rows::FixedJoint<float> rows = step.fixed[lane / kTile].get(lane % kTile);
    publishJoint(world.joints[step.fixedJoint[lane]], rows.ball, rows.lambda);
  }
  for (uint32_t i = 0; i < step.forestCount; ++i)
    for (const TreeJoint& joint : step.forests[i].joints)
      if (joint.mixed < 0)
        publishJoint(world.joints[joint.slot], joint.rows.ball, joint.angular ? joint.rows.lambda : none);
  for (uint32_t i = 0; i < step.batches.size(); ++i) {
    publishScalarJoints(world, step, i);
    publishLinkedJoints(world, step, i);
  }
  for (size_t lane = 0; lane < step.tetJoint.size(); ++lane) {
    if (step.tetJoint[lane] == kNone) continue;
    JointData& joint = world.joints[step.tetJoint[lane]];
    const rows::TetVolume<float> rows = step.tets[lane / kTile].get(lane % kTile);
    joint.lambda[0] = rows.lambda;
    joint.reaction = {
        fromRow((cross(rows.ac, rows.ad) + cross(rows.ad, rows.ab) + cross(rows.ab, rows.ac)) * (rows.lambda / 6)), {}};
  }
}

}  // namespace

void publish(WorldData& world, StepData& step) {
  checkForces(world, step);
  world.treeBehind = true;
  publishContacts(world, step);
  publishSoftTouches(world, step);
  publishElements(world, step);
  publishBodies(world, step);
  publishJoints(world, step);
  if (step.substep + 1 == world.def.substeps) publishEvents(world, step);
  world.report.simdWidth = static_cast<uint32_t>(step.backend->width);
}

}  // namespace avbd
