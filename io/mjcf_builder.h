// The builder behind buildModel(): one file for each part of what it makes.
#pragma once

#include <array>
#include <map>
#include <set>

#include "io/mjcf_build.h"
#include "io/mjcf_stages.h"
#include "io/notes.h"

namespace avbd::mjcf {

struct Motion {
  Vec3d linear, angular;  // of the body frame's origin, world axes
};

struct Placed {
  Posed pose;
  Motion motion;
};

/// A coordinate of a hinge or slide as ours; id is null where the joint stands still.
struct Coordinate {
  JointId id{};
  JointAxis axis = JointAxis::Twist;
  double sign = 1, offset = 0;  ///< the file's is sign * ours + offset
  double start = 0;             ///< the file's, where the model starts
};

/// A length of the file that is a sum of coordinates: one joint's, or a fixed tendon's.
struct Length {
  std::vector<CouplingTerm> terms;  ///< of ours
  double constant = 0;              ///< what is to be added to them
  double reference = 0;             ///< where all joints are at their references
  double start = 0;
};

class Builder {
 public:
  Builder(const Description& description, const MjcfOptions& options);
  Model build();

 private:
  using Link = Clusters::Link;

  // mjcf_build.cpp: masses, shapes, bodies
  void noteWelds();
  void gather();
  void stopWithoutMass();
  ShapeDef shapeLike(const Geom& geom) const;
  void addShapes(size_t body);
  void setMoving(BodyDef& def, size_t root, const Mass& mass, const Placed& placed) const;
  void splitMasses(size_t root);
  void addBody(size_t root);
  void addBetween(size_t root);
  std::string whereOf(size_t root, const Error& error) const;
  std::string nameOf(size_t body);
  std::string nameOf(JointRef joint) const;
  std::string once(std::string name);

  // mjcf_build_start.cpp: poses and velocities
  void chooseStart(const MjcfOptions& options);
  void setVelocities();
  std::vector<Motion> motionsAlong(size_t body) const;
  std::vector<Posed> posesAlong(size_t body) const;

  // mjcf_build_joints.cpp
  void addJoints(size_t body);
  void addBallJoint(size_t body);
  void addStage(size_t body, size_t stage, const std::vector<double>& starts);
  JointId addStage(const Body& body, const Stage& stage, D6Joint joint);
  void nameJoints();
  std::vector<double> startsOf(size_t body) const;
  D6Axis axisOf(const Joint& joint, const Coordinate& at) const;
  void setBall(const Joint& joint, D6Joint& out);
  BodyId sideOf(size_t body, size_t stage) const;

  // mjcf_build_links.cpp: equalities and excludes
  void addEquality(const Equality& equality);
  void addHold(const Equality& equality);
  void addWeld(const Equality& equality, BodyId a, BodyId b, const Posed& startA, const Posed& startB);
  void addRelation(const Equality& equality);
  void addExclude(const Exclude& exclude);
  void keep(const Equality& equality, JointId joint);

  // mjcf_build_flex.cpp: what stretches between bodies
  void planFlexes();
  void takePoints(size_t root);
  void addRigidFlexes();
  void addFlexes();
  void addSoft(size_t flex);
  void addPoint(size_t flex, size_t vertex);
  void addPoint(size_t flex, size_t vertex, const ShapeDef& shape);
  void placePoint(size_t flex, size_t vertex, BodyId point);
  void setMoving(size_t flex, size_t vertex, BodyId point);
  SoftMaterial materialOf(const Flex& flex, const SoftMeshData& mesh, double mass);
  ShapeDef pointShape(size_t flex, double radius) const;
  bool isPoint(const FlexVertex& vertex, size_t flex) const {
    return in_.bodies[static_cast<size_t>(vertex.body)].flex == static_cast<int>(flex);
  }
  Vec3d placeOf(const FlexVertex& vertex, const std::vector<Posed>& poses) const;

  // mjcf_build_rope.cpp
  struct Held {
    BodyId id;
    Pose frame;
  };
  Held holderOf(const FlexVertex& vertex) const;
  double momentOfPoint(const Flex& flex) const;
  double restLength(const Flex& flex, size_t a, size_t b) const;
  void addRope(size_t flex);
  void addRods(size_t flex);
  void addRod(size_t flex, size_t vertex, size_t before);
  void addEdge(const Flex& flex, const FlexElement& element);

  // mjcf_build_tendons.cpp
  Length lengthOf(JointRef joint) const;
  Length lengthOf(const Tendon& tendon) const;
  void addTendon(size_t tendon, bool driven);
  void addFixed(size_t tendon, bool driven);
  void addStraight(const Tendon& tendon);
  void addRope(const Tendon& tendon, DistanceJoint joint, const std::array<double, 2>& range);

  // mjcf_build_actuators.cpp
  void addActuators();
  void addActuator(const Actuation& actuation, size_t index);
  void startControls();
  double held(const Actuator& actuator, double position) const;

  // mjcf_build_probes.cpp
  void addProbes();
  void addProbeTree();
  bool aimProbe(const Sensor& sensor, Probe& probe);
  void measureLength(const Sensor& sensor, Probe& probe) const;
  ProbeFrame frameOf(size_t body, const Posed& pose) const;
  ProbeFrame beforeBall(JointRef ball) const;
  std::vector<ProbeFrame> pathOf(const Tendon& tendon) const;
  std::vector<size_t> actuatorsOf(const Sensor& sensor) const;

  Vec3 narrow(Vec3d v, const std::string& where) const;
  size_t rootOf(size_t body) const { return static_cast<size_t>(clusters_.rootOf[body]); }
  Link linkOf(size_t root) const { return clusters_.linkOf[root]; }
  bool isDynamic(size_t root) const { return linkOf(root) != Link::Static && linkOf(root) != Link::Mocap; }
  bool isParticle(size_t root) const { return linkOf(root) == Link::Particle; }
  /// Of a body that moves, by itself or by its user; else null, the world.
  BodyId movingId(size_t root) const { return isDynamic(root) || linkOf(root) == Link::Mocap ? ids_[root] : BodyId{}; }
  /// Pose of a body in the frame of the body that it is part of.
  Posed inRoot(size_t body) const {
    return body == rootOf(body) ? Posed{} : inverse(start_[rootOf(body)]) * start_[body];
  }
  const double* qposOf(const Body& body) const {
    return key_ && !key_->qpos.empty() ? key_->qpos.data() + body.qposAt : nullptr;
  }

  const Description& in_;
  Clusters clusters_;
  const Key* key_ = nullptr;                     // that the bodies start at
  std::vector<Posed> start_;                     // world poses at the start
  std::vector<Posed> rest_;                      // world poses as in the file
  std::vector<Mass> masses_;                     // of dynamic roots, in their frame
  std::vector<Motion> motion_;                   // at the start
  std::vector<BodyDef> defs_;                    // of roots
  std::vector<std::vector<const Geom*>> geoms_;  // of defs_' shapes
  std::vector<BodyId> ids_;                      // of roots
  std::vector<std::vector<Stage>> stages_;       // of jointed roots
  std::vector<std::vector<Mass>> betweenMass_;   // of the bodies between a root's stages, in the root's frame
  std::vector<std::vector<BodyId>> between_;
  std::vector<std::vector<Coordinate>> coordinates_;  // by body and joint
  std::vector<JointId> couplings_;                    // of fixed tendons; null: none was needed
  std::vector<double> actuatorStarts_;                // of model_.actuators: the coordinate in the file's sense
  std::vector<size_t> actuatorControls_;              // of model_.actuators: its place in a keyframe's ctrl
  std::vector<ProbeHold> holds_;                      // of equalities that join bodies
  std::vector<std::vector<double>> pointMass_;        // of in_.flexes, by vertex [kg]; empty of rigid ones
  std::set<std::string> names_;                       // used so far
  Notes notes_;
  GeomShapes shapes_{in_, notes_};
  std::map<std::pair<int, size_t>, PairGroup> pairGroups_;  // by body and geom
  Model model_;
};

double radiusOfPoint(const Flex& flex);  ///< [m] as a ball

inline Quat toQuat(Quatd q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}
inline Pose toPose(const Posed& p) { return {p.position, toQuat(p.rotation)}; }

// What the world refuses is still a fault of the file.
template <class Make>
auto at(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw FileError(where + ": " + error.what());
  }
}

}  // namespace avbd::mjcf
