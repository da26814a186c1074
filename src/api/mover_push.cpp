// Pushes and weight of a Mover (mover_push.h).
#include "api/mover_push.h"

#include <algorithm>

#include "world/check.h"
#include "world/limits.h"
#include "world/mass.h"
#include "world/rotation.h"

namespace avbd {
namespace {

// What a ground bears may exceed what moves it as fast as the mover falls by no more than this factor: where the
// support of a light ground slips, it is not shot away.
constexpr double kMostTimes = 10;

void checkPoint(const World& world, Vec3d point) {
  const double unit = static_cast<double>(world.definition().lengthUnit);
  check(Path("Mover::move") / "position", point, symmetric(kMaxPosition * unit));
}

}  // namespace

Vec3 pointVelocity(const World& world, BodyId body, Vec3d point) {
  const Velocity v = world.velocity(body);
  return v.linear + cross(v.angular, toFloat(point - world.worldCenterOfMass(body)));
}

MoverPushes::Answer MoverPushes::answerOf(BodyId body, Vec3d point, Vec3 direction) const {
  const Vec3d lever = toDouble(cross(toFloat(point - world_.worldCenterOfMass(body)), direction));
  const SymMat3 inertia = world_.inertia(body);
  Answer answer;
  answer.spin = solveUnlocked(worldInertia(world_.pose(body).rotation, inertia), kLockNone, lever);
  answer.inverseMass = 1 / static_cast<double>(world_.mass(body)) + dot(lever, toDouble(answer.spin));
  answer.spinBound = length(lever) / principalMoments(inertia)[0];
  return answer;
}

Velocity& MoverPushes::velocityOf(BodyId body) {
  for (Body& known : bodies_)
    if (known.id == body) return known.velocity;
  bodies_.push_back({body, world_.velocity(body)});
  return bodies_.back().velocity;
}

void MoverPushes::collide(const NearHit& hit, Vec3 velocity) {
  Velocity& v = velocityOf(hit.body);
  const Vec3 arm = toFloat(hit.onShape - world_.worldCenterOfMass(hit.body));
  const double closing = -static_cast<double>(dot(velocity - (v.linear + cross(v.angular, arm)), hit.normal));
  if (!(closing > 0)) return;
  checkPoint(world_, hit.onShape);
  const Vec3 direction = -hit.normal;
  const Answer answer = answerOf(hit.body, hit.onShape, direction);
  const double mass = static_cast<double>(world_.mass(hit.body));
  double impulse = closing / (1 / mass_ + answer.inverseMass);
  // A body can be so small that this would spin it faster than the world allows.
  const double fastest = kMaxSpeed * static_cast<double>(world_.definition().lengthUnit);
  const double roomLinear = 0.99 * fastest - static_cast<double>(length(v.linear));
  const double roomAngular = 0.99 * kMaxSpin - static_cast<double>(length(v.angular));
  impulse = std::min({impulse, kMaxForce, roomLinear * mass});
  if (answer.spinBound > 0) impulse = std::min(impulse, roomAngular / answer.spinBound);
  if (!(impulse > 0)) return;
  const float amount = static_cast<float>(impulse);
  v.linear = v.linear + direction * static_cast<float>(impulse / mass);
  v.angular = v.angular + answer.spin * amount;
  impulses_.push_back({hit.body, direction * amount, hit.onShape});
}

float MoverPushes::weigh(const MoverGround& ground, float last, float acceleration) {
  const Vec3 gravity = world_.definition().gravity;
  const double pull = static_cast<double>(length(gravity));
  if (!(pull > 0)) return 0;
  if (!(mass_ * pull <= kMaxForce)) {
    (Path("MoverDef") / "mass").refuse(toText(mass_), "must weigh no more than " + toText(kMaxForce) + " N");
  }
  checkPoint(world_, ground.point);
  const Vec3 down = gravity * static_cast<float>(1 / pull);
  const double both = 1 / (1 / mass_ + answerOf(ground.body, ground.point, down).inverseMass);
  const double apart = pull - static_cast<double>(last) / mass_ - static_cast<double>(acceleration);
  const double most = std::min(mass_, kMostTimes * both) * pull;
  const double force = std::clamp(static_cast<double>(last) + both * apart, 0.0, most);
  forces_.push_back({ground.body, down * static_cast<float>(force), ground.point});
  return static_cast<float>(force);
}

void MoverPushes::apply(World& world) const {
  for (const Push& push : impulses_) world.addImpulseAt(push.body, push.amount, push.point);
  for (const Push& push : forces_) world.addForceAt(push.body, push.amount, push.point);
}

}  // namespace avbd
