// From what the user named to a model and a plan.
#pragma once

#include "app/arguments.h"
#include "io/model.h"

namespace avbd::cli {

/// A built-in scene by its name, else a soft mesh, or a MJCF or URDF file by its root element. Throws BadInput,
/// FileError or Error.
Model loadModel(const RunArguments& arguments);

struct Plan {
  double dt = 0;  ///< [s]
  int64_t steps = 0;
};

/// Throws BadInput for a step or time that no run can have.
Plan planRun(const RunArguments& arguments, const Model& model);

}  // namespace avbd::cli
