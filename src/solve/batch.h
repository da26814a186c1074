// A batch: some whole islands, laid out for the solver. The unit of work; batches share nothing.
//
// Body rows. Each array of body rows holds 8 floats a body, (lin xyz, -, ang xyz, -) or as said. The rows of a batch
// are its dynamic bodies, island by island, then one row a chunk for everything static, then kinematic bodies; rows are
// padded to a multiple of 16. Pairs name their bodies by row within the batch.
//
// Chunks. A large island is cut into chunks of rows, so that several threads can solve it: the sums of a body are those
// of its chunk first, then those of the seams in the order of their colours, whoever makes them. Each chunk has its own
// static row, since rows are added to; static rows are then in no chunk, begin at a multiple of 16, and hold sums that
// nobody reads.
//
// Tiles. Constants and multipliers of 16 pairs are the transpose of their family's struct (lane/tile.h). Unused lanes
// name the static row on both sides and have stiffness 0.
#pragma once

#include <cstdint>
#include <span>

#include "avbd/rows/cloth_bend.h"
#include "avbd/rows/corotational.h"
#include "avbd/rows/family.h"
#include "avbd/rows/node_contact.h"
#include "avbd/rows/star_elastic.h"
#include "avbd/rows/tet_elastic.h"
#include "avbd/rows/triangle_elastic.h"
#include "lane/tile.h"
#include "solve/free_body.h"

namespace avbd {

inline constexpr int kHessianRow = 24;  ///< floats a body: Sym6, padded

/// What the products with H need of a pair: its stiffness about the reference point and the arms to it.
template <class R>
struct PairOp {
  rows::V3<R> armA, armB;
  rows::Sym6<R> stiffness;
};

/// The same where the pair's wrench acts on A and B times a factor.
template <class R>
struct ScaledOp {
  PairOp<R> pair;
  R hessianA, hessianB;
};

/// The same of a row over four nodes: J and k.
template <class R>
struct NodeOp {
  rows::V3<R> lin[4];
  R k;
};

/// Entries begin .. end - 1.
struct Slice {
  uint32_t begin = 0, end = 0;
};

/// A part of a batch that one thread can solve for: some body rows, from a multiple of 16 to one, and the tiles of the
/// contacts that touch no dynamic or kinematic body but theirs. Chunks share no row.
struct Chunk {
  Slice rows, tiles;
};

/// Contacts between two chunks. Seams of one colour share no chunk.
struct Seam {
  Slice tiles;
  uint32_t color = 0;
};

/// Pairs of one family in tiles of 16, with the rows of their bodies.
template <template <class> class Family>
struct PairTiles {
  Tile<Family>* tile = nullptr;
  const uint32_t* a = nullptr;  ///< 16 a tile
  const uint32_t* b = nullptr;
  uint32_t tiles = 0;
};

/// What joins four nodes, in tiles of 16: its rows or energy, the body rows of its nodes, and what products need of it.
template <template <class> class Family, template <class> class Op>
struct NodeTiles {
  Tile<Family>* tile = nullptr;
  const uint32_t* node[4] = {};
  Tile<Op>* op = nullptr;
  uint32_t tiles = 0;
};

/// A point of a star but its centre: b_j (rows/star_elastic.h) and its body row.
struct StarLink {
  float x = 0, y = 0, z = 0;
  uint32_t row = 0;
};

/// Stars of points of soft solids, in tiles of 16. Star i joins its centre to links begin[i] .. begin[i + 1] - 1.
template <template <class> class Star, template <class> class Op>
struct StarTiles {
  Tile<Star>* tile = nullptr;
  Tile<Op>* op = nullptr;
  const uint32_t* center = nullptr;  ///< body rows
  const uint32_t* begin = nullptr;
  const StarLink* link = nullptr;
  uint32_t tiles = 0;
};

struct ScalarJoint;

/// Joints whose rows are evaluated one at a time (scalar_joint.h), with their lanes in the products with H.
struct ScalarJoints {
  ScalarJoint* joint = nullptr;
  uint32_t count = 0;
  const uint32_t* a = nullptr;  ///< body rows by lane, padded to whole tiles
  const uint32_t* b = nullptr;
  uint32_t tiles = 0;
};

struct SweptContact;
struct LinkedJoint;

/// Joints over any number of bodies, one at a time (linked_joint.h).
struct LinkedJoints {
  LinkedJoint* joint = nullptr;
  uint32_t count = 0;
};

/// One island within a batch.
struct IslandRange {
  uint32_t begin = 0, end = 0;  ///< body rows
  bool hasTree = false;
  bool coupled = false;   ///< holds rows that the preconditioner does not solve exactly
  bool floating = false;  ///< touches nothing static or kinematic
  bool inTiles = false;   ///< has ball or fixed joints that no tree holds
};

struct BatchView {
  uint32_t bodies = 0;  ///< dynamic rows
  uint32_t rows = 0;    ///< all rows, a multiple of 16
  uint32_t islands = 0;
  const IslandRange* island = nullptr;

  // Body rows.
  const Tile<FreeBody>* body = nullptr;  ///< of 16 rows each
  Tile<FreeMotion>* free = nullptr;
  Tile<EndMotion>* end = nullptr;
  float* d = nullptr;  ///< displacement since the start of the step
  /// Of particles the motion of their soft body as a whole, and the rest of their velocities, times the time: an island
  /// starts with as much of both as lowers its energy. Null: nothing.
  const float *whole = nullptr, *deform = nullptr;
  float* target = nullptr;    ///< y: where the body would go alone
  float* mass = nullptr;      ///< (m, I xx yy zz xy xz yz, -) / h^2, I in world axes
  float* invMass = nullptr;   ///< (1/m, I^-1 ..., -); 0 for static and kinematic
  float* diagonal = nullptr;  ///< as mass, with the geometric stiffness of joints
  float* gradient = nullptr;
  float* hessian = nullptr;        ///< kHessianRow floats a body
  float* elementBlocks = nullptr;  ///< what the elements of soft bodies have in it: 8 floats a body, 6 of them used
  Tile<rows::Sym6>* inverse = nullptr;  ///< of 16 bodies: their inverse blocks
  float *x = nullptr, *r = nullptr, *z = nullptr, *p = nullptr, *q = nullptr;
  float* step = nullptr;     ///< a float a row: length of a step of its island's search
  float* product = nullptr;  ///< a float a row: its share of a scalar product

  std::span<const Chunk> chunks;  ///< one, or those of a large island: then it is the batch's only one
  std::span<const Seam> seams;    ///< by colour

  PairTiles<rows::Contact> contacts;
  PairTiles<rows::BallJoint> balls;  ///< those that no tree holds
  PairTiles<rows::FixedJoint> fixed;
  PairTiles<rows::FullContact> full;
  std::span<const SweptContact> swept;  ///< contacts whose rows follow the iterations (swept_contact.h)
  NodeTiles<rows::TetVolume, NodeOp> tets;
  // Of soft bodies: elements of solids and of cloth, whose fourth node is a static row; hinges; points that touch
  // faces.
  NodeTiles<rows::TetElastic, rows::ElasticOp> elastic;
  NodeTiles<rows::TriangleElastic, rows::TriangleOp> triangles;
  NodeTiles<rows::ClothBend, rows::BendOp> bends;
  StarTiles<rows::StarElastic, rows::SolidOp> stars;
  NodeTiles<rows::TetCorotational, rows::TetCorotationalOp> corotational;  ///< of solids by that energy
  StarTiles<rows::StarCorotational, rows::CorotationalOp> corotationalStars;
  bool threads = false;  ///< some of these dampen, are woven or have a limit
  NodeTiles<rows::NodeContact, rows::NodeContactOp> nodeContacts;
  ScalarJoints scalar;
  LinkedJoints linked;
  Tile<PairOp>* op = nullptr;  ///< contacts, then balls, then fixed, then scalar joints
  Tile<ScaledOp>* fullOp = nullptr;

  const uint32_t* locked = nullptr;  ///< rows of bodies with locked axes
  const uint8_t* locks = nullptr;
  uint32_t lockedCount = 0;
};

/// Blocks of the elements of soft bodies in the hessian, which precondition and no more: they are worth computing once
/// a step.
enum class ElementBlocks { None, New, Kept };

/// What a step asks of the solver.
struct SolveSettings {
  float h = 0;  ///< [s] of a substep
  int iterations = 4;
  int krylovIterations = 8;
  int newtonFactor = 8;    ///< Newton steps of islands that are solved exactly: at most so many times the iterations
  float contactLeak = 1;   ///< share of a contact multiplier that survives an iteration
  float jointLeak = 1;     ///< the same of joints outside trees: loops that cannot close must not wind up
  float negligible = 0;    ///< [m] root mean square of a correction that is not worth an iteration of a search
  float floorFactor = 10;  ///< c: stiffness floor is c / (w h^2)
};

}  // namespace avbd
