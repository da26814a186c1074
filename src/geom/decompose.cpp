// Convex decomposition (decompose.h): cut the worst part until all are good, then join what fits one hull.
#include <avbd/decompose.h>
#include <avbd/error.h>

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "base/format.h"
#include "geom/decompose_join.h"

namespace avbd {
namespace {

constexpr double kDefaultError = 0.02;  // of the largest extent
constexpr double kFinestError = 1e-6;   // the same

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

/// Cuts the worst piece until all are good or there are enough.
std::vector<Piece> cutPieces(const PieceMaker& maker, int maxHulls) {
  std::vector<Piece> pieces;
  for (SolidPart& part : wholeParts(maker.solid())) pieces.push_back(maker.pieceOf(std::move(part)));
  // More pieces than are allowed in the end: joining finds better sets than cutting alone.
  const size_t limit = static_cast<size_t>(maxHulls) * 2;
  while (pieces.size() < limit) {
    Piece* worst = nullptr;
    for (Piece& p : pieces) {
      if (p.final || maker.isGood(p)) continue;
      if (worst == nullptr || p.reach.bound > worst->reach.bound) worst = &p;
    }
    if (worst == nullptr) break;
    std::vector<SolidPart> parts = cutPart(maker.solid(), worst->part);
    if (parts.size() < 2) {
      worst->final = true;
      continue;
    }
    *worst = maker.pieceOf(std::move(parts[0]));
    for (size_t i = 1; i < parts.size(); ++i) pieces.push_back(maker.pieceOf(std::move(parts[i])));
  }
  return pieces;
}

/// The hull that its own vertices make again, so that vertices and tolerance are all one has to keep of it. Each round
/// that is not the last leaves a vertex out, but for one that only merges faces otherwise.
std::shared_ptr<const HullData> settled(std::shared_ptr<const HullData> hull, float tolerance) {
  for (size_t rounds = hull->vertices().size() + 2;; --rounds) {
    std::shared_ptr<const HullData> again =
        makeHull({.points = hull->vertices(), .tolerance = tolerance, .maxVertices = 255});
    const bool same = again->contentHash() == hull->contentHash();
    AVBD_ASSERT(same || (rounds > 0 && again->vertices().size() <= hull->vertices().size()));
    hull = std::move(again);
    if (same || rounds == 0) return hull;
  }
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
  // Coordinates are floats: less than their rounding makes no difference.
  const PieceMaker maker(solid, std::fmax(maxError, kFinestError * extent), def.maxVerticesPerHull);
  std::vector<Piece> pieces = cutPieces(maker, def.maxHulls);
  if (pieces.empty()) refuse("triangles", toText(surface.size()) + " triangles", "must have area");
  joinPieces(maker, def.maxHulls, pieces);
  Decomposition result;
  result.openEdges = open.count;
  result.volume = static_cast<float>(open.count > 0 ? grid.volume() : surface.volume());
  result.tolerance = maker.tolerance();
  double bound = 0, found = 0;
  for (const Piece& piece : pieces) {
    // A settled hull lies within the piece's, and mostly it is that one.
    result.hulls.push_back(settled(piece.hull, result.tolerance));
    const bool known =
        piece.reach.bound <= grid.cellSize() / 2 && result.hulls.back()->contentHash() == piece.hull->contentHash();
    const Reach reach = known ? piece.reach : reachOf(*result.hulls.back(), solid, 0, grid.cellSize() / 2);
    bound = std::fmax(bound, std::fmin(reach.bound, piece.reach.bound));
    found = std::fmax(found, reach.found);
  }
  const Reach left = leftOutside(result.hulls, solid, bound, std::fmin(grid.cellSize(), bound) / 2);
  result.error = static_cast<float>(std::fmax(bound, left.bound));
  result.errorFound = static_cast<float>(std::fmin(std::fmax(found, left.found), result.error));
  return result;
}

}  // namespace avbd
