// Which lane widths this processor runs.
#include "base/lane_width.h"

namespace avbd {

bool laneWidthRuns(int width) {
#if defined(__x86_64__)
  if (width == 8) return __builtin_cpu_supports("avx2");
  if (width == 16)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq");
#endif
  return width == 1 || width == 4 || width == 8 || width == 16;
}

int widestLane() {
#if defined(__x86_64__)
  if (laneWidthRuns(16)) return 16;
  if (laneWidthRuns(8)) return 8;
#endif
  return 4;
}

}  // namespace avbd
