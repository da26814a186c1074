// MJCF text: refused with a place, or a world that takes a few steps.
#include "fuzz/model.h"
#include "io/mjcf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  avbd::fuzz::readAndStep([&] { return avbd::readMjcfText({reinterpret_cast<const char*>(data), size}, "fuzz.xml"); });
  return 0;
}
