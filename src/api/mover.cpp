// The character mover: checks, what carries it, what it pushes (mover.h).
#include <avbd/mover.h>

#include "api/mover_walk.h"
#include "world/check.h"
#include "world/limits.h"

namespace avbd {
namespace {

/// The shortest turn of y to `up`.
Quat uprightRotation(Vec3 up) {
  const double w = 1 + static_cast<double>(up.y);
  if (w < 1e-9) return {0, 1, 0, 0};
  const double k = 1 / std::sqrt(w * w + double(up.z) * up.z + double(up.x) * up.x);
  return {static_cast<float>(w * k), static_cast<float>(up.z * k), 0, static_cast<float>(-up.x * k)};
}

void checkMover(const MoverDef& def) {
  const Path path("MoverDef");
  check(path / "position", def.position, symmetric(kMaxPosition * kMaxUnit));
  check(path / "radius", def.radius, positive(kMaxSize * kMaxUnit));
  check(path / "height", def.height, Range{2.0 * static_cast<double>(def.radius), kMaxSize * kMaxUnit});
  // Written so that NaN is refused.
  if (!(std::abs(length(def.up) - 1) <= 1e-3f))
    (path / "up").refuse(toText(def.up), "must have a length within 0.001 of 1");
  check(path / "maxSlope", def.maxSlope, notNegative(1e6));
  check(path / "stepHeight", def.stepHeight, notNegative(kMaxSize * kMaxUnit));
  check(path / "skin", def.skin, positive(static_cast<double>(def.radius)));
  check(path / "mass", def.mass, notNegative(kMaxMass));
}

Vec3 pointVelocity(const World& world, BodyId body, Vec3d point) {
  const Velocity v = world.velocity(body);
  return v.linear + cross(v.angular, toFloat(point - world.worldCenterOfMass(body)));
}

/// Dynamic bodies that it runs against, as in a collision without rebound of two free bodies.
void pushBodies(World& world, const Mover& mover, Vec3 velocity) {
  const MoverDef& def = mover.definition();
  for (const NearHit& hit : world.nearest(mover.geometry(), mover.pose(), 2 * def.skin, def.filter)) {
    if (world.type(hit.body) != BodyType::Dynamic || hit.body == mover.ground().body) continue;
    const float closing = -dot(velocity - pointVelocity(world, hit.body, hit.onShape), hit.normal);
    if (!(closing > 0)) continue;
    const float mass = world.mass(hit.body), both = def.mass * mass / (def.mass + mass);
    world.addImpulseAt(hit.body, hit.normal * -(closing * both), hit.onShape);
  }
}

}  // namespace

Mover::Mover(const MoverDef& def) : def_(def) {
  checkMover(def);
  def_.up = def.up * (1 / length(def.up));
  halfHeight_ = 0.5f * def.height - def.radius;
  rotation_ = uprightRotation(def_.up);
  position_ = def.position;
}

Pose Mover::pose() const { return {position_ + def_.up * (0.5f * def_.height), rotation_}; }

void Mover::setPosition(Vec3d position) {
  check(Path("Mover::setPosition") / "position", position, symmetric(kMaxPosition * kMaxUnit));
  position_ = position;
  ground_ = {};
}

void Mover::move(World& world, Vec3 velocity, float dt) {
  const Path path("Mover::move");
  check(path / "velocity", velocity, symmetric(kMaxSpeed * static_cast<double>(world.definition().lengthUnit)));
  if (!(dt > 0 && dt <= 1)) (path / "dt").refuse(toText(dt), "must be finite and > 0 and at most 1");
  Walk walk(world, *this, pose().position);
  if (ground_.shape && world.isAlive(ground_.body)) {
    QueryFilter others = def_.filter;
    others.ignore = ground_.body;
    const Vec3 carried = toFloat((world.pose(ground_.body) * Pose{onGroundBody_, {}}).position - ground_.point);
    if (ground_.onGround && !(carried == Vec3{})) walk.advance(carried, others);
  }
  walk.recover();
  const Vec3d start = walk.center();
  const Vec3 motion = velocity * dt;
  const float rise = dot(motion, def_.up);
  Vec3 level = motion - def_.up * rise;
  const bool walks = ground_.onGround && rise <= 0;
  // Along the ground, as fast as on the level.
  if (walks) level = level - def_.up * (dot(level, ground_.normal) / dot(ground_.normal, def_.up));
  if (walks) {
    walk.stride(level);
  } else {
    walk.slide(level, true);
  }
  if (!walks || !walk.settle(def_.stepHeight - rise)) {
    // On the way down it lands where it can stand; elsewhere it slides.
    if (rise > 0 || !walk.settle(-rise)) walk.slide(def_.up * rise, false);
  }
  const Vec3d end = walk.center();
  velocity_ = toFloat(end - start) * (1 / dt);
  position_ = end - def_.up * (0.5f * def_.height);
  ground_ = rise > 0 ? MoverGround{} : walk.findGround(3 * def_.skin);
  if (ground_.shape) onGroundBody_ = (inverse(world.pose(ground_.body)) * Pose{ground_.point, {}}).position;
  if (!(def_.mass > 0)) return;
  pushBodies(world, *this, velocity);
  if (ground_.shape && world.type(ground_.body) == BodyType::Dynamic)
    world.addImpulseAt(ground_.body, world.definition().gravity * (def_.mass * dt), ground_.point);
}

}  // namespace avbd
