// What a fuzz target does when it has found something: says what, and stops the process so that the input is kept.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace avbd::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "found: %s\n", what);
  std::abort();
}

}  // namespace avbd::fuzz
