// The kernels of stars of soft solids (rows/star_elastic.h), for kernels.h. Stars have many points, and not as many as
// each other: sums over a star's points take one point after the other, its three axes at a time, which are the same
// additions in every width; what follows of a sum is done for N stars at once.

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

using StarRow = lane::Wide<4>;
/// Three columns of 3 x 3 matrices, padded.
struct StarColumns {
  alignas(64) float f[N][12];
};

/// Sums of (d - d of the centre) b^T over the points of N stars, d from an array of body rows: a motion that all share
/// is no deformation, to the last bit.
template <class Stars>
AVBD_INLINE Columns<R> sumStars(const Stars& stars, const float* array, uint32_t at) {
  StarColumns sums;
  for (uint32_t l = 0; l < N; ++l) {
    const StarRow center = lane::load<StarRow>(array + size_t(8) * stars.center[at + l]);
    StarRow x = zero<StarRow>(), y = x, z = x;
    for (uint32_t i = stars.begin[at + l]; i < stars.begin[at + l + 1]; ++i) {
      const StarLink& link = stars.link[i];
      const StarRow d = lane::load<StarRow>(array + size_t(8) * link.row) - center;
      x = x + d * link.x;
      y = y + d * link.y;
      z = z + d * link.z;
    }
    lane::store(sums.f[l], x), lane::store(sums.f[l] + 4, y), lane::store(sums.f[l] + 8, z);
  }
  R c[12];
  lane::loadRows<N>(sums.f[0], 12, c);
  return {{c[0], c[1], c[2]}, {c[4], c[5], c[6]}, {c[8], c[9], c[10]}};
}

/// Adds P b to all points of N stars, and to their centres what makes the sum zero.
template <class Stars>
AVBD_INLINE void spreadStars(const Stars& stars, float* array, uint32_t at, const Columns<R>& p) {
  const R o = zero<R>();
  const R c[12] = {p.x.x, p.x.y, p.x.z, o, p.y.x, p.y.y, p.y.z, o, p.z.x, p.z.y, p.z.z, o};
  StarColumns stress;
  lane::storeRows<N>(stress.f[0], 12, c);
  for (uint32_t l = 0; l < N; ++l) {
    const StarRow x = lane::load<StarRow>(stress.f[l]), y = lane::load<StarRow>(stress.f[l] + 4),
                  z = lane::load<StarRow>(stress.f[l] + 8);
    StarRow whole = zero<StarRow>();
    for (uint32_t i = stars.begin[at + l]; i < stars.begin[at + l + 1]; ++i) {
      const StarLink& link = stars.link[i];
      const StarRow force = x * link.x + y * link.y + z * link.z;
      float* row = array + size_t(8) * link.row;
      lane::store(row, lane::load<StarRow>(row) + force);
      whole = whole + force;
    }
    float* row = array + size_t(8) * stars.center[at + l];
    lane::store(row, lane::load<StarRow>(row) - whole);
  }
}

AVBD_INLINE void addStarBlock(const BatchView& v, uint32_t row, const Sym3<float>& m) {
  const float entries[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
  for (int k = 0; k < 6; ++k) v.elementBlocks[size_t(kElementBlock) * row + static_cast<size_t>(k)] += entries[k];
}

template <class Stars>
AVBD_INLINE void addStarBlocks(const BatchView& v, const Stars& stars, uint32_t star) {
  const auto op = stars.op[star / kTile].get(static_cast<int>(star % kTile));
  V3<float> center = zeroV3<float>();
  for (uint32_t i = stars.begin[star]; i < stars.begin[star + 1]; ++i) {
    const StarLink& link = stars.link[i];
    const V3<float> b{link.x, link.y, link.z};
    addStarBlock(v, link.row, solidBlock(op, b));
    center -= b;
  }
  addStarBlock(v, stars.center[star], solidBlock(op, center));
}

template <template <class> class Star, template <class> class Op>
void stampStars(const BatchView& v, const StarTiles<Star, Op>& stars, bool dual, bool blocks) {
  forLanes({0, stars.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Star<R> star = stars.tile[t].template load<N>(o);
    const auto s = star.deformation(sumStars(stars, v.d, at));
    if constexpr (requires { star.pressure; }) {
      if (dual) {
        star.pressure = star.pressureAt(s);
        stars.tile[t].template store<N>(o, star);
      }
    }
    const Op<R> op = star.op(s);
    stars.op[t].template store<N>(o, op);
    spreadStars(stars, v.gradient, at, star.stress(s, op));
    for (uint32_t l = 0; blocks && l < N; ++l) addStarBlocks(v, stars, at + l);
  });
}

void addElementBlocks(const BatchView& v) {
  for (size_t row = 0; row < v.rows; ++row)
    for (size_t k = 0; k < 6; ++k) v.hessian[kHessianRow * row + k] += v.elementBlocks[kElementBlock * row + k];
}

void stampSofts(const BatchView& v, bool dual, ElementBlocks blocks) {
  if (v.elastic.tiles + v.corotational.tiles + v.triangles.tiles + v.bends.tiles == 0) return;
  const bool isNew = blocks == ElementBlocks::New;
  if (isNew) std::fill_n(v.elementBlocks, size_t(kElementBlock) * v.rows, 0.0f);
  if (dual) dualTriangles(v);
  stampElements(v, v.elastic, isNew);
  stampElements(v, v.corotational, isNew);
  stampElements(v, v.triangles, isNew);
  stampElements(v, v.bends, isNew);
  stampStars(v, v.stars, dual, isNew);
  stampStars(v, v.corotationalStars, dual, isNew);
  if (blocks != ElementBlocks::None) addElementBlocks(v);
}

template <class Stars>
void multiplyStars(const BatchView& v, const Stars& stars) {
  forLanes({0, stars.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const Columns<R> d = sumStars(stars, v.p, at);
    spreadStars(stars, v.q, at, stressRate(stars.op[t].template load<N>(o), v.threads, d));
  });
}

void dualStars(const BatchView& v) {
  forLanes({0, v.stars.tiles}, [&](uint32_t t, int o) {
    StarElastic<R> star = v.stars.tile[t].load<N>(o);
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    star.pressure = star.pressureAt(star.deformation(sumStars(v.stars, v.d, at)));
    v.stars.tile[t].store<N>(o, star);
  });
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
