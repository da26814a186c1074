// Small worlds that between them use every kind of shape, joint and row, for comparing bits.
#pragma once

#include <avbd/avbd.h>

#include <functional>
#include <string>
#include <vector>

namespace avbd::bits {

struct Trial {
  std::string name;
  std::function<World(const WorldDef&)> make;
  int steps = 0;                         ///< 0: fewer the more bodies there are
  bool sweep = false;                    ///< once more with the block sweep
  std::function<void(World&)> before{};  ///< before each step; may be empty
};

/// The small ones of these tests, made here.
std::vector<Trial> smallTrials();
/// The benchmark's scenes for a few steps.
std::vector<Trial> sceneTrials();

}  // namespace avbd::bits
