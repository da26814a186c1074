// What one move of a Mover does to dynamic bodies: found while the move is worked out, done at its end.
#pragma once

#include <avbd/mover.h>
#include <avbd/world.h>

#include <vector>

namespace avbd {

/// Velocity of a body's point.
Vec3 pointVelocity(const World& world, BodyId body, Vec3d point);

/// Impulses and a weight. Nothing changes before apply(), which does not throw: what the world would refuse is bounded
/// or refused while it is found.
class MoverPushes {
 public:
  /// mass: of the mover, > 0 [kg]
  MoverPushes(const World& world, float mass) : world_(world), mass_(mass) {}

  /// As two free bodies collide without rebound; velocity: of the mover [m/s].
  void collide(const NearHit& hit, Vec3 velocity);

  /// The force that the ground bears [N, along gravity]. As in a solver that starts from its last answer: `last` is
  /// corrected by what the mover, with gravity and that force, and the ground, which gained `acceleration` along
  /// gravity, still differ by. A ground that holds comes to bear the whole weight; one that gives way no more than
  /// keeps it from falling faster than the mover.
  float weigh(const MoverGround& ground, float last, float acceleration);

  void apply(World& world) const;

 private:
  struct Body {
    BodyId id;
    Velocity velocity;  ///< with the impulses so far
  };
  struct Push {
    BodyId body;
    Vec3 amount;  ///< impulse or force
    Vec3d point;
  };
  /// A body's answer to a unit impulse along a unit direction at a point.
  struct Answer {
    Vec3 spin;
    double inverseMass = 0;  ///< of the point, along the direction [1/kg]
    double spinBound = 0;    ///< |spin| is no more than this whatever axes are locked
  };
  Answer answerOf(BodyId body, Vec3d point, Vec3 direction) const;
  Velocity& velocityOf(BodyId body);

  const World& world_;
  double mass_;
  std::vector<Body> bodies_;
  std::vector<Push> impulses_, forces_;
};

}  // namespace avbd
