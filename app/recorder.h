// Fills a Recording while a world runs.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "io/model.h"
#include "scenes/measure.h"
#include "viewer/recording.h"

namespace avbd::cli {

class Recorder {
 public:
  /// Keeps at most about `contactsMax` contact points, the strongest of each frame, if there will be this many frames.
  Recorder(const Model& model, size_t frames, size_t contactsMax = 8'000'000);

  /// Adds the world's state as a frame. `poses` are of the model's bodies in their order.
  void add(const Model& model, double time, std::span<const Pose> poses);
  Recording& recording() { return recording_; }

 private:
  void addJoints(const World& world);
  uint32_t slotOf(BodyId id) const;

  Recording recording_;
  scenes::Layout layout_;
  std::unordered_map<uint32_t, uint32_t> slots_;  ///< from BodyId::index to the model's order
  std::vector<uint32_t> order_;                   ///< the model's order of each of the layout's bodies
  size_t contactsPerFrame_;
};

}  // namespace avbd::cli
