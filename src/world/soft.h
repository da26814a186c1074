// Soft bodies between steps: adding, removing, what they are made of.
#pragma once

#include <array>

#include "world/world_data.h"

namespace avbd {

// Everything here has been checked before; these functions do not fail.
/// Makes the particles and their shapes. Returns the slot.
uint32_t addSoft(WorldData& data, const SoftDef& def);
void removeSoft(WorldData& data, uint32_t slot);  ///< with its particles
/// Of each point a quarter of the tetrahedra that it is in, a third of the triangles [kg].
std::vector<float> softMasses(const SoftMeshData& mesh, const SoftMaterial& material);
/// A particle does not turn, but a body has an inertia [kg m^2]: that of a ball.
inline float particleInertia(float mass, float radius) { return 0.4f * mass * radius * radius; }
double volumeOf(const WorldData& data, const SoftData& soft);  ///< [m^3] now

/// Lame's parameters as the energy takes them (rows/tet_elastic.h) [Pa].
struct Elasticity {
  float mu, lambda;
};
Elasticity elasticityOf(const SoftMaterial& material);

/// Of an element, for its rows.
struct ElementAtRest {
  Vec3 gb, gc, gd;   ///< gradients of the weights of corners 1 to 3 [1/m]
  float volume = 0;  ///< [m^3]
};
ElementAtRest elementAtRest(const SoftMeshData& mesh, size_t tet);

/// The same of cloth: times its thickness [N/m], by plane stress.
Elasticity sheetOf(const SoftMaterial& material);
float bendingOf(const SoftMaterial& material);  ///< [N m]

struct TriangleAtRest {
  float bx = 0, by = 0, cx = 0, cy = 0;  ///< gradients of the weights of corners 1 and 2, in the plane [1/m]
  float area = 0;                        ///< [m^2]
};
TriangleAtRest triangleAtRest(const SoftMeshData& mesh, size_t triangle);

struct HingeAtRest {
  std::array<float, 4> weight{};
  float areas = 0;  ///< [m^2] of both triangles
};
HingeAtRest hingeAtRest(const SoftMeshData& mesh, size_t hinge);

/// Nothing of it moves: its particles rest together or not at all.
inline bool isAsleep(const WorldData& data, const SoftData& soft) { return data.bodies[soft.bodies[0]].asleep; }

}  // namespace avbd
