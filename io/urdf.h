// Reads URDF (ROS's XML of robots) into a world.
//
// Kept: the tree of links and joints with all origins, inertias, collisions (box, cylinder, sphere, capsule, mesh as
// its convex hull or several), friction of <contact> and of Gazebo's <mu1>, meshes by package://, model://, file:// or
// a path; of joints axis, bounds, effort, velocity, damping, friction and mimic; transmissions as actuators. Links that
// fixed joints join are one body. A robot is held where it starts, by drives within the joints' effort. Real files are
// full of mistakes. A mistake with one reasonable reading is repaired, and a note says so; where a guess would be wrong
// the file is refused with its place. What is repaired or left out stands in docs/manual.md, and for one file in
// Model::notes.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_error.h"
#include "io/model.h"

namespace avbd {

/// What to do with a collision mesh that is missing, of a kind that cannot be read, or without volume.
enum class BadMesh : uint8_t {
  /// FileError. Of a mesh of another kind, such as .dae, there or missing, a sibling .stl, .obj or .msh is read
  /// instead; one that is there without such a sibling is only noted.
  Refuse,
  Note,  ///< leave the collision out with a note
};

struct UrdfOptions {
  WorldDef world{};  ///< settings of the world; its gravity becomes (0, 0, -9.81)
  /// The root link is free to move. False: it stands still, or the link that a fixed joint holds in the world.
  bool floating = false;
  /// Joints are free to move and actuators are forces. False: critically damped drives of 20 Hz hold each joint
  /// where it starts, and actuators of joints without transmission take a position.
  bool limp = false;
  /// Puts the surface of a static half space (body "ground") this far [m] below the robot's lowest point. Finite, >= 0.
  std::optional<double> ground{};
  std::map<std::string, std::filesystem::path> packages{};  ///< folder of a package
  std::vector<std::filesystem::path> packagePaths{};        ///< folders that hold packages, or are packages
  BadMesh badMesh = BadMesh::Refuse;
  bool decompose = false;             ///< a mesh becomes several convex hulls that follow it, not one around it
  std::filesystem::path hullCache{};  ///< folder that keeps what decompose made (hull_cache.h); empty: none
  bool collideVisuals = false;        ///< links without <collision> collide as their <visual> looks
  /// Links collide with each other, but for those that a joint joins and those that overlap at the start.
  bool selfCollision = true;
};

/// Throws FileError: nothing is returned half-made. The world's z is up; a body's frame is that of its first link,
/// whose name it has. Model::dt is 1/240 s where there are joints. Joints start at 0, or at the bound nearest to it.
/// Model::joints has the coordinates by the joints' names, a planar joint's as NAME/x, NAME/y and NAME/theta.
/// Model::actuators has those of transmissions, which are forces, then one for each coordinate that has no transmission
/// and follows no other.
Model readUrdf(const std::filesystem::path& file, const UrdfOptions& options = {});
/// The same from text. Relative mesh paths are then those of the working folder.
Model readUrdfText(std::string_view xml, std::string_view nameForMessages, const UrdfOptions& options = {});

}  // namespace avbd
