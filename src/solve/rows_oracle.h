// For tests: random instances of every family, its rows as plain numbers, and a double in a real's clothes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "avbd/rows/family.h"
#include "avbd/rows/sinks.h"
#include "lane/formulas.h"

namespace avbd::oracle {

using formulas::Random;
using rows::Family;
using rows::V3;

// ---- A double as the real R ------------------------------------------------------------------------------------

struct PreciseMask {
  bool v;
  friend PreciseMask operator&(PreciseMask a, PreciseMask b) { return {a.v && b.v}; }
  friend PreciseMask operator|(PreciseMask a, PreciseMask b) { return {a.v || b.v}; }
  friend PreciseMask operator!(PreciseMask a) { return {!a.v}; }
};

struct Precise {
  double v;
  Precise() = default;
  Precise(float s) : v(s) {}
  explicit Precise(double s) : v(s) {}
  friend Precise operator+(Precise a, Precise b) { return Precise(a.v + b.v); }
  friend Precise operator-(Precise a, Precise b) { return Precise(a.v - b.v); }
  friend Precise operator*(Precise a, Precise b) { return Precise(a.v * b.v); }
  friend Precise operator/(Precise a, Precise b) { return Precise(a.v / b.v); }
  friend Precise operator-(Precise a) { return Precise(-a.v); }
  friend PreciseMask operator<(Precise a, Precise b) { return {a.v < b.v}; }
  friend PreciseMask operator>(Precise a, Precise b) { return {a.v > b.v}; }
  friend PreciseMask operator<=(Precise a, Precise b) { return {a.v <= b.v}; }
  friend PreciseMask operator>=(Precise a, Precise b) { return {a.v >= b.v}; }
  friend PreciseMask operator==(Precise a, Precise b) { return {a.v == b.v}; }
  friend Precise sqrt(Precise a) { return Precise(std::sqrt(a.v)); }
  friend Precise abs(Precise a) { return Precise(std::fabs(a.v)); }
  friend Precise copySign(Precise a, Precise b) { return Precise(std::copysign(a.v, b.v)); }
  friend Precise min(Precise a, Precise b) { return a.v < b.v ? a : b; }
  friend Precise max(Precise a, Precise b) { return a.v > b.v ? a : b; }
  // The float's way of rounding to an integer counts on 24 bits.
  friend Precise nearest(Precise a) { return Precise(std::nearbyint(a.v)); }
  friend Precise select(PreciseMask mask, Precise a, Precise b) { return mask.v ? a : b; }
};

}  // namespace avbd::oracle

namespace avbd::rows {
template <>
struct Lanes<oracle::Precise> {
  using Mask = oracle::PreciseMask;
  static constexpr int kCount = 1;
};
}  // namespace avbd::rows

namespace avbd::oracle {

template <template <class> class F>
inline constexpr int kFieldCount = sizeof(F<float>) / sizeof(float);

template <template <class> class F>
F<Precise> toPrecise(const F<float>& rows) {
  float from[kFieldCount<F>];
  Precise to[kFieldCount<F>];
  std::memcpy(from, &rows, sizeof(from));
  std::copy(std::begin(from), std::end(from), to);
  F<Precise> result;
  std::memcpy(&result, to, sizeof(to));
  return result;
}

// ---- Random instances ------------------------------------------------------------------------------------------

inline V3<float> randomVector(Random& random, float size) {
  return {random.number(size), random.number(size), random.number(size)};
}
inline rows::Q4<float> randomTurn(Random& random, float angle) { return rows::expQuat(randomVector(random, angle)); }
/// Of any order of magnitude from low to high.
inline float randomSize(Random& random, float low, float high) {
  return low * std::pow(high / low, 0.5f * (random.number() + 1));
}

/// What the laws need to know of a family, beside its rows:
/// - any(): an instance as a step would make it; atRest(): satisfied where nothing moves, without multipliers;
/// - exact(): one whose J is the derivative of C at d = 0 (kExactEverywhere: at any d);
/// - scaleForces(): stiffnesses and multipliers times a factor.
template <template <class> class F>
struct RandomRows;

template <>
struct RandomRows<rows::Contact> {
  using Rows = rows::Contact<float>;
  static constexpr bool kExactEverywhere = true;
  static Rows any(Random& random) {
    Rows c{};
    c.n = rows::normalised(randomVector(random, 1));
    rows::orthonormalBasis(c.n, c.t1, c.t2);
    c.armA = randomVector(random, 1), c.armB = randomVector(random, 1);
    c.loadStiffness = randomSize(random, 50, 500);
    const uint32_t points = 1 + random.bits() % 4;
    for (uint32_t i = 0; i < points; ++i) {
      auto& p = c.point[i];
      p.arm = randomVector(random, 0.5f);
      p.biasN = random.number(0.01f), p.bias1 = random.number(0.01f), p.bias2 = random.number(0.01f);
      p.floorN = randomSize(random, 1e3f, 1e6f), p.floorT = randomSize(random, 1e3f, 1e6f);
      p.mu = std::max(0.0f, random.number(1));
      p.lambdaN = std::max(0.0f, random.number(3000));
      p.lambda1 = random.number(300), p.lambda2 = random.number(300);
    }
    return c;
  }
  static Rows exact(Random& random) { return any(random); }
  /// Some points touch, some are apart.
  static Rows atRest(Random& random) {
    Rows c = any(random);
    for (auto& p : c.point) {
      p.biasN = random.bits() % 2 ? 0.0f : -std::fabs(random.number(0.01f));
      p.bias1 = p.bias2 = p.lambdaN = p.lambda1 = p.lambda2 = 0;
    }
    return c;
  }
  static void scaleForces(Rows& c, float by) {
    for (auto& p : c.point) p.floorN *= by, p.floorT *= by, p.lambdaN *= by, p.lambda1 *= by, p.lambda2 *= by;
  }
};

template <>
struct RandomRows<rows::FullContact> {
  using Rows = rows::FullContact<float>;
  static constexpr bool kExactEverywhere = true;
  static Rows any(Random& random) {
    Rows f{};
    f.contact = RandomRows<rows::Contact>::any(random);
    f.torsional = std::max(0.0f, random.number(0.05f)), f.rolling = std::max(0.0f, random.number(0.05f));
    f.biasTorsion = random.number(0.01f), f.bias1 = random.number(0.01f), f.bias2 = random.number(0.01f);
    f.kTorsion = randomSize(random, 1e2f, 1e5f), f.kRolling = randomSize(random, 1e2f, 1e5f);
    f.lambdaTorsion = random.number(30), f.lambda1 = random.number(30), f.lambda2 = random.number(30);
    f.scaleA = std::fabs(random.number(2)), f.scaleB = random.bits() % 3 ? 1.0f : 0.0f;
    f.hessianA = std::fabs(random.number(2)), f.hessianB = std::fabs(random.number(2));
    return f;
  }
  static Rows exact(Random& random) { return any(random); }
  static Rows atRest(Random& random) {
    Rows f = any(random);
    f.contact = RandomRows<rows::Contact>::atRest(random);
    f.biasTorsion = f.bias1 = f.bias2 = f.lambdaTorsion = f.lambda1 = f.lambda2 = 0;
    return f;
  }
  static void scaleForces(Rows& f, float by) {
    RandomRows<rows::Contact>::scaleForces(f.contact, by);
    f.kTorsion *= by, f.kRolling *= by, f.lambdaTorsion *= by, f.lambda1 *= by, f.lambda2 *= by;
  }
};

template <>
struct RandomRows<rows::BallJoint> {
  using Rows = rows::BallJoint<float>;
  static constexpr bool kExactEverywhere = false;
  static Rows any(Random& random) {
    Rows b{};
    b.rA = randomVector(random, 1), b.rB = randomVector(random, 1), b.bias = randomVector(random, 0.01f);
    b.tau = 0.5f * std::fabs(random.number());
    b.k = randomSize(random, 1e3f, 1e6f);
    b.lambda = randomVector(random, 1000);
    return b;
  }
  static Rows exact(Random& random) { return any(random); }
  static Rows atRest(Random& random) {
    Rows b = any(random);
    b.bias = b.lambda = {0, 0, 0};
    return b;
  }
  static void scaleForces(Rows& b, float by) { b.k *= by, b.lambda *= by; }
};

template <>
struct RandomRows<rows::FixedJoint> {
  using Rows = rows::FixedJoint<float>;
  static constexpr bool kExactEverywhere = false;
  static Rows any(Random& random) {
    Rows f{};
    f.ball = RandomRows<rows::BallJoint>::any(random);
    f.q0 = randomTurn(random, 0.05f);
    f.held = rows::logQuat(f.q0) * 0.95f;
    f.kAngular = randomSize(random, 1e3f, 1e6f);
    f.lambda = randomVector(random, 100);
    return f;
  }
  static Rows exact(Random& random) {
    Rows f = any(random);
    f.q0 = {1, 0, 0, 0};
    f.held = randomVector(random, 0.01f);
    return f;
  }
  static Rows atRest(Random& random) {
    Rows f = any(random);
    f.ball = RandomRows<rows::BallJoint>::atRest(random);
    f.held = rows::logQuat(f.q0);
    f.lambda = {0, 0, 0};
    return f;
  }
  static void scaleForces(Rows& f, float by) {
    RandomRows<rows::BallJoint>::scaleForces(f.ball, by);
    f.kAngular *= by, f.lambda *= by;
  }
};

template <>
struct RandomRows<rows::TetVolume> {
  using Rows = rows::TetVolume<float>;
  static constexpr bool kExactEverywhere = true;
  static Rows any(Random& random) {
    Rows t{};
    t.ab = randomVector(random, 1), t.ac = randomVector(random, 1), t.ad = randomVector(random, 1);
    t.bias = random.number(0.01f);
    t.k = randomSize(random, 1e3f, 1e6f);
    t.s = random.bits() % 2 ? 1 : 0.5f + 0.4f * random.number();
    t.lambda = random.number(1000);
    return t;
  }
  static Rows exact(Random& random) { return any(random); }
  static Rows atRest(Random& random) {
    Rows t = any(random);
    t.bias = 0;
    t.lambda = 0;
    return t;
  }
  static void scaleForces(Rows& t, float by) { t.k *= by, t.lambda *= by; }
  /// Where the blocks stand at the start of the step.
  static void positions(const Rows& t, V3<float> (&x)[4]) { x[0] = {0, 0, 0}, x[1] = t.ab, x[2] = t.ac, x[3] = t.ad; }
};

// ---- Rows as plain numbers -------------------------------------------------------------------------------------

/// Where a row stands in a friction cone.
enum class Cone : uint8_t { Outside, First, Second, Alone };

/// ProbeSink that also keeps what the friction cone lets through.
template <class R, int kMax>
struct ConeProbe : rows::ProbeSink<R, kMax> {
  using Base = rows::ProbeSink<R, kMax>;
  R share[kMax], bound[kMax];
  Cone cone[kMax];
  R emit(const rows::PairRow<R>& one, R& multiplier) {
    keep(this->count, R(1.0f), R(rows::kInfinity), Cone::Outside);
    return Base::emit(one, multiplier);
  }
  R emitCone(const rows::PairRow<R>& r1, const rows::PairRow<R>& r2, R& l1, R& l2, const R& limit) {
    const int first = this->count;
    const R allowed = Base::emitCone(r1, r2, l1, l2, limit);
    keep(first, allowed, limit, Cone::First);
    keep(first + 1, allowed, limit, Cone::Second);
    return allowed;
  }
  R emitBounded(const rows::PairRow<R>& one, R& multiplier, const R& limit) {
    const int at = this->count;
    const R allowed = Base::emitBounded(one, multiplier, limit);
    keep(at, allowed, limit, Cone::Alone);
    return allowed;
  }

 private:
  void keep(int i, R allowed, R limit, Cone place) { share[i] = allowed, bound[i] = limit, cone[i] = place; }
};

inline constexpr int kMaxRows = 15, kMaxUnknowns = 12;

/// Rows of one instance. Unknowns: (lin, ang) of A and of B, or lin of each block.
template <class R>
struct RowList {
  int count = 0, unknowns = 0;
  R C[kMaxRows], k[kMaxRows], force[kMaxRows], lower[kMaxRows], upper[kMaxRows], share[kMaxRows], bound[kMaxRows];
  Cone cone[kMaxRows] = {};
  R* lambda[kMaxRows];
  R J[kMaxRows][kMaxUnknowns];
};

template <class R>
void put(R* to, const V3<R>& v) {
  to[0] = v.x, to[1] = v.y, to[2] = v.z;
}
template <class R>
rows::Twist<R> twistAt(const R* d) {
  return {{d[0], d[1], d[2]}, {d[3], d[4], d[5]}};
}

template <template <class> class F>
inline constexpr bool kIsPair = requires {
  F<float>::kRows;
};

template <template <class> class F, class R>
RowList<R> listPair(F<R>& rows, const R* d) {
  ConeProbe<R, F<R>::kRows> probe;
  rows.rows(twistAt(d), twistAt(d + 6), probe);
  RowList<R> list;
  list.count = probe.count, list.unknowns = 12;
  for (int i = 0; i < probe.count; ++i) {
    const rows::PairRow<R>& row = probe.row[i];
    list.C[i] = row.C, list.k[i] = row.k, list.lower[i] = row.lower, list.upper[i] = row.upper;
    list.share[i] = probe.share[i], list.bound[i] = probe.bound[i], list.cone[i] = probe.cone[i];
    list.lambda[i] = probe.lambda[i];
    list.force[i] = rows::clamp(row.s * *probe.lambda[i] + row.k * row.C, row.lower, row.upper) * probe.share[i];
    put(list.J[i], row.lin);
    put(list.J[i] + 3, cross(probe.armA, row.lin) + row.ang);
    put(list.J[i] + 6, -row.lin);
    put(list.J[i] + 9, -(cross(probe.armB, row.lin) + row.ang));
  }
  return list;
}

template <template <class> class F, class R>
RowList<R> listBlocks(F<R>& rows, const R* d) {
  constexpr int kBlocks = F<R>::kBlocks;
  V3<R> motion[kBlocks];
  for (int i = 0; i < kBlocks; ++i) motion[i] = {d[3 * i], d[3 * i + 1], d[3 * i + 2]};
  rows::BlockProbeSink<R, kBlocks> probe;
  rows.rows(motion, probe);
  RowList<R> list;
  list.count = 1, list.unknowns = 3 * kBlocks;
  list.C[0] = probe.row.C, list.k[0] = probe.row.k, list.lower[0] = probe.row.lower, list.upper[0] = probe.row.upper;
  list.share[0] = R(1.0f), list.bound[0] = R(rows::kInfinity);
  list.lambda[0] = &rows.lambda;
  list.force[0] = rows::clamp(probe.row.s * rows.lambda + probe.row.k * probe.row.C, probe.row.lower, probe.row.upper);
  for (int i = 0; i < kBlocks; ++i) put(list.J[0] + 3 * i, probe.row.lin[i]);
  return list;
}

/// All rows of an instance at the motions d. `lambda` points into the instance.
template <template <class> class F, class R>
RowList<R> listRows(F<R>& rows, const R* d) {
  if constexpr (kIsPair<F>)
    return listPair<F, R>(rows, d);
  else
    return listBlocks<F, R>(rows, d);
}

/// Calls f(Family<F>{}, name) for every family of both lists.
template <class Visitor>
void forEachFamily(Visitor&& f) {
  rows::forEachPairFamily(f);
  rows::forEachBlockFamily(f);
}

}  // namespace avbd::oracle
