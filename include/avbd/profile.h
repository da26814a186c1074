// What a step did and what it cost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace avbd {

/// Stages of a step in the order in which they run; the files of src/step carry the same names.
enum class Stage : uint8_t {
  Pairs,
  Contacts,
  Islands,
  Colors,
  BeginRows,
  Predict,
  SolveBlocks,
  UpdateRows,
  Velocities,
  Continuous,
  Sleep,
  Publish
};
inline constexpr size_t kStageCount = 12;
/// Name of a stage as in its file: "pairs", "contacts", ... "publish".
const char* stageName(Stage stage);

/// Figures of the last step.
struct StepReport {
  uint64_t step = 0;      ///< how many steps this world has made
  uint32_t bodies = 0;    ///< dynamic bodies that were awake
  uint32_t asleep = 0;    ///< dynamic bodies that sleep at its end; what follows leaves out what belongs to sleepers
  uint32_t pairs = 0;     ///< pairs of shapes whose bounds overlap
  uint32_t contacts = 0;  ///< pairs with at least one contact point
  uint32_t points = 0;    ///< contact points
  uint32_t joints = 0;
  uint32_t islands = 0;
  uint32_t colors = 0;                        ///< of the block sweep; 0 where it did not run
  uint32_t fastBodies = 0;                    ///< moved so far in the last substep that their way was searched
  uint32_t impacts = 0;                       ///< found on those ways, each at its own time within the step
  uint32_t simdWidth = 0;                     ///< lanes used: 1, 4, 8 or 16
  uint32_t sharedRuns = 0;                    ///< work that was cut for several threads, each with a wait for its end
  std::array<double, kStageCount> seconds{};  ///< wall time of each stage
  std::array<double, kStageCount> sharedSeconds{};  ///< of that in work cut for several threads, few or many
};

}  // namespace avbd
