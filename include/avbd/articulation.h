// Articulations: bodies and joints of a world seen as a tree, with its coordinates and its dynamics in them.
//
// An articulation is a view. It keeps ids alone; the bodies and joints live in the world, which steps them as ever, and
// every call that reads or writes them is given that world. A tree has a fixed base (all bodies that are not dynamic,
// and the world itself) or a floating one (a link that no joint holds to such a body). Joints that would close a loop
// stay out of the tree: coordinates and dynamics are those of the tree without them.
//
// Velocities, efforts and accelerations have dofCount() numbers, in the order of dofs(), that is of links():
// - first six of a floating base: of the root's centre of mass along the world's x, y, z, then turning about them;
// - of a hinge, slider or D6 joint its free coordinates, as World::coordinate() tells them;
// - of a ball joint the turning of frame B against frame A, along A's x, y, z;
// - none of a fixed joint.
// An effort is what does the work: force or torque times velocity. Positions have positionCount() numbers, in the same
// order without the six of a floating base, whose place is a pose; of a ball joint the rotation vector of frame B in
// frame A. A ball's velocity is not the rate of its rotation vector, everything else is.
//
// Equation of motion: M(q) a + bias(q, v) = efforts + gravity(q) + what external forces give. Efforts are all that acts
// along the coordinates: drives, springs, friction, limits and forces given. Damping of bodies and loops are left out.
#pragma once

#include <avbd/body.h>
#include <avbd/id.h>
#include <avbd/joint.h>
#include <avbd/types.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace avbd {

class World;
namespace articulation {
struct Placed;
struct Tree;
}  // namespace articulation

/// A body of the tree.
struct ArticulationLink {
  BodyId body;
  JointId joint{};        ///< to its parent; null of a floating root
  int parent = -1;        ///< index in links(), below the link's own; -1: a floating root, or joined to the base
  BodyId base{};          ///< where parent is -1: the body of the base that it is joined to; null: the world
  bool reversed = false;  ///< the parent is body B of the joint
  int firstDof = 0;       ///< index in dofs()
  int dofCount = 0;
};

/// One number of velocities, efforts and accelerations.
struct ArticulationDof {
  int link = 0;  ///< index in links(): the link that it moves against its parent
  /// Of a hinge, slider or D6 joint its coordinate. Of a ball Twist, SwingY, SwingZ stand for x, y, z of frame A; of a
  /// floating base all six for x, y, z of the world.
  JointAxis axis = JointAxis::Twist;
};

/// Which links of an articulation collide with each other. Links that a joint joins do so only where the joint's
/// collideConnected says so too.
struct SelfCollision {
  bool enabled = true;  ///< false: no link touches another
  /// Pairs of links that never touch; each of two different links, once or more, in any order.
  std::vector<std::array<BodyId, 2>> excluded{};
};

/// Where an articulation is and how it moves.
struct ArticulationState {
  Pose base;                       ///< of the root's frame, in the world; unused with a fixed base
  std::vector<double> positions;   ///< positionCount() of them [m, rad]
  std::vector<double> velocities;  ///< dofCount() of them [m/s, rad/s]
};

/// Velocity of a link in double.
struct LinkVelocity {
  Vec3d linear;   ///< [m/s] of the centre of mass, world axes
  Vec3d angular;  ///< [rad/s], world axes
};

/// What acts on a link from outside.
struct LinkForce {
  Vec3d force;   ///< [N] at the centre of mass, world axes
  Vec3d torque;  ///< [N m], world axes
};

/// An articulation's dynamics in one state, in double. It has copied what it needs: it does not change with the world,
/// and may be used by several threads. Vectors are as dofs(); matrices are row by row. Throws Error for spans of
/// another length, values that are not finite and links that are not there. Recursive Newton-Euler and composite bodies
/// after R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5 and 6, with each link's vectors in world
/// axes about its own centre of mass, so that far from the origin nothing is lost.
class ArticulationDynamics {
 public:
  size_t linkCount() const;
  size_t dofCount() const;
  Pose pose(size_t link) const;  ///< of the body's frame, in the world: forward kinematics
  LinkVelocity velocity(size_t link) const;
  Vec3d centerOfMass(size_t link) const;  ///< in the world [m]
  Vec3d centerOfMass() const;             ///< of all links, in the world [m]
  double mass() const;                    ///< [kg] of all links
  double kineticEnergy() const;           ///< [J] of links and armatures
  double potentialEnergy() const;         ///< [J] in the world's gravity, zero at its origin
  /// 6 x dofCount: velocity at a world point of the link, its linear part [m/s] in rows 0 .. 2, the angular [rad/s] in
  /// 3 .. 5, world axes, of each dof's unit velocity.
  std::vector<double> jacobian(size_t link, Vec3d point) const;
  /// dofCount x dofCount, symmetric, armatures included. Kinetic energy is v M v / 2 (on a base at rest).
  std::vector<double> massMatrix() const;
  /// Efforts that velocities alone ask for: Coriolis and centrifugal.
  std::vector<double> biasForces() const;
  /// What gravity does along each coordinate: minus the slope of the potential energy.
  std::vector<double> gravityForces() const;
  /// Efforts that give these accelerations [m/s^2, rad/s^2] while `external` acts: none, or one for each link.
  std::vector<double> inverseDynamics(std::span<const double> accelerations,
                                      std::span<const LinkForce> external = {}) const;
  /// Accelerations under efforts [N, N m]. Throws Error too where the mass matrix is singular: at a swing of half a
  /// turn with a free twist.
  std::vector<double> forwardDynamics(std::span<const double> efforts, std::span<const LinkForce> external = {}) const;

 private:
  friend class Articulation;
  explicit ArticulationDynamics(std::shared_ptr<const articulation::Placed> placed) : placed_(std::move(placed)) {}
  std::shared_ptr<const articulation::Placed> placed_;
};

/// The view. It stays right as long as its bodies and joints live, whatever else happens to the world; after that calls
/// throw Error. Masses, frames and gravity are read anew by every call. A joint that breaks or is disabled later still
/// counts as one that holds.
class Articulation {
 public:
  /// The tree of these hinges, sliders, balls, D6 and fixed joints, at least one. The base is fixed if one of them
  /// holds a link to the world or to a static or kinematic body; else body A of the first is the floating root. Throws
  /// Error for joints that are dead, not enabled, of another type, given twice, not connected with the others, or of
  /// bodies with locked axes.
  Articulation(const World& world, std::span<const JointId> joints);
  /// All such joints that can be reached from a body over joints without crossing bodies that are not dynamic; disabled
  /// joints and joints of other types are left out. A floating base is this body. Throws Error for a dead body, one
  /// without such joints, and bodies with locked axes.
  Articulation(const World& world, BodyId root);

  bool isFloating() const { return floating_; }
  /// Parents first; nearer the root first. With a floating base link 0 is the root.
  const std::vector<ArticulationLink>& links() const { return links_; }
  const std::vector<ArticulationDof>& dofs() const { return dofs_; }
  size_t dofCount() const { return dofs_.size(); }
  size_t positionCount() const { return dofs_.size() - (floating_ ? 6 : 0); }
  const std::vector<JointId>& loopJoints() const { return loopJoints_; }  ///< not in the tree
  size_t linkOf(BodyId body) const;                                       ///< index in links(); Error if it is no link

  // State. What is read is as exact as the world's rotations, which are float: about 1e-7 rad.
  ArticulationState state(const World& world) const;
  std::vector<double> positions(const World& world) const;
  std::vector<double> velocities(const World& world) const;
  Pose basePose(const World& world) const;  ///< of a floating root; of a fixed base Error
  /// Places and moves all links (World::setPose, World::setVelocity). Loop joints are not looked at.
  void setState(World& world, const ArticulationState& state) const;
  /// As setState, with base and velocities (of the coordinates) as they are. Twists count full turns from where they
  /// were in the last step: what is set farther than half a turn from there reads back by full turns less.
  void setPositions(World& world, std::span<const double> positions) const;
  void setVelocities(World& world, std::span<const double> velocities) const;
  void setBasePose(World& world, const Pose& pose) const;  ///< the coordinates stay; of a fixed base Error

  /// Efforts [N, N m] during the next step, then forgotten; they add to what else was given (World::addJointForce, and
  /// of balls and a floating base World::addTorque and addForce).
  void addEfforts(World& world, std::span<const double> efforts) const;
  /// Sets the positions, and if given the velocities, that drives pull to; everything else of the drives stays. A D6
  /// joint whose slerp drive has stiffness or damping gets its rotation and velocity. Balls and fixed joints have no
  /// drives: their numbers are not used, nor are the velocities of a floating base.
  void setDriveTargets(World& world, std::span<const double> positions, std::span<const double> velocities = {}) const;

  /// Takes the place of what was set so before, and of World::excludeCollision between links; their collisions with
  /// other bodies, also those of the base, are as they were. The world keeps it: copies of this view need not set it
  /// again. Throws Error for pairs of bodies that are dead, no links, or the same.
  void setSelfCollision(World& world, const SelfCollision& rule) const;
  /// Outer iterations for all that touches or is jointed to the links, as BodyDef::iterations of each; 0: the world's.
  void setIterations(World& world, int iterations) const;
  /// Pairs of links that never touch, whatever excludes them: as World::excludedPairs. Filters are not looked at.
  std::vector<std::array<BodyId, 2>> excludedPairs(const World& world) const;

  ArticulationDynamics dynamics(const World& world) const;  ///< in the world's state
  /// In another state; the base's own motion and gravity are the world's.
  ArticulationDynamics dynamics(const World& world, const ArticulationState& state) const;

 private:
  void layOut(const World& world, articulation::Tree tree);
  std::vector<ArticulationLink> links_;
  std::vector<ArticulationDof> dofs_;
  std::vector<JointId> loopJoints_;
  bool floating_ = false;
};

}  // namespace avbd
