// What is read off a world's state: energy, momenta, joint errors, contacts. In double; nothing here feeds back.
#pragma once

#include "world/world_data.h"

namespace avbd {

double kineticEnergyOf(const BodyData& body);
double totalKineticEnergy(const WorldData& data);
Vec3d totalMomentum(const WorldData& data);
Vec3d totalAngularMomentum(const WorldData& data, Vec3d about);

/// Distance of the anchors [m], or |C| [m^3] of a TetVolume.
double jointGap(const WorldData& data, const JointData& joint);
/// Angle between the two frames of a FixedJoint; 0 of others.
double jointAngleError(const WorldData& data, const JointData& joint);

/// How many points its contact has for the user.
inline int contactPoints(const PairData& pair) {
  return pair.manifold.count > 0 ? pair.manifold.count : pair.gonePoints;
}
/// `head`: the first entry of the pair's run.
Contact contactOf(const WorldData& data, const PairData& pair, const PairData& head);

}  // namespace avbd
