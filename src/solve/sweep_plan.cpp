// Plan of a block sweep: places, sides, runs, groups. All orders follow from body rows and lanes alone.
#include <algorithm>

#include "solve/sweep.h"

namespace avbd {

namespace {

uint32_t roundUp(uint32_t n) { return (n + kTile - 1) / kTile * kTile; }

}  // namespace

/// Body rows of a family's lanes, role by role.
struct SweepPlan::Lanes {
  const uint32_t* row[4] = {};
  uint32_t roles = 0, count = 0;
  int fields = 0;
};

void SweepPlan::build(const BatchView& view, const Colors& colors) {
  placeBodies(view, colors);
  placeLocks(view, colors);
  using namespace rows;
  listSides(view, kContactSides,
            {{view.contacts.a, view.contacts.b}, 2, view.contacts.tiles * kTile, kRecord<Contact>});
  listSides(view, kBallSides, {{view.balls.a, view.balls.b}, 2, view.balls.tiles * kTile, kRecord<BallJoint>});
  listSides(view, kFixedSides, {{view.fixed.a, view.fixed.b}, 2, view.fixed.tiles * kTile, kRecord<FixedJoint>});
  listSides(view, kFullSides, {{view.full.a, view.full.b}, 2, view.full.tiles * kTile, kRecord<FullContact>});
  const auto& node = view.tets.node;
  listSides(view, kTetSides, {{node[0], node[1], node[2], node[3]}, 4, view.tets.tiles * kTile, kRecord<TetVolume>});
}

/// Bodies of a colour take places in the order of their rows.
void SweepPlan::placeBodies(const BatchView& view, const Colors& colors) {
  colors_.assign(colors.count, {});
  place_.resize(view.bodies);
  for (uint32_t i = 0; i < view.bodies; ++i) place_[i] = colors_[colors.of[i]].bodies++;
  while (!colors_.empty() && colors_.back().bodies == 0) colors_.pop_back();
  uint32_t begin = 0;
  for (SweepColor& color : colors_) {
    color.rowBegin = begin;
    color.places = roundUp(color.bodies);
    begin += color.places;
  }
  row_.assign(begin, view.bodies);
  for (uint32_t i = 0; i < view.bodies; ++i) row_[colors_[colors.of[i]].rowBegin + place_[i]] = i;
}

void SweepPlan::placeLocks(const BatchView& view, const Colors& colors) {
  locked_.clear(), locks_.clear();
  if (view.lockedCount == 0) return;
  for (uint32_t c = 0; c < colors_.size(); ++c) {
    colors_[c].lockedBegin = static_cast<uint32_t>(locked_.size());
    for (uint32_t i = 0; i < view.lockedCount; ++i) {
      if (colors.of[view.locked[i]] != c) continue;
      locked_.push_back(place_[view.locked[i]]);
      locks_.push_back(view.locks[i]);
    }
    colors_[c].lockedCount = static_cast<uint32_t>(locked_.size()) - colors_[c].lockedBegin;
  }
}

BatchView SweepPlan::lockedIn(const BatchView& view, const SweepColor& color) const {
  BatchView v = view;
  v.locked = locked_.data() + color.lockedBegin;
  v.locks = locks_.data() + color.lockedBegin;
  v.lockedCount = color.lockedCount;
  return v;
}

void SweepPlan::listSides(const BatchView& view, SideFamily family, const Lanes& lanes) {
  FamilySides& out = families_[family];
  out.groups.clear(), out.row.clear(), out.place.clear(), out.pair.clear(), out.other.clear(), out.role.clear();
  out.pairs = lanes.count;
  if (lanes.count == 0) return;
  out.records.assign(size_t(lanes.count + 1) * static_cast<size_t>(lanes.fields), 0.0f);
  firstSide_.assign(view.bodies + 1, 0);
  for (uint32_t role = 0; role < lanes.roles; ++role)
    for (uint32_t i = 0; i < lanes.count; ++i)
      if (lanes.row[role][i] < view.bodies) ++firstSide_[lanes.row[role][i]];
  uint32_t end = 0;
  for (uint32_t& first : firstSide_) first = end += first;
  sides_.resize(end);
  for (uint32_t i = lanes.count; i-- > 0;)
    for (uint32_t role = lanes.roles; role-- > 0;) {
      const uint32_t row = lanes.row[role][i];
      if (row < view.bodies) sides_[--firstSide_[row]] = {i, lanes.row[role ^ 1][i], role};
    }
  for (SweepColor& color : colors_) {
    color.groupBegin[family] = static_cast<uint32_t>(out.groups.size());
    cutRuns(family, color);
    for (uint32_t i = 0; i < sortedRuns_.size(); i += kTile)
      addGroup(view, out, sortedRuns_.data() + i,
               std::min<uint32_t>(kTile, static_cast<uint32_t>(sortedRuns_.size()) - i));
    color.groupEnd[family] = static_cast<uint32_t>(out.groups.size());
  }
}

/// Runs of one colour's bodies, longest first, else in order of places.
void SweepPlan::cutRuns(SideFamily, SweepColor& color) {
  runs_.clear();
  uint32_t before[kRunSides + 1] = {};
  for (uint32_t place = 0; place < color.bodies; ++place) {
    const uint32_t row = row_[color.rowBegin + place];
    for (uint32_t i = firstSide_[row]; i < firstSide_[row + 1]; i += kRunSides) {
      const uint32_t length = std::min(kRunSides, firstSide_[row + 1] - i);
      runs_.push_back({row, place, i, length});
      ++before[length - 1];
    }
  }
  for (uint32_t length = kRunSides; length-- > 0;) before[length] += before[length + 1];
  sortedRuns_.resize(runs_.size());
  for (const Run& run : runs_) sortedRuns_[before[run.length]++] = run;
}

void SweepPlan::addGroup(const BatchView& view, FamilySides& out, const Run* runs, uint32_t count) {
  const uint32_t first = static_cast<uint32_t>(out.pair.size()), length = runs[0].length;
  out.groups.push_back({first, length});
  for (uint32_t lane = 0; lane < kTile; ++lane) {
    out.row.push_back(lane < count ? runs[lane].row : view.bodies);
    out.place.push_back(lane < count ? runs[lane].place : view.rows - 1);  // where no body of a colour stands
  }
  out.pair.resize(first + length * kTile, out.pairs);
  out.other.resize(out.pair.size(), view.bodies);
  out.role.resize(out.pair.size(), 0.0f);
  for (uint32_t lane = 0; lane < count; ++lane)
    for (uint32_t i = 0; i < runs[lane].length; ++i) {
      const Side& side = sides_[runs[lane].first + i];
      const uint32_t at = first + i * kTile + lane;
      out.pair[at] = side.pair, out.other[at] = side.other, out.role[at] = static_cast<float>(side.role);
    }
}

SweepView SweepPlan::view() {
  SweepView v;
  v.row = row_.data();
  for (int f = 0; f < kSideFamilies; ++f) {
    FamilySides& s = families_[f];
    v.sides[f] = {s.records.data(), s.pairs,       s.groups.data(), s.row.data(),
                  s.place.data(),   s.pair.data(), s.other.data(),  s.role.data()};
  }
  return v;
}

}  // namespace avbd
