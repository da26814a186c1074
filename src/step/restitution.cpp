// Restitution: where and how fast contacts rebound.
#include "step/restitution.h"

#include <algorithm>

#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "step/swept_contacts.h"

namespace avbd {

namespace {

constexpr int kPasses = 8;  ///< over the rebounding rows

Vec3 velocityAt(Vec3 linear, Vec3 angular, Vec3 arm) { return linear + cross(angular, arm); }

Vec3 accelerationOf(const WorldData& world, const BodyData& body) {
  return body.type == BodyType::Dynamic ? freeAcceleration(body, world.def.gravity) : Vec3{};
}

Vec3 turning(const StepData& step, uint32_t row, Vec3 torque) {
  const float* m = step.invMass.data() + size_t(8) * row;
  return fromRow(rows::Sym3<float>{m[1], m[2], m[3], m[4], m[5], m[6]} * toRow(torque));
}

void addSide(const WorldData& world, const StepData& step, uint32_t slot, Vec3 arm, float sign, Bounce& bounce) {
  const BodyData& body = world.bodies[slot];
  if (body.type != BodyType::Dynamic) {
    bounce.fixedSpeed += sign * dot(bounce.n, velocityAt(body.linearVelocity, body.angularVelocity, arm));
    return;
  }
  const uint32_t row = step.rowOfEnd[step.endOf[slot]];
  const Vec3 lever = cross(arm, bounce.n);
  const Vec3 turn = turning(step, row, lever);
  bounce.weight += (sign > 0 ? bounce.scaleB : bounce.scaleA) * (step.invMass[size_t(8) * row] + dot(lever, turn));
  (sign > 0 ? bounce.b : bounce.a) = step.endOf[slot];
  (sign > 0 ? bounce.turnB : bounce.turnA) = turn;
}

Bounce makeBounce(const WorldData& world, const StepData& step, uint32_t index, int i) {
  const PairData& pair = world.pairs[index];
  const ContactChange& change = changeOf(step, index);
  Bounce bounce;
  bounce.pair = index, bounce.point = i;
  bounce.scaleA = change.scaleA, bounce.scaleB = change.scaleB;
  bounce.n = pair.normal;
  const ContactArms arms = armsOf(world, step, pair, i);
  bounce.armA = arms.a, bounce.armB = arms.b;
  addSide(world, step, pair.bodyA, bounce.armA, -1, bounce);
  addSide(world, step, pair.bodyB, bounce.armB, 1, bounce);
  bounce.speed = pair.points[i].rebound;
  bounce.weight = bounce.weight > 0 ? 1 / bounce.weight : 0;
  return bounce;
}

void push(StepData& step, const Bounce& bounce, float impulse) {
  const auto give = [&](uint32_t index, Vec3 turn, float p, const float* invMass) {
    StepData::EndState& end = step.end[index];
    end.linearVelocity = end.linearVelocity + bounce.n * (p * invMass[0]);
    end.angularVelocity = end.angularVelocity + turn * p;
  };
  if (bounce.a != kNone)
    give(bounce.a, bounce.turnA, -impulse * bounce.scaleA, step.invMass.data() + size_t(8) * step.rowOfEnd[bounce.a]);
  if (bounce.b != kNone)
    give(bounce.b, bounce.turnB, impulse * bounce.scaleB, step.invMass.data() + size_t(8) * step.rowOfEnd[bounce.b]);
}

float separationSpeed(const StepData& step, const Bounce& bounce) {
  float speed = bounce.fixedSpeed;
  if (bounce.b != kNone) {
    const StepData::EndState& end = step.end[bounce.b];
    speed += dot(bounce.n, velocityAt(end.linearVelocity, end.angularVelocity, bounce.armB));
  }
  if (bounce.a != kNone) {
    const StepData::EndState& end = step.end[bounce.a];
    speed -= dot(bounce.n, velocityAt(end.linearVelocity, end.angularVelocity, bounce.armA));
  }
  return speed;
}

}  // namespace

Rebound rebound(const WorldData& world, const StepData& step, const PairData& pair, int i) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const ContactArms arms = armsOf(world, step, pair, i);
  const float h = step.h;
  const float approach = dot(pair.normal, velocityAt(a.linearVelocity, a.angularVelocity, arms.a) -
                                              velocityAt(b.linearVelocity, b.angularVelocity, arms.b));
  const float pull = dot(pair.normal, accelerationOf(world, a) - accelerationOf(world, b));
  const float gap = std::max(pair.manifold.points[i].separation, 0.0f);
  const float now = approach + pull * (0.5f * h);  // at the start of the step
  if (!(approach > world.def.restitutionThreshold) || !(now > 0) || gap >= h * (now + 0.5f * pull * h)) return {};
  float time = gap / now;
  for (int k = 0; k < 3; ++k) time = gap / std::max(now + 0.5f * pull * time, 0.5f * now);
  time = std::min(time, h);
  const float leave = pair.restitution * (now + pull * time), left = h - time;
  const float height = leave * left - 0.5f * pull * left * left;
  return {std::max(height, 0.0f), std::max(leave - pull * (0.5f * h - time), 0.0f)};
}

namespace {

/// `contactAt(lane)`: the contact's rows.
template <class ContactAt>
void listBounces(const WorldData& world, StepData& step, const std::vector<uint32_t>& pairs, ContactAt contactAt) {
  for (size_t lane = 0; lane < pairs.size(); ++lane) {
    if (pairs[lane] == kNone || !step.found[pairs[lane]].bounces) continue;
    const PairData& pair = world.pairs[pairs[lane]];
    for (int i = 0; i < pair.pointCount; ++i) {
      if (pair.points[i].rebound <= 0) continue;
      const float force = contactAt(lane).point[i].lambdaN;
      if (force <= 0) continue;
      step.bounces.push_back(makeBounce(world, step, pairs[lane], i));
      step.bounces.back().least = -force * step.h;
    }
  }
}

}  // namespace

void applyRestitution(const WorldData& world, StepData& step) {
  std::vector<Bounce>& bounces = step.bounces;
  bounces.clear();
  listBounces(world, step, step.contactPair,
              [&](size_t lane) { return step.contacts[lane / kTile].get(lane % kTile); });
  listBounces(world, step, step.fullPair,
              [&](size_t lane) { return step.full[lane / kTile].get(lane % kTile).contact; });
  for (int pass = 0; pass < kPasses; ++pass)
    for (Bounce& bounce : bounces) {
      const float wanted = bounce.impulse + bounce.weight * (bounce.speed - separationSpeed(step, bounce));
      const float next = std::max(wanted, bounce.least);
      push(step, bounce, next - bounce.impulse);
      bounce.impulse = next;
    }
}

}  // namespace avbd
