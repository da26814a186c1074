// From arguments to a command, and from what it throws to an exit status.
#include "app/command_line.h"

#include <exception>
#include <new>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/failure.h"

namespace avbd::cli {
namespace {

int dispatch(const Arguments& arguments, std::ostream& out, std::ostream& err) {
  if (const auto* text = std::get_if<PrintText>(&arguments)) {
    out << text->text;
    return kExitDone;
  }
  if (const auto* run = std::get_if<RunArguments>(&arguments)) return runCommand(*run, out, err);
  if (const auto* bench = std::get_if<BenchArguments>(&arguments)) return benchCommand(*bench, out);
  if (const auto* verify = std::get_if<VerifyArguments>(&arguments)) return verifyCommand(*verify, out);
  if (const auto* convert = std::get_if<ConvertArguments>(&arguments)) return convertCommand(*convert, out, err);
  if (const auto* play = std::get_if<PlayArguments>(&arguments)) return playCommand(*play, out);
  if (const auto* replay = std::get_if<ReplayArguments>(&arguments)) return replayCommand(*replay, out);
  if (const auto* info = std::get_if<InfoArguments>(&arguments)) return infoCommand(*info, out);
  return scenesCommand(out);
}

// One line, whatever the text holds: file names and XML may bring line ends with them.
int fail(std::ostream& err, std::string message, int status) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  while (message.ends_with(' ')) message.pop_back();
  err << "avbd: error: " << message << "\n";
  err.flush();
  return status;
}

}  // namespace

int runCommandLine(std::vector<std::string> args, std::ostream& out, std::ostream& err) {
  try {
    const int status = dispatch(parseArguments(std::move(args)), out, err);
    if (!out.flush()) return fail(err, "standard output: cannot write", kExitBadInput);
    return status;
  } catch (const Stopped&) {
    return fail(err, "stopped", kExitStopped);
  } catch (const NonFiniteRun& e) {
    return fail(err, e.what(), kExitNonFinite);
  } catch (const std::bad_alloc&) {
    return fail(err, "out of memory", kExitBadInput);
  } catch (const std::exception& e) {
    return fail(err, e.what(), kExitBadInput);
  }
}

}  // namespace avbd::cli
