// Reads MJCF (MuJoCo's XML) into a world; docs/mjcf.md says what is kept, changed and left out.
#pragma once

#include "io/file_error.h"
#include "io/model.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace avbd {

struct MjcfOptions {
  WorldDef world;         ///< settings of the world; its gravity is replaced by the file's
  /// Keyframe that the bodies start at. Empty: the first one, if the file has any.
  std::string keyframe;
  bool useKeyframe = true;  ///< false: start as the bodies stand in the file, as MuJoCo does
};

/// Throws FileError: nothing is returned half-made. World axes are the file's: z is up where its gravity says so.
Model readMjcf(const std::filesystem::path& file, const MjcfOptions& options = {});
/// The same from text, which cannot include files.
Model readMjcfText(std::string_view xml, std::string_view nameForMessages, const MjcfOptions& options = {});

}  // namespace avbd
