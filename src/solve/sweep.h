// Primal solver: block Gauss-Seidel. Colour after colour, every body re-evaluates all rows that touch it where the
// others stand now, sums its gradient and 6x6 Hessian, and moves. Bodies of one colour share no row.
//
// Layout. A side is what one body has of a pair. The sides of a body are cut into runs of at most kRunSides; the runs
// of a colour, longest first, are taken sixteen at a time: lanes are runs, and each lane sums its sides one after the
// other before the sum goes to the body. So long lists fill the lanes, and a body with hundreds of contacts does too.
// Constants and multipliers of a pair stand together in a record, a row of floats that both of its sides gather.
#pragma once

#include <vector>

#include "base/aligned.h"
#include "solve/backend.h"

namespace avbd {

inline constexpr uint32_t kRunSides = 8;

/// Floats in the record of a pair.
template <template <class> class Family>
inline constexpr int kRecord = (lane::kFields<Family> + 3) / 4 * 4;

/// Sixteen runs.
struct SideGroup {
  uint32_t first = 0;   ///< of its lanes in SideView::pair
  uint32_t length = 0;  ///< sides of the longest run; 16 lanes each
};

/// All sides of one family.
struct SideView {
  float* records = nullptr;  ///< by lane of the family's tiles; one more, all zero, for lanes that stand for nothing
  uint32_t pairs = 0;        ///< lanes of the tiles
  const SideGroup* group = nullptr;
  const uint32_t* row = nullptr;    ///< 16 a group: body row of the run
  const uint32_t* place = nullptr;  ///< 16 a group: place of that body in its colour
  const uint32_t* pair = nullptr;   ///< by side: record
  const uint32_t* other = nullptr;  ///< by side: row of the pair's other body
  const float* role = nullptr;      ///< by side: 0 this body is the pair's A, 1 its B; of four nodes 0 .. 3
};

enum SideFamily : int { kContactSides, kBallSides, kFixedSides, kFullSides, kTetSides, kSideFamilies };

struct SweepColor {
  uint32_t bodies = 0, places = 0;  ///< places: bodies, up to a multiple of 16
  uint32_t rowBegin = 0;            ///< of SweepView::row
  uint32_t groupBegin[kSideFamilies] = {}, groupEnd[kSideFamilies] = {};
  uint32_t lockedBegin = 0, lockedCount = 0;
};

struct SweepView {
  SideView sides[kSideFamilies];
  const uint32_t* row = nullptr;  ///< by colour and place; the static row where there is no body
};

/// Colours of a batch's dynamic bodies, by body row.
struct Colors {
  const uint32_t* of = nullptr;
  uint32_t count = 0;
};

/// Who is swept when, for one batch; memory is kept between steps.
class SweepPlan {
 public:
  void build(const BatchView& view, const Colors& colors);
  SweepView view();
  const std::vector<SweepColor>& colors() const { return colors_; }
  uint32_t placeOf(uint32_t row) const { return place_[row]; }  ///< of a body in its colour
  /// `view` with the locked bodies of one colour, named by their places.
  BatchView lockedIn(const BatchView& view, const SweepColor& color) const;

 private:
  struct Side {
    uint32_t pair, other, role;
  };
  struct Run {
    uint32_t row, place, first, length;
  };
  struct FamilySides {
    AlignedVector<float> records, role;
    uint32_t pairs = 0;
    std::vector<SideGroup> groups;
    std::vector<uint32_t> row, place, pair, other;
  };
  struct Lanes;

  void placeBodies(const BatchView& view, const Colors& colors);
  void placeLocks(const BatchView& view, const Colors& colors);
  void listSides(const BatchView& view, SideFamily family, const Lanes& lanes);
  void cutRuns(SideFamily family, SweepColor& color);
  void addGroup(const BatchView& view, FamilySides& out, const Run* runs, uint32_t count);

  std::vector<SweepColor> colors_;
  std::vector<uint32_t> row_, place_;  ///< by colour and place; by row
  std::vector<uint32_t> locked_;
  std::vector<uint8_t> locks_;
  FamilySides families_[kSideFamilies];
  std::vector<uint32_t> firstSide_;  ///< by row, while a family is listed
  std::vector<Side> sides_;
  std::vector<Run> runs_, sortedRuns_;
};

/// Runs all outer iterations: d and the multipliers of the batch move to the end of the step.
void solveSweep(const BatchView& view, const Backend& backend, const SolveSettings& settings, const Colors& colors,
                SweepPlan& plan);

}  // namespace avbd
