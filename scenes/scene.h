// A scene: a function that builds a world, how to run it, and a check of the result.
#pragma once

#include <avbd/avbd.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace avbd::scenes {

/// One figure that a scene's check measured, against its bounds.
struct Figure {
  std::string name;    ///< e.g. "penetration_max"
  std::string params;  ///< e.g. "mu=0.5", empty if none
  double measured = 0;
  double lower = 0, upper = 0;  ///< passes if finite and lower <= measured <= upper
  std::string unit;
};

}  // namespace avbd::scenes
