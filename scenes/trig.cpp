// Sines by series, in operations that every platform rounds alike.
#include "scenes/trig.h"

#include <cmath>
#include <cstdint>

namespace avbd::scenes {
namespace {

// sum of (-1)^k x^2k / (2k + first)! times first!, |x| <= pi / 4, from the smallest term on
double series(double square, int first) {
  double sum = 1;
  for (int k = 9; k >= 1; --k) sum = 1 - square / ((2.0 * k + first) * (2.0 * k + first - 1)) * sum;
  return sum;
}

// sin(angle + quarter pi / 2)
double shiftedSine(double angle, int64_t quarter) {
  // A quarter turn in two parts, the first with so few digits that its multiples are exact.
  constexpr double kInverse = 0.63661977236758134308, kHigh = 1.57079632673412561417, kLow = 6.07710050650619224932e-11;
  const double quarters = std::nearbyint(angle * kInverse);
  const double r = (angle - quarters * kHigh) - quarters * kLow, square = r * r;
  const auto turn = (static_cast<int64_t>(quarters) + quarter) & 3;
  const double size = turn & 1 ? series(square, 0) : r * series(square, 1);
  return turn & 2 ? -size : size;
}

}  // namespace

double sine(double angle) { return shiftedSine(angle, 0); }
double cosine(double angle) { return shiftedSine(angle, 1); }

}  // namespace avbd::scenes
