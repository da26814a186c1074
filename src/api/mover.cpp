// The character mover: checks, and one move: carried, walking, looking at the ground, pushing (mover.h).
#include <avbd/mover.h>

#include "api/mover_push.h"
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
  check(path / "maxSlope", def.maxSlope, notNegative(100));
  check(path / "stepHeight", def.stepHeight, notNegative(kMaxSize * kMaxUnit));
  check(path / "skin", def.skin, positive(static_cast<double>(def.radius)));
  check(path / "mass", def.mass, notNegative(kMaxMass));
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

/// What the ground has done since the last move, at the point that the mover touched.
struct Mover::Ride {
  Vec3 motion;             ///< [m]
  Vec3 velocity;           ///< [m/s] now
  float acceleration = 0;  ///< [m/s^2] along gravity, mean of the steps since then
  bool stepped = true;     ///< the world was stepped since then
  QueryFilter others;      ///< what may be in the way while it is carried: the mover's filter without the ground
};

Mover::Ride Mover::ride(const World& world) const {
  Ride ride;
  if (!ground_.onGround || !world.isAlive(ground_.body)) return ride;
  // Places of one point in both poses, so that a ground at rest carries nowhere, not even by rounding.
  const Pose touch{onGroundBody_, {}};
  const Pose now = world.pose(ground_.body) * touch;
  ride.motion = toFloat(now.position - (groundPose_ * touch).position);
  ride.velocity = pointVelocity(world, ground_.body, now.position);
  const Vec3 gravity = world.definition().gravity;
  const double elapsed = world.time() - groundTime_;
  ride.stepped = elapsed > 0;
  if (ride.stepped && dot(gravity, gravity) > 0) {
    const Vec3 down = gravity * (1 / length(gravity));
    ride.acceleration = static_cast<float>(dot(toDouble(ride.velocity - ground_.velocity), toDouble(down)) / elapsed);
  }
  ride.others = def_.filter;
  ride.others.accept = [this, &world](ShapeId shape) {
    return world.body(shape) != ground_.body && (!def_.filter.accept || def_.filter.accept(shape));
  };
  return ride;
}

void Mover::walk(Walk& walk, Vec3 motion) const {
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
  if (walks && walk.settle(def_.stepHeight - rise)) return;
  // On the way down it lands where it can stand; elsewhere it slides.
  if (rise > 0 || !walk.settle(-rise)) walk.slide(def_.up * rise, false);
}

void Mover::move(World& world, Vec3 velocity, float dt) {
  const Path path("Mover::move");
  check(path / "velocity", velocity, symmetric(kMaxSpeed * static_cast<double>(world.definition().lengthUnit)));
  // As short as a world's substep: its inverse is still a number.
  if (!(dt >= kMinSubstep && dt <= 1)) {
    (path / "dt").refuse(toText(dt), "must be at least " + toText(kMinSubstep) + " and at most 1");
  }
  // Everything that can throw comes first; what it comes to is set last.
  const Ride carried = ride(world);
  Walk steps(world, *this, pose().position);
  steps.advance(carried.motion, carried.others);
  steps.recover();
  const Vec3d start = steps.center();
  walk(steps, velocity * dt);
  const Vec3d end = steps.center();
  const MoverGround ground = dot(velocity, def_.up) > 0 ? MoverGround{} : steps.findGround(3 * def_.skin);
  const Pose groundPose = ground.shape ? world.pose(ground.body) : Pose{};
  MoverPushes pushes(world, def_.mass);
  float weight = 0;
  if (def_.mass > 0) {
    // The ground that it walks on is not pushed, but one that it lands on is.
    const BodyId under = ground_.onGround && ground.onGround ? ground.body : BodyId{};
    for (const NearHit& hit : world.nearest(geometry(), {end, rotation_}, 2 * def_.skin, def_.filter))
      if (hit.body != under && world.type(hit.body) == BodyType::Dynamic)
        pushes.collide(hit, velocity + carried.velocity);
    if (ground.onGround && world.type(ground.body) == BodyType::Dynamic) {
      const bool stays = ground_.onGround && ground.body == ground_.body;
      // A force lasts a step: without one since the last move it is still to act.
      weight = stays && !carried.stepped ? weight_
               : stays                   ? pushes.weigh(ground, weight_, carried.acceleration)
                                         : pushes.weigh(ground, 0, 0);
    }
  }
  pushes.apply(world);
  velocity_ = toFloat(end - start) * (1 / dt);
  position_ = end - def_.up * (0.5f * def_.height);
  ground_ = ground;
  groundPose_ = groundPose;
  onGroundBody_ = (inverse(groundPose) * Pose{ground.point, {}}).position;
  groundTime_ = world.time();
  weight_ = weight;
}

}  // namespace avbd
