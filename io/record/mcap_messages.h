// The messages of an MCAP export as JSON, and the schemas that describe them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/record/recording.h"

namespace avbd::record {

struct McapTopic {
  std::string_view name, schemaName, schema;
};
/// Channel and schema number i + 1 is element i.
inline constexpr uint16_t kMcapScene = 1, kMcapTransforms = 2, kMcapFigures = 3, kMcapContacts = 4, kMcapEvents = 5;
const std::array<McapTopic, 5>& mcapTopics();

class McapMessages {
 public:
  explicit McapMessages(const Recording& head);

  /// All shapes but balls of soft bodies, each locked to its body's frame.
  std::string scene(uint64_t nanoseconds) const;
  /// The surfaces of all soft bodies, in the world.
  std::string softs(const RecordedFrame& frame, uint64_t nanoseconds) const;
  /// Of all bodies that are no points of soft bodies.
  std::string transforms(const RecordedFrame& frame, uint64_t nanoseconds) const;
  std::string figures(const RecordedFrame& frame) const;
  std::string contacts(const RecordedFrame& frame) const;
  std::string events(const RecordedFrame& frame) const;

 private:
  const Recording& head_;
  std::vector<std::vector<uint32_t>> corners_;  // of soft bodies: the points of their surfaces
  std::vector<std::string> triangles_;          // their triangles, as numbers of those, and their colours
  std::vector<std::string> frames_;             // names of the bodies' frames, each once, as JSON
};

}  // namespace avbd::record
