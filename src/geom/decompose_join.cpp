// Pieces of a decomposition and joining them (decompose_join.h).
#include "geom/decompose_join.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

namespace avbd {
namespace {

/// What bounds must tell apart at least [parts of the largest extent]: with less, measuring takes too long.
constexpr double kFine = 1.0 / 128;

double extentOf(const ClosedSurface& surface) {
  const Vec3d size = surface.upper() - surface.lower();
  return std::fmax(size.x, std::fmax(size.y, size.z));
}

/// Costs from here on are of pairs that are only joined because there are too many.
constexpr double kRefused = 1e30;

class Joiner {
 public:
  Joiner(const PieceMaker& maker, std::vector<Piece>& pieces)
      : maker_(maker), pieces_(pieces), rows_(pieces.size()), alive_(pieces.size(), true), count_(pieces.size()) {
    for (size_t i = 0; i < rows_.size(); ++i) search(i);
  }

  void run(size_t allowed) {
    while (count_ > 1) {
      size_t a = 0;
      for (size_t i = 1; i < rows_.size(); ++i) {
        if (alive_[i] && rows_[i].least < rows_[a].least) a = i;
      }
      const size_t b = rows_[a].partner;
      if (rows_[a].least >= kRefused && count_ <= allowed) break;
      Piece both = maker_.joined(pieces_[a], pieces_[b]);
      const double allow = std::fmax(maker_.maxError(), std::fmax(maker_.worst(pieces_[a]), maker_.worst(pieces_[b])));
      if (rows_[a].least < kRefused && maker_.worst(both) > allow) {
        // Only when nothing good is left, and then the least first.
        rows_[a].known[b] = kRefused * (1 + maker_.worst(both));
        search(a);
      } else {
        join(a, b, std::move(both));
      }
    }
    size_t kept = 0;
    for (size_t i = 0; i < pieces_.size(); ++i) {
      if (!alive_[i]) continue;
      if (kept != i) pieces_[kept] = std::move(pieces_[i]);
      ++kept;
    }
    pieces_.resize(kept);
  }

 private:
  /// A piece's pairs with those after it.
  struct Row {
    double least = 1e300;  ///< cost of the cheapest, and with whom: the first of equals
    size_t partner = 0;
    std::unordered_map<size_t, double> known;  ///< costs that took work
  };

  double costOf(size_t a, size_t b) {
    const SolidPart &p = pieces_[a].part, &q = pieces_[b].part;
    if (const auto known = rows_[a].known.find(b); known != rows_[a].known.end()) return known->second;
    const auto gap = [](int lowA, int highA, int lowB, int highB) { return std::max({0, lowA - highB, lowB - highA}); };
    const int apart = gap(p.low.x, p.high.x, q.low.x, q.high.x) + gap(p.low.y, p.high.y, q.low.y, q.high.y) +
                      gap(p.low.z, p.high.z, q.low.z, q.high.z);
    // Parts that do not touch come last, the nearest of them first.
    if (apart > 0) return kRefused * 1e9 * apart;
    return rows_[a].known[b] = emptiness(maker_.solid(), p, q);
  }

  void search(size_t i) {
    rows_[i].least = 1e300;
    for (size_t k = i + 1; k < rows_.size(); ++k) {
      if (!alive_[k]) continue;
      const double cost = costOf(i, k);
      if (cost < rows_[i].least) rows_[i].least = cost, rows_[i].partner = k;
    }
  }

  void join(size_t a, size_t b, Piece both) {
    pieces_[a] = std::move(both);
    pieces_[b] = {};
    alive_[b] = false;
    --count_;
    rows_[b] = {};
    rows_[a].known.clear();
    search(a);
    for (size_t i = 0; i < b; ++i) {
      if (!alive_[i] || i == a) continue;
      Row& row = rows_[i];
      row.known.erase(b);
      if (i < a) row.known.erase(a);
      if (row.partner == b || (i < a && row.partner == a)) {
        search(i);
      } else if (i < a) {
        const double cost = costOf(i, a);
        if (cost < row.least || (cost == row.least && a < row.partner)) row.least = cost, row.partner = a;
      }
    }
  }

  const PieceMaker& maker_;
  std::vector<Piece>& pieces_;
  std::vector<Row> rows_;
  std::vector<bool> alive_;
  size_t count_;
};

}  // namespace

PieceMaker::PieceMaker(const Solid3& solid, double maxError, int maxVertices)
    : solid_(solid), maxError_(maxError), maxVertices_(maxVertices) {
  const double cell = solid.grid.cellSize(), fine = kFine * extentOf(solid.surface);
  // Bounds are half of maxError and the slack, or more.
  slack_ = std::fmin(cell / 2, std::fmax(maxError / 4, fine - maxError / 2));
  isCoarse_ = maxError / 2 + slack_ > maxError;
}

Piece PieceMaker::pieceOf(SolidPart part) const {
  Piece piece;
  piece.hull = hullOfPart(part.points, maxVertices_, tolerance(), maxError_ / 4);
  piece.reach = reachOf(*piece.hull, solid_, maxError_ / 2, slack_);
  piece.part = std::move(part);
  return piece;
}

Piece PieceMaker::joined(const Piece& a, const Piece& b) const {
  SolidPart both;
  std::merge(a.part.cells.begin(), a.part.cells.end(), b.part.cells.begin(), b.part.cells.end(),
             std::back_inserter(both.cells), [](Cell l, Cell r) {
               if (l.z != r.z) return l.z < r.z;
               return l.y != r.y ? l.y < r.y : l.x < r.x;
             });
  const Cell &l = a.part.low, &m = b.part.low, &h = a.part.high, &k = b.part.high;
  both.low = {std::min(l.x, m.x), std::min(l.y, m.y), std::min(l.z, m.z)};
  both.high = {std::max(h.x, k.x), std::max(h.y, k.y), std::max(h.z, k.z)};
  both.points = a.part.points;
  both.points.insert(both.points.end(), b.part.points.begin(), b.part.points.end());
  Piece piece = pieceOf(std::move(both));
  piece.final = true;
  return piece;
}

void joinPieces(const PieceMaker& maker, int maxHulls, std::vector<Piece>& pieces) {
  if (pieces.size() < 2) return;
  Joiner(maker, pieces).run(static_cast<size_t>(maxHulls));
}

}  // namespace avbd
