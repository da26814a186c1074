// What ends a command early.
#pragma once

#include <stdexcept>

namespace avbd::cli {

/// The user asked for something that cannot be done.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The simulation left the finite numbers.
struct NonFiniteRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// requestStop() was called.
struct Stopped {};

/// Throws Stopped if requestStop() was called since the last time.
void throwIfStopped();

}  // namespace avbd::cli
