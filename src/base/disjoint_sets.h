// Disjoint sets by parents: a set is named by its least member, which is its own parent.
#pragma once

#include <cstdint>
#include <vector>

namespace avbd {

/// The least of i's set; shortens the way there.
inline uint32_t setOf(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

inline void join(std::vector<uint32_t>& parent, uint32_t a, uint32_t b) {
  a = setOf(parent, a), b = setOf(parent, b);
  if (a < b) parent[b] = a;
  if (b < a) parent[a] = b;
}

}  // namespace avbd
