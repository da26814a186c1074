// An MJCF file as plain data: defaults resolved, angles in radians, poses in the parent's frame, masses computed.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/color.h"
#include "io/file_error.h"
#include "io/mjcf_flexcomp.h"
#include "io/mjcf_math.h"
#include "io/probe.h"

namespace avbd::mjcf {

enum class GeomKind { Plane, HeightField, Sphere, Capsule, Ellipsoid, Cylinder, Box, Mesh, Sdf };
enum class JointKind { Free, Ball, Slide, Hinge };

/// Mass about its centre; inertia in the axes of the frame that the owner names.
struct Mass {
  double mass = 0;  ///< [kg]
  Vec3d center;     ///< [m]
  Sym3d inertia;    ///< [kg m^2]
};

/// A mesh after refpos, refquat and scale. Unlike MuJoCo's it is not moved to its inertia frame: geoms are placed the
/// same either way.
struct MeshAsset {
  std::string name, where;
  std::vector<Vec3d> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  Mass solid;            ///< at 1 kg/m^3: its mass is the volume
  Mass shell;            ///< at 1 kg/m^2: its mass is the area
  int mostVertices = 0;  ///< of its hull; 0: no wish
};

struct HeightAsset {
  std::string name, where;
  int rows = 0, columns = 0;   ///< both 0: a kind of file that is not read
  Vec3d radius;                ///< half extents along x and y; z: height of 1
  double base = 0;             ///< solid down to this below 0 [m]
  std::vector<float> heights;  ///< 0 .. 1, row by row towards +y, each towards +x
};

struct Geom {
  std::string name, where;  ///< where: `tower.xml:12: geom "a"`, for messages
  GeomKind kind = GeomKind::Sphere;
  Vec3d size;  ///< radius; radius, half length; or half extents; the rest zero
  Posed pose;  ///< in the body's frame; long shapes lie along z
  double mass = 0;
  bool massKnown = true;  ///< false where the shape is one whose volume this reader cannot compute
  double friction = 1;    ///< sliding
  double torsional = 0.005, rolling = 0.0001;
  int asset = -1;        ///< of Description::meshes or heights
  bool isShell = false;  ///< meshes: mass is that of a surface
  int condim = 3, priority = 0, contype = 1, conaffinity = 1, group = 0;
  std::optional<Color> color;  ///< its own, or its material's
};

struct Joint {
  std::string name, where;
  JointKind kind = JointKind::Hinge;
  Vec3d pos;            ///< in the body's frame
  Vec3d axis{0, 0, 1};  ///< unit, in the body's frame
  double ref = 0;       ///< [rad] or [m] that the pose of the file stands for
  bool limited = false;
  double lower = 0, upper = 0;  ///< of limited ones, in the file's coordinate; ball: upper is the largest turn
  double stiffness = 0, springRef = 0, damping = 0;
  double armature = 0, friction = 0;
  double maxForce = std::numeric_limits<double>::infinity();  ///< of all actuators together
};

/// A place in a body that others refer to.
struct Site {
  std::string where;
  int body = 0;
  Posed pose;      ///< in the body's frame
  ProbeZone zone;  ///< its shape
};

struct Body {
  std::string name, where;
  int parent = 0;  ///< index; the world is body 0 and its own parent
  Posed pose;      ///< in the parent's frame
  std::vector<Joint> joints;
  std::vector<Geom> geoms;
  Mass mass;                          ///< in the body's frame
  std::optional<Quatd> inertialAxes;  ///< of its inertia, where the file tells them: given, or of its only geom
  bool massKnown = true;              ///< false where a geom's mass is not
  bool partsLeftOut = false;          ///< composites and the like, which may have had mass
  bool moves = false;                 ///< it or a body above it has a joint
  bool mocap = false;
  double gravcomp = 0;
  int flex = -1;                  ///< that it is a vertex of and nothing else: its mass moves as a point
  size_t qposAt = 0, qvelAt = 0;  ///< where its joints' coordinates begin in a keyframe
};

struct FlexVertex {
  int body = 0;
  Vec3d at;  ///< in the body's frame
};

/// What stretches between places in bodies: lines, triangles or tetrahedra.
struct Flex {
  std::string name, where;
  int dim = 2;
  double radius = 0.005;
  std::vector<FlexVertex> vertices;
  std::vector<FlexElement> elements;
  double young = 0, poisson = 0;              ///< young 0: it resists nothing
  double damping = 0;                         ///< [s] by which the stiffness is multiplied for the damping
  double thickness = 0;                       ///< of two dimensions; 0: twice the radius
  bool stretches = true, bends = true;        ///< of two dimensions: what young is for
  bool holdsEdges = false;                    ///< an equality keeps the length of each
  double bending = -1;                        ///< [N m] of two dimensions, where it is given as such
  double edgeStiffness = 0, edgeDamping = 0;  ///< of one dimension
  bool touchesItself = true;
  Geom surface;  ///< friction, filter and colour
};

struct Exclude {
  std::string where;
  int bodyA = 0, bodyB = 0;
};

/// Names one geom.
struct GeomRef {
  int body = 0;
  size_t geom = 0;
};

/// Names one joint.
struct JointRef {
  int body = 0;
  size_t joint = 0;
};

struct Pair {
  std::string where;
  GeomRef a, b;
  bool hasFriction = false, hasCondim = false;
  double friction = 1, torsional = 0.005, rolling = 0.0001;
  int condim = 3;
};

enum class EqualityKind { Connect, Weld, Joint, Tendon, Distance };

struct Equality {
  std::string where;
  EqualityKind kind = EqualityKind::Connect;
  bool active = true;
  int bodyA = 0, bodyB = 0;
  Vec3d anchor;  ///< connect: in A's frame; weld: in B's
  bool hasRelative = false;
  Posed relative;                  ///< weld: of B in A's frame, if given; else as the file's poses are
  bool atSites = false;            ///< connect and weld hold these two together, distance keeps them apart
  Posed siteA, siteB;              ///< in A's and B's frame
  double distance = 0;             ///< [m] of the two places
  JointRef jointA, jointB;         ///< Joint: A follows B
  int tendonA = -1, tendonB = -1;  ///< Tendon: A follows B
  bool alone = false;              ///< Joint, Tendon: A is held, there is no B
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};  ///< of B's coordinate from its reference, lowest power first
};

/// One joint of a fixed tendon.
struct TendonTerm {
  JointRef joint;
  double factor = 1;
};

struct Tendon {
  std::string name, where;
  std::vector<TendonTerm> terms;  ///< of a fixed one
  std::vector<int> sites;         ///< of a spatial one
  bool straight = true;           ///< a spatial one that neither wraps around geoms nor runs over pulleys
  bool limited = false;
  double lower = 0, upper = 0;
  double stiffness = 0, damping = 0, friction = 0, armature = 0;
  std::optional<std::array<double, 2>> springLength;  ///< no force between; none: the length at the reference
};

/// An actuator: force = gear (gain control + bias[0] + bias[1] length + bias[2] speed), the bracket within maxForce;
/// length and speed are gear times those of what it moves.
struct Actuation {
  std::string name, where;
  bool leftOut = false;  ///< with a note; it still counts in the controls of keyframes
  JointRef joint;        ///< where it has no tendon
  int tendon = -1;
  double gear = 1, gain = 1;
  std::array<double, 3> bias{0, 0, 0};
  std::optional<std::array<double, 2>> range;  ///< of the control
  double maxForce = std::numeric_limits<double>::infinity();
};

/// A frame that a sensor looks at.
struct SensorFrame {
  int body = 0;
  Posed pose;  ///< in the body's frame
};

/// A sensor that maps to a probe.
struct Sensor {
  std::string name, where;
  ProbeKind kind = ProbeKind::Clock;
  double cutoff = 0;
  JointRef joint;
  int tendon = -1, actuation = -1;
  SensorFrame at;  ///< its body is also that whose subtree is measured
  std::optional<SensorFrame> reference;
  ProbeZone zone;
};

struct Key {
  std::string name, where;
  std::vector<double> qpos, qvel, ctrl;  ///< of the whole model, or empty
};

struct Description {
  std::string name;  ///< of the model; empty where the file gives none
  std::string fileName;
  double dt = 0.002;
  Vec3d gravity{0, 0, -9.81};
  bool contactsOff = false;  ///< only predefined pairs collide, if those
  bool pairsOff = false;
  bool filterParent = true;  ///< a moving parent and its child do not collide
  std::vector<Body> bodies;  ///< parents first, in the order of the file; [0] is the world
  std::vector<Exclude> excludes;
  std::vector<Pair> pairs;
  std::vector<Equality> equalities;
  std::vector<Site> sites;
  std::vector<Tendon> tendons;
  std::vector<Actuation> actuations;
  std::vector<Sensor> sensors;
  std::vector<Flex> flexes;
  Vec3d magneticFlux{0, -0.5, 0};
  std::vector<Key> keys;
  std::vector<MeshAsset> meshes;  ///< of the file; those that no geom uses are empty
  std::vector<HeightAsset> heights;
  size_t nq = 0, nv = 0;
  std::vector<std::string> notes;
};

/// Reads and checks; throws FileError.
Description parseFile(const std::filesystem::path& file);
Description parseText(std::string_view xml, std::string_view nameForMessages);

inline const Joint& jointOf(const Description& description, JointRef ref) {
  return description.bodies[static_cast<size_t>(ref.body)].joints[ref.joint];
}

/// Where a body's frame is before its first joint and after each of them, `before` being the first. q: its joints'
/// coordinates in a keyframe, or null for their references.
std::vector<Posed> posesAlong(const Body& body, const Posed& before, const double* q);

/// World poses of all bodies with the joints at qpos, or as the file has them where qpos is empty.
std::vector<Posed> worldPoses(const Description& description, const std::vector<double>& qpos);

}  // namespace avbd::mjcf
