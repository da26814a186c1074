// The kernels that go over body rows alone, for kernels.h. Ranges begin and end at multiples of 16. Rows beyond the
// dynamic bodies take no part in the search: their x, r, z, p and products stay 0.

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

/// Calls f(row, mask of the lanes that are dynamic bodies) for N rows at a time, as far as there are such bodies.
template <class F>
AVBD_INLINE void forBodies(const BatchView& v, Slice rows, F&& f) {
  for (uint32_t i = rows.begin; i < rows.end && i < v.bodies; i += N)
    f(i, lane::firstLanes<R>(static_cast<int>(v.bodies - i)));
}

AVBD_INLINE Twist<R> selected(const MaskOf<R>& mask, const Twist<R>& t) { return select(mask, t, zeroTwist<R>()); }

struct MassRow {
  R linear;
  Sym3<R> angular;
};

AVBD_INLINE MassRow loadMass(const float* row) {
  R c[8];
  lane::loadRows<N>(row, 8, c);
  return {c[0], {c[1], c[2], c[3], c[4], c[5], c[6]}};
}

AVBD_INLINE Sym6<R> loadInverse(const BatchView& v, uint32_t i) {
  return v.inverse[i / kTile].load<N>(static_cast<int>(i % kTile));
}

AVBD_INLINE R dotTwists(const Twist<R>& a, const Twist<R>& b) { return dot(a.lin, b.lin) + dot(a.ang, b.ang); }

void beginRows(const BatchView& v, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const MassRow m = loadMass(v.mass + 8 * i);
    const Twist<R> e = lane::loadTwists<N>(v.d + 8 * i) - lane::loadTwists<N>(v.target + 8 * i);
    lane::storeTwists<N>(v.gradient + 8 * i, Twist<R>{e.lin * m.linear, m.angular * e.ang});
    const R o = zero<R>();
    const R c[8] = {m.linear, m.angular.xx, m.angular.yy, m.angular.zz, m.angular.xy, m.angular.xz, m.angular.yz, o};
    lane::storeRows<N>(v.diagonal + 8 * i, 8, c);
    const Sym6<R> block{{m.linear, m.linear, m.linear, o, o, o}, {{o, o, o}, {o, o, o}, {o, o, o}}, m.angular};
    lane::storeSym6<N>(v.hessian + kHessianRow * i, block);
  }
}

void factor(const BatchView& v, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end && i < v.bodies; i += N) {
    const Sym6<R> inv = inverse(lane::loadSym6<N>(v.hessian + kHessianRow * i));
    v.inverse[i / kTile].store<N>(static_cast<int>(i % kTile), inv);
  }
}

void beginSearch(const BatchView& v, Slice rows) {
  const Twist<R> none = zeroTwist<R>();
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const auto bodies = lane::firstLanes<R>(static_cast<int>(v.bodies) - static_cast<int>(i));
    lane::storeTwists<N>(v.r + 8 * i, selected(bodies, -lane::loadTwists<N>(v.gradient + 8 * i)));
    for (float* array : {v.x, v.z, v.p}) lane::storeTwists<N>(array + 8 * i, none);
    lane::store(v.step + i, zero<R>());
    lane::store(v.product + i, zero<R>());
  }
}

AVBD_INLINE void multiplyMass(const BatchView& v, uint32_t i, const Twist<R>& p) {
  const MassRow m = loadMass(v.diagonal + 8 * i);
  lane::storeTwists<N>(v.q + 8 * i, Twist<R>{p.lin * m.linear, m.angular * p.ang});
}

void multiplyRows(const BatchView& v, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) multiplyMass(v, i, lane::loadTwists<N>(v.p + 8 * i));
}

void turnAndMultiply(const BatchView& v, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const auto bodies = lane::firstLanes<R>(static_cast<int>(v.bodies) - static_cast<int>(i));
    const Twist<R> p = selected(
        bodies, lane::loadTwists<N>(v.z + 8 * i) + lane::loadTwists<N>(v.p + 8 * i) * lane::load<R>(v.step + i));
    lane::storeTwists<N>(v.p + 8 * i, p);
    multiplyMass(v, i, p);
  }
}

AVBD_INLINE void storePreconditioned(const BatchView& v, uint32_t i, const MaskOf<R>& bodies, const Twist<R>& r) {
  const Twist<R> z = selected(bodies, loadInverse(v, i) * r);
  lane::storeTwists<N>(v.z + 8 * i, z);
  lane::store(v.product + i, dotTwists(r, z));
}

void precondition(const BatchView& v, Slice rows) {
  forBodies(v, rows, [&](uint32_t i, const MaskOf<R>& bodies) {
    storePreconditioned(v, i, bodies, lane::loadTwists<N>(v.r + 8 * i));
  });
}

void dotRows(const BatchView& v, const float* a, const float* b, Slice rows) {
  forBodies(v, rows, [&](uint32_t i, const MaskOf<R>&) {
    lane::store(v.product + i, dotTwists(lane::loadTwists<N>(a + 8 * i), lane::loadTwists<N>(b + 8 * i)));
  });
}

/// y + s x; y where s is 0, whatever x is.
AVBD_INLINE Twist<R> stepped(const Twist<R>& y, const R& s, const Twist<R>& x) {
  return select(s != 0.0f, y + x * s, y);
}

AVBD_INLINE Twist<R> advanceRows(const BatchView& v, uint32_t i) {
  const R s = lane::load<R>(v.step + i);
  const uint32_t at = 8 * i;
  lane::storeTwists<N>(v.x + at, stepped(lane::loadTwists<N>(v.x + at), s, lane::loadTwists<N>(v.p + at)));
  const Twist<R> r = stepped(lane::loadTwists<N>(v.r + at), -s, lane::loadTwists<N>(v.q + at));
  lane::storeTwists<N>(v.r + at, r);
  return r;
}

void advance(const BatchView& v, Slice rows) {
  forBodies(v, rows, [&](uint32_t i, const MaskOf<R>&) { advanceRows(v, i); });
}

void advanceAndPrecondition(const BatchView& v, Slice rows) {
  forBodies(v, rows,
            [&](uint32_t i, const MaskOf<R>& bodies) { storePreconditioned(v, i, bodies, advanceRows(v, i)); });
}

void moveRows(const BatchView& v, float mostTurn, Slice rows) {
  forBodies(v, rows, [&](uint32_t i, const MaskOf<R>&) {
    const Twist<R> x = lane::loadTwists<N>(v.x + 8 * i);
    const R turn = dot(x.ang, x.ang), most = splat<R>(mostTurn);
    const auto far = turn > most * most;
    const R share = select(far, most / sqrt(select(far, turn, splat<R>(1))), splat<R>(1));
    lane::storeTwists<N>(v.x + 8 * i, x * share);
    lane::storeTwists<N>(v.d + 8 * i, lane::loadTwists<N>(v.d + 8 * i) + x * share);
  });
}

/// Sixteen sums side by side, then halved: the same order at every width.
float sum(const float* a, uint32_t begin, uint32_t end) {
  alignas(64) float sums[16] = {};
  uint32_t i = begin;
  for (; i + 16 <= end; i += 16)
    for (int k = 0; k < 16; k += N) lane::store(sums + k, lane::load<R>(sums + k) + lane::loadUnaligned<R>(a + i + k));
  for (int k = 0; i < end; ++i, ++k) sums[k] += a[i];
  for (int half = 8; half > 0; half /= 2)
    for (int k = 0; k < half; ++k) sums[k] += sums[k + half];
  return sums[0];
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
