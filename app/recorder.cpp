// A source's frames with penetration and joint gap.
#include "app/recorder.h"

#include <algorithm>

namespace avbd::cli {
namespace {

constexpr size_t kFewestContacts = 1000;

}  // namespace

Recorder::Recorder(const Model& model, size_t frames, size_t contactsMax)
    : source_(model),
      layout_(scenes::layoutOf(model.world)),
      contactsPerFrame_(std::max(kFewestContacts, contactsMax / std::max<size_t>(1, frames))) {
  for (const BodyId id : layout_.bodies) order_.push_back(source_.slotOf(id));
}

RecordedFrame Recorder::frame(const Model& model, double time) {
  RecordedFrame frame = source_.frame(model, time, contactsPerFrame_);
  std::vector<Pose> ordered;
  for (const uint32_t slot : order_) ordered.push_back(frame.poses[slot]);
  frame.penetrationMax = scenes::penetrationOf(layout_, ordered).max;
  frame.jointGapMax = scenes::jointGapMax(layout_, ordered);
  return frame;
}

}  // namespace avbd::cli
