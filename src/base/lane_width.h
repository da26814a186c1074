// Which lane widths this processor runs.
#pragma once

namespace avbd {

/// Of 1, 4, 8 and 16; the narrow ones run everywhere, the wide ones on x86-64 where their instructions exist.
bool laneWidthRuns(int width);
/// Widest that this processor runs well.
int widestLane();

}  // namespace avbd
