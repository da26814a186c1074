// An articulation's links and dofs in one state, in world axes.
#pragma once

#include <avbd/articulation.h>

#include <vector>

#include "api/articulation_math.h"

namespace avbd::articulation {

/// A link. Its spatial vectors are about its own centre of mass; those of its joint are at the pivot.
struct PlacedLink {
  int parent = -1;
  int firstDof = 0, dofCount = 0;
  Posed frame{};       ///< of the body, in the world
  Vec3d center{};      ///< of mass, in the world
  double mass = 0;     ///< [kg]
  SymMat3d inertia{};  ///< about the centre, world axes [kg m^2]
  Vec3d weight{};      ///< [N]
  Vec3d pivot{};       ///< where its dofs turn it, in the world
  Spatial velocity{};  ///< of the centre
  Spatial rate{};      ///< at the pivot: acceleration against the parent that velocities alone make
  Vec3d baseOrigin{};  ///< where parent is -1: what the base turns about, in the world
  Vec3d baseSpin{};    ///< how fast [rad/s]
};

struct PlacedDof {
  Spatial axis;         ///< at the link's pivot: velocity against the parent of the dof's unit velocity
  double armature = 0;  ///< [kg, kg m^2]
  double velocity = 0;  ///< [m/s, rad/s]
};

struct Placed {
  std::vector<PlacedLink> links;
  std::vector<PlacedDof> dofs;
  Vec3d gravity;  ///< [m/s^2]

  /// Dofs of a link and of all that it hangs on, from the link up: visit(index of the dof, its link).
  template <class Visit>
  void eachDofAbove(size_t link, const Visit& visit) const {
    for (int at = static_cast<int>(link); at >= 0; at = links[static_cast<size_t>(at)].parent) {
      const PlacedLink& on = links[static_cast<size_t>(at)];
      for (int i = 0; i < on.dofCount; ++i) visit(static_cast<size_t>(on.firstDof + i), on);
    }
  }
};

/// The state's numbers must be as many as the articulation's.
Placed place(const World& world, const Articulation& tree, const ArticulationState& state);

}  // namespace avbd::articulation
