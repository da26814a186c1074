// Names of the stages of a step.
#include <avbd/profile.h>

namespace avbd {

const char* stageName(Stage stage) {
  switch (stage) {
    case Stage::Pairs:
      return "pairs";
    case Stage::Contacts:
      return "contacts";
    case Stage::Islands:
      return "islands";
    case Stage::Colors:
      return "colors";
    case Stage::BeginRows:
      return "begin_rows";
    case Stage::Predict:
      return "predict";
    case Stage::SolveBlocks:
      return "solve_blocks";
    case Stage::UpdateRows:
      return "update_rows";
    case Stage::Velocities:
      return "velocities";
    case Stage::Continuous:
      return "continuous";
    case Stage::Sleep:
      return "sleep";
    case Stage::Publish:
      return "publish";
  }
  return "unknown";
}

}  // namespace avbd
