// GMSH files: refused with a place, not read for a reason, or elements whose points there are.
#include <cmath>

#include "fuzz/check.h"
#include "io/gmsh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using avbd::fuzz::require;
  try {
    const avbd::GmshFile file = avbd::readGmsh({reinterpret_cast<const char*>(data), size}, "fuzz.msh");
    require(file.leftOut.empty() != file.elements.empty(), "neither elements nor a reason");
    for (const auto& element : file.elements)
      for (const uint32_t corner : element) require(corner < file.points.size(), "a corner beyond the points");
    for (const avbd::Vec3 p : file.points)
      require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a point that is not finite");
  } catch (const avbd::FileError&) {
  }
  return 0;
}
