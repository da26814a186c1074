// Soft bodies between steps: adding, removing, what they are made of.
#pragma once

#include "world/world_data.h"

namespace avbd {

// Everything here has been checked before; these functions do not fail.
/// Makes the particles and their shapes. Returns the slot.
uint32_t addSoft(WorldData& data, const SoftDef& def);
void removeSoft(WorldData& data, uint32_t slot);  ///< with its particles
/// Of each point a quarter of the elements that it is in [kg].
std::vector<float> softMasses(const TetMeshData& mesh, float density);
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
ElementAtRest elementAtRest(const TetMeshData& mesh, size_t tet);

/// Nothing of it moves: its particles rest together or not at all.
inline bool isAsleep(const WorldData& data, const SoftData& soft) { return data.bodies[soft.bodies[0]].asleep; }

}  // namespace avbd
