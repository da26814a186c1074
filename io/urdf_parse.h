// A URDF file as plain data: names resolved to indices, angles in radians, poses in the parent's frame, repairs made.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/color.h"
#include "io/file_error.h"
#include "io/mjcf_math.h"
#include "io/mjcf_parse.h"
#include "io/notes.h"

namespace avbd::urdf {

using mjcf::Mass;
using mjcf::Posed;

enum class ShapeKind { Box, Cylinder, Sphere, Capsule, Mesh };
enum class JointKind { Fixed, Revolute, Continuous, Prismatic, Floating, Planar, Spherical };
const char* nameOf(JointKind kind);

/// A <collision> or <visual>.
struct Shape {
  std::string where, place;  ///< where: `robot.urdf:12: link "arm" > collision`; place: `robot.urdf:12`
  int line = 0;
  ShapeKind kind = ShapeKind::Sphere;
  Vec3d size;        ///< half extents; radius and half length (along z, a capsule's without its ends); the rest zero
  Posed pose;        ///< in the link's frame
  std::string mesh;  ///< as the file names it
  Vec3d scale{1, 1, 1};
  std::optional<Color> color;  ///< of a visual's <material>
};

/// Contact of a link, from <contact> or <gazebo>; not set where the file says nothing.
struct Surface {
  std::optional<double> friction, rolling, spinning, restitution;
};

struct Link {
  std::string name, where;
  int line = 0;
  /// In the link's frame. No value: no <inertial>, or a mass of 0. Inertia without a value is to be that of the link's
  /// collisions.
  std::optional<Mass> mass;
  bool inertiaKnown = false;
  std::vector<Shape> collisions, visuals;
  Surface surface;
  int joint = -1;             ///< to its parent; -1 for the root
  std::vector<int> children;  ///< joints below it, in the order of the file
};

struct Limit {
  double lower = 0, upper = 0;  ///< [rad] or [m]; infinite: no bound
  double effort = 0;            ///< [N m] or [N]; 0: no bound
  double velocity = 0;          ///< [rad/s] or [m/s]; 0: no bound
};
/// This joint = multiplier * that joint + offset. That joint mimics none: chains are followed to their end.
struct Mimic {
  int joint = 0;
  double multiplier = 1, offset = 0;
};
struct Safety {
  double softLower = 0, softUpper = 0, kPosition = 0, kVelocity = 0;
};
struct Calibration {
  std::optional<double> rising, falling;
};

struct Joint {
  std::string name, where;
  int line = 0;
  JointKind kind = JointKind::Fixed;
  int parent = 0, child = 0;   ///< links; parent -1: the joint is the anchor, not part of the tree
  Posed pose;                  ///< of the child's frame in the parent's, at position zero
  Vec3d axis{1, 0, 0};         ///< unit, in the joint's (= child's) frame
  std::optional<Limit> limit;  ///< lower and upper bound revolute and prismatic joints only
  double start = 0;            ///< [rad] or [m] position at the start, of joints with one coordinate
  double damping = 0;          ///< [N m s/rad] or [N s/m]
  double friction = 0;         ///< [N m] or [N]
  std::optional<Mimic> mimic;
  std::optional<Safety> safety;
  std::optional<Calibration> calibration;
};

/// What a transmission makes of an actuator's effort: effort of the joint = reduction * that of the actuator.
struct Driven {
  int joint = 0;
  std::string actuator;  ///< its name
  double reduction = 1;  ///< not zero
};
struct Transmission {
  std::string name, type, where;
  std::vector<Driven> driven;
};

/// Holds a link that is not the root at a place in the world: a fixed joint from a world that is not a link.
struct Anchor {
  int link = 0;
  Posed pose;  ///< in the world
};

struct Description {
  std::string name;      ///< of the robot; the file's stem where it gives none
  std::string fileName;  ///< for messages
  std::filesystem::path folder;
  std::vector<Link> links;    ///< in the order of the file
  std::vector<Joint> joints;  ///< in the order of the file
  std::vector<Transmission> transmissions;
  std::optional<Anchor> anchor;
  std::vector<int> order;  ///< links, parents first; [0] is the root
  Notes notes;
};

/// Reads and checks; throws FileError. Mesh files are not touched.
Description parseFile(const std::filesystem::path& file);
Description parseText(std::string_view xml, std::string_view nameForMessages);

/// A revolute, continuous or prismatic joint: its position is one number.
bool hasOneCoordinate(JointKind kind);

/// Poses of all links in the world at the start: the root stands at the origin, or where the anchor holds it.
std::vector<Posed> linkPoses(const Description& description);

}  // namespace avbd::urdf
