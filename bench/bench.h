// The benchmark: one record per scene and engine, both measured by the same code.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace avbd::bench {

struct BenchRecord {
  std::string scene, engine;
  int workers = 1;
  int steps = 0;
  double msMedian = 0, msP95 = 0;                  ///< wall clock of the step call alone
  double penetrationMax = 0, penetrationMean = 0;  ///< after the last step [m]
  double displacementMax = 0;                      ///< from the start [m]
  double jointGapMax = 0;                          ///< over the last 300 steps where joints are watched [m]
  std::string check;                               ///< "pass", or the figures of the scene's check that fail
  std::vector<scenes::Figure> figures;             ///< of the scene's check
};

/// This engine. Throws Error if the settings are refused.
BenchRecord benchAvbd(const scenes::Scene& scene, const scenes::Settings& settings = {});

/// Whether this program was built with Bullet.
bool hasBullet();
/// Bullet with its default settings, over the bodies, shapes and joints that the scene makes. Throws Error without it,
/// or if the scene has something that Bullet's side does not build.
BenchRecord benchBullet(const scenes::Scene& scene);

/// A record from what was seen.
BenchRecord toRecord(const scenes::Scene& scene, std::string engine, int workers, const scenes::Evidence& evidence);

}  // namespace avbd::bench
