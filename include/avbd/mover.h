// A character mover: a capsule that walks through a world by its queries alone. It is no body; the world does not see
// it.
//
// A move carries the capsule with its ground, moves it out of what has moved into it, moves it across `up` with slides
// and steps, then along `up`, and ends by looking at the ground. Everything that moves is cast first, so nothing is
// passed through however fast; a gap of `skin` to everything is kept, so that casts never start in what they should
// meet. Where it is squeezed and cannot leave an overlap, it may move in every way that does not go deeper.
#pragma once

#include <avbd/query.h>
#include <avbd/types.h>

namespace avbd {

class World;

struct MoverDef {
  Vec3d position{};          ///< of the lowest point, in the world [m]
  float radius = 0.3f;       ///< [m] > 0
  float height = 1.8f;       ///< [m] >= 2 radius, from the lowest point to the highest
  Vec3 up{0, 1, 0};          ///< unit within 1e-3
  float maxSlope = 1.2f;     ///< >= 0: steepest ground to stand on, as rise over run (1 is 45 degrees)
  float stepHeight = 0.35f;  ///< [m] >= 0: highest step to climb, and deepest to follow down without falling
  float skin = 0.02f;        ///< [m] > 0, below radius: gap kept to everything
  /// [kg] >= 0: dynamic bodies in the way, and what it lands on, are pushed as by a free body of this mass, and a
  /// dynamic ground bears its weight: no more than lets it fall as fast as the mover would, and ten times its own where
  /// it is lighter than that. 0: all bodies are walls.
  float mass = 70;
  QueryFilter filter{};  ///< what it collides with
};

/// What a mover stands on.
struct MoverGround {
  bool onGround = false;  ///< stands on something no steeper than maxSlope
  ShapeId shape;          ///< of the ground, or of what is too steep to stand on; null in the air
  BodyId body;
  Vec3d point;    ///< where it touches, in the world
  Vec3 normal;    ///< of the ground there, unit; of an edge: of the face to stand on
  Vec3 velocity;  ///< [m/s] of the ground body at that point
  explicit operator bool() const { return onGround; }
};

class Mover {
 public:
  explicit Mover(const MoverDef& def);  ///< throws Error
  /// Moves by velocity dt [m] relative to the ground (a ground body that moved since the last call carries it along,
  /// however it was moved). The caller adds gravity to the velocity while not on ground. Once after each step of the
  /// world. Throws Error for bad input, before the mover or the world has changed.
  void move(World& world, Vec3 velocity, float dt);
  Vec3d position() const { return position_; }  ///< of the lowest point
  void setPosition(Vec3d position);             ///< teleport: what it stood on is forgotten
  /// [m/s] that came of the last move, without what the ground carried.
  Vec3 velocity() const { return velocity_; }
  const MoverGround& ground() const { return ground_; }
  const MoverDef& definition() const { return def_; }
  Geometry geometry() const { return Capsule{def_.radius, halfHeight_}; }
  Pose pose() const;  ///< of the geometry

 private:
  class Walk;
  struct Ride;
  Ride ride(const World& world) const;
  void walk(Walk& walk, Vec3 motion) const;

  MoverDef def_;
  float halfHeight_ = 0;
  Quat rotation_;
  Vec3d position_;
  Vec3 velocity_;
  MoverGround ground_;
  Vec3d onGroundBody_;     ///< the touch, in the ground body's frame
  Pose groundPose_;        ///< of that body then
  double groundTime_ = 0;  ///< the world's then
  float weight_ = 0;       ///< [N] that the ground was given to bear
};

}  // namespace avbd
