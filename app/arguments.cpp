// The grammar of the command line.
#include "app/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/failure.h"
#include "app/near_names.h"
#include "app/number_text.h"
#include "bench/bench.h"

namespace avbd::cli {
namespace {

constexpr const char* kSolver = "Solver";
constexpr const char* kSoft =
    "of a closed surface (.obj, .stl, .msh): makes it a soft body of a lattice of this cell [m]";

void addSolver(CLI::App& command, scenes::Settings& s, std::string& solver) {
  command.add_option("--substeps", s.substeps, "substeps of a step [1]")->group(kSolver);
  command.add_option("--iterations", s.iterations, "outer iterations of a substep [4]")->group(kSolver);
  command.add_option("--solver", solver, "krylov or sweep [krylov]")
      ->check(CLI::IsMember({"krylov", "sweep"}))
      ->group(kSolver);
  command.add_option("--krylov", s.krylovIterations, "conjugate-gradient steps of an iteration; 0 for the default")
      ->group(kSolver);
  command.add_option("--simd", s.simdWidth, "lanes: 1, 4, 8 or 16; 0 for the widest")
      ->check(CLI::IsMember({0, 1, 4, 8, 16}))
      ->group(kSolver);
  command
      .add_flag_callback(
          "--sleep", [&s] { s.sleep = true; }, "bodies at rest fall asleep; else they do not")
      ->group(kSolver);
}

void addSettings(CLI::App& command, scenes::Settings& s, std::string& solver) {
  command.add_option("--workers", s.workers, "threads [1]")->group(kSolver);
  addSolver(command, s, solver);
}

void setSolver(scenes::Settings& s, const std::string& solver) {
  if (!solver.empty()) s.primalSolver = solver == "sweep" ? PrimalSolver::BlockSweep : PrimalSolver::Krylov;
}

// The bounds of settings are the library's own; a world that refuses them does so before anything has happened.
void checkSettings(const scenes::Settings& s) { World(scenes::apply(s)); }

void addUrdf(CLI::App& command, UrdfArguments& a) {
  constexpr const char* kUrdf = "URDF";
  command.add_flag("--floating", a.floating, "the robot is not fixed: it stands free on a ground below it")
      ->group(kUrdf);
  command.add_flag("--limp", a.limp, "nothing holds the joints, and their actuators are forces")->group(kUrdf);
  command
      .add_flag_callback(
          "--no-self-collision", [&a] { a.selfCollision = false; }, "links of the robot do not collide with each other")
      ->group(kUrdf);
  command
      .add_option("--package", a.packages,
                  "NAME=DIR: where package://NAME lies; DIR: where packages lie; may be given often")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kUrdf);
  command.add_flag("--skip-bad-meshes", a.skipBadMeshes, "leave out meshes that cannot be read instead of refusing")
      ->group(kUrdf);
  command.add_flag("--decompose", a.decompose, "a mesh becomes several convex hulls that follow it, not one around it")
      ->group(kUrdf);
  command.add_option("--hull-cache", a.hullCache, "folder that keeps what --decompose made [~/.cache/avbd/hulls]")
      ->group(kUrdf);
  command.add_flag("--collide-visuals", a.collideVisuals, "links without a collision collide as they look")
      ->group(kUrdf);
}

void addMaterial(CLI::App& command, MaterialArguments& a) {
  constexpr const char* kMaterial = "Soft body";
  const SoftMaterial usual;
  const auto add = [&](const char* name, std::optional<double>& value, const std::string& what, float otherwise) {
    command.add_option(name, value, what + " of a soft mesh or --soft [" + digits(double{otherwise}, 6) + "]")
        ->group(kMaterial);
  };
  add("--young", a.young, "Young's modulus [Pa]", usual.youngsModulus);
  add("--poisson", a.poisson, "Poisson's ratio", usual.poissonRatio);
  add("--density", a.density, "density [kg/m^3]", usual.density);
  command.add_option("--solid", a.solid, "energy of it: neo-hookean or corotational [neo-hookean]")
      ->check(CLI::IsMember({"neo-hookean", "corotational"}))
      ->group(kMaterial);
}

void addPort(CLI::App& command, int& port) {
  command.add_option("--port", port, "port of the page on this computer [8642]; 0 for any that is free")
      ->check(CLI::Range(0, 65535));
}

CLI::App* addRun(CLI::App& app, RunArguments& a, std::string& solver) {
  CLI::App* run = app.add_subcommand("run", "Simulate a MJCF or URDF file, a soft mesh or a built-in scene and report");
  run->add_option("scene", a.scene,
                  "FILE.xml, FILE.urdf, a soft mesh (.msh, .vtk, .node, .ele), or a name that `avbd scenes` lists")
      ->required();
  run->add_option("--time", a.time, "simulated time [s]; else the scene's own");
  run->add_option("--dt", a.dt, "step [s]; else the file's or scene's own");
  run->add_option("--keyframe", a.keyframe, "keyframe of the file to start at; else its first one");
  run->add_option("--soft", a.soft, kSoft);
  run->add_option("--html", a.html, "write a page that plays the run");
  run->add_option("--poses", a.poses, "write poses of body frames as CSV, in the file's world frame");
  run->add_option("--probes", a.probes, "write what the file's sensors measure as CSV, a row a step");
  run->add_option("--trace", a.trace, "write when each step and stage ran, for Perfetto or chrome://tracing");
  run->add_option("--fps", a.fps, "row sets of the CSV, and frames of the recording, per simulated second [60]");
  run->add_option("--control", a.control, "CSV of time, actuator, value: what actuators are given; values hold");
  run->add_option("--record", a.record, "write a recording, which play, convert and info read");
  run->add_flag("--live", a.live, "serve a page that shows the run as it happens");
  addPort(*run, a.port);
  run->add_flag("--json", a.json, "the report as one JSON object");
  run->add_flag_callback(
      "--no-report", [&a] { a.report = false; }, "no report");
  addUrdf(*run, a.urdf);
  addMaterial(*run, a.material);
  addSettings(*run, a.settings, solver);
  return run;
}

CLI::App* addConvert(CLI::App& app, ConvertArguments& a) {
  CLI::App* convert = app.add_subcommand("convert", "Write a recording in other formats");
  convert->add_option("file", a.file, "FILE.avbd, as `avbd run --record` writes it")->required();
  convert->add_option("--csv", a.csv, "poses and velocities of all bodies, a row each");
  convert->add_option("--json", a.json, "everything, as one JSON object");
  convert->add_option("--mcap", a.mcap, "MCAP with JSON messages, for Foxglove and the like");
  convert->add_option("--html", a.html, "a page that plays it");
  return convert;
}

CLI::App* addPlay(CLI::App& app, PlayArguments& a) {
  CLI::App* play = app.add_subcommand("play", "Serve a page that plays a recording, even while it grows");
  play->add_option("file", a.file, "FILE.avbd")->required();
  addPort(*play, a.port);
  return play;
}

CLI::App* addReplay(CLI::App& app, ReplayArguments& a, std::string& solver) {
  CLI::App* replay =
      app.add_subcommand("replay", "Make a recording's run again and compare each step; exit status 1 if they part");
  replay->add_option("file", a.file, "FILE.avbd, as `avbd run --record` writes it")->required();
  addSettings(*replay, a.settings, solver);
  return replay;
}

CLI::App* addInfo(CLI::App& app, InfoArguments& a) {
  CLI::App* info = app.add_subcommand("info", "Say what a file holds, and what of it was ignored and why");
  info->add_option("file", a.file,
                   "MJCF, URDF, a mesh (.obj, .stl, .msh), a soft mesh (.msh, .vtk, .node, .ele), a recording (.avbd), "
                   "or a scene's name")
      ->required();
  info->add_option("--keyframe", a.keyframe, "keyframe of the file to start at; else its first one");
  info->add_option("--soft", a.soft, kSoft);
  info->add_flag("--json", a.json, "one JSON object");
  addUrdf(*info, a.urdf);
  return info;
}

CLI::App* addBench(CLI::App& app, BenchArguments& a, std::string& solver) {
  CLI::App* bench = app.add_subcommand("bench", "Time scenes and measure their errors; exit status 1 if a check fails");
  bench->add_option("scene", a.scenes, "names that `avbd scenes` lists")->required();
  std::vector<std::string> known;
  for (const bench::Peer& peer : bench::peers()) known.push_back(peer.name);
  bench->add_option("--peer", a.peers, "other engines to run beside: bullet, mujoco, ode; several with commas")
      ->delimiter(',')
      ->check(CLI::IsMember(known));
  bench->add_option("--workers", a.workers, "threads [1]; several with commas: a record for each")
      ->delimiter(',')
      ->group(kSolver);
  bench->add_flag("--json", a.json, "a JSON object for each record");
  addSolver(*bench, a.settings, solver);
  return bench;
}

CLI::App* addVerify(CLI::App& app, VerifyArguments& a, std::string& solver) {
  CLI::App* verify = app.add_subcommand("verify", "Measure the lines of acceptance; exit status 1 if one fails");
  verify->add_option("name", a.names, "lists (R, J, A, S, D) or lines; else all");
  verify->add_flag("--json", a.json, "a JSON object for each record");
  addSettings(*verify, a.settings, solver);
  return verify;
}

// CLI11 says only that some command is missing.
void refuseUnknownCommand(const CLI::App& app, const std::vector<std::string>& args) {
  if (args.empty() || args[0].starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), args[0]) != names.end()) return;
  throw BadInput("no command \"" + args[0] + "\"" + nearText(args[0], names) + "; `avbd --help` lists them");
}

}  // namespace

Arguments parseArguments(std::vector<std::string> args) {
  CLI::App app("AVBD: a 3D physics engine around one solver", "avbd");
  app.set_version_flag("--version", "avbd " AVBD_VERSION);
  app.require_subcommand(1);
  RunArguments run;
  BenchArguments bench;
  VerifyArguments verify;
  ConvertArguments convert;
  PlayArguments play;
  std::string solver;
  CLI::App* runApp = addRun(app, run, solver);
  CLI::App* benchApp = addBench(app, bench, solver);
  CLI::App* verifyApp = addVerify(app, verify, solver);
  CLI::App* convertApp = addConvert(app, convert);
  CLI::App* playApp = addPlay(app, play);
  ReplayArguments replay;
  CLI::App* replayApp = addReplay(app, replay, solver);
  InfoArguments info;
  CLI::App* infoApp = addInfo(app, info);
  app.add_subcommand("scenes", "List the built-in scenes");
  refuseUnknownCommand(app, args);
  run.given = args;
  try {
    std::reverse(args.begin(), args.end());
    app.parse(args);
  } catch (const CLI::CallForHelp&) {
    return PrintText{app.help()};
  } catch (const CLI::CallForVersion& e) {
    return PrintText{std::string(e.what()) + "\n"};
  } catch (const CLI::ParseError& e) {
    throw BadInput(std::string(e.what()) + " (avbd --help says more)");
  }
  if (runApp->parsed()) {
    setSolver(run.settings, solver);
    checkSettings(run.settings);
    return run;
  }
  if (benchApp->parsed()) {
    setSolver(bench.settings, solver);
    checkSettings(bench.settings);
    for (const int workers : bench.workers) checkSettings({.workers = workers});
    return bench;
  }
  if (verifyApp->parsed()) {
    setSolver(verify.settings, solver);
    checkSettings(verify.settings);
    return verify;
  }
  if (convertApp->parsed()) return convert;
  if (playApp->parsed()) return play;
  if (replayApp->parsed()) {
    setSolver(replay.settings, solver);
    checkSettings(replay.settings);
    return replay;
  }
  if (infoApp->parsed()) return info;
  return ScenesArguments{};
}

}  // namespace avbd::cli
