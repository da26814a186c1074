// From a world's getters to a recording's head and frames.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "io/model.h"
#include "io/record/recording.h"

namespace avbd {

/// How far a joint's coordinates lie beyond their limits, and its swing beyond its cone.
struct LimitExcess {
  double length = 0, angle = 0;  ///< [m], [rad]
};
LimitExcess limitExcess(const World& world, JointId joint);

// Of pulleys, couplings and custom joints (source_links.cpp): what the head says of them but bodies, frames and terms,
// and their RecordedFrame::residuals. Of joints of other types nothing.
void describeLink(const World& world, JointId joint, RecordedJoint& out);
std::vector<RecordedTerm> termsOf(const Coupling& coupling, std::span<const JointId> recorded);
void addResiduals(const World& world, JointId joint, std::vector<float>& out);

class RecordSource {
 public:
  explicit RecordSource(const Model& model);

  /// Bodies in the model's order but for the points of soft bodies, which come last.
  const Recording& head() const { return head_; }
  /// To be called after every step: keeps the events for the next frame, however many steps lie between two.
  void watch(const World& world);
  /// The world's state now, with the events watched since the last frame. Of more contact points than `contactsMost`
  /// the strongest are kept. penetrationMax and jointGapMax are left for others to measure. The bodies and shapes must
  /// be those of the constructor's model; a joint destroyed since is one that is not enabled.
  RecordedFrame frame(const Model& model, double time, size_t contactsMost = SIZE_MAX);
  /// Index into head().bodies, or kNotRecorded.
  uint32_t slotOf(BodyId id) const;

 private:
  uint32_t slotOf(ShapeId id) const;
  void addSofts(const Model& model);
  void addJoints(const Model& model);
  void addTerms(const World& world);
  void addJointStates(const World& world, RecordedFrame& frame) const;
  void addContacts(const World& world, size_t most, RecordedFrame& frame) const;

  Recording head_;
  std::vector<BodyId> ids_;
  std::vector<JointId> joints_;  // of the head's joints
  std::vector<RecordedEvent> events_;
  std::unordered_map<uint32_t, uint32_t> bodies_, shapes_;  // from an id's index to the head's order
};

}  // namespace avbd
