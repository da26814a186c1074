// Masses of meshes as MuJoCo computes them, and primitives fitted to meshes.
#pragma once

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

/// At density 1. MuJoCo's default takes each triangle as the base of a pyramid whose tip is the centre of the surface
/// and counts all of them positive, which is right for convex meshes. `exact` counts with signs: right for every closed
/// mesh whose triangles face outwards.
Mass solidMass(const MeshAsset& mesh, bool exact);
/// Of the surface, at 1 kg/m^2.
Mass shellMass(const MeshAsset& mesh);

/// Size and pose of a sphere, capsule, ellipsoid, cylinder or box that stands for a mesh: one of the same inertia, or
/// one around it. geom.pose is the mesh's before and the shape's after.
void fitToInertia(const MeshAsset& mesh, Geom& geom);
void fitAround(const MeshAsset& mesh, Geom& geom);

}  // namespace avbd::mjcf
