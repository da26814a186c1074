// Takes frames of a world while it runs, with the figures that are measured over the poses.
#pragma once

#include <span>
#include <vector>

#include "io/model.h"
#include "io/record/source.h"
#include "scenes/measure.h"

namespace avbd::cli {

class Recorder {
 public:
  /// Keeps at most about `contactsMax` contact points, the strongest of each frame, if there will be this many frames.
  Recorder(const Model& model, size_t frames, size_t contactsMax = 8'000'000);

  const Recording& head() const { return source_.head(); }
  /// To be called after every step.
  void watch(const World& world) { source_.watch(world); }
  /// The world's state, with the events watched since the last frame.
  RecordedFrame frame(const Model& model, double time);

 private:
  RecordSource source_;
  scenes::Layout layout_;
  std::vector<uint32_t> order_;  ///< the model's order of each of the layout's bodies
  size_t contactsPerFrame_;
};

}  // namespace avbd::cli
