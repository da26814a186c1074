// Recordings as text that other programs read. Written frame by frame, whatever their number.
#pragma once

#include <ostream>

#include "io/record/reader.h"

namespace avbd {

/// A row for each body and frame: time, body, x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz. Numbers read back as the
/// same bits; velocities are empty where they were not recorded.
void exportCsv(RecordReader& reader, std::ostream& out);
/// One object with everything; what is not finite is null.
void exportJson(RecordReader& reader, std::ostream& out);

struct McapOptions {
  bool compress = true;  ///< chunks with zstd, where the build has it
};
/// MCAP (mcap.dev) with JSON messages for Foxglove and the like: foxglove.FrameTransforms on /tf,
/// foxglove.SceneUpdate on /scene, avbd.Figures on /figures, avbd.Contacts on /contacts and avbd.Events on /events.
void exportMcap(RecordReader& reader, std::ostream& out, const McapOptions& options = {});

}  // namespace avbd
