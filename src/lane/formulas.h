// For tests: every formula of avbd/rows/math.h as a function of plain reals, with inputs that reach its corners.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>

#include "avbd/rows/math.h"
#include "lane/wide.h"

namespace avbd::formulas {

using namespace rows;
using namespace lane;

/// xorshift: the same numbers from every compiler and library.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  uint32_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<uint32_t>(state_ >> 32);
  }
  /// Uniform in [-size, size].
  float number(float size = 1) { return (static_cast<float>(bits() >> 8) * (2.0f / 16777215.0f) - 1.0f) * size; }
  /// A number of everyday size, of any size, or a corner of the format.
  float nasty() {
    static constexpr uint32_t kCorner[] = {0,          0x80000000, 0x3f800000, 0xbf800000, 0x7f800000, 0xff800000,
                                           0x7fc00000, 0xffc00000, 1,          0x80000001, 0x007fffff, 0x00800000,
                                           0x7f7fffff, 0xff7fffff, 0x3f000000, 0x40490fdb, 0x3fc90fdb, 0x5f000000};
    switch (bits() % 6) {
      case 0:
        return std::bit_cast<float>(kCorner[bits() % std::size(kCorner)]);
      case 1:
        return std::bit_cast<float>(bits());
      case 2:
        return number(1000);
      default:
        return number(2);
    }
  }

 private:
  uint64_t state_;
};

template <class T, class R>
T take(const R*& in) {
  T value;
  std::memcpy(&value, in, sizeof(T));
  in += sizeof(T) / sizeof(R);
  return value;
}
template <class T, class R>
void give(R*& out, const T& value) {
  std::memcpy(out, &value, sizeof(T));
  out += sizeof(T) / sizeof(R);
}

struct Operators {
  static constexpr int kIn = 3, kOut = 22;
  template <class R>
  static void run(const R* in, R* out) {
    const R a = in[0], b = in[1], c = in[2];
    const R list[kOut] = {a + b,
                          a - b,
                          a * b,
                          a / b,
                          -a,
                          sqrt(a),
                          abs(a),
                          copySign(a, b),
                          min(a, b),
                          max(a, b),
                          a * b + c,
                          a + 1.5f,
                          2.0f - a,
                          a * 3.0f,
                          1.0f / a,
                          clamp(a, b, c),
                          select(a < b, a, c),
                          select(a > b, a, c),
                          select(a <= b, 1.0f, c),
                          select(a >= b, a, 0.0f),
                          select((a == b) | !(a < c), b, c),
                          select((a != b) & (b > c), b, c)};
    std::memcpy(out, list, sizeof(list));
  }
};
struct Trigonometry {
  static constexpr int kIn = 2, kOut = 6;
  template <class R>
  static void run(const R* in, R* out) {
    const SinCos<R> t = sinCos(in[0]);
    const R list[kOut] = {t.sin, t.cos, atan2(in[0], in[1]), acos(in[0]), asin(in[0]), nearest(in[0])};
    std::memcpy(out, list, sizeof(list));
  }
};
struct Vectors {
  static constexpr int kIn = 7, kOut = 22;
  template <class R>
  static void run(const R* in, R* out) {
    const auto a = take<V3<R>>(in), b = take<V3<R>>(in);
    V3<R> t1, t2;
    orthonormalBasis(normalised(a), t1, t2);
    give(out, a + b * in[0] - cross(a, b));
    give(out, normalised(a));
    give(out, t1);
    give(out, t2);
    give(out, select(a.x < b.x, a, b));
    give(out, dot(a, b));
    give(out, length(a));
    V3<R> c = a;
    c += b;
    c *= in[0];
    c -= a;
    give(out, -c);
    give(out, in[0] * lengthSq(a));
    give(out, in[0] * a.y);
  }
};
struct Rotations {
  static constexpr int kIn = 14, kOut = 34;
  template <class R>
  static void run(const R* in, R* out) {
    const auto p = take<Q4<R>>(in), q = take<Q4<R>>(in);
    const auto v = take<V3<R>>(in), w = take<V3<R>>(in);
    give(out, p * conjugate(q));
    give(out, normalised(p));
    give(out, rotate(q, v));
    give(out, expQuat(v));
    give(out, logQuat(p));
    give(out, rotate(expQuat(w), v));
    give(out, toMatrix(q));
    give(out, select(p.w < q.w, p, q));
  }
};
struct Matrices {
  static constexpr int kIn = 18, kOut = 45;
  template <class R>
  static void run(const R* in, R* out) {
    auto s = take<Sym3<R>>(in);
    const auto q = take<Q4<R>>(in);
    const auto v = take<V3<R>>(in), w = take<V3<R>>(in);
    const M33<R> m = toMatrix(q);
    give(out, rotated(s, q));
    give(out, inverse(s));
    give(out, solve3(s, v));
    give(out, inverse(factor(s)));
    give(out, s * w);
    addOuter(s, in[0], v);
    give(out, s);
    give(out, (s + diagonal(w)) * in[1]);
    give(out, (m * transposed(m) + outer(v, w)) * v + mulTransposed(m, w));
    give(out, s - s * in[1]);
  }
};
/// A block as a solver sees one: masses and a few stiff rows. With wild input it is just six-by-six arithmetic.
struct Blocks {
  static constexpr int kIn = 24, kOut = 75;
  template <class R>
  static void run(const R* in, R* out) {
    const auto mass = take<V3<R>>(in);
    const auto a = take<Twist<R>>(in), b = take<Twist<R>>(in), c = take<Twist<R>>(in);
    const auto arm = take<V3<R>>(in);
    Sym6<R> k = zeroSym6<R>();
    k.ll = diagonal(V3<R>{abs(mass.x), abs(mass.x), abs(mass.x)});
    k.aa = diagonal(V3<R>{abs(mass.x), abs(mass.y), abs(mass.z)});
    addOuter(k, 10.0f, a);
    addOuter(k, 1000.0f, b);
    give(out, k * c);
    const Sym6<R> moved = shifted(k, arm);
    give(out, moved);
    give(out, solve(factor(moved), c));
    give(out, inverse(k + moved * 0.5f));
    give(out, shiftToPoint(a, arm));
    give(out, shiftWrench(b, arm) * dot(a, c));
    Twist<R> sum = a - b;
    sum += c;
    sum -= -a;
    give(out, select(a.lin.x < b.lin.x, sum, zeroTwist<R>()));
    give(out, arm);
  }
};

template <class Visitor>
void forEach(Visitor&& f) {
  f(Operators{}, "operators");
  f(Trigonometry{}, "trigonometry");
  f(Vectors{}, "vectors");
  f(Rotations{}, "rotations");
  f(Matrices{}, "matrices");
  f(Blocks{}, "blocks");
}

}  // namespace avbd::formulas
