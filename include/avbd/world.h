// The world: everything that exists between steps, and the step.
#pragma once

#include <avbd/body.h>
#include <avbd/coupling.h>
#include <avbd/custom_joint.h>
#include <avbd/error.h>
#include <avbd/events.h>
#include <avbd/joint.h>
#include <avbd/profile.h>
#include <avbd/query.h>
#include <avbd/soft.h>
#include <avbd/tasks.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace avbd {

/// How the primal system of an iteration is solved (docs/method.md).
enum class PrimalSolver : uint8_t {
  Krylov,      ///< preconditioned conjugate gradients over an island, exact trees inside (default)
  BlockSweep,  ///< Gauss-Seidel over bodies in colours, as in the AVBD paper
};

/// Settings of a world. All have defaults that need no turning.
struct WorldDef {
  Vec3 gravity{0, -9.81f, 0};  ///< [m/s^2]
  int workers = 1;             ///< threads that step() may use, 1 .. 64. Changes no bit of the result.
  int iterations = 4;          ///< outer iterations of the solver per substep, 1 .. 1000
  int substeps = 1;            ///< 1 .. 1000
  /// Size of a usual thing, in the unit of the positions: 1 where that is the metre. All tolerances scale with it.
  float lengthUnit = 1;
  float restitutionThreshold = 1;  ///< [m/s] approach speed below which nothing rebounds
  /// [m/s] at which bodies that overlap at the start of a step, or are not where their joint wants them, are moved at
  /// most.
  float maxDepenetrationSpeed = 3;
  float hitSpeed = 1;       ///< [m/s] > 0: approach speed from which a contact is a HitEvent
  bool moveEvents = false;  ///< list every body that moved in Events::moves
  /// Bodies that move far for their size in a step have their way searched, and stop for the rest of it where they
  /// would pass through something. They keep their velocity: the next step makes the impact.
  bool continuous = true;
  /// So do those that joints tie to others that move. They cannot stop behind the solve: where they would pass, the
  /// step is solved again, up to four times. Off, as a crowd of ragdolls that falls pays for that what its steps cost.
  bool continuousJointed = false;
  PrimalSolver primalSolver = PrimalSolver::Krylov;
  int krylovIterations = 0;  ///< conjugate-gradient steps per outer iteration; 0 takes the default, <= 1000
  /// Where joints take their arms: 0 at the step's start (symplectic; unstable under heavy loads), 1 at its end
  /// (implicit; eats energy), between: a blend. -1 chooses for each joint and step by its stability number
  /// (docs/method.md).
  float jointArmBlend = -1;
  /// Bodies that touch or are jointed fall asleep together once all of them have been slower than sleepSpeed for
  /// sleepTime; what sleeps costs nothing, does not move and has no velocity.
  bool sleep = true;
  float sleepTime = 0.5f;    ///< [s] >= 0
  float sleepSpeed = 0.02f;  ///< [lengthUnit/s] >= 0, of the centre of mass, and of the farthest point about it
  int simdWidth = 0;   ///< 1, 4, 8, 16; 0 takes the widest that this processor runs. Changes no bit of the result.
  TaskSystem tasks{};  ///< the user's own threads, in place of `workers`
};

/// A simulation. Different worlds may be used by different threads at the same time. One world may be read (every
/// const function) by many threads at the same time, as long as no thread calls a function that is not const.
class World {
 public:
  explicit World(const WorldDef& def = {});  ///< throws Error
  ~World();
  World(World&&) noexcept;  ///< the source may then only be destroyed or assigned to
  World& operator=(World&&) noexcept;

  // Making and removing. Throw Error before anything has changed.
  BodyId create(const BodyDef& def);
  ShapeId create(BodyId body, const ShapeDef& def);  ///< mass is computed anew unless massProperties were given
  JointId create(const BallJoint& def);
  JointId create(const FixedJoint& def);
  JointId create(const TetVolume& def);
  JointId create(const HingeJoint& def);
  JointId create(const SliderJoint& def);
  JointId create(const D6Joint& def);
  JointId create(const DistanceJoint& def);
  JointId create(const PulleyJoint& def);
  JointId create(const Coupling& def);
  JointId create(const CustomJoint& def);
  SoftId create(const SoftDef& def);
  void destroy(BodyId id);   ///< with its shapes and its joints; not a particle
  void destroy(ShapeId id);  ///< as create; a dynamic body that loses its last mass keeps what it had
  void destroy(JointId id);  ///< with the couplings that name it
  void destroy(SoftId id);   ///< with its particles and their joints
  bool isAlive(BodyId id) const;
  bool isAlive(ShapeId id) const;
  bool isAlive(JointId id) const;
  bool isAlive(SoftId id) const;
  /// Shapes of these two bodies never touch from now on, until allowCollision or one of the bodies is destroyed. Once
  /// more changes nothing.
  void excludeCollision(BodyId a, BodyId b);
  /// Ends what excludeCollision began, if it did. What a joint between the two excludes stays excluded.
  void allowCollision(BodyId a, BodyId b);
  /// Bodies that never touch each other: excluded by excludeCollision or by a joint between them. Each pair once, the
  /// lower slot first, in ascending order.
  std::vector<std::array<BodyId, 2>> excludedPairs() const;

  /// Advances time by dt [s], 0 < dt <= 1 and at least 1e-7 for each substep. Throws Error for a bad dt or a bad answer
  /// of the contact hook, NonFiniteError if a body's state becomes NaN or infinite. Poses, velocities and time are then
  /// those from before, and the forces given for the step are kept for the next one.
  const StepReport& step(float dt);
  const StepReport& report() const;  ///< of the last step
  double time() const;               ///< [s] since the world was made

  // Whole world.
  const WorldDef& definition() const;
  void setGravity(Vec3 gravity);
  void setIterations(int iterations);
  void setSubsteps(int substeps);
  /// Hash over poses, velocities and row memories: equal if and only if (but for chance) the states are equal.
  uint64_t hash() const;
  /// Of what each stage leaves to the steps to come, by Stage; 0 of those that leave nothing. Where two runs part, the
  /// first that differs tells where. Made of the same and of some things more than hash().
  std::array<uint64_t, kStageCount> stageHashes() const;
  std::vector<BodyId> bodies() const;  ///< in order of their slots
  std::vector<JointId> joints() const;
  size_t bodyCount() const;
  size_t shapeCount() const;
  size_t jointCount() const;

  // Soft bodies.
  std::vector<SoftId> softBodies() const;  ///< in order of their slots
  std::shared_ptr<const SoftMeshData> mesh(SoftId id) const;
  SoftMaterial material(SoftId id) const;
  float radius(SoftId id) const;                          ///< [m] as SoftDef::radius
  std::vector<BodyId> particles(SoftId id) const;         ///< by point of the mesh
  SoftId softBody(BodyId id) const;                       ///< null of a body that is no particle
  void getPoints(SoftId id, std::span<Vec3d> out) const;  ///< where the particles are [m]; Error for another length
  double volume(SoftId id) const;                         ///< [m^3] of all tetrahedra now
  uint64_t userData(SoftId id) const;
  void setUserData(SoftId id, uint64_t data);

  // Bodies.
  BodyType type(BodyId id) const;
  Pose pose(BodyId id) const;  ///< of the body's frame
  /// Teleport: sets the pose of the body's frame; contacts of the body lose their memory.
  void setPose(BodyId id, const Pose& pose);
  Velocity velocity(BodyId id) const;
  void setVelocity(BodyId id, const Velocity& velocity);  ///< not of static bodies; zero along locked axes
  float mass(BodyId id) const;                            ///< [kg]; 0 for static and kinematic bodies
  SymMat3 inertia(BodyId id) const;                       ///< about the centre of mass, body axes
  Vec3 centerOfMass(BodyId id) const;                     ///< in the body's frame
  Vec3d worldCenterOfMass(BodyId id) const;
  void setMassProperties(BodyId id, const MassProperties& properties);  ///< dynamic bodies only
  /// Forces, torques and impulses: dynamic bodies only. Forces act during the next step and are then forgotten.
  void addForce(BodyId id, Vec3 force);                 ///< [N]
  void addForceAt(BodyId id, Vec3 force, Vec3d point);  ///< [N] at a world point
  void addTorque(BodyId id, Vec3 torque);               ///< [N m]
  void addImpulse(BodyId id, Vec3 impulse);             ///< [N s], changes the velocity now
  void addImpulseAt(BodyId id, Vec3 impulse, Vec3d point);
  void addAngularImpulse(BodyId id, Vec3 impulse);  ///< [N m s]
  void clearForces();  ///< forgets forces and torques given for the next step, of all bodies
  void setDamping(BodyId id, float linear, float angular);
  void setGravityScale(BodyId id, float scale);
  void setLocks(BodyId id, uint8_t locks);
  void setMaxSpeeds(BodyId id, float linear, float angular);
  void setIterations(BodyId id, int iterations);   ///< as BodyDef::iterations
  void setContinuous(BodyId id, bool continuous);  ///< as BodyDef::continuous
  float linearDamping(BodyId id) const;            ///< [1/s]
  float angularDamping(BodyId id) const;           ///< [1/s]
  float gravityScale(BodyId id) const;
  int iterations(BodyId id) const;         ///< as BodyDef::iterations
  bool isContinuous(BodyId id) const;      ///< as BodyDef::continuous
  uint8_t locks(BodyId id) const;          ///< of Locks
  float maxLinearSpeed(BodyId id) const;   ///< [m/s]
  float maxAngularSpeed(BodyId id) const;  ///< [rad/s]
  // Sleep. Sleeping bodies wake when something that moves touches them, and by every call that changes them, what they
  // touch or their joints. To make something that does not move wakes nothing.
  bool isAwake(BodyId id) const;  ///< false of a static body, and of a kinematic one that does not move
  void wake(BodyId id);           ///< a dynamic body and all that sleeps with it; of another, all that rests on it
  void wakeAll();
  void putToSleep(BodyId id);  ///< a dynamic body now, with all that it touched in the last step or is jointed to
  bool canSleep(BodyId id) const;
  void setCanSleep(BodyId id, bool canSleep);
  uint64_t userData(BodyId id) const;
  void setUserData(BodyId id, uint64_t data);
  std::vector<ShapeId> shapes(BodyId id) const;
  double kineticEnergy(BodyId id) const;          ///< [J]
  double kineticEnergy() const;                   ///< of all dynamic bodies
  Vec3d momentum() const;                         ///< of all dynamic bodies [kg m/s]
  Vec3d angularMomentum(Vec3d about = {}) const;  ///< [kg m^2/s]

  // Bulk: out[i] belongs to ids[i]; spans of equal length, else Error.
  void getPoses(std::span<const BodyId> ids, std::span<Pose> out) const;
  void getVelocities(std::span<const BodyId> ids, std::span<Velocity> out) const;
  void setVelocities(std::span<const BodyId> ids, std::span<const Velocity> in);
  void addForces(std::span<const BodyId> ids, std::span<const Vec3> forces);

  // Shapes.
  BodyId body(ShapeId id) const;
  Geometry geometry(ShapeId id) const;
  Pose localPose(ShapeId id) const;  ///< in the body's frame
  Material material(ShapeId id) const;
  void setMaterial(ShapeId id, const Material& material);
  std::vector<Material> materials(ShapeId id) const;
  void setMaterials(ShapeId id, std::span<const Material> materials);  ///< as ShapeDef::materials
  Filter filter(ShapeId id) const;
  void setFilter(ShapeId id, const Filter& filter);
  uint64_t userData(ShapeId id) const;
  void setUserData(ShapeId id, uint64_t data);

  // Joints.
  JointType type(JointId id) const;
  std::vector<BodyId> bodies(JointId id) const;  ///< that it acts on, each once, without the world
  /// Where its frames are in the world, A's first; of joints without frames an Error.
  std::array<Pose, 2> worldFrames(JointId id) const;
  BallJoint ballJoint(JointId id) const;      ///< the definition; Error if it is a joint of another type
  FixedJoint fixedJoint(JointId id) const;    ///< as above
  TetVolume tetVolume(JointId id) const;      ///< as above; restVolume is the one in use
  HingeJoint hingeJoint(JointId id) const;    ///< as above
  SliderJoint sliderJoint(JointId id) const;  ///< as above
  D6Joint d6Joint(JointId id) const;          ///< as above
  DistanceJoint distanceJoint(JointId id) const;
  PulleyJoint pulleyJoint(JointId id) const;  ///< length is the one in use
  Coupling coupling(JointId id) const;        ///< rest is the one in use
  CustomJoint customJoint(JointId id) const;  ///< memory is that of now
  /// One coordinate of a hinge, slider or D6 joint; else Error.
  JointCoordinate coordinate(JointId id, JointAxis axis) const;
  /// The coordinate that a hinge or slider leaves free; the length of a distance joint or pulley; L of a coupling.
  JointCoordinate coordinate(JointId id) const;
  /// Of a free coordinate of a D6 joint; without axis that of a hinge or slider. Takes effect in the next step.
  void setLimit(JointId id, JointAxis axis, const JointLimit& limit);
  void setLimit(JointId id, const JointLimit& limit);
  void setDrive(JointId id, JointAxis axis, const JointDrive& drive);
  void setDrive(JointId id, const JointDrive& drive);
  void setSpring(JointId id, JointAxis axis, const JointSpring& spring);
  void setSpring(JointId id, const JointSpring& spring);
  void setSlerp(JointId id, const SlerpDrive& drive);  ///< of a D6 joint that may have one
  /// A force along a free coordinate during the next step, on B along the axis and on A against it [N, N m]; also along
  /// L of a free coupling. Adds to what was given before and is then forgotten.
  void addJointForce(JointId id, JointAxis axis, float force);
  void addJointForce(JointId id, float force);  ///< of a hinge, slider or coupling
  /// New frames in the bodies; what the joint remembers stays, so that nothing jumps but what the frames make jump. Of
  /// joints that have frames.
  void setFrames(JointId id, const Pose& frameA, const Pose& frameB);
  /// A joint that is not enabled does nothing, also to collisions: those of its bodies are then as if it were not
  /// there.
  bool isEnabled(JointId id) const;
  void setEnabled(JointId id, bool enabled);
  JointBreak breakLimits(JointId id) const;
  void setBreakLimits(JointId id, const JointBreak& limits);
  JointReaction reaction(JointId id) const;
  /// How far the joint is from holding [m]: the distance of the frames' origins, of a slider or D6 joint along its
  /// locked axes only; beyond its range of a distance joint or pulley; |C| [m^3] of a TetVolume; |L - rest| of a locked
  /// coupling, 0 of a free one; the largest |C| of a custom joint's hard rows.
  double gap(JointId id) const;
  /// [rad] between the frames about locked axes; 0 of joints that lock none.
  double angleError(JointId id) const;
  uint64_t userData(JointId id) const;
  void setUserData(JointId id, uint64_t data);

  /// Contacts of the last step, ordered by shape ids. Touches that began and persist are told apart by Contact::touch.
  /// What touched within the step but has flown far apart by its end is in Events::begins and hits alone.
  std::vector<Contact> contacts() const;
  /// The same in place of what `out` holds: its memory is used again.
  void getContacts(std::vector<Contact>& out) const;
  /// What faces and edges of soft bodies touch. What weighs on a soft body is the sum of these and its points'
  /// contacts.
  std::vector<SurfaceTouch> surfaceTouches() const;
  /// What began, ended and hit in the last step.
  const Events& events() const;
  /// Called in every substep for each contact of a shape with contactHook, before it is solved; may change the plan's
  /// last fields; false refuses the contact for this substep. It must depend on nothing but its argument and the
  /// user's own constant data, must not touch the world, and must not throw. An empty function removes the hook.
  void setContactHook(std::function<bool(ContactPlan&)> hook);
  // As in ShapeDef; changes count from the next step on. A touch that goes on begins, or ends, for who asks for its
  // events, or no longer does, in the middle of it.
  bool isTrigger(ShapeId id) const;
  bool contactEvents(ShapeId id) const;
  void setContactEvents(ShapeId id, bool wanted);
  bool hitEvents(ShapeId id) const;
  void setHitEvents(ShapeId id, bool wanted);
  bool contactHook(ShapeId id) const;
  void setContactHook(ShapeId id, bool wanted);

  // Snapshots: all that the steps to come, and every call, depend on, with the ids. A world goes back to any of its own
  // in place; so does any other that was made with an equal WorldDef (workers and simdWidth apart) and has, or had,
  // equal hulls, meshes, height fields and custom families: a new world then becomes a copy. The contact hook and what
  // else the user holds (a Mover, control values) stay as they are. From a snapshot on all goes the same, bit for bit.
  size_t snapshotSize() const;                   ///< [bytes] of one taken now; takes as long as taking it
  void save(std::vector<std::byte>& out) const;  ///< in place of what `out` holds; its memory is used again
  size_t save(std::span<std::byte> out) const;   ///< returns its size; Error for a span that is too short
  /// Goes back to (or on to) a snapshot. Throws Error, with the world as it was, for one that is cut short, damaged, of
  /// another version of the library or of another world.
  void restore(std::span<const std::byte> snapshot);

  // Queries (query.h): about where shapes are now. Queried geometries are convex: not HalfSpace, Mesh or HeightField.
  // Ties go to the lower shape id. Throw Error for arguments that are not finite, ways of no length, a dead body in the
  // filter. Lists are in the order told. Bulk forms: out[i] belongs to the i-th entry; spans of equal length, else
  // Error.
  CastHit rayClosest(const Ray& ray, const QueryFilter& filter = {}) const;  ///< shape is null if there is none
  bool rayAny(const Ray& ray, const QueryFilter& filter = {}) const;
  std::vector<CastHit> rayAll(const Ray& ray, const QueryFilter& filter = {}) const;  ///< by distance
  CastHit castClosest(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  CastHit castClosest(const Geometry& geometry, const Pose& pose, Vec3 motion, const QueryFilter& filter = {}) const;
  bool castAny(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  std::vector<CastHit> castAll(const ShapeCast& cast, const QueryFilter& filter = {}) const;  ///< by distance
  std::vector<CastHit> castAll(const Geometry& geometry, const Pose& pose, Vec3 motion,
                               const QueryFilter& filter = {}) const;
  /// Shapes that overlap the geometry or touch it, ascending. A HeightField also what lies below it by no more than its
  /// thickness (by the geometry's origin).
  std::vector<ShapeId> overlaps(const Geometry& geometry, const Pose& pose, const QueryFilter& filter = {}) const;
  bool overlapsAny(const Geometry& geometry, const Pose& pose, const QueryFilter& filter = {}) const;
  /// Shapes no farther than maxDistance [m] >= 0, by distance.
  std::vector<NearHit> nearest(const Geometry& geometry, const Pose& pose, float maxDistance,
                               const QueryFilter& filter = {}) const;
  NearHit nearestClosest(const Geometry& geometry, const Pose& pose, float maxDistance,
                         const QueryFilter& filter = {}) const;  ///< shape is null if there is none
  /// Shapes that hold a point, surface included, ascending. Never a Mesh; a HeightField as for overlaps.
  std::vector<ShapeId> containing(Vec3d point, const QueryFilter& filter = {}) const;
  void raysClosest(std::span<const Ray> rays, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  void raysAny(std::span<const Ray> rays, std::span<uint8_t> out, const QueryFilter& filter = {}) const;  ///< 1 or 0
  void castsClosest(std::span<const ShapeCast> casts, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  void overlapTests(std::span<const PlacedGeometry> placed, std::span<uint8_t> out,
                    const QueryFilter& filter = {}) const;  ///< 1 or 0
  /// nearestClosest() of each.
  void nearestOfEach(std::span<const PlacedGeometry> placed, float maxDistance, std::span<NearHit> out,
                     const QueryFilter& filter = {}) const;
  /// 1 where a shape holds the point, as for containing(); else 0.
  void pointTests(std::span<const Vec3d> points, std::span<uint8_t> out, const QueryFilter& filter = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace avbd
