// TetGen's two files, the points before a line of %% and the tetrahedra behind it: refused with a place, or a soft mesh
// that can be made and bound to.
#include <string_view>

#include "fuzz/soft_mesh_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr std::string_view kBetween = "%%\n";
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const size_t middle = std::min(text.find(kBetween), size);
  const size_t behind = std::min(middle + kBetween.size(), size);
  avbd::fuzz::readSoftMeshInput([&] {
    const auto bytes = std::as_bytes(std::span(data, size));
    return avbd::readTetgenBytes(bytes.first(middle), bytes.subspan(behind), "fuzz");
  });
  return 0;
}
