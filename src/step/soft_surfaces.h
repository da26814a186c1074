// Where the surfaces of soft bodies are in a step, and which of their faces come near each other.
//
// Near is what may touch while the points go the ways that they are thought to go: straight from the start of the step
// to its end. Each body is seen from where its mean goes, so that what moves as a whole comes near no more than what
// stands still.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "geom/face_tree.h"
#include "step/soft_impact_data.h"
#include "step/surface_turns.h"
#include "world/world_data.h"

namespace avbd {

struct StepData;

/// A soft body in this step.
struct SoftPlace {
  Vec3d origin;
  Vec3 drift;                             ///< [m] mean of the ways
  std::vector<Vec3> points;               ///< from the origin, at the start
  std::vector<Vec3> ways;                 ///< [m] less the drift
  std::vector<Vec3> normals, endNormals;  ///< of the faces, unit; 0 of one without area
  SurfaceTurns turns;                     ///< of a body that touches itself
  /// All that faces, points and edges pass over but for the drift, grown by half of what is near.
  std::vector<Aabb> faces, pointBoxes, edgeBoxes;
  std::vector<Aabb> bounds;  ///< of the tree's nodes
  bool tangled = false;      ///< its surface passes through itself
  float fastest = 0;         ///< [m] of the ways with the drift
};

/// Two faces that come near each other.
struct NearFaces {
  uint32_t softA = kNone, softB = kNone;  ///< slots; the same within one body
  uint32_t faceA = 0, faceB = 0;
  friend auto operator<=>(const NearFaces&, const NearFaces&) = default;
};

/// A touch of this step.
struct FoundTouch {
  SoftTouch touch;
  std::array<float, 4> weights{};  ///< of its nodes, where the two are nearest
  Vec3 arm;                        ///< of a shape from its body's centre of mass to there
  float separation = 0;            ///< [m] less the thickness of both
  bool awake = false;
  Vec3 off;  ///< [m] from the second to the first; tells touches of one place
};

/// Two features, as SoftTouch names them.
struct FeatureNames {
  TouchKind kind = TouchKind::PointFace;
  uint32_t first = kNone, firstPart = 0, second = kNone, secondPart = 0;
  bool within() const { return first == second; }
  SoftTouch touch() const {
    SoftTouch named;
    named.kind = kind;
    named.first = first, named.firstPart = firstPart;
    named.second = second, named.secondPart = secondPart;
    return named;
  }
};

/// Two features that come near each other, and how they lie at the start.
struct NearContact {
  FeatureNames names;
  Vec3 direction;  ///< unit, from the second's nearest point to the first's
  float distance = 0;
};

struct SoftSurfaces {
  TurnScratch turnScratch;
  std::vector<uint32_t> shapes;       ///< near one body
  std::vector<NearContact> contacts;  ///< of the search at the start
  std::vector<SoftPlace> places;      ///< by slot
  std::vector<NearFaces> near;        ///< by the slots
  /// Of a body along x.
  struct Ends {
    double lower, upper;
    uint32_t slot;
  };
  std::vector<Ends> ends;
  SoftImpactData impacts;
  std::vector<std::vector<uint8_t>> moved;  ///< by slot and point, of soft bodies of which some go other ways
  std::vector<Vec3> ways;  ///< [m] by body slot: of points after impacts; empty: all go where the solve leads them
  std::vector<std::array<uint32_t, 2>> pairs;  ///< slots of bodies whose bounds overlap, the lower first, one may sleep
};

/// How far apart two points are at the start, and how much one goes on beyond the other.
struct PlaceShift {
  Vec3 start, drift;
  /// A box of the one body, as the other may meet it.
  Aabb of(const Aabb& box) const { return swept({box.lower + start, box.upper + start}, drift); }
};
/// Of b's frame in a's.
PlaceShift shiftOf(const SoftPlace& a, const SoftPlace& b);

/// [m] that the solve led a body.
Vec3 solvedWay(const WorldData& world, const StepData& step, uint32_t body);
/// Puts all soft bodies to their places, with the ways that they go if nothing but gravity acts.
void placeSofts(const WorldData& world, StepData& step);
/// The same with the ways that the solve gave them.
void placeSolvedSofts(const WorldData& world, StepData& step);
/// The points take the ways that the solve gave them; drift and bounds stay. Whether no two features that `contacts`
/// does not hold may have come near each other.
bool takeSolvedWays(const WorldData& world, StepData& step);
/// Fills `pairs` and `near`.
void findNearFaces(const WorldData& world, SoftSurfaces& surfaces);
/// Points take other ways (SoftSurfaces::ways), and bounds hold those too; `near` becomes what faces with such a point
/// (by slot and point) come near.
void takeWays(const WorldData& world, StepData& step, const std::vector<std::array<uint32_t, 2>>& points);
/// [m] within which touches are looked for, beyond the thickness and the ways.
float touchMargin(const WorldData& world);

}  // namespace avbd
