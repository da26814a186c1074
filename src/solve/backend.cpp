// Choice of the kernels at run time.
#include "solve/backend.h"

namespace avbd {

const Backend& backend(int width) {
  switch (width) {
    case 1:
      return w1::kBackend;
    case 8:
      return w8::kBackend;
    case 16:
      return w16::kBackend;
    default:
      return w4::kBackend;
  }
}

}  // namespace avbd
