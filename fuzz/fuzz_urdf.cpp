// URDF text: refused with a place, or a world that takes a few steps.
#include "fuzz/model.h"
#include "io/urdf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  avbd::UrdfOptions options;
  options.floating = size % 2 == 1;
  avbd::fuzz::readAndStep([&] {
    return avbd::readUrdfText({reinterpret_cast<const char*>(data), size}, "fuzz.urdf", options);
  });
  return 0;
}
