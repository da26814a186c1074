// Gmsh's MSH files: refused with a place, or a soft mesh that can be made and bound to.
#include "fuzz/soft_mesh_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  avbd::fuzz::readSoftMeshInput(data, size, "msh");
  return 0;
}
