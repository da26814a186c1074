// What exists between steps: bodies, shapes, joints, contact pairs. Plain data in vectors, links by slot, so that a
// snapshot is a copy.
#pragma once

#include <avbd/soft.h>
#include <avbd/world.h>

#include <tuple>
#include <vector>

#include "base/coupling_curve.h"
#include "base/handle_pool.h"
#include "geom/shape.h"
#include "geom/tree.h"
#include "world/pair_list.h"

namespace avbd {

struct BodyData {
  Vec3d position;  ///< of the centre of mass
  Quat rotation;   ///< body to world
  Vec3 linearVelocity, angularVelocity;
  Pose last;                    ///< of the centre of mass, where contacts were last looked for
  Vec3 acceleration;            ///< of the centre of mass in the last step
  Vec3 force, torque;           ///< given by the user for the next step
  Vec3 center;                  ///< centre of mass in the body's frame
  float mass = 0;               ///< 0 for static and kinematic
  SymMat3 inertia, invInertia;  ///< about the centre, body axes
  float linearDamping = 0, angularDamping = 0, gravityScale = 1;
  int iterations = 0;  ///< as BodyDef::iterations
  float maxLinearSpeed = 0, maxAngularSpeed = 0;
  float radius = 0;             ///< of a ball about the centre of mass that holds all bounded shapes but triggers
  float minExtent = 0;          ///< smallest half thickness of its convex shapes, triggers left out
  float massScale = 0;          ///< BodyDef.mass: mass that the shapes are scaled to; 0 keeps their densities'
  uint32_t firstShape = kNone;  ///< the newest; ShapeData.next leads to older ones
  uint32_t firstJoint = kNone;  ///< JointData.next[k] leads on, where JointData.body[k] is this body
  BodyType type = BodyType::Dynamic;
  uint8_t locks = 0;
  bool massGiven = false;  ///< massProperties came from the user
  bool continuous = true;  ///< as BodyDef::continuous
  bool canSleep = true;
  /// Not in SleepData::awake: a dynamic body that sleeps, a kinematic one that does not move, a static one.
  bool asleep = false;
  bool toldAsleep = false;       ///< as the events say
  float stillTime = 0;           ///< [s] for which it has been slow, up to WorldDef::sleepTime
  uint32_t soft = kNone;         ///< of a particle: slot of its soft body
  uint32_t sleepIsland = kNone;  ///< of a dynamic body that sleeps: in SleepData::islands
  uint64_t userData = 0;
};

struct ShapeData {
  Geometry geometry;                       ///< as the user gave it; keeps shared geometry alive
  std::shared_ptr<const HullData> scaled;  ///< what geom points to where a Hull has a scale
  ShapeGeom geom;
  Pose local;       ///< in the body's frame
  NearPose toMass;  ///< in the body's axes, relative to its centre of mass
  Material material;
  std::vector<Material> materials;  ///< of a surface's triangles; empty: `material`
  Filter filter;
  bool isTrigger = false, contactEvents = true, hitEvents = false, contactHook = false;
  float density = 0;
  uint32_t body = kNone;
  uint32_t next = kNone;  ///< next shape of the body
  int32_t proxy = -1;     ///< in the tree
  uint64_t userData = 0;
};

struct JointData {
  JointType type = JointType::Ball;
  bool collideConnected = false;
  uint32_t body[4] = {kNone, kNone, kNone, kNone};  ///< slots; kNone is the world
  uint32_t next[4] = {kNone, kNone, kNone, kNone};  ///< next joint of body[k]
  Pose frame[2];                                    ///< as the user gave them
  Vec3 anchor[2];                                   ///< relative to the centre of mass, body axes; of the world: unused
  Quat axes[2];                                     ///< joint frame in the body; of the world: in the world
  float restVolume = 0, stiffness = 0;
  float lambda[6] = {};  ///< multipliers [N, N m] along world axes, of body A; of a pulley and a custom joint by row
  JointReaction reaction;
  bool enabled = true;
  JointBreak breaks;
  bool strained = false;  ///< the last step's reaction was beyond `breaks`
  uint64_t userData = 0;
};

/// Of the rows of one coordinate [N, N m], along it on B.
struct JointMultipliers {
  float lock = 0, lower = 0, upper = 0, drive = 0, friction = 0, passive = 0;
};

/// What a hinge, slider or D6 joint has besides, in the order of its inner coordinates: where only one swing is free,
/// the frames are turned so that it is the twist.
struct D6Data {
  D6Axis axis[6];
  uint8_t turned = 0;  ///< inner axis i is the user's axis (i + turned) mod 3
  float twist = 0;     ///< [rad] at the end of the last step, full turns counted
  bool twistKnown = false;
  JointMultipliers lambda[6];
  float force[6] = {};  ///< given by the user for the next step
  SwingCone cone;
  SlerpDrive slerp;
  float coneLambda = 0;
  Vec3 slerpLambda;  ///< along A's axes
};

/// What a coordinate adds to a coupling.
struct LinkTerm {
  uint32_t joint = kNone;  ///< slot
  JointAxis axis = JointAxis::Twist;
  CouplingCurve curve;
};

/// What a distance joint, pulley, coupling or custom joint has besides.
struct LinkData {
  float min = 0, max = 0, damping = 0;  ///< distance: range; pulley: max is the length
  Vec3d wheel[2];                       ///< pulley, world
  float ratio = 1;
  bool slack = true;
  std::vector<LinkTerm> terms;  ///< coupling
  D6Axis axis;                  ///< of a coupling's coordinate
  double rest = 0;
  float force = 0;  ///< given by the user for the next step
  JointMultipliers lambda;
  std::shared_ptr<const CustomFamily> family;  ///< custom joint
  int bodies = 0;
  std::vector<float> constants, memory;
};

/// What a soft body remembers of the last substep.
struct SoftMemory {
  std::vector<float> pressures;  ///< by point, times the volume of its star [J]; empty: none is augmented
  std::vector<Vec3> tensions;    ///< by triangle: of its limit of strain, warp, weft and shear [J]; empty: it has none
};

struct SoftData {
  std::shared_ptr<const SoftMeshData> mesh;
  SoftMaterial material;
  float radius = 0;
  bool selfContact = true;
  std::vector<uint32_t> bodies;  ///< slots, by point of the mesh
  uint64_t userData = 0;
  SoftMemory memory;
};

/// What touches what, the first behind the second.
enum class TouchKind : uint8_t {
  PointFace,  ///< a point of a soft body, a face of one
  EdgeEdge,   ///< edges of soft bodies
  ShapeFace   ///< a shape of a body, a face of a soft body
};

/// A touch of a surface of a soft body, with what it remembers. Points of soft bodies touch shapes as pairs of theirs.
struct SoftTouch {
  TouchKind kind = TouchKind::PointFace;
  uint8_t sticks = 1;                       ///< it did not slip in the last step
  uint8_t slides = 0;                       ///< steps since it stuck, saturating
  uint32_t first = kNone, firstPart = 0;    ///< slot of the soft body, point or edge; of the shape, 0
  uint32_t second = kNone, secondPart = 0;  ///< slot of the soft body; face or edge in its mesh
  Vec3 normal;                              ///< from the second to the first
  Vec3 lambda;                              ///< [N] of the last substep, on the first: along the normal, and across it
  Vec3 anchor;  ///< where it stuck: weights of the face's corners, or the shares of the edges' ways
  Vec3 place;   ///< of a shape the same, in its body's axes from the centre of mass
  /// By whose it is.
  friend bool operator<(const SoftTouch& a, const SoftTouch& b) {
    return std::tie(a.kind, a.first, a.firstPart, a.second, a.secondPart) <
           std::tie(b.kind, b.first, b.firstPart, b.second, b.secondPart);
  }
};

/// A touch of a surface of a soft body in the last step, as World::contacts() tells it.
struct SoftContact {
  TouchKind kind = TouchKind::PointFace;
  uint32_t first = kNone, firstPart = 0;    ///< as of SoftTouch
  uint32_t second = kNone, secondPart = 0;  ///< likewise
  uint32_t shape[2] = {kNone, kNone};       ///< slots: of the first, of the second; of a soft body the nearest point's
  Vec3d position;                           ///< halfway between the surfaces, when the last substep began
  Vec3 normal;                              ///< from the second to the first
  float separation = 0;                     ///< [m]
  float normalForce = 0;                    ///< [N] mean over the step, as the next
  Vec3 frictionForce;                       ///< [N] on the first
  /// By whose it is, as touches.
  friend bool operator<(const SoftContact& a, const SoftContact& b) {
    return std::tie(a.kind, a.first, a.firstPart, a.second, a.secondPart) <
           std::tie(b.kind, b.first, b.firstPart, b.second, b.secondPart);
  }
};

/// What touched a soft body in the last step, a shape or a soft body, or a trigger that it is in. For events, so that a
/// soft body counts as one thing with all its shapes.
struct SoftPair {
  uint64_t key = 0;  ///< of the two things (soft_contacts.h)
  SoftId soft[2];    ///< A, B; null of what is none
  ShapeId shape[2];  ///< of a soft body the shape of the particle where they pushed each other most
  BodyId body[2];
  bool isTrigger = false, triggerIsA = false;
  bool reports = false;  ///< its begin and end are events
  bool begins = false;   ///< as far as who asks for it knows, it did not touch in the step before
  Vec3d position;        ///< where they pushed most
  Vec3 normal;
};

/// A pair that touched when it left the list: its end is still to be reported, unless it is found again.
struct LostTouch {
  ShapeId shape[2];  ///< A, B
  BodyId body[2];
  bool isTrigger = false, triggerIsA = false, reports = true;
  bool wasTouching = false;  ///< in the last finished step
  bool touched = false;      ///< in the substeps of this step that went before
  bool unwanted = false;     ///< nobody asks for its events any more: its end in any case
  Vec3d position;            ///< of its last point
  Vec3 normal;
};

/// Bodies that fell asleep together. What belongs to them is not in the lists that a step walks.
struct SleepingIsland {
  std::vector<uint32_t> bodies;    ///< slots, ascending; none: not in use
  std::vector<uint32_t> joints;    ///< slots, ascending
  std::vector<uint32_t> supports;  ///< static and kinematic bodies that they touch or are jointed to; slots, ascending
  std::vector<PairData> pairs;     ///< those that have points or touch, ordered by key
};

/// What is awake and what sleeps. A pair or joint is awake if one of its bodies is.
struct SleepData {
  /// Slots, ascending. Those of what has been destroyed or put to sleep stay until the next step: `stale`.
  std::vector<uint32_t> awake;                ///< dynamic bodies that are awake, kinematic ones that move
  std::vector<uint32_t> joints;               ///< joints that are awake
  std::vector<uint32_t> newAwake, newJoints;  ///< to be added to them, in no order
  bool stale = false;
  std::vector<SleepingIsland> islands;  ///< by BodyData::sleepIsland
  std::vector<uint32_t> free;           ///< of the islands: not in use
  std::vector<uint32_t> woken;          ///< of the islands: their bodies are awake, the rest is still here
  std::vector<uint32_t> changed;        ///< slots of bodies whose events are to be found out, in no order
  uint32_t asleep = 0;                  ///< how many dynamic bodies sleep
};

struct WorldData {
  WorldDef def;
  HandlePool<BodyTag> bodyIds;
  HandlePool<ShapeTag> shapeIds;
  HandlePool<JointTag> jointIds;
  HandlePool<SoftTag> softIds;
  std::vector<BodyData> bodies;  ///< by slot
  std::vector<ShapeData> shapes;
  std::vector<JointData> joints;
  std::vector<D6Data> d6;                 ///< by joint slot, up to the highest that needs one
  std::vector<LinkData> links;            ///< likewise
  std::vector<SoftData> softs;            ///< by slot
  std::vector<SoftTouch> softTouches;     ///< of the last substep, ascending
  std::vector<SoftContact> softContacts;  ///< of the last step, ascending
  std::vector<SoftPair> softPairs;        ///< likewise, by key
  std::vector<uint32_t> couplings;        ///< joint slots, ascending
  bool jointForces = false;               ///< some joint was given a force for the next step
  uint32_t breakable = 0;                 ///< how many joints have a bound in `breaks`
  PairList pairs;                         ///< that are awake
  std::vector<uint64_t> excludedPairs;    ///< body slots, low << 32 | high, sorted, each as often as it was excluded
  DynamicTree tree;                       ///< fat bounds of all shapes; user data is the shape's slot
  /// Shapes whose pairs have to be found anew (made, moved by the user, refiltered): slots, ascending, each once.
  std::vector<uint32_t> unpaired;
  /// Shapes whose pairs above are void (moved, refiltered, destroyed): World::step drops them first. Slots likewise.
  std::vector<uint32_t> forgotten;
  bool treeBehind = false;  ///< bodies have moved since the tree was last fitted: a query fits it first
  double time = 0;
  float lastSubstep = 0;  ///< [s]: about how long ago BodyData::last was
  StepReport report;
  std::vector<PointMeans> means;       ///< of the last step, by PairData::mean
  Events events;                       ///< of the last step
  std::vector<LostTouch> lostTouches;  ///< since the last step
  std::function<bool(ContactPlan&)> contactHook;
  uint32_t hookedShapes = 0;  ///< how many shapes have contactHook
  SleepData sleep;
  bool wishesChanged = false;  ///< some shape's contactEvents, hitEvents or contactHook: pairs do not know it yet
};

/// Of a soft body: it does not turn. False of kNone.
inline bool isParticle(const WorldData& data, uint32_t body) {
  return body != kNone && data.bodies[body].soft != kNone;
}

/// False of kNone, the world.
inline bool isDynamic(const WorldData& data, uint32_t body) {
  return body != kNone && data.bodies[body].type == BodyType::Dynamic;
}

}  // namespace avbd
