// Angles and inertias of URDF files.
#pragma once

#include "io/mjcf_math.h"

namespace avbd::urdf {

struct SinCosd {
  double sin = 0, cos = 1;
};
/// Within 1e-15 up to |x| = 100; the same bits on every machine, which the C library does not promise. |x| <= 1e9.
SinCosd sinCos(double x);

/// URDF's rpy [rad]: turns about the fixed axes x, then y, then z.
mjcf::Quatd fromRollPitchYaw(Vec3d rpy);

/// What became of an inertia.
enum class InertiaFault {
  None,
  Unset,     ///< all zero: nothing known
  Repaired,  ///< no body has these moments: the nearest one that has was taken
  Hopeless,  ///< nothing positive in it
};
/// A body's second moments s_i = (sum of I)/2 - I_i cannot be negative: such ones become 1e-3 of the largest, and so do
/// two zero ones. Up to 1 % below zero is taken for the rounding of printed digits and becomes zero without a fault.
InertiaFault repair(mjcf::Sym3d& inertia);

}  // namespace avbd::urdf
