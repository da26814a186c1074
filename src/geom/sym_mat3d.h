// Symmetric 3x3 matrix in double, for moments and inertias.
#pragma once

namespace avbd {

struct SymMat3d {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

}  // namespace avbd
