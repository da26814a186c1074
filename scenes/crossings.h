// Whether surfaces of soft bodies pass through each other, themselves or shapes: counted without the engine's own
// detection, in double, over all features.
#pragma once

#include <avbd/world.h>

#include <memory>
#include <span>
#include <vector>

namespace avbd::scenes {

/// A mesh and where its points are.
struct PlacedMesh {
  std::shared_ptr<const SoftMeshData> mesh;
  std::vector<Vec3d> points;
};
/// Edges of soft bodies that pass through faces of soft bodies which do not hold their ends.
int crossings(const World& world);
int crossings(std::span<const PlacedMesh> meshes);

/// Signed distance of a point from a shape: less than 0 inside.
struct Solid {
  Pose pose;
  Geometry geometry;  ///< Sphere, Box, Capsule or HalfSpace
};
double distanceTo(const Solid& solid, Vec3d point);
/// How deep points along the edges of all soft bodies are in solids [m]; 0: none is inside any.
double deepestInside(const World& world, const std::vector<Solid>& solids);

}  // namespace avbd::scenes
