// For tests: the robots of Debian's libsimbody-dev.
#pragma once

#include <filesystem>

namespace avbd {

inline const std::filesystem::path kSimbodyExamples = "/usr/share/doc/simbody/examples/src";

/// Why its robots are not here; nullptr where they are.
inline const char* simbodyRobotsMissing() {
  namespace fs = std::filesystem;
  if (fs::exists(kSimbodyExamples / "TaskSpaceControl-UR10/models")) return nullptr;
  // dpkg leaves out what `path-exclude` names, on slim images all of /usr/share/doc.
  return fs::exists("/usr/include/simbody")
             ? "libsimbody-dev is installed without its /usr/share/doc (dpkg path-exclude)"
             : "libsimbody-dev is not installed";
}

}  // namespace avbd
