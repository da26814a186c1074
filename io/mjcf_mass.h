// Masses of MJCF geoms and bodies by MuJoCo's rules.
#pragma once

#include <span>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

/// Volume [m^3] of a solid; 0 for planes and for shapes that only a mesh describes.
double volume(GeomKind kind, Vec3d size);
/// Inertia of the uniform solid of mass 1 about its centre, in the geom's axes.
Sym3d unitInertia(GeomKind kind, Vec3d size);
/// Of a geom, in its body's frame; `meshes` are those of its description.
Mass massOf(const Geom& geom, std::span<const MeshAsset> meshes);
/// Sum about the common centre.
Mass sum(std::span<const Mass> parts);
/// The same mass seen from the frame that `pose` is given in.
Mass moved(const Mass& mass, const Posed& pose);

}  // namespace avbd::mjcf
