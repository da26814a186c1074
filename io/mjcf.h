// Reads MJCF (MuJoCo's XML) into a world.
//
// Kept as MuJoCo means it: compiler settings, default classes, the body tree with all orientations and frames,
// spheres, capsules, boxes and planes, masses by density, mass, inertial and the compiler's bounds, contype and
// conaffinity, excludes, friction by maximum and priority, ball joints, connect and weld, keyframes, gravity, timestep.
// A body without a free or ball joint is part of its parent's rigid body (static under worldbody): MuJoCo's own meaning
// where it has no joint at all; hinges and slides are welded like this, and noted.
// Left out with a note: other shapes (cylinders and ellipsoids still weigh), tendons, actuators, sensors, composites,
// contact softness, torsional and rolling friction, joint limits and damping. condim 1 is friction 0.
// Anything unknown is noted; anything wrong is refused with its place in the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/file_error.h"
#include "io/model.h"

namespace avbd {

struct MjcfOptions {
  WorldDef world{};  ///< settings of the world; its gravity is replaced by the file's
  /// Keyframe that the bodies start at. Empty: the first one, if the file has any.
  std::string keyframe{};
  bool useKeyframe = true;  ///< false: start as the bodies stand in the file, as MuJoCo does
};

/// Throws FileError: nothing is returned half-made. World axes are the file's: z is up where its gravity says so.
Model readMjcf(const std::filesystem::path& file, const MjcfOptions& options = {});
/// The same from text, which cannot include files.
Model readMjcfText(std::string_view xml, std::string_view nameForMessages, const MjcfOptions& options = {});

}  // namespace avbd
