// A world under fuzzing beside a record of what ought to be in it.
#pragma once

#include <avbd/avbd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/check.h"

namespace avbd::fuzz {

inline bool isFinite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool isFinite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool isUnit(Vec3 v) { return std::fabs(length(v) - 1) < 1e-3f; }

/// Decodes calls from bytes and makes them in a world that begins as one of a few scenes, at the origin or far from it.
/// After each: a refused call has changed nothing, what lives and what is dead is as recorded, every body, contact and
/// reaction is finite, queries find every convex shape where its pose says, and events tell of what was not so before.
class Session {
 public:
  Session(Bytes& in, int simdWidth);
  /// Returns a hash over all states of the world on the way.
  uint64_t run();

 private:
  /// As events count: a soft body or, with a null id of that, a shape.
  using Thing = std::pair<SoftId, ShapeId>;
  using Pair = std::pair<Thing, Thing>;
  static Pair pairOf(SoftId softA, ShapeId shapeA, SoftId softB, ShapeId shapeB) {
    const Thing a{softA, softA ? ShapeId{} : shapeA}, b{softB, softB ? ShapeId{} : shapeB};
    return std::minmax(a, b);
  }

  template <class Call>
  void attempt(Call&& call);
  void act();
  void check();
  Vec3d place() { return in_.position() + offset_; }
  Pose placePose();

  // session_told.cpp
  uint64_t told() const;
  void checkFound() const;

  // session_scenes.cpp
  void begin(uint32_t scene, int count);
  void add(const BodyDef& def);
  void pile(int count);
  void chain(int count);
  void hills(int count);
  void machine(int count);
  void arm(int count);
  void addTreeJoint(int kind, std::array<BodyId, 2> ends, const std::array<Pose, 2>& frames);

  // session_make.cpp
  void make();
  void makeJoint();
  void makeSoft();
  SoftMaterial softMaterial();
  SoftDef softDef();
  void makeMovingJoint(uint32_t kind, BodyId a, BodyId b, const Pose& frameA, const Pose& frameB);
  D6Axis axis();
  BodyDef bodyDef();
  ShapeDef shapeDef();
  Geometry geometry();
  Geometry convexGeometry();
  Material material();
  Filter filter();
  BodyId anyBody();
  ShapeId anyShape();

  // session_change.cpp
  void change();
  void changeBody(BodyId body);
  void changeJoint();
  void changeShape(ShapeId shape);
  void changeMany();
  void push(BodyId body);
  void remove();
  void bodyGone(BodyId id);
  void moveWorld();
  void setHook();

  // session_articulation.cpp
  void articulate();
  void changeTree(uint32_t what);
  void changeSelfCollision();
  void askTree(bool elsewhere);
  void checkDynamics(const ArticulationDynamics& dynamics);
  std::vector<double> numbers(size_t count);
  JointId anyJoint();

  // session_ask.cpp
  void read();
  void readJoints();
  void ask();
  void askRays(const QueryFilter& filter);
  void askCasts(const QueryFilter& filter);
  void askPlaces(const QueryFilter& filter);
  void askMany(const QueryFilter& filter);
  void walk();
  QueryFilter queryFilter();
  void checkHit(const CastHit& hit, double way, const QueryFilter& filter) const;
  void checkNear(const NearHit& hit, float most, const QueryFilter& filter) const;
  void checkSeen(ShapeId shape, BodyId body, const QueryFilter& filter) const;

  // session_step.cpp
  void step();
  void checkEvents();
  std::set<Pair> follow(std::set<Pair>& now, const std::set<Pair>& begins, const std::set<Pair>& ends);
  void checkTouches();
  void checkVisits();
  void checkContacts() const;
  bool everLived(ShapeId id) const;
  bool lives(const Thing& thing) const {
    return thing.first ? world_.isAlive(thing.first) : world_.isAlive(thing.second);
  }

  Bytes& in_;
  World world_;
  Vec3d offset_;  // of all that happens
  std::vector<BodyId> bodies_, deadBodies_;
  std::vector<SoftId> softs_;
  std::vector<ShapeId> shapes_, deadShapes_;
  std::vector<JointId> joints_, deadJoints_;
  std::set<ShapeId> silent_;  // without contactEvents
  std::set<Pair> touching_, visiting_;
  std::optional<Mover> mover_;
  std::optional<Articulation> tree_;
};

}  // namespace avbd::fuzz
