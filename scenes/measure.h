// Figures of a world that do not depend on the engine that moved it.
#pragma once

#include <avbd/avbd.h>

#include <array>
#include <span>
#include <unordered_set>
#include <vector>

#include "scenes/penetration.h"

namespace avbd::scenes {

inline constexpr uint32_t kWorldBody = 0xffffffffu;

/// What of a world does not move: its shapes, joints and which pairs may touch. Bodies are indices into `bodies`.
struct Layout {
  struct Piece {
    uint32_t body = 0;
    Geometry geometry;
    Pose pose;  ///< in the body's frame
    Filter filter;
    SoftId soft{};  ///< that the body is a point of; else null
  };
  struct Anchors {
    uint32_t bodyA = kWorldBody, bodyB = kWorldBody;
    Vec3d a, b;               ///< in each body's frame; in the world for kWorldBody
    Quat frameA{}, frameB{};  ///< likewise
    uint8_t locked = 7;       ///< coordinates that are held, bits by JointAxis
    bool spans = false;       ///< the distance of the anchors is what is held, within the range below [m]
    double shortest = 0, longest = 0;
  };
  /// A rope over two wheels.
  struct Rope {
    uint32_t bodyA = kWorldBody, bodyB = kWorldBody;
    Vec3d a, b, wheelA, wheelB;
    double ratio = 1, length = 0;
    bool slack = true;
  };
  std::vector<BodyId> bodies;
  std::vector<char> dynamic;
  std::vector<Piece> pieces;
  std::vector<Anchors> anchors;            ///< of joints of two bodies
  std::vector<Rope> ropes;                 ///< of pulleys
  std::unordered_set<uint64_t> separated;  ///< pairs of bodies that a joint keeps from colliding

  bool mayTouch(uint32_t pieceA, uint32_t pieceB) const;
};

Layout layoutOf(const World& world);
std::vector<Pose> posesOf(const World& world, const Layout& layout);

/// Exact penetration over all pairs of the layout that may touch: soft bodies by the balls of their points, without
/// those of one and the same body.
Penetration penetrationOf(const Layout& layout, std::span<const Pose> poses);
/// How far the worst joint is from holding: the distance of its anchors along locked axes, or what a rope or rod is
/// out of its range [m].
double jointGapMax(const Layout& layout, std::span<const Pose> poses);
/// The same of angles about locked axes [rad].
double jointAngleMax(const Layout& layout, std::span<const Pose> poses);

/// Coordinates of a rotation as JointAxis tells them [rad].
struct TwistSwing {
  double twist = 0, y = 0, z = 0;
};
TwistSwing twistSwing(Quat rotation);

struct Displacement {
  double total = 0, horizontal = 0;  ///< the largest of a dynamic body; horizontal leaves y out [m]
};
Displacement displacement(const Layout& layout, std::span<const Pose> from, std::span<const Pose> to);

/// All dynamic bodies are finite.
bool isFinite(const World& world);
bool isFinite(std::span<const Pose> poses);

/// Kinetic and gravitational energy of the dynamic bodies [J].
double energy(const World& world);

/// A body where it is now.
struct Motion {
  BodyId body;
  double mass, potential;        ///< [kg], [J]
  std::array<Vec3d, 3> inertia;  ///< columns, world axes [kg m^2]
  Velocity coming;               ///< of the step that led here
};
std::vector<Motion> motionsOf(const World& world);  ///< of all dynamic bodies
/// Energy where the bodies were when `motions` were taken, one step ago, at the mean of the velocities with which they
/// came and left: a step's velocity is that of its middle, and half a step ahead of its place a body that rises has too
/// much.
double energyBetween(std::span<const Motion> motions, const World& world);
/// Sums over dynamic bodies in double from poses and velocities: linear, and angular about the origin; and the sums of
/// the bodies' magnitudes, which relative errors refer to.
struct Momentum {
  Vec3d linear, angular;
  double linearScale = 0, angularScale = 0;
};
Momentum momentum(const World& world);
/// Largest linear speed of a dynamic body [m/s].
double speedMax(const World& world);

}  // namespace avbd::scenes
