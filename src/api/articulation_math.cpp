// Sines, rotation vectors and their rates (articulation_math.h): + - * / sqrt alone.
#include "api/articulation_math.h"

namespace avbd::articulation {
namespace {

/// 1 - x / (first (first + 1)) + x^2 / (first ... (first + 3)) - ..., of x within 1.
double alternating(double x, int first) {
  double sum = 1;
  for (int k = first + 16; k >= first; k -= 2) sum = 1 - x / (k * (k + 1.0)) * sum;
  return sum;
}

/// Sum over k >= 1 of (-1)^k 2k x^(k - 1) / (2k + first)!, of x within 1.
double slopeSeries(double x, int first) {
  double sum = 0, term = first == 2 ? 0.5 : 1.0 / 6;
  for (int k = 1; k <= 10; ++k, term *= x) {
    term = -term / ((first + 2.0 * k - 1) * (first + 2.0 * k));
    sum += 2 * k * term;
  }
  return sum;
}

}  // namespace

SinCos sinCos(double angle) {
  // A quarter turn in two parts, the first with so few digits that its multiples are exact.
  constexpr double kInverse = 0.63661977236758134308, kHigh = 1.57079632673412561417, kLow = 6.07710050650619224932e-11;
  const double quarters = std::nearbyint(angle * kInverse);
  const double r = (angle - quarters * kHigh) - quarters * kLow, square = r * r;
  const double s = r * alternating(square, 2), c = alternating(square, 1);
  switch (static_cast<int64_t>(quarters) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

Quatd rotationOf(Vec3d v) {
  const double square = dot(v, v), angle = std::sqrt(square);
  // sin(angle / 2) / angle
  const SinCos half = sinCos(0.5 * angle);
  const double k = square < 1e-2 ? 0.5 * alternating(0.25 * square, 2) : half.sin / angle;
  return {half.cos, v.x * k, v.y * k, v.z * k};
}

Vec3d rotationVectorOf(Quatd q) {
  // q and -q are the same turn: the shorter way round.
  if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
  const Vec3d v{q.x, q.y, q.z};
  const double size = length(v);
  if (size < 1e-12) return v * 2;
  return v * (2 * angleOf(q.w, size) / size);
}

TurningFactors turningFactors(Vec3d v) {
  const double square = dot(v, v);
  if (square < 1) {
    return {0.5 * alternating(square, 3), alternating(square, 4) / 6, slopeSeries(square, 2), slopeSeries(square, 3)};
  }
  const double angle = std::sqrt(square);
  const SinCos t = sinCos(angle);
  const double away = 1 - t.cos, lag = angle - t.sin;
  return {away / square, lag / (square * angle), (angle * t.sin - 2 * away) / (square * square),
          (away * angle - 3 * lag) / (square * square * angle)};
}

}  // namespace avbd::articulation
