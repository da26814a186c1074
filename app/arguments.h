// What the user asked for, as plain data.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/scene.h"

namespace avbd::cli {

/// For URDF files only.
struct UrdfArguments {
  bool floating = false, limp = false;
  bool selfCollision = true;
  std::vector<std::string> packages;  ///< NAME=DIR, or DIR that holds packages
  bool skipBadMeshes = false, decompose = false, collideVisuals = false;
  std::optional<std::string> hullCache;  ///< folder; not set: the user's usual one
};

/// Where a browser finds `play` and `run --live`.
inline constexpr int kLivePort = 8642;

/// What a soft body from a file is made of, where it is not as usual (SoftMaterial).
struct MaterialArguments {
  std::optional<double> young, poisson, density;  ///< [Pa], [], [kg/m^3]
  std::string solid;                              ///< neo-hookean or corotational; empty: as usual
};

struct RunArguments {
  std::string scene;               ///< a file, or a scene's name or alias
  std::optional<double> time, dt;  ///< [s]; not set: the file's or scene's own
  std::string html, poses;         ///< files to write; empty: none
  double fps = 60;                 ///< row sets of `poses` and frames of `record` per second of simulated time
  std::string record;              ///< recording to write; empty: none
  std::string probes;              ///< readings of the model's probes to write; empty: none
  std::string trace;               ///< trace of steps and stages to write; empty: none
  std::string control;             ///< control values over time to read; empty: none
  bool live = false;               ///< serve the page while it runs
  int port = kLivePort;            ///< of `live`
  std::optional<std::string> keyframe;
  std::optional<double> soft;  ///< [m] cell of the lattice that a surface becomes
  MaterialArguments material;
  UrdfArguments urdf;
  bool json = false, report = true;
  scenes::Settings settings;
  std::vector<std::string> given;  ///< the arguments as they were, for a recording to hold
};

struct BenchArguments {
  std::vector<std::string> scenes;
  std::vector<std::string> peers;  ///< other engines, by name
  std::vector<int> workers;        ///< one record for each; empty: one worker
  bool json = false;
  scenes::Settings settings;  ///< of which workers is not used
};

struct VerifyArguments {
  std::vector<std::string> names;  ///< lists and lines; empty: all
  bool json = false;
  scenes::Settings settings;
};

struct ConvertArguments {
  std::string file;                   ///< a recording
  std::string csv, json, mcap, html;  ///< files to write; empty: none
};

struct PlayArguments {
  std::string file;  ///< a recording
  int port = kLivePort;
};

struct ReplayArguments {
  std::string file;           ///< a recording
  scenes::Settings settings;  ///< in place of the recorded run's own
};

struct InfoArguments {
  std::string file;  ///< a model, a mesh, a recording, or a scene's name
  std::optional<std::string> keyframe;
  std::optional<double> soft;  ///< as of `run`
  UrdfArguments urdf;
  bool json = false;
};

struct ScenesArguments {};

/// Help or the version.
struct PrintText {
  std::string text;
};

using Arguments = std::variant<PrintText, RunArguments, BenchArguments, VerifyArguments, ConvertArguments,
                               PlayArguments, ReplayArguments, InfoArguments, ScenesArguments>;

/// `args` without the program's name. Throws BadInput.
Arguments parseArguments(std::vector<std::string> args);

}  // namespace avbd::cli
