// How the surface of a soft body has turned since rest about each of its points.
//
// Where a surface moves as one body does, what lies beside each other at rest stays so. By that a search of a surface
// against itself leaves out the neighbours of each face, which are near it all the time.
#pragma once

#include <vector>

#include "geom/surface_at_rest.h"

namespace avbd {

struct SoftPlace;
class SoftMeshData;

/// The turn at a point, as the images of the three axes; and how far the turns of the faces up to two edges away are
/// from it at most: the length of the difference that they make to a unit vector.
struct PointTurn {
  Vec3 x, y, z;
  float spread;
};

/// Those of several points stand between these.
struct TurnRange {
  Aabb x, y, z;
  float spread;
};

/// At the start of the step or at the end of the ways.
struct TurnsThen {
  std::vector<PointTurn> points;
  std::vector<TurnRange> nodes;  ///< of the tree
};

struct SurfaceTurns {
  TurnsThen start, end;
};

/// Room of the search.
struct TurnScratch {
  std::vector<Vec3> normals;  ///< by point
  std::vector<float> spreads;
  std::vector<Vec3> endNormals;
  std::vector<PointTurn> turns;
};

void findTurns(const SoftMeshData& mesh, const SoftPlace& place, TurnScratch& scratch, SurfaceTurns& turns);

/// Whether the surface turns on the ways by now about as it did on those of `turns`: what turned as one still does.
bool turnsAsThought(const SoftMeshData& mesh, const SoftPlace& place, const SurfaceTurns& turns, TurnScratch& scratch);

/// Whether all that is within two edges of either point has turned about as much, at the start and at the end.
bool turnAsOne(const SurfaceTurns& turns, uint32_t a, uint32_t b);
/// The same of all points below two nodes of the tree.
bool nodesTurnAsOne(const SurfaceTurns& turns, uint32_t a, uint32_t b);

}  // namespace avbd
