// What replaces a tetrahedron of the lattice that the surface cuts (lattice.h).
#include <algorithm>

#include "geom/lattice.h"

namespace avbd {

void Stencils::emit(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  out_.push_back(odd_ ? Tet{a, b, d, c} : Tet{a, b, c, d});
}

/// Cutting off a corner of a face leaves two ends of an edge inside and two cuts. Whether the diagonal starts at a, the
/// first end: told by the face alone, so that its two tetrahedra agree. Where one cut is of a long edge, the diagonal
/// ends there: the other way leaves thinner tetrahedra.
bool Stencils::startsAtFirst(uint32_t a, uint32_t b, uint32_t outside) const {
  const bool longA = lattice_.isLong(a, outside), longB = lattice_.isLong(b, outside);
  if (longA != longB) return longB;
  return a < b;
}

void Stencils::add(Tet t) {
  int inside = 0, outside = 0;
  for (const uint32_t p : t) inside += side_[p] > 0, outside += side_[p] < 0;
  if (inside == 0) return;
  odd_ = false;
  if (outside == 0) return emit(t[0], t[1], t[2], t[3]);
  // From inside to outside, by swaps of neighbours.
  for (size_t last = 3; last > 0; --last)
    for (size_t i = 0; i < last; ++i)
      if (side_[t[i]] < side_[t[i + 1]]) std::swap(t[i], t[i + 1]), odd_ = !odd_;
  if (inside == 3) return addThreeInside(t);
  if (inside == 2) return addTwoInside(t, side_[t[2]] < 0);
  const auto other = [&](uint32_t p) { return side_[p] == 0 ? p : cut_(t[0], p); };
  emit(t[0], other(t[1]), other(t[2]), other(t[3]));
}

/// low, high: the triangles of a prism. before[i][k]: the diagonal of the side over i and k starts at low[i]. A side
/// without that is free, and split so that some order of the three exists.
void Stencils::addPrism(const std::array<uint32_t, 3>& low, const std::array<uint32_t, 3>& high,
                        const std::array<std::array<bool, 3>, 3>& before) {
  std::array<uint32_t, 3> order{0, 1, 2};
  bool odd = false;
  for (size_t last = 2; last > 0; --last)
    for (size_t i = 0; i < last; ++i)
      if (before[order[i + 1]][order[i]]) std::swap(order[i], order[i + 1]), odd = !odd;
  const auto [a, b, c] = order;
  const bool kept = odd_;
  odd_ = odd_ != odd;
  emit(low[a], low[b], low[c], high[c]);
  emit(low[a], low[b], high[c], high[b]);
  emit(low[a], high[b], high[c], high[a]);
  odd_ = kept;
}

void Stencils::addThreeInside(const Tet& t) {
  std::array<uint32_t, 3> high;
  std::array<std::array<bool, 3>, 3> before{};
  for (size_t i = 0; i < 3; ++i) {
    high[i] = cut_(t[i], t[3]);
    for (size_t k = 0; k < 3; ++k) before[i][k] = i != k && startsAtFirst(t[i], t[k], t[3]);
  }
  addPrism({t[0], t[1], t[2]}, high, before);
}

/// third: the third corner is outside, not on the surface.
void Stencils::addTwoInside(const Tet& t, bool third) {
  const uint32_t a = t[0], b = t[1], cutA = cut_(a, t[3]), cutB = cut_(b, t[3]);
  const bool startsAtA = startsAtFirst(a, b, t[3]);
  if (!third) {
    if (startsAtA) {
      emit(a, b, t[2], cutB);
      emit(a, cutB, t[2], cutA);
    } else {
      emit(a, b, t[2], cutA);
      emit(cutA, b, t[2], cutB);
    }
    return;
  }
  std::array<std::array<bool, 3>, 3> before{};
  const bool alsoAtA = startsAtFirst(a, b, t[2]);
  before[0][1] = alsoAtA, before[1][0] = !alsoAtA;
  before[0][2] = startsAtA, before[2][0] = !startsAtA;
  // Of the side on the surface: what the other two leave.
  before[1][2] = !alsoAtA && startsAtA;
  before[2][1] = alsoAtA && !startsAtA;
  addPrism({a, cut_(a, t[2]), cutA}, {b, cut_(b, t[2]), cutB}, before);
}

}  // namespace avbd
