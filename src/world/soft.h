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

/// Lame's parameters as the energies of a tetrahedron and of a star take them (rows/solid.h, corotational.h) [Pa].
struct Elasticity {
  float tetMu, tetLambda;
  float starMu, starLambda, starShare;
};
Elasticity elasticityOf(const SoftMaterial& material);
/// Not the same all ways.
inline bool isWoven(const SoftMaterial& material) { return material.weftModulus >= 0 || material.shearModulus >= 0; }
// How many of each a soft body remembers (SoftMemory).
size_t pressuresOf(const SoftMeshData& mesh, const SoftMaterial& material);
size_t tensionsOf(const SoftMeshData& mesh, const SoftMaterial& material);

/// As the energy of a triangle takes them: times the thickness [N/m], by plane stress.
struct SheetElasticity {
  float mu, lambda;
  float warp, weft, shear;  ///< beyond that; 0 where it is not woven
};
SheetElasticity sheetOf(const SoftMaterial& material);
float bendingOf(const SoftMaterial& material);  ///< [N m]

/// Nothing of it moves: its particles rest together or not at all.
inline bool isAsleep(const WorldData& data, const SoftData& soft) { return data.bodies[soft.bodies[0]].asleep; }

}  // namespace avbd
