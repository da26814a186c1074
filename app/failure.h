// What ends a command early.
#pragma once

#include <stdexcept>

#include "io/model.h"

namespace avbd::cli {

/// The user asked for something that cannot be done.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The simulation left the finite numbers.
struct NonFiniteRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// With the body's name instead of its id.
NonFiniteRun nonFiniteRun(const Model& model, const NonFiniteError& error, int64_t step, double time);

/// requestStop() was called.
struct Stopped {};
/// Throws Stopped if requestStop() was called since the last time.
void throwIfStopped();

}  // namespace avbd::cli
