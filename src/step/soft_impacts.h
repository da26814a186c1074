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
  SoftImpacts(WorldData& world, StepData& step) : world_(world), step_(step), s_(step.softs) {}

  /// Two features meet at a time 0 .. 1 if they go on so.
  void meet(const NearFeatures& near, float time);
  void meet(const ShapePiece& piece, uint32_t soft, uint32_t face, float time);
  bool any() const { return !met_.empty(); }
  /// Changes ways so that what has met is kept apart. `changed`: soft bodies and points that go other ways now.
  void resolve(int pass, std::vector<std::array<uint32_t, 2>>& changed);
  /// Poses, shifts and velocities of the points, and what bodies get from them.
  void end();

 private:
  struct Impact {
    bool ofShape = false;
    std::array<uint32_t, 4> nodes{};  ///< body slots
    std::array<float, 4> weight{};    ///< SoftTouch's
    Vec3 normal;                      ///< unit, from the second side to the first
    Vec3 arm;                         ///< of a shape from its body's centre of mass to where it meets
    float start = 0;                  ///< [m] along the normal at the start of the step, less what is to be left
    float shapeWay = 0;               ///< [m] of a shape along the normal
    float time = 1;                   ///< 0 .. 1 of the step, when so much is to be left
    bool isFast = false;
    bool hasRow = false;  ///< the solve knew of it
    float meets = 0;      ///< 0 .. 1 of the step
    float impulse = 0;    ///< [kg m] >= 0: a change of ways
  };
  /// Of a point that is stopped.
  struct Stop {
    Vec3 way;             ///< [m] that it went before
    float share = 1;      ///< of that, beyond its group's
    bool hadRow = false;  ///< for all that it met
    Vec3 taken;           ///< [kg m] impulses that did not move it
  };
  /// Soft bodies and shapes' bodies that have met.
  struct Group {
    float mass = 0;
    Vec3 way;               ///< [kg m] of all, then [m] the mean
    uint32_t held = kNone;  ///< a body that does not yield, whose way is the group's
    Vec3 lost;              ///< [kg m] that stops took
  };

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
  std::vector<uint32_t> bodiesOfShapes() const;
  void addToGroup(uint32_t body);
  void giveBack();
  void endPoint(uint32_t slot);
  void setWay(uint32_t body, Vec3 way);
  bool moves(uint32_t body) const;
  Vec3 solvedWay(uint32_t body) const;

  WorldData& world_;
  StepData& step_;
  SoftSurfaces& s_;
  std::vector<Impact> impacts_;
  std::vector<size_t> met_;        ///< of `impacts_`, in this pass
  std::vector<uint32_t> pointOf_;  ///< by body slot
  std::vector<uint8_t> touched_;   ///< by body slot: it is in `changed_`
  std::vector<uint32_t> changed_;  ///< body slots whose ways changed in this pass
  std::vector<Stop> stops_;        ///< by body slot
  std::vector<uint32_t> stopped_;  ///< body slots
  std::vector<uint32_t> parent_;   ///< of members of groups: soft slots, then body slots
  std::vector<Group> groups_;      ///< by the member that names it
};

}  // namespace avbd
