// For tests: how many events steps had.
#pragma once

#include <avbd/world.h>

namespace avbd {

struct Counts {
  int begins = 0, ends = 0, enters = 0, leaves = 0, hits = 0;
};

/// Steps of 1/60 s.
inline Counts countOver(World& world, int steps) {
  Counts n;
  for (int i = 0; i < steps; ++i) {
    world.step(1.0f / 60);
    const Events& e = world.events();
    n.begins += static_cast<int>(e.begins.size()), n.ends += static_cast<int>(e.ends.size());
    n.enters += static_cast<int>(e.enters.size()), n.leaves += static_cast<int>(e.leaves.size());
    n.hits += static_cast<int>(e.hits.size());
  }
  return n;
}

}  // namespace avbd
