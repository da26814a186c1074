// Writes a recording as one HTML file that plays it in a browser, with no network and no other file.
#pragma once

#include <filesystem>
#include <ostream>

#include "viewer/recording.h"

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

}  // namespace avbd
