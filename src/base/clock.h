// Wall time, for what a step reports of itself.
#pragma once

#include <chrono>

namespace avbd {

/// [s] since some moment before.
inline double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace avbd
