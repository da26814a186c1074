// The commands. Each returns an exit status and throws what failure.h lists, Error or FileError.
#pragma once

#include <ostream>

#include "app/arguments.h"

namespace avbd::cli {

int runCommand(const RunArguments& arguments, std::ostream& out, std::ostream& err);
int scenesCommand(std::ostream& out);
/// Each record is printed as soon as it is measured. A peer's failed check is shown but is no failure of ours.
int benchCommand(const BenchArguments& arguments, std::ostream& out);
int verifyCommand(const VerifyArguments& arguments, std::ostream& out);
int convertCommand(const ConvertArguments& arguments, std::ostream& out, std::ostream& err);
/// Serves until requestStop(), which is how it ends in order.
int playCommand(const PlayArguments& arguments, std::ostream& out);

/// Status kExitCheckFailed where the run does not go as it was recorded.
int replayCommand(const ReplayArguments& arguments, std::ostream& out);

int infoCommand(const InfoArguments& arguments, std::ostream& out);

/// The catalogue's scene. Throws BadInput that lists near names.
const scenes::Scene& sceneNamed(const std::string& name);

}  // namespace avbd::cli
