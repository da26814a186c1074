// What the user asked for, as plain data.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/scene.h"

namespace avbd::cli {

struct RunArguments {
  std::string scene;               ///< a file, or a scene's name or alias
  std::optional<double> time, dt;  ///< [s]; not set: the file's or scene's own
  std::string html, poses;         ///< files to write; empty: none
  double fps = 60;                 ///< row sets of `poses` per second of simulated time
  std::optional<std::string> keyframe;
  bool json = false, report = true;
  scenes::Settings settings;
};

struct BenchArguments {
  std::vector<std::string> scenes;
  bool bullet = false, json = false;
  scenes::Settings settings;
};

struct VerifyArguments {
  std::vector<std::string> names;  ///< lists and lines; empty: all
  bool json = false;
  scenes::Settings settings;
};

struct ScenesArguments {};

/// Help or the version.
struct PrintText {
  std::string text;
};

using Arguments = std::variant<PrintText, RunArguments, BenchArguments, VerifyArguments, ScenesArguments>;

/// `args` without the program's name. Throws BadInput.
Arguments parseArguments(std::vector<std::string> args);

}  // namespace avbd::cli
