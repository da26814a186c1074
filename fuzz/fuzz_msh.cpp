// MSH files: refused with a place, or triangles within range that a hull and a mesh can be tried on.
#include "fuzz/mesh_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  avbd::fuzz::readMeshInput(data, size, "msh");
  return 0;
}
