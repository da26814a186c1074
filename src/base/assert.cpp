// What a failed AVBD_ASSERT does: says where on standard error and aborts.
#include "base/assert.h"

#include <cstdio>
#include <cstdlib>

namespace avbd {

void assertFailed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: AVBD_ASSERT(%s) failed\n", file, line, expression);
  std::abort();
}

}  // namespace avbd
