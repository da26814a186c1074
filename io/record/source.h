// From a world's getters to a recording's head and frames.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "io/model.h"
#include "io/record/recording.h"

namespace avbd {

class RecordSource {
 public:
  explicit RecordSource(const Model& model);

  const Recording& head() const { return head_; }
  /// To be called after every step: keeps the events for the next frame, however many steps lie between two.
  void watch(const World& world);
  /// The world's state now, with the events watched since the last frame. Of more contact points than `contactsMost`
  /// the strongest are kept. penetrationMax and jointGapMax are left for others to measure. The bodies and shapes must
  /// be those of the constructor's model.
  RecordedFrame frame(const Model& model, double time, size_t contactsMost = SIZE_MAX);
  /// Index into head().bodies, or kNotRecorded.
  uint32_t slotOf(BodyId id) const;

 private:
  uint32_t slotOf(ShapeId id) const;
  void addJoints(const World& world);
  void addContacts(const World& world, size_t most, RecordedFrame& frame) const;

  Recording head_;
  std::vector<BodyId> ids_;
  std::vector<RecordedEvent> events_;
  std::unordered_map<uint32_t, uint32_t> bodies_, shapes_;  // from an id's index to the head's order
};

}  // namespace avbd
