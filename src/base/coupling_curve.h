// What a coordinate adds to a coupling (avbd/coupling.h), and how fast.
#pragma once

namespace avbd {

struct CouplingCurve {
  float factor[4] = {};  ///< of q, q^2, q^3, q^4

  double value(double q) const { return q * (at(0) + q * (at(1) + q * (at(2) + q * at(3)))); }
  double slope(double q) const { return at(0) + q * (2 * at(1) + q * (3 * at(2) + q * 4 * at(3))); }

 private:
  double at(int i) const { return static_cast<double>(factor[i]); }
};

}  // namespace avbd
