// Bounds on what users may give, wide enough for any scene and narrow enough that no product overflows a float.
#pragma once

namespace avbd {

// Lengths and speeds are in units of WorldDef::lengthUnit.
inline constexpr double kMaxPosition = 1e9;
inline constexpr double kMinSize = 1e-6, kMaxSize = 1e6;    ///< of shapes, and distances within a body
inline constexpr double kMinScale = 1e-3, kMaxScale = 1e3;  ///< of shared geometry, per axis and without its sign
inline constexpr double kMaxSpeed = 1e9;                    ///< [1/s]
inline constexpr double kMaxSpin = 1e6;                     ///< [rad/s]
inline constexpr double kMaxAcceleration = 1e6;             ///< [1/s^2]
inline constexpr double kMinUnit = 1e-6, kMaxUnit = 1e6;    ///< of lengthUnit itself

inline constexpr double kMaxSleepTime = 1e6;  ///< [s]

/// [s] Shorter steps would square to nothing in float.
inline constexpr float kMinSubstep = 1e-7f;

inline constexpr double kMinMass = 1e-24, kMaxMass = 1e18;        ///< [kg]
inline constexpr double kMinInertia = 1e-34, kMaxInertia = 1e30;  ///< [kg m^2], of each principal moment
inline constexpr double kMaxDensity = 1e12;                       ///< [kg/m^3]
inline constexpr double kMaxForce = 1e18;                         ///< [N], also of torques and impulses
inline constexpr double kMaxVolume = 1e27;                        ///< [m^3]
inline constexpr double kMaxStiffness = 1e30;
inline constexpr int kMaxIterations = 1000;
inline constexpr double kMaxRate = 1e6;  ///< [1/s] of damping; also of friction and gravityScale, which have no unit

/// How much a sum of two principal moments may fall short of the third: files round their figures.
inline constexpr double kInertiaTolerance = 1e-3;
/// How far from 1 the length of a quaternion may be.
inline constexpr double kQuatTolerance = 1e-3;

/// Shapes lie in the tree with this margin [lengthUnit], so that small motions leave the tree as it is.
inline constexpr float kFatMargin = 0.05f;

}  // namespace avbd
