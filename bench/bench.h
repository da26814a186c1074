// The benchmark: one record per scene and engine, all measured by the same code.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace avbd::bench {

struct BenchRecord {
  std::string scene, engine;
  int workers = 1;
  int iterations = 0;  ///< outer ones of this engine; 0: a peer's default
  size_t bodies = 0;   ///< that can move
  int steps = 0;
  double msMedian = 0, msP95 = 0;  ///< wall clock of the step call alone
  /// Of a peer: our time in the scene's first record over its time. Of this engine: the time of the scene's first
  /// record over this one's, which tells what more workers gain. NaN where our check failed or there is nothing to
  /// compare.
  double ratio = 0;
  double penetrationMax = 0, penetrationMean = 0;  ///< after the last step [m]
  double displacementMax = 0;                      ///< from the start [m]
  double jointGapMax = 0;                          ///< over the last 300 steps where joints are watched [m]
  std::string check;                               ///< "pass", or the figures of the scene's check that fail
  std::vector<scenes::Figure> figures;             ///< of the scene's check

  bool passed() const { return check == "pass"; }
};

/// This engine. Throws Error if the settings are refused.
BenchRecord benchAvbd(const scenes::Scene& scene, const scenes::Settings& settings = {});

/// Another engine with its default settings, over the bodies, shapes, soft bodies and joints that the scene makes.
struct Peer {
  const char* name;
  bool built;           ///< this program was built with it
  const char* differs;  ///< what is not the same as here, in a line
  /// Throws Error if it is not built, or if the scene has something that this engine's side does not build.
  BenchRecord (*run)(const scenes::Scene& scene);
};
std::span<const Peer> peers();
/// By name; null if there is none.
const Peer* findPeer(std::string_view name);

BenchRecord benchBullet(const scenes::Scene& scene);
BenchRecord benchBullet4(const scenes::Scene& scene);  ///< with four steps a frame
BenchRecord benchMujoco(const scenes::Scene& scene);
BenchRecord benchOde(const scenes::Scene& scene);

/// A peer's side of a scene: makes the engine from the scene's world and observes it.
BenchRecord observePeer(
    const scenes::Scene& scene, const char* name,
    const std::function<std::unique_ptr<scenes::Engine>(const World&, const scenes::Layout&)>& make);
/// A record from what was seen.
BenchRecord toRecord(const scenes::Scene& scene, std::string engine, int workers, const scenes::Evidence& evidence);

/// Least-squares slope of log(time) against log(bodies): time grows as bodies to this power. NaN for fewer than two
/// numbers of bodies.
double costExponent(std::span<const BenchRecord> records);

}  // namespace avbd::bench
