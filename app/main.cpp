// The program: signals and streams; the rest is the library's.
#include <csignal>
#include <iostream>

#include "app/command_line.h"

namespace {

void stop(int) { avbd::cli::requestStop(); }

}  // namespace

int main(int argc, char** argv) {
  // The first signal ends the run in order, so that no file stays behind half-written; the second one kills.
  struct sigaction action {};
  action.sa_handler = stop;
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::ios::sync_with_stdio(false);
  return avbd::cli::runCommandLine({argv + (argc > 0 ? 1 : 0), argv + argc}, std::cout, std::cerr);
}
