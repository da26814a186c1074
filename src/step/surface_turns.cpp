// Turns of surfaces (surface_turns.h).
#include "step/surface_turns.h"

#include <algorithm>

#include "avbd/rows/math.h"
#include "geom/soft_mesh_parts.h"
#include "step/soft_surfaces.h"

namespace avbd {

namespace {

/// Of unit vectors 45 degrees apart. What turns by no more from a mean keeps 0.7 of the distances at rest along the
/// surface, less what it is pressed together; features of one surface touch below half of them.
constexpr float kAsOne = 0.765f;
/// As much may point turns and face normals each differ from what was thought: then all is within 60 degrees of a mean,
/// which keeps half of the distances.
constexpr float kAsThought = 0.117f;
constexpr float kAstray = 4;  ///< more than two turns can be apart

/// What makes a frame of rest the frame of now.
PointTurn turnOf(const SurfaceFrame& rest, const SurfaceFrame& now) {
  const Vec3 across = cross(rest.normal, rest.along), acrossNow = cross(now.normal, now.along);
  const auto image = [&](float n, float a, float c) { return now.normal * n + now.along * a + acrossNow * c; };
  return {image(rest.normal.x, rest.along.x, across.x), image(rest.normal.y, rest.along.y, across.y),
          image(rest.normal.z, rest.along.z, across.z), 0};
}

Vec3 turned(const PointTurn& turn, Vec3 v) { return turn.x * v.x + turn.y * v.y + turn.z * v.z; }

/// The most that the turns make of a unit vector's difference: the norm of matrices, of rotations by the root of 2 less
/// than that of their entries.
float difference(const PointTurn& a, const PointTurn& b) {
  const Vec3 x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return rows::sqrt(0.5f * (dot(x, x) + dot(y, y) + dot(z, z)));
}

/// Of the faces at each point.
void turnPoints(const SoftMeshData& mesh, const std::vector<Vec3>& normals, std::vector<Vec3>& sums,
                const std::vector<Vec3>& points, const std::vector<Vec3>* ways, std::vector<PointTurn>& turns) {
  const auto faces = mesh.surface();
  const SurfaceAtRest& rest = mesh.parts().atRest;
  sums.assign(points.size(), Vec3{});
  for (size_t f = 0; f < faces.size(); ++f)
    for (const uint32_t p : faces[f]) sums[p] = sums[p] + normals[f];
  turns.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const uint32_t other = rest.neighbour[i];
    Vec3 off = points[other] - points[i];
    if (ways) off = off + (*ways)[other] - (*ways)[i];
    SurfaceFrame now;
    const bool has = surfaceFrame(sums[i], off, now);
    turns[i] = turnOf(rest.frames[i], has ? now : SurfaceFrame{});
    turns[i].spread = has ? 0 : kAstray;
  }
  for (size_t f = 0; f < faces.size(); ++f)
    for (const uint32_t p : faces[f]) {
      const Vec3 off = turned(turns[p], rest.normals[f]) - normals[f];
      turns[p].spread = std::max(turns[p].spread, dot(off, off));
    }
  for (PointTurn& turn : turns) turn.spread = rows::sqrt(turn.spread);
}

/// Takes in the points at the other ends of edges.
void spreadTurns(const SoftMeshData& mesh, std::vector<float>& spreads, std::vector<PointTurn>& turns) {
  spreads.resize(turns.size());
  for (size_t i = 0; i < turns.size(); ++i) spreads[i] = turns[i].spread;
  for (const auto& [a, b] : mesh.parts().features.edges) {
    const float apart = difference(turns[a], turns[b]);
    turns[a].spread = std::max(turns[a].spread, apart + spreads[b]);
    turns[b].spread = std::max(turns[b].spread, apart + spreads[a]);
  }
}

TurnRange merge(const TurnRange& a, const TurnRange& b) {
  return {avbd::merge(a.x, b.x), avbd::merge(a.y, b.y), avbd::merge(a.z, b.z), std::max(a.spread, b.spread)};
}

TurnRange rangeOf(const PointTurn& t) { return {{t.x, t.x}, {t.y, t.y}, {t.z, t.z}, t.spread}; }

void findRanges(const SoftMeshData& mesh, TurnsThen& turns) {
  const auto faces = mesh.surface();
  const auto of = [&](uint32_t face) {
    const auto& [a, b, c] = faces[face];
    return merge(rangeOf(turns.points[a]), merge(rangeOf(turns.points[b]), rangeOf(turns.points[c])));
  };
  mesh.faceTree().refit(turns.nodes, of, [](const TurnRange& a, const TurnRange& b) { return merge(a, b); });
}

bool asOne(const PointTurn& a, const PointTurn& b) { return a.spread < kAsOne && difference(a, b) + b.spread < kAsOne; }

bool asOne(const TurnRange& a, const TurnRange& b) {
  const TurnRange both = merge(a, b);
  if (!(both.spread < kAsOne)) return false;
  const Vec3 x = both.x.upper - both.x.lower, y = both.y.upper - both.y.lower, z = both.z.upper - both.z.lower;
  const float left = kAsOne - both.spread;
  return 0.5f * (dot(x, x) + dot(y, y) + dot(z, z)) < left * left;
}

}  // namespace

void findTurns(const SoftMeshData& mesh, const SoftPlace& place, TurnScratch& scratch, SurfaceTurns& turns) {
  turnPoints(mesh, place.normals, scratch.normals, place.points, nullptr, turns.start.points);
  turnPoints(mesh, place.endNormals, scratch.normals, place.points, &place.ways, turns.end.points);
  for (TurnsThen* then : {&turns.start, &turns.end}) {
    spreadTurns(mesh, scratch.spreads, then->points);
    findRanges(mesh, *then);
  }
}

bool turnsAsThought(const SoftMeshData& mesh, const SoftPlace& place, const SurfaceTurns& turns, TurnScratch& scratch) {
  const auto faces = mesh.surface();
  scratch.endNormals.resize(faces.size());
  for (size_t f = 0; f < faces.size(); ++f) {
    const auto end = [&](size_t k) { return place.points[faces[f][k]] + place.ways[faces[f][k]]; };
    scratch.endNormals[f] = unitNormal(end(0), end(1), end(2));
    const Vec3 off = scratch.endNormals[f] - place.endNormals[f];
    if (!(dot(off, off) < kAsThought * kAsThought)) return false;
  }
  turnPoints(mesh, scratch.endNormals, scratch.normals, place.points, &place.ways, scratch.turns);
  for (size_t i = 0; i < scratch.turns.size(); ++i)
    if (!(difference(scratch.turns[i], turns.end.points[i]) < kAsThought)) return false;
  return true;
}

bool turnAsOne(const SurfaceTurns& turns, uint32_t a, uint32_t b) {
  return asOne(turns.start.points[a], turns.start.points[b]) && asOne(turns.end.points[a], turns.end.points[b]);
}

bool nodesTurnAsOne(const SurfaceTurns& turns, uint32_t a, uint32_t b) {
  return asOne(turns.start.nodes[a], turns.start.nodes[b]) && asOne(turns.end.nodes[a], turns.end.nodes[b]);
}

}  // namespace avbd
