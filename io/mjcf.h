// Reads MJCF (MuJoCo's XML) into a world.
//
// Kept as MuJoCo means it: compiler settings, default classes, the body tree with all orientations and frames,
// spheres, capsules, boxes, planes, cylinders, ellipsoids, meshes (their convex hulls collide, as in MuJoCo),
// primitives fitted to meshes, height fields, masses by density, mass, inertial and the compiler's bounds, contype and
// conaffinity, excludes, friction by maximum and priority, all joints with limits, springs, dampers, friction and
// armature, equalities, fixed tendons and spatial ones between two sites, motors and servos, keyframes, gravity,
// timestep, sensors (as probes); flexes, flexcomps and composites, as told below.
// A body without a joint is part of its parent's rigid body (static under worldbody), as in MuJoCo. Several
// joints of one body are one joint of ours where that is the same, else light bodies stand between (mjcf_stages.h).
// condim 1 is friction 0, 4 adds torsional and 6 rolling friction.
// A mesh weighs by its own volume, as in MuJoCo from 2.3 on (2.2 took that of a box of the same inertia); its pyramids
// all count positive unless compiler exactmeshinertia or the mesh's inertia="exact" asks for the exact integral.
// Files of meshes and height fields: an absolute path as it is, others from the model's folder and meshdir (or
// assetdir); `..` may leave the folder, as in MuJoCo; regular files only, at most 256 MiB together. A mesh's file is
// read when a geom first uses it.
// Left out with a note: sdf geoms, height fields from PNG, tendons around geoms and over pulleys, muscles and other
// actuators with states, transmissions to sites and balls, some sensors, skins, composites of type box, cylinder and
// ellipsoid, other elements that make bodies, softness of contacts, limits and equalities. A body that moves and has no
// mass but that of parts left out stands still; contacts, equalities and actuators that name such parts are left out
// too. A flex of three dimensions is a soft body, of two cloth, of one a chain of rods (springs where no equality holds
// its edges). Each vertex of a body that does nothing else is a particle with that body's mass and name; others are
// held by their bodies, which give them their mass. What one body holds wholly is part of it. Edges that an equality
// holds are so stiff that a cloth or solid stretches about 0.1 % by its weight. flexcomp numbers and places points as
// MuJoCo does; a mesh without elements of its own is a shell, or tetrahedra about `origin`. Composites of type rope,
// loop and cable are the bodies and joints that MuJoCo makes of them, particle free points, grid and cloth a cloth.
// Left out of flexes with a note: binary files of GMSH, nodes and dofs between them (each point moves by itself),
// damping of edges and of the material, touching itself. At most 100000 points. Sensors left out with a note: forces of
// limits, ranges of balls, of tendons around geoms or over pulleys, of left-out actuators, of cameras, distances of
// geoms, user, plugin, energies, contact, tactile, insidesite; axes of inertia (objtype body) that the file does not
// tell: of several geoms, a mesh or a fullinertia. noise is not used. A rangefinder sees what can collide. Anything
// unknown is noted; anything wrong is refused with its place in the file.
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
/// Model::probes has what the sensors measure (probes.h).
/// Model::joints has the coordinates of hinges and slides; Model::actuators start with the keyframe's ctrl, or where it
/// gives positions alone, so that servos hold these.
Model readMjcf(const std::filesystem::path& file, const MjcfOptions& options = {});
/// The same from text, which cannot include files.
Model readMjcfText(std::string_view xml, std::string_view nameForMessages, const MjcfOptions& options = {});

}  // namespace avbd
