// Masses of URDF links and of the bodies that they make.
#pragma once

#include <avbd/hull.h>

#include <map>
#include <memory>

#include "io/urdf_parse.h"

namespace avbd::urdf {

/// Of links without a mass of their own, where they need one [kg/m^3].
inline constexpr double kDensity = 1000;

/// What a mesh collides as.
using MeshHulls = std::vector<std::shared_ptr<const HullData>>;
/// Hulls of a link's mesh collisions by index; a mesh without any has no volume.
using LinkHulls = std::map<size_t, MeshHulls>;

/// Of all collisions as uniform solids of kDensity, in the link's frame. Where they overlap both count.
Mass massOfCollisions(const Link& link, const LinkHulls& hulls);

/// Fills in the inertia of a link that has a mass but no inertia: that of its collisions scaled to the mass, or of a
/// ball of kDensity where they have no volume.
Mass withInertia(const Link& link, const LinkHulls& hulls);

/// Radius of a ball about the link's centre of mass that holds all its collisions [m]; 0 without any.
double reach(const Link& link, const LinkHulls& hulls);

/// Depth of the shape's lowest point below the origin of the frame that `pose` is given in, along its z: min of z.
double lowest(const Shape& shape, const HullData* hull, const Posed& pose);

}  // namespace avbd::urdf
