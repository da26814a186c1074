// What soft bodies do that the solve would take through something: impacts behind the solve.
//
// - Features that come too near slowly have rows that did not hold them. They get equal and opposite impulses along
//   their normal, inelastic ones, which leave them as near as they may come; all that were found are solved together by
//   projected Gauss-Seidel (Bridson, Fedkiw and Anderson 2002; Harmon et al. 2008). Points take their velocities from
//   the ways that they go then. A shape goes on as solved and gets its part as velocity.
// - What meets fast, and what impulses do not keep apart, stops: points go less far of what they go beyond the mean of
//   all that has met, in the end not at all. What the solve had no row for keeps its velocity, for the next step has
//   one.
#pragma once

#include "step/near_shapes.h"
#include "step/soft_touches.h"

namespace avbd {

class SoftImpacts {
 public:
  SoftImpacts(WorldData& world, StepData& step);

  /// Two features meet at a time 0 .. 1 if they go on so.
  void meet(const NearFeatures& near, float time);
  void meet(const ShapePiece& piece, uint32_t soft, uint32_t face, float time);
  bool any() const { return !d_.met.empty(); }
  /// Changes ways so that what has met is kept apart. The soft bodies and points that go other ways now, ascending.
  const std::vector<std::array<uint32_t, 2>>& resolve(int pass);
  /// Poses, shifts and velocities of the points, and what bodies get from them.
  void end();

 private:
  using Impact = SoftImpact;
  using Stop = SoftStop;
  using Group = SoftGroup;

  Impact impactOf(const FeatureNames& names, const FoundTouch& found) const;
  void add(const Impact& impact);
  float wayOf(const Impact& impact) const;
  float mobilityOf(const Impact& impact) const;
  bool yields(uint32_t body) const;
  void begin();
  void push(Impact& impact);
  void forgetMoved();
  bool isPushed(uint32_t slot) const;
  void pushBody(uint32_t slot, Vec3 arm, Vec3 impulse);
  // soft_stops.cpp
  void stopMet(int pass, bool onlyFast);
  void stop(uint32_t body, float share, bool hasRow);
  uint32_t groupOf(uint32_t member);
  void findGroups();
  const std::vector<uint32_t>& bodiesOfShapes();
  void addToGroup(uint32_t body);
  void giveBack();
  void endPoint(uint32_t slot);
  void setWay(uint32_t body, Vec3 way);
  bool moves(uint32_t body) const;

  WorldData& world_;
  StepData& step_;
  SoftSurfaces& s_;
  SoftImpactData& d_;
};

}  // namespace avbd
