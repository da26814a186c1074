// Convex decomposition (decompose.h): cut the worst part until all are good, then join what fits one hull.
#include <avbd/decompose.h>
#include <avbd/error.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/format.h"
#include "geom/decompose_parts.h"

namespace avbd {
namespace {

constexpr double kDefaultError = 0.02;  // of the largest extent

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& range) {
  throw Error("DecomposeDef", field, value, range);
}

void checkWithin(const char* field, int value, int low, int high) {
  if (value >= low && value <= high) return;
  refuse(field, toText(value), "must be at least " + toText(low) + " and at most " + toText(high));
}

void checkDef(const DecomposeDef& def) {
  checkWithin("maxHulls", def.maxHulls, 1, 1024);
  checkWithin("resolution", def.resolution, 8, 256);
  checkWithin("maxVerticesPerHull", def.maxVerticesPerHull, 4, 255);
  if (!(def.maxError >= 0) || !(def.maxError <= 1e6f)) {
    refuse("maxError", toText(def.maxError), "must be finite and >= 0 and at most 1e+06");
  }
  for (size_t i = 0; i < def.vertices.size(); ++i) {
    const Vec3 v = def.vertices[i];
    if (!(std::fabs(v.x) <= 1e6f && std::fabs(v.y) <= 1e6f && std::fabs(v.z) <= 1e6f)) {
      refuse("vertices[" + toText(i) + "]", toText(v), "must be finite and at most 1e+06 in size");
    }
  }
  for (size_t i = 0; i < def.triangles.size(); ++i) {
    for (uint32_t v : def.triangles[i]) {
      if (v < def.vertices.size()) continue;
      refuse("triangles[" + toText(i) + "]", toText(v),
             "must be below the number of vertices, " + toText(def.vertices.size()));
    }
  }
}

/// A part, or several that were joined, in one hull.
struct Piece {
  SolidPart part;
  std::shared_ptr<const HullData> hull;
  Reach reach;
  bool final = false;  // cannot be cut
};

class Decomposer {
 public:
  Decomposer(const DecomposeDef& def, const Solid3& solid, double maxError)
      : def_(def), solid_(solid), maxError_(maxError), slack_(std::fmin(solid.grid.cellSize() / 2, maxError / 4)) {}

  std::vector<Piece> run() {
    for (SolidPart& part : wholeParts(solid_)) pieces_.push_back(pieceOf(std::move(part)));
    // More pieces than are allowed in the end: joining finds better sets than cutting alone.
    const size_t limit = static_cast<size_t>(def_.maxHulls) * 2;
    while (pieces_.size() < limit && cutWorst()) {
    }
    joinPieces();
    return std::move(pieces_);
  }

  float tolerance() const { return static_cast<float>(maxError_ / 8); }
  double worst(const Piece& p) const { return std::fmax(p.reach.bound, p.hull->error()); }

 private:
  Piece pieceOf(SolidPart part) const {
    Piece piece;
    piece.hull = hullOfPart(part.points, def_.maxVerticesPerHull, tolerance(), maxError_ / 4);
    piece.reach = reachOf(*piece.hull, solid_, maxError_ / 2, slack_);
    piece.part = std::move(part);
    return piece;
  }

  bool cutWorst() {
    Piece* worstPiece = nullptr;
    for (Piece& p : pieces_) {
      if (p.final || p.reach.bound <= maxError_) continue;
      if (worstPiece == nullptr || p.reach.bound > worstPiece->reach.bound) worstPiece = &p;
    }
    if (worstPiece == nullptr) return false;
    std::vector<SolidPart> parts = cutPart(solid_, worstPiece->part);
    if (parts.size() < 2) {
      worstPiece->final = true;
      return true;
    }
    *worstPiece = pieceOf(std::move(parts[0]));
    for (size_t i = 1; i < parts.size(); ++i) pieces_.push_back(pieceOf(std::move(parts[i])));
    return true;
  }

  Piece joined(const Piece& a, const Piece& b) const {
    SolidPart both;
    both.cells = a.part.cells;
    both.cells.insert(both.cells.end(), b.part.cells.begin(), b.part.cells.end());
    std::sort(both.cells.begin(), both.cells.end(), [](Cell l, Cell r) {
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

  /// Parts that do not touch come last, the nearest of them first.
  double joinCost(const SolidPart& a, const SolidPart& b) const {
    const auto gap = [](int lowA, int highA, int lowB, int highB) { return std::max({0, lowA - highB, lowB - highA}); };
    const int apart = gap(a.low.x, a.high.x, b.low.x, b.high.x) + gap(a.low.y, a.high.y, b.low.y, b.high.y) +
                      gap(a.low.z, a.high.z, b.low.z, b.high.z);
    return apart > 0 ? kRefused * 1e9 * apart : emptiness(solid_, a, b);
  }

  /// Joins the pair whose common hull holds least that is not solid: while it stays good enough, and beyond that while
  /// there are too many.
  void joinPieces() {
    const size_t n = pieces_.size();
    std::vector<std::vector<double>> cost(n, std::vector<double>(n, -1));
    const auto forget = [&](size_t i) {
      for (size_t k = 0; k < cost.size(); ++k) cost[i][k] = cost[k][i] = -1;
    };
    while (pieces_.size() > 1) {
      size_t a = 0, b = 0;
      double least = 1e300;
      for (size_t i = 0; i < pieces_.size(); ++i) {
        for (size_t k = i + 1; k < pieces_.size(); ++k) {
          if (cost[i][k] < 0) cost[i][k] = joinCost(pieces_[i].part, pieces_[k].part);
          if (cost[i][k] < least) least = cost[i][k], a = i, b = k;
        }
      }
      if (least >= kRefused && pieces_.size() <= static_cast<size_t>(def_.maxHulls)) return;
      Piece both = joined(pieces_[a], pieces_[b]);
      const bool good = worst(both) <= std::fmax(maxError_, std::fmax(worst(pieces_[a]), worst(pieces_[b])));
      if (!good && least < kRefused) {
        // Only when nothing good is left, and then the least first.
        cost[a][b] = kRefused * (1 + worst(both));
        continue;
      }
      pieces_[a] = std::move(both);
      pieces_.erase(pieces_.begin() + static_cast<long>(b));
      cost.erase(cost.begin() + static_cast<long>(b));
      for (auto& row : cost) row.erase(row.begin() + static_cast<long>(b));
      forget(a);
    }
  }

  static constexpr double kRefused = 1e30;

  const DecomposeDef& def_;
  const Solid3& solid_;
  double maxError_, slack_;
  std::vector<Piece> pieces_;
};

/// The hull that its own vertices make again, so that vertices and tolerance are all one has to keep of it.
std::shared_ptr<const HullData> settled(std::shared_ptr<const HullData> hull, float tolerance, float& left) {
  for (int round = 0; round < 4; ++round) {
    std::shared_ptr<const HullData> again =
        makeHull({.points = hull->vertices(), .tolerance = tolerance, .maxVertices = 255});
    if (again->contentHash() == hull->contentHash()) return again;
    left += again->error();
    hull = std::move(again);
  }
  return hull;
}

}  // namespace

Decomposition decompose(const DecomposeDef& def) {
  checkDef(def);
  const ClosedSurface surface(def.vertices, def.triangles);
  if (surface.size() == 0) refuse("triangles", toText(def.triangles.size()) + " triangles", "must have area");
  const ClosedSurface::OpenEdges& open = surface.openEdges();
  if (open.count > 0 && !def.seal) {
    refuse("triangles", toText(open.count) + " open edges, first " + open.first,
           "must form a closed surface: each edge of two triangles that agree about the outside (or set seal)");
  }
  if (open.count == 0 && !(surface.volume() > 0)) {
    refuse("triangles", "a volume of " + toText(surface.volume()), "must be anticlockwise seen from outside");
  }
  const VoxelGrid grid(surface, def.resolution, open.count > 0);
  const Solid3 solid{surface, grid};
  const Vec3d size = surface.upper() - surface.lower();
  const double extent = std::fmax(size.x, std::fmax(size.y, size.z));
  const double maxError = def.maxError > 0 ? double{def.maxError} : kDefaultError * extent;
  Decomposer decomposer(def, solid, maxError);
  Decomposition result;
  result.openEdges = open.count;
  result.volume = static_cast<float>(open.count > 0 ? grid.volume() : surface.volume());
  result.tolerance = decomposer.tolerance();
  for (const Piece& piece : decomposer.run()) {
    const Reach reach = reachOf(*piece.hull, solid, 0, grid.cellSize() / 2);
    const double bound = std::fmin(reach.bound, piece.reach.bound);
    const double found = std::fmax(reach.found, piece.reach.found);
    float left = piece.hull->error();
    result.hulls.push_back(settled(piece.hull, result.tolerance, left));
    result.error = std::fmax(result.error, std::fmax(static_cast<float>(bound), left));
    result.errorFound = std::fmax(result.errorFound, std::fmax(static_cast<float>(found), left));
  }
  return result;
}

}  // namespace avbd
