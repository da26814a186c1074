// What the stages of a step hand to each other.
#pragma once

#include <array>
#include <vector>

#include "base/aligned.h"
#include "base/jobs.h"
#include "collide/collide_surface.h"
#include "solve/backend.h"
#include "solve/krylov.h"
#include "solve/linked_joint.h"
#include "solve/scalar_joint.h"
#include "solve/sweep.h"
#include "solve/tree_response.h"
#include "step/continuous.h"
#include "step/soft_surfaces.h"
#include "world/world_data.h"

namespace avbd {

/// An island: bodies that touch or are jointed, directly or through others. Static and kinematic bodies join nothing.
struct Island {
  uint32_t bodyBegin = 0, bodyCount = 0;    ///< in StepData::order
  uint32_t pairBegin = 0, pairCount = 0;    ///< in StepData::islandPairs
  uint32_t jointBegin = 0, jointCount = 0;  ///< in StepData::islandJoints
  uint32_t softBegin = 0, softCount = 0;    ///< in StepData::islandSofts
  uint32_t touchBegin = 0, touchCount = 0;  ///< in StepData::islandTouches
  float mass = 0;                           ///< [kg]
  int iterations = 0;                       ///< outer ones
  float startTime = 1;                      ///< of the step: where its iterations start
  bool floating = true;
};

/// Where the pieces of a batch lie in the arrays of StepData.
struct BatchRange {
  uint32_t islandBegin = 0, islandCount = 0;
  int iterations = 0;  ///< of all its islands
  uint32_t orderBegin = 0, bodies = 0;
  uint32_t rowBegin = 0, rows = 0;
  uint32_t contactTile = 0, contactTiles = 0;
  uint32_t ballTile = 0, ballTiles = 0;
  uint32_t fixedTile = 0, fixedTiles = 0;
  uint32_t tetTile = 0, tetTiles = 0;
  uint32_t touchTile = 0, touchTiles = 0;
  uint32_t triangleTile = 0, triangleTiles = 0;
  uint32_t bendTile = 0, bendTiles = 0;
  Slice elastic, stars, corotational, corotationalStars;
  bool threads = false;  ///< as in BatchView
  bool hasElements() const {
    return elastic.end - elastic.begin + corotational.end - corotational.begin + triangleTiles > 0;
  }
  uint32_t fullTile = 0, fullTiles = 0;
  uint32_t scalarTile = 0, scalarTiles = 0, scalarCount = 0;
  uint32_t linkedBegin = 0, linkedCount = 0;
  uint32_t lockedBegin = 0, lockedCount = 0;
  uint32_t sweptBegin = 0, sweptCount = 0;
  uint32_t forest = kNone;                  ///< in StepData::forests
  uint32_t chunkBegin = 0, chunkCount = 0;  ///< in StepData::chunks
  uint32_t seamBegin = 0, seamCount = 0;    ///< in StepData::seams
};

/// A piece of work of the stages that go over body rows or contacts: a chunk of a batch, or a seam, which has no rows.
struct WorkUnit {
  uint32_t batch = 0;
  Slice rows;   ///< of the batch's dynamic bodies
  Slice tiles;  ///< of the batch's contacts
};

/// A contact on its way to a lane.
struct PlacedPair {
  uint32_t pair = kNone, rowA = 0, rowB = 0;
  uint32_t bucket = 0;  ///< chunks, then seams, then what touches a kinematic body
};

/// What finding the chunks' and seams' contacts needs.
struct ChunkScratch {
  std::vector<PlacedPair> pairs;
  std::vector<uint8_t> chunkOf;  ///< by row of a dynamic body
  struct Piece {
    std::vector<uint32_t> seams;  ///< codes of those that it meets, in that order
    std::vector<uint32_t> next;   ///< by place of a bucket: where its next contact goes
    bool hasKinematic = false;
  };
  std::vector<Piece> pieces;  ///< the first pieceCount of them are in use
  size_t pieceCount = 0;
  std::vector<uint32_t> seamOf;  ///< by code of two chunks: index in `seams`
  struct Between {
    uint32_t low = 0, high = 0, color = 0;
  };
  std::vector<Between> seams;
  std::vector<uint32_t> order;  ///< of the seams, by colour
  std::vector<uint32_t> place;  ///< by bucket: among the buckets in their order
};

/// A contact row that rebounds (restitution.h).
struct Bounce {
  uint32_t pair = kNone;  ///< index
  int point = 0;
  uint32_t a = kNone, b = kNone;  ///< in StepData::end; kNone where the body is not dynamic
  Vec3 n, armA, armB;
  Vec3 turnA, turnB;             ///< I^-1 (arm x n)
  float speed = 0;               ///< to reach
  float fixedSpeed = 0;          ///< of kinematic bodies along n, B minus A
  float weight = 0;              ///< 1 / inverse mass along n
  float scaleA = 1, scaleB = 1;  ///< of the inverse masses
  float impulse = 0, least = 0;  ///< [N s]
};

/// A tree joint as a body row sees it, in a list that starts at ForestScratch::first.
struct ForestEdge {
  uint32_t joint = 0;      ///< index in ForestScratch::joints
  uint32_t neighbour = 0;  ///< row
  uint32_t next = kNone;   ///< edge of the same row
};

/// A joint between two bodies, or a body and the world, before it has a place.
struct PlannedJoint {
  uint32_t rowA = 0, rowB = 0, slot = 0, island = 0;  ///< as in TreeJoint
  bool angular = false, childIsA = true;              ///< likewise
  bool eligible = false;                              ///< a tree can hold it
  bool inTree = false;                                ///< one does
  bool scalar = false;
  uint32_t lane = 0;  ///< among those of its kind, over all batches
};

/// A node's partner in the factor, in a list that starts at ForestScratch::frontOf.
struct FrontLink {
  uint32_t other = 0;     ///< node
  uint32_t next = kNone;  ///< link of the same node
};

struct ForestScratch {
  std::vector<PlannedJoint> joints;
  std::vector<uint32_t> first;  ///< by row: its first edge
  std::vector<ForestEdge> edges;
  std::vector<int32_t> nodeOf;    ///< by row
  std::vector<uint32_t> frontOf;  ///< by node: its first link; kNone: its parent is all
  std::vector<FrontLink> links;
  std::vector<int32_t> front;    ///< of one node
  std::vector<int32_t> fronts;   ///< of all, as Forest::fills will stand
  std::vector<uint32_t> blocks;  ///< by island: what its fill costs
  std::vector<uint8_t> wide;     ///< by island: its loops would cost too much, and trees in it be no use
};

/// Colours of the dynamic bodies, and what finding them needs; empty unless the block sweep runs.
struct Coloring {
  uint32_t colors = 0;
  std::vector<uint32_t> ofOrder;               ///< colour, by StepData::order
  std::vector<uint32_t> at;                    ///< place in the order, by body slot
  std::vector<std::array<uint32_t, 2>> links;  ///< places of bodies that share a row
  std::vector<uint32_t> first, neighbour;      ///< by place: its neighbours start at neighbour[first[place]]
  std::vector<uint32_t> takenBy;               ///< by colour: the last body that found it at a neighbour
};

/// Directions that the memory of a point is given in.
struct ContactBasis {
  Vec3 normal, t1, t2;
};

/// What a point of the last step remembered.
struct OldPoint {
  PointMemory memory;
  ContactBasis basis;
  Vec3 mean;  ///< as in WorldData::means, after the first substep
};

/// What later stages need of all pairs, without the records of pairs and bodies.
struct FoundContact {
  uint32_t bodyA = 0, bodyB = 0;  ///< slots
  uint8_t points = 0;
  BodyType typeA = BodyType::Static, typeB = BodyType::Static;
  bool isFull : 1 = false;
  bool bounces : 1 = false;  ///< has restitution
  bool ends : 1 = false;     ///< touched in the last step, and has no points any more
  bool isSoft : 1 = false;   ///< one of them is a particle
  bool isBetweenDynamic() const { return typeA == BodyType::Dynamic && typeB == BodyType::Dynamic; }
  bool hasKinematic() const { return typeA == BodyType::Kinematic || typeB == BodyType::Kinematic; }
};
inline FoundContact foundContact(const WorldData& world, const PairData& pair) {
  return {pair.bodyA,
          pair.bodyB,
          static_cast<uint8_t>(pair.pointCount),
          world.bodies[pair.bodyA].type,
          world.bodies[pair.bodyB].type,
          pair.isFull,
          pair.restitution > 0,
          pair.wasTouching && pair.pointCount == 0,
          anyIsParticle(world, pair.bodyA, pair.bodyB)};
}

/// What the contact hook wants of a contact beyond its coefficients.
struct ContactChange {
  uint32_t pair = kNone;         ///< index
  Vec3 belt;                     ///< [m/s] at which B's surface shall slide over A's
  float scaleA = 1, scaleB = 1;  ///< of the inverse masses
};

/// What the contacts of a pair that reports hits did in a substep, patch by patch.
struct HitRecord {
  uint64_t key = 0;  ///< of the pair
  uint32_t order = 0;
  HitEvent event;
};

/// What the points of a patch did in a substep, of a pair that did not touch in the last step.
struct TouchRecord {
  uint64_t key = 0;  ///< of the pair
  uint32_t order = 0;
  Vec3d position;  ///< of the point that pushed most
  Vec3 normal;
  float impulse = 0;  ///< [N s] of all points
};

/// What a soft body and a thing did with each other in a substep: of those that follow each other one.
struct SoftNote {
  SoftPair pair;
  uint32_t order = 0;
  float most = 0;     ///< [N] of the point that pushed most
  float impulse = 0;  ///< [N s] of all
};

struct PoseBefore {
  Vec3d position;
  Quat rotation;
};

/// Copies by slot, whose memory is used again.
template <class T>
struct Saved {
  struct Entry {
    uint32_t slot;
    T data;
  };
  std::vector<Entry> list;
  size_t count = 0;  ///< in use
  void save(uint32_t slot, const T& data) {
    if (count == list.size()) list.emplace_back();
    list[count].slot = slot, list[count++].data = data;
  }
  void restore(std::vector<T>& to) const {
    for (size_t i = 0; i < count; ++i) to[list[i].slot] = list[i].data;
  }
};

struct StepData {
  float h = 0;             ///< [s] of a substep
  float restingSpeed = 0;  ///< [m/s] contacts at rest approach more slowly, and carry a load
  float alpha = 0;         ///< share of a violation at the start of the step that a row keeps
  float slop = 0;          ///< [m] depth at which contacts come to rest
  float loadDepth = 0;     ///< [m] at which a loaded row holds its load
  SolveSettings solve;
  const Backend* backend = nullptr;
  Jobs* jobs = nullptr;
  int substep = 0;  ///< that runs

  Saved<BodyData> bodiesBefore;   ///< what is awake, where substeps may fail; and what a step woke
  Saved<JointData> jointsBefore;  ///< likewise
  Saved<D6Data> d6Before;
  Saved<LinkData> linksBefore;
  std::vector<uint32_t> unpairedBefore;
  PairList pairsBefore;                 ///< the same, where the contact hook may fail: if pairsKept
  size_t lostBefore = 0;                ///< how many lostTouches there were when the step began
  std::vector<PointMeans> meansBefore;  ///< of the step before
  bool pairsKept = false;

  // 10_pairs
  std::vector<uint32_t> moved;                   ///< shapes that left their fat bounds
  std::vector<DynamicTree::Shift> shifts;        ///< of those in `moved`
  std::vector<uint8_t> isMoved;                  ///< by shape slot
  std::vector<std::vector<uint32_t>> leavingOf;  ///< by piece of the awake bodies: shapes that leave their fat bounds
  std::vector<std::vector<uint64_t>> keysOf;     ///< by piece of `moved`: new keys that it finds
  std::vector<uint64_t> newKeys;
  std::vector<std::vector<uint32_t>> partedOf;  ///< by piece of the pairs: places of those that do not overlap any more
  std::vector<uint32_t> parted;                 ///< of all pieces

  // 20_contacts
  std::vector<SurfacePatch> patches;   ///< of one pair with a surface; by patch:
  std::vector<uint32_t> entryOf;       ///< place in the run
  std::vector<uint8_t> continues;      ///< it was touched in the last step
  std::vector<uint32_t> match;         ///< by point, kMaxManifoldPoints a patch: the old point that it continues
  std::vector<uint32_t> patchOf;       ///< by place in the run: its patch, kNone
  std::vector<OldPoint> oldPoints;     ///< of the whole run
  std::vector<uint32_t> oldEntry;      ///< their places in the run
  std::vector<uint8_t> oldTaken;       ///< some new point continues it
  std::vector<PairData> overflow;      ///< entries for which runs are too short, by key
  std::vector<ContactChange> changes;  ///< by pair
  std::vector<FoundContact> found;     ///< by index of the pair

  SoftSurfaces softs;
  std::vector<FoundTouch> softTouches;       ///< ascending
  std::vector<SoftTouch> softTouchesBefore;  ///< of the step before, where substeps may fail
  std::vector<SoftMemory> softMemoryBefore;  ///< likewise, by slot

  std::vector<uint32_t> wokenIslands;  ///< in SleepData::islands: what a contact woke in this step
  std::vector<uint32_t> wokenPairs;    ///< indices of the first entries of their pairs

  // 30_islands
  struct AwakeBody {
    uint32_t slot;
    BodyType type;
    float mass;      ///< [kg]
    int iterations;  ///< that it asks for; 0: as the world
  };
  std::vector<AwakeBody> awake;       ///< what islands need of bodies, as SleepData::awake
  std::vector<uint32_t> touching;     ///< pairs with points
  std::vector<uint32_t> touchingEnd;  ///< by piece of the pairs, while they are listed
  std::vector<uint32_t> parent;       ///< union-find, by body slot
  std::vector<uint32_t> islandOf;     ///< by body slot
  std::vector<uint32_t> order;        ///< dynamic body slots, island by island
  std::vector<Island> islands;
  std::vector<uint32_t> islandPairs;    ///< pairs with points, island by island, by key
  std::vector<uint32_t> islandJoints;   ///< joint slots
  std::vector<uint32_t> islandSofts;    ///< slots of soft bodies
  std::vector<uint32_t> islandTouches;  ///< indices in softTouches
  std::vector<BatchRange> batches;
  std::vector<Chunk> chunks;
  std::vector<Seam> seams;
  std::vector<WorkUnit> units;
  ChunkScratch chunking;
  std::vector<uint32_t> rowOf;           ///< by body slot: row within its batch; static bodies: kNone
  std::vector<uint32_t> kinematic;       ///< slots
  std::vector<uint32_t> kinematicBatch;  ///< by body slot: the last batch that gave it a row
  struct KinematicRow {
    uint32_t body, row;
  };
  std::vector<KinematicRow> kinematicRows;  ///< rows count over all batches

  std::vector<uint8_t> slidesOnly;  ///< by body row over all batches: all its contacts have slid for some steps
  std::vector<Vec3> carried;        ///< likewise: force of contacts and joints in the last step [N]

  Coloring coloring;  // 40_colors

  // Body rows.
  std::vector<IslandRange> ranges;
  UnwrittenVector<Tile<FreeBody>> body;  ///< of all batches, as the rows
  UnwrittenVector<Tile<FreeMotion>> free;
  UnwrittenVector<Tile<EndMotion>> endTiles;
  UnwrittenVector<float> d, target, mass, invMass, diagonal, gradient, hessian, elementBlocks, x, r, z, p, q, length,
      product;
  std::vector<float> whole, deform;  ///< as in BatchView; only where there are soft bodies
  UnwrittenVector<Tile<rows::Sym6>> inverse;
  std::vector<uint32_t> lockedRows;
  std::vector<uint8_t> locks;

  // Tiles.
  UnwrittenVector<Tile<rows::Contact>> contacts;
  UnwrittenVector<Tile<rows::BallJoint>> balls;
  UnwrittenVector<Tile<rows::FixedJoint>> fixed;
  UnwrittenVector<Tile<rows::TetVolume>> tets;
  UnwrittenVector<Tile<rows::FullContact>> full;
  std::vector<ScalarJoint> scalar;  ///< by lane; padding has no slot
  std::vector<uint32_t> scalarOf;   ///< by joint slot: index in `scalar`
  std::vector<LinkedJoint> linked;
  std::vector<uint32_t> contactRow[2], ballRow[2], fixedRow[2], tetRow[4], fullRow[2], scalarRow[2];
  std::vector<uint32_t> contactPair, ballJoint, fixedJoint, tetJoint;  ///< by lane: pair or joint slot, kNone
  UnwrittenVector<Tile<PairOp>> op;
  /// Of elements and hinges by lane: the soft body, kNone, and the place in its mesh.
  struct Element {
    uint32_t soft = kNone, index = 0;
  };
  std::vector<Element> triangles, hinges;
  std::vector<uint32_t> triangleRow[4], bendRow[4];
  UnwrittenVector<Tile<rows::TriangleElastic>> triangleTiles;
  UnwrittenVector<Tile<rows::TriangleOp>> triangleOp;
  UnwrittenVector<Tile<rows::ClothBend>> bendTiles;
  UnwrittenVector<Tile<rows::BendOp>> bendOp;
  std::vector<uint32_t> touchLane;  ///< index in softTouches by lane, kNone
  std::vector<uint32_t> touchRow[4];
  UnwrittenVector<Tile<rows::NodeContact>> touchTiles;
  UnwrittenVector<Tile<rows::NodeContactOp>> touchOp;
  /// Tetrahedra and stars of one energy.
  template <template <class> class Tet, template <class> class TetOp, template <class> class Star,
            template <class> class StarOp>
  struct Solids {
    std::vector<Element> tets, stars;
    std::vector<uint32_t> row[4];
    UnwrittenVector<Tile<Tet>> tetTiles;
    UnwrittenVector<Tile<TetOp>> tetOp;
    std::vector<uint32_t> starCenter, starBegin;  ///< by star, as in StarTiles
    std::vector<StarLink> starLinks;
    UnwrittenVector<Tile<Star>> starTiles;
    UnwrittenVector<Tile<StarOp>> starOp;
  };
  Solids<rows::TetElastic, rows::ElasticOp, rows::StarElastic, rows::SolidOp> elastic;
  Solids<rows::TetCorotational, rows::TetCorotationalOp, rows::StarCorotational, rows::CorotationalOp> corotational;
  std::vector<uint32_t> fullPair;  ///< by lane, as contactPair
  UnwrittenVector<Tile<NodeOp>> tetOp;
  UnwrittenVector<Tile<ScaledOp>> fullOp;
  std::vector<Forest> forests;  ///< the first forestCount are in use
  uint32_t forestCount = 0;
  std::vector<TreeResponse> response;  ///< of one forest
  ForestScratch planting;
  std::vector<KrylovScratch> krylov;  ///< by worker
  std::vector<SweepPlan> sweep;       ///< by worker

  // 70_velocities: the state at the end of the step, by StepData::order; written back by 90_publish
  struct EndState {
    Vec3d position;
    Quat rotation;
    Vec3 linearVelocity, angularVelocity;
  };
  std::vector<EndState> end;
  std::vector<Bounce> bounces;
  std::vector<uint32_t> rowOfEnd;  ///< body row over all batches, by index in end
  std::vector<uint32_t> endOf;     ///< index in end, by body slot

  ContinuousData continuous;  // 75_continuous
  TiedData tied;
  int round = 0;                         ///< how often this substep was solved before
  std::vector<SweptPair> swept;          ///< by key and patch: contacts that earlier rounds found on the way
  std::vector<SweptContact> sweptLanes;  ///< by batch

  // 80_sleep
  std::vector<float> stillTime;   ///< [s] by StepData::order
  std::vector<uint32_t> falling;  ///< islands that fall asleep

  // 90_publish
  std::vector<uint64_t> touchChanges;  ///< keys of pairs that may have begun or ended to touch
  std::vector<uint8_t> told;           ///< by lane of contacts: what its publication makes beyond its own forces
  std::vector<TouchRecord> touches;    ///< of all substeps so far
  std::vector<HitRecord> hits;         ///< likewise
  std::vector<SoftNote> softNotes;     ///< likewise
  std::vector<SoftPair> softPairs;     ///< room for WorldData::softPairs
  std::vector<SoftContact> softContacts, newSoftContacts, mergedSoftContacts;  ///< of all substeps so far; of one; both
  std::vector<PoseBefore> posesBefore;                                         ///< by body slot, where moves are events

  size_t rows() const { return product.size(); }  ///< of all batches
  BatchView view(size_t batch);
};

/// Of a PairData or FoundContact with at least one dynamic body.
template <class Pair>
uint32_t islandOfPair(const StepData& step, const Pair& pair) {
  const uint32_t a = step.islandOf[pair.bodyA];
  return a != kNone ? a : step.islandOf[pair.bodyB];
}

/// What the contact hook changed in a pair.
const ContactChange& changeOf(const StepData& step, uint32_t pair);

/// Of a walk over lanes: asks for the record of a pair that comes soon.
AVBD_INLINE void prefetchAhead(const WorldData& world, const std::vector<uint32_t>& pairs, size_t lane) {
  if (lane + PairList::kAhead < pairs.size()) world.pairs.prefetch(pairs[lane + PairList::kAhead]);
}

inline constexpr float kSpeculative = 0.005f;  ///< of the length unit: margin within which contacts are found

// The stages, in order.
void findPairs(WorldData& world, StepData& step);
void findContacts(WorldData& world, StepData& step);
void findIslands(WorldData& world, StepData& step);
void colorBlocks(WorldData& world, StepData& step);
void beginRows(WorldData& world, StepData& step);
void predict(WorldData& world, StepData& step);
void solveBlocks(WorldData& world, StepData& step);
void updateRows(WorldData& world, StepData& step);
void updateVelocities(WorldData& world, StepData& step);
/// What tied bodies meet on the way that the solve gave them: step.tied.meetings.
void findTiedImpacts(WorldData& world, StepData& step);
/// Makes contacts of it for the next solve.
void sweepContacts(WorldData& world, StepData& step);
void stopAtImpacts(WorldData& world, StepData& step);
void chooseSleepers(WorldData& world, StepData& step);
void publish(WorldData& world, StepData& step);

}  // namespace avbd
