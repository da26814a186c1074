// `avbd play`: a recording in the browser, while it grows too.
#include <chrono>
#include <thread>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "viewer/live.h"

namespace avbd::cli {

int playCommand(const PlayArguments& a, std::ostream& out) {
  const LiveServer server(a.file, static_cast<uint16_t>(a.port));
  out << "playing " << a.file << " at " << server.url() << " until Ctrl-C" << std::endl;
  if (!out) return kExitDone;  // the command line says that it cannot write
  try {
    for (;;) {
      throwIfStopped();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  } catch (const Stopped&) {
    return kExitDone;
  }
}

}  // namespace avbd::cli
