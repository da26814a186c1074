// The whole command line as one function.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace avbd::cli {

enum ExitStatus : int {
  kExitDone = 0,
  kExitCheckFailed = 1,  ///< of `bench`, `verify` and `replay`
  kExitBadInput = 2,     ///< one message on `err`; nothing was created, but for a recording that had begun
  kExitNonFinite = 3,    ///< the simulation left the finite numbers; nothing was created but the recording up to there
  kExitStopped = 130,    ///< by requestStop()
};

/// Runs `avbd` with these arguments (without the program's name) and returns its exit status. Throws nothing.
int runCommandLine(std::vector<std::string> args, std::ostream& out, std::ostream& err);

/// Ends what is running as soon as it can; may be called by a signal. Leaves no files but the recording of `--record`,
/// which is closed and holds all frames up to there.
void requestStop() noexcept;

}  // namespace avbd::cli
