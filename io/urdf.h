// Reads URDF (ROS's XML of robots) into a world.
//
// Kept: the tree of links and joints with all origins, inertias, collisions (box, cylinder, sphere, capsule, mesh as
// its convex hull or several), friction of <contact> and of Gazebo's <mu1>, meshes by package://, model://, file:// or
// a path. Joints are welded at their zero position, except floating and spherical ones: links become one rigid body per
// group. Real files are full of mistakes. A mistake with one reasonable reading is repaired, and a note says so; where
// a guess would be wrong the file is refused with its place. What is repaired or left out stands in docs/manual.md, and
// for one file in Model::notes.
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
  /// instead;
  /// one that is there without such a sibling is only noted.
  Refuse,
  Note,  ///< leave the collision out with a note
};

struct UrdfOptions {
  WorldDef world{};       ///< settings of the world; its gravity becomes (0, 0, -9.81)
  bool floating = false;  ///< the root link is free to move; false: it stands still
  /// Puts the surface of a static half space (body "ground") this far [m] below the robot's lowest point. Finite, >= 0.
  std::optional<double> ground{};
  std::map<std::string, std::filesystem::path> packages{};  ///< folder of a package
  std::vector<std::filesystem::path> packagePaths{};        ///< folders that hold packages, or are packages
  BadMesh badMesh = BadMesh::Refuse;
  bool decompose = false;             ///< a mesh becomes several convex hulls that follow it, not one around it
  std::filesystem::path hullCache{};  ///< folder that keeps what decompose made (hull_cache.h); empty: none
  bool collideVisuals = false;        ///< links without <collision> collide as their <visual> looks
};

/// Throws FileError: nothing is returned half-made. The world's z is up; a body's frame is that of its first link,
/// whose name it has.
Model readUrdf(const std::filesystem::path& file, const UrdfOptions& options = {});
/// The same from text. Relative mesh paths are then those of the working folder.
Model readUrdfText(std::string_view xml, std::string_view nameForMessages, const UrdfOptions& options = {});

}  // namespace avbd
