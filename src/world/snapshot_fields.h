// The fields of what lives between steps, for snapshots (snapshot_codec.h).
//
// Each list binds all members of its struct by name, in their order: a member that is added to a struct and not to its
// list here does not compile ("... names provided"). Add it to both lines. A member that is left out of the second one
// is either coded by hand where the comment says, or is no state.
#pragma once

#include <concepts>
#include <tuple>

#include "world/world_data.h"

namespace avbd {

template <class T, class Of>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Of>;

template <MaybeConst<Material> T>
auto snapshotParts(T& x) {
  auto& [friction, staticFriction, restitution, frictionCombine, restitutionCombine, frictionPriority,
         torsionalFriction, rollingFriction] = x;
  return std::tie(friction, staticFriction, restitution, frictionCombine, restitutionCombine, frictionPriority,
                  torsionalFriction, rollingFriction);
}

template <MaybeConst<Filter> T>
auto snapshotParts(T& x) {
  auto& [category, mask, group, anyMask] = x;
  return std::tie(category, mask, group, anyMask);
}

/// By hand (snapshot_bodies.cpp): last.
template <MaybeConst<BodyData> T>
auto snapshotParts(T& x) {
  auto& [position, rotation, linearVelocity, angularVelocity, last, acceleration, force, torque, center, mass, inertia,
         invInertia, linearDamping, angularDamping, gravityScale, iterations, maxLinearSpeed, maxAngularSpeed, radius,
         minExtent, massScale, firstShape, firstJoint, type, locks, massGiven, continuous, canSleep, asleep, toldAsleep,
         stillTime, soft, sleepIsland, userData] = x;
  return std::tie(position, rotation, linearVelocity, angularVelocity, acceleration, force, torque, center, mass,
                  inertia, invInertia, linearDamping, angularDamping, gravityScale, iterations, maxLinearSpeed,
                  maxAngularSpeed, radius, minExtent, massScale, firstShape, firstJoint, type, locks, massGiven,
                  continuous, canSleep, asleep, toldAsleep, stillTime, soft, sleepIsland, userData);
}

/// By hand (snapshot_shapes.cpp): geometry, and what follows from it; materials.
template <MaybeConst<ShapeData> T>
auto snapshotParts(T& x) {
  auto& [geometry, scaled, geom, local, toMass, material, materials, filter, isTrigger, contactEvents, hitEvents,
         contactHook, density, body, next, proxy, userData] = x;
  return std::tie(local, toMass, material, filter, isTrigger, contactEvents, hitEvents, contactHook, density, body,
                  next, proxy, userData);
}

template <MaybeConst<JointReaction> T>
auto snapshotParts(T& x) {
  auto& [force, torque] = x;
  return std::tie(force, torque);
}

template <MaybeConst<JointBreak> T>
auto snapshotParts(T& x) {
  auto& [force, torque] = x;
  return std::tie(force, torque);
}

template <MaybeConst<JointData> T>
auto snapshotParts(T& x) {
  auto& [type, collideConnected, body, next, frame, anchor, axes, restVolume, stiffness, lambda, reaction, enabled,
         breaks, strained, userData] = x;
  return std::tie(type, collideConnected, body, next, frame, anchor, axes, restVolume, stiffness, lambda, reaction,
                  enabled, breaks, strained, userData);
}

template <MaybeConst<JointMultipliers> T>
auto snapshotParts(T& x) {
  auto& [lock, lower, upper, drive, friction, passive] = x;
  return std::tie(lock, lower, upper, drive, friction, passive);
}

template <MaybeConst<JointLimit> T>
auto snapshotParts(T& x) {
  auto& [lower, upper, stiffness, damping, restitution] = x;
  return std::tie(lower, upper, stiffness, damping, restitution);
}

template <MaybeConst<JointSpring> T>
auto snapshotParts(T& x) {
  auto& [stiffness, damping, position] = x;
  return std::tie(stiffness, damping, position);
}

template <MaybeConst<JointDrive> T>
auto snapshotParts(T& x) {
  auto& [stiffness, damping, position, velocity, maxForce, acceleration, force] = x;
  return std::tie(stiffness, damping, position, velocity, maxForce, acceleration, force);
}

template <MaybeConst<D6Axis> T>
auto snapshotParts(T& x) {
  auto& [motion, limit, drive, friction, spring, armature, maxVelocity] = x;
  return std::tie(motion, limit, drive, friction, spring, armature, maxVelocity);
}

template <MaybeConst<SwingCone> T>
auto snapshotParts(T& x) {
  auto& [y, z, stiffness, damping] = x;
  return std::tie(y, z, stiffness, damping);
}

template <MaybeConst<SlerpDrive> T>
auto snapshotParts(T& x) {
  auto& [stiffness, damping, rotation, velocity, maxForce, acceleration] = x;
  return std::tie(stiffness, damping, rotation, velocity, maxForce, acceleration);
}

template <MaybeConst<D6Data> T>
auto snapshotParts(T& x) {
  auto& [axis, turned, twist, twistKnown, lambda, force, cone, slerp, coneLambda, slerpLambda] = x;
  return std::tie(axis, turned, twist, twistKnown, lambda, force, cone, slerp, coneLambda, slerpLambda);
}

template <MaybeConst<CouplingCurve> T>
auto snapshotParts(T& x) {
  auto& [factor] = x;
  return std::tie(factor);
}

template <MaybeConst<LinkTerm> T>
auto snapshotParts(T& x) {
  auto& [joint, axis, curve] = x;
  return std::tie(joint, axis, curve);
}

/// By hand (snapshot_joints.cpp): terms, family, constants, memory.
template <MaybeConst<LinkData> T>
auto snapshotParts(T& x) {
  auto& [min, max, damping, wheel, ratio, slack, terms, axis, rest, force, lambda, family, bodies, constants, memory] =
      x;
  return std::tie(min, max, damping, wheel, ratio, slack, axis, rest, force, lambda, bodies);
}

template <MaybeConst<LostTouch> T>
auto snapshotParts(T& x) {
  auto& [shape, body, isTrigger, triggerIsA, reports, wasTouching, touched, unwanted, position, normal] = x;
  return std::tie(shape, body, isTrigger, triggerIsA, reports, wasTouching, touched, unwanted, position, normal);
}

template <MaybeConst<SoftTouch> T>
auto snapshotParts(T& x) {
  auto& [kind, sticks, slides, first, firstPart, second, secondPart, normal, lambda, anchor, place] = x;
  return std::tie(kind, sticks, slides, first, firstPart, second, secondPart, normal, lambda, anchor, place);
}

template <MaybeConst<SoftContact> T>
auto snapshotParts(T& x) {
  auto& [kind, first, firstPart, second, secondPart, shape, position, normal, separation, normalForce, frictionForce] =
      x;
  return std::tie(kind, first, firstPart, second, secondPart, shape, position, normal, separation, normalForce,
                  frictionForce);
}

template <MaybeConst<SoftPair> T>
auto snapshotParts(T& x) {
  auto& [key, soft, shape, body, isTrigger, triggerIsA, reports, begins, position, normal] = x;
  return std::tie(key, soft, shape, body, isTrigger, triggerIsA, reports, begins, position, normal);
}

template <MaybeConst<TouchEvent> T>
auto snapshotParts(T& x) {
  auto& [shapeA, shapeB, bodyA, bodyB, position, normal, impulse, softA, softB] = x;
  return std::tie(shapeA, shapeB, bodyA, bodyB, position, normal, impulse, softA, softB);
}

template <MaybeConst<TriggerEvent> T>
auto snapshotParts(T& x) {
  auto& [trigger, visitor, triggerBody, visitorBody, visitorSoft] = x;
  return std::tie(trigger, visitor, triggerBody, visitorBody, visitorSoft);
}

template <MaybeConst<HitEvent> T>
auto snapshotParts(T& x) {
  auto& [shapeA, shapeB, bodyA, bodyB, position, normal, speed, impulse, softA, softB] = x;
  return std::tie(shapeA, shapeB, bodyA, bodyB, position, normal, speed, impulse, softA, softB);
}

template <MaybeConst<BreakEvent> T>
auto snapshotParts(T& x) {
  auto& [joint, reaction] = x;
  return std::tie(joint, reaction);
}

template <MaybeConst<MoveEvent> T>
auto snapshotParts(T& x) {
  auto& [body, pose, userData] = x;
  return std::tie(body, pose, userData);
}

/// No state: the times of the stages, how they are shared, and the width, which is the processor's.
template <MaybeConst<StepReport> T>
auto snapshotParts(T& x) {
  auto& [step, bodies, asleep, pairs, contacts, points, joints, islands, colors, fastBodies, impacts, simdWidth,
         sharedRuns, seconds, sharedSeconds] = x;
  return std::tie(step, bodies, asleep, pairs, contacts, points, joints, islands, colors, fastBodies, impacts);
}

}  // namespace avbd
