// Writes a recording as one HTML file that plays it in a browser, with no network and no other file.
#pragma once

#include <filesystem>
#include <ostream>

#include "io/record/recording.h"

namespace avbd {

struct PageOptions {
  /// Contact points stored over all frames (about 17 bytes of file each). A longer recording keeps the strongest ones
  /// of each frame, and the page says how many it shows of how many.
  size_t contactsMax = 600'000;
};

/// Throws std::invalid_argument for a recording that does not fit together, before the file is touched, and
/// std::runtime_error if the file cannot be written.
void writePage(const std::filesystem::path& file, const Recording& recording, const PageOptions& options = {});
void writePage(std::ostream& out, const Recording& recording, const PageOptions& options = {});

/// The page with no recording in it: it asks the server it came from, at this port, for everything.
void writeLivePage(std::ostream& out, uint16_t port);

namespace page {

struct LiveHead {
  std::string json;
  Vec3d origin;  ///< positions that the page is sent are relative to this
};
/// The head of a page whose frames are sent one by one. The recording must hold its first frame.
LiveHead liveHead(const Recording& recording);

}  // namespace page
}  // namespace avbd
