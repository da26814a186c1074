// Soft bodies between steps: adding, removing, what they are made of.
#pragma once

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

/// The same of cloth: times its thickness [N/m], by plane stress.
Elasticity sheetOf(const SoftMaterial& material);
float bendingOf(const SoftMaterial& material);  ///< [N m]

/// Nothing of it moves: its particles rest together or not at all.
inline bool isAsleep(const WorldData& data, const SoftData& soft) { return data.bodies[soft.bodies[0]].asleep; }

}  // namespace avbd
