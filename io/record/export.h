// Recordings as text that other programs read. Written frame by frame, whatever their number.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "io/record/reader.h"

namespace avbd {

// Frames that cannot be read are left out. Each returns what that were, a line for every run of them.

/// A row for each body and frame: time, body, x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz. Numbers read back as the
/// same bits; velocities are empty where they were not recorded.
std::vector<std::string> exportCsv(RecordReader& reader, std::ostream& out);
/// One object with everything; what is not finite is null.
std::vector<std::string> exportJson(RecordReader& reader, std::ostream& out);

struct McapOptions {
  bool compress = true;  ///< chunks with zstd, where the build has it
};
/// MCAP (mcap.dev) with JSON messages for Foxglove and the like: foxglove.FrameTransforms on /tf,
/// foxglove.SceneUpdate on /scene, avbd.Figures on /figures, avbd.Contacts on /contacts and avbd.Events on /events.
std::vector<std::string> exportMcap(RecordReader& reader, std::ostream& out, const McapOptions& options = {});

/// Every frame that can be read, in order, until `use` returns false; lines as above.
std::vector<std::string> eachFrame(RecordReader& reader, const std::function<bool(const RecordedFrame&)>& use);

}  // namespace avbd
