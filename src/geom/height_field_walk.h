// Cells of a height field near a box or along its way, by the pyramid of ranges; all in the unscaled frame.
#pragma once

#include "geom/height_field_parts.h"
#include "geom/mesh_tree.h"

namespace avbd {

/// Calls f(column, row) for the closed cells whose bounds overlap the box, until it returns false.
template <class F>
class CellsInBox {
 public:
  CellsInBox(const HeightFieldData::Parts& parts, const Aabb& box, F& f) : parts_(parts), box_(box), f_(f) {
    first_[0] = cellAt(box.lower.x, parts.x(0), parts.spacingX, parts.cellColumns(), -1);
    last_[0] = cellAt(box.upper.x, parts.x(0), parts.spacingX, parts.cellColumns(), 1);
    first_[1] = cellAt(box.lower.z, parts.z(0), parts.spacingZ, parts.cellRows(), -1);
    last_[1] = cellAt(box.upper.z, parts.z(0), parts.spacingZ, parts.cellRows(), 1);
    if (first_[0] > last_[0] || first_[1] > last_[1]) return;
    // The level of which no more than 2 x 2 blocks are touched.
    int level = 0, shift = HeightFieldData::Parts::kBlockShift;
    const int top = static_cast<int>(parts.levels.size()) - 1;
    while (level < top &&
           ((last_[0] >> shift) - (first_[0] >> shift) > 1 || (last_[1] >> shift) - (first_[1] >> shift) > 1)) {
      ++level;
      ++shift;
    }
    for (int r = first_[1] >> shift; r <= last_[1] >> shift; ++r) {
      for (int c = first_[0] >> shift; c <= last_[0] >> shift; ++c) {
        if (!visit(level, shift, c, r)) return;
      }
    }
  }

 private:
  /// The cell that holds a coordinate, one farther out for rounding; beyond the grid: the range becomes empty or is
  /// cut.
  static int cellAt(float x, float start, float spacing, int count, int side) {
    const float k = (x - start) / spacing;
    if (side < 0) {
      if (!(k > 0)) return 0;
      if (k >= static_cast<float>(count) + 1) return count;
      const int cell = static_cast<int>(k);
      return cell > 0 ? cell - 1 : 0;
    }
    if (!(k > -1)) return -1;
    if (k >= static_cast<float>(count)) return count - 1;
    const int cell = static_cast<int>(k > 0 ? k : 0);
    return cell + 1 < count ? cell + 1 : count - 1;
  }

  bool visit(int level, int shift, int column, int row) {
    const HeightFieldData::Parts::Level& l = parts_.levels[static_cast<size_t>(level)];
    const auto& block =
        l.blocks[static_cast<size_t>(row) * static_cast<size_t>(l.columns) + static_cast<size_t>(column)];
    if (!(block.low <= box_.upper.y && block.high >= box_.lower.y)) return true;
    if (level == 0) return cells(column << shift, row << shift);
    for (int r = 2 * row; r <= 2 * row + 1; ++r) {
      for (int c = 2 * column; c <= 2 * column + 1; ++c) {
        const int s = shift - 1;
        if (c > last_[0] >> s || c < first_[0] >> s || r > last_[1] >> s || r < first_[1] >> s) continue;
        if (!visit(level - 1, s, c, r)) return false;
      }
    }
    return true;
  }

  bool cells(int column, int row) {
    constexpr int kSize = 1 << HeightFieldData::Parts::kBlockShift;
    const int c0 = column > first_[0] ? column : first_[0], r0 = row > first_[1] ? row : first_[1];
    const int c1 = column + kSize - 1 < last_[0] ? column + kSize - 1 : last_[0];
    const int r1 = row + kSize - 1 < last_[1] ? row + kSize - 1 : last_[1];
    for (int r = r0; r <= r1; ++r) {
      for (int c = c0; c <= c1; ++c) {
        if (parts_.isClosed(c, r) && !f_(c, r)) return false;
      }
    }
    return true;
  }

  const HeightFieldData::Parts& parts_;
  const Aabb box_;
  F& f_;
  int first_[2], last_[2];
};

/// Calls f(column, row, fraction) for the closed cells that a swept box may meet, near blocks first; f returns the
/// fraction left, negative to stop.
template <class F>
class CellsAlong {
 public:
  CellsAlong(const HeightFieldData::Parts& parts, const SweptBox& swept, F& f) : parts_(parts), swept_(swept), f_(f) {
    const int top = static_cast<int>(parts.levels.size()) - 1;
    visit(top, HeightFieldData::Parts::kBlockShift + top, 0, 0);
  }

 private:
  /// False if a block of cells is not met.
  bool meets(int column, int row, int size, float low, float high, float& enter) const {
    const int c1 = column + size < parts_.cellColumns() ? column + size : parts_.cellColumns();
    const int r1 = row + size < parts_.cellRows() ? row + size : parts_.cellRows();
    const float lower[3] = {parts_.x(column), low, parts_.z(row)}, upper[3] = {parts_.x(c1), high, parts_.z(r1)};
    float exit = fraction_;
    enter = 0;
    swept_.meet(lower, upper, enter, exit);
    return enter <= exit;
  }

  void visit(int level, int shift, int column, int row) {
    const HeightFieldData::Parts::Level& l = parts_.levels[static_cast<size_t>(level)];
    if (column >= l.columns || row >= l.rows || fraction_ < 0) return;
    const auto& block =
        l.blocks[static_cast<size_t>(row) * static_cast<size_t>(l.columns) + static_cast<size_t>(column)];
    float enter;
    if (!(block.low <= block.high) || !meets(column << shift, row << shift, 1 << shift, block.low, block.high, enter))
      return;
    const int size = level == 0 ? 1 << shift : 2;
    // Along each axis from where the motion comes: so no block is visited before one that hides it.
    const bool backX = swept_.inverse[0] < 0, backZ = swept_.inverse[2] < 0;
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < size && fraction_ >= 0; ++k) {
        const int c = size * column + (backX ? size - 1 - k : k), r = size * row + (backZ ? size - 1 - i : i);
        if (level > 0) {
          visit(level - 1, shift - 1, c, r);
        } else if (parts_.isClosed(c, r)) {
          cell(c, r);
        }
      }
    }
  }

  void cell(int c, int r) {
    float low = parts_.height(c, r), high = low;
    for (const float h : {parts_.height(c + 1, r), parts_.height(c, r + 1), parts_.height(c + 1, r + 1)}) {
      low = h < low ? h : low;
      high = h > high ? h : high;
    }
    float enter;
    if (meets(c, r, 1, low, high, enter)) fraction_ = f_(c, r, fraction_);
  }

  const HeightFieldData::Parts& parts_;
  const SweptBox& swept_;
  F& f_;
  float fraction_ = 1;
};

}  // namespace avbd
