// Pieces of a decomposition: a part in its hull and how good that is; and joining those that fit one hull.
#pragma once

#include <cmath>

#include "geom/decompose_parts.h"

namespace avbd {

/// A part, or several that were joined, in one hull.
struct Piece {
  SolidPart part;
  std::shared_ptr<const HullData> hull;
  Reach reach;
  bool final = false;  ///< cannot be cut
};

class PieceMaker {
 public:
  PieceMaker(const Solid3& solid, double maxError, int maxVertices);

  const Solid3& solid() const { return solid_; }
  float tolerance() const { return static_cast<float>(maxError_ / 8); }
  double maxError() const { return maxError_; }

  Piece pieceOf(SolidPart part) const;
  Piece joined(const Piece& a, const Piece& b) const;
  /// How bad a piece is: what it reaches out, or leaves out.
  double worst(const Piece& p) const { return std::fmax(p.reach.bound, p.hull->error()); }
  /// Whether cutting need not go on: no farther out than allowed, as far as that can be told.
  bool isGood(const Piece& p) const { return p.reach.bound <= maxError_ || (isCoarse_ && p.reach.found <= maxError_); }

 private:
  const Solid3& solid_;
  double maxError_, slack_;
  int maxVertices_;
  bool isCoarse_;  ///< maxError is less than what bounds tell apart
};

/// Joins the pair whose common hull holds least that is not solid: while it stays good enough, and beyond that while
/// there are too many.
void joinPieces(const PieceMaker& maker, int maxHulls, std::vector<Piece>& pieces);

}  // namespace avbd
