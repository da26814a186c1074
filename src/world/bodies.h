// Bodies and their shapes between steps: adding, removing, moving, mass.
#pragma once

#include "world/check.h"
#include "world/world_data.h"

namespace avbd {

// Everything here has been checked before; these functions do not fail.
uint32_t addBody(WorldData& data, const BodyDef& def, const BodyPlan& plan);  ///< returns the slot
void removeBody(WorldData& data, uint32_t slot);
/// Mass, inertia and centre. The body's frame stays where it is and every point of it keeps its velocity.
void setMass(WorldData& data, uint32_t slot, const MassProperties& properties);
/// Teleport of the body's frame.
void moveBody(WorldData& data, uint32_t slot, const Pose& pose);
Pose bodyPose(const BodyData& body);  ///< of the body's frame
/// Sets both velocities, zero along locked axes.
void setVelocityOf(BodyData& body, const Velocity& velocity);
/// The same of a body that may sleep: it wakes, unless it shall go on resting.
void changeVelocity(WorldData& data, uint32_t slot, const Velocity& velocity);
/// Velocity along locked axes becomes zero.
void stopLockedAxes(BodyData& body);
/// Change of the angular velocity by an angular impulse [N m s], locked axes kept.
Vec3 spinFromImpulse(const BodyData& body, Vec3 impulse);
/// Inertia about the centre of mass in world axes times w [kg m^2/s].
Vec3d angularMomentumOf(const BodyData& body);

uint32_t addShape(WorldData& data, uint32_t body, const ShapeDef& shape);  ///< leaves the mass alone; returns the slot
/// Leaves mass and pairs alone: the caller has the pairs forgotten.
void removeShape(WorldData& data, uint32_t slot);
/// Shapes of a body as definitions, oldest first.
std::vector<ShapeDef> shapeDefs(const WorldData& data, uint32_t body);
std::vector<uint32_t> shapeSlots(const WorldData& data, uint32_t body);  ///< oldest first
/// Where all shapes lie about the centre of mass; radius and minExtent of the body.
void placeShapes(WorldData& data, uint32_t body);
/// Bounds of a shape where it is now, with the tree's margin.
Aabb fatBounds(const WorldData& data, const ShapeData& shape);

}  // namespace avbd
