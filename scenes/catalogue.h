// The families of scenes and lines, each from its own file; the catalogue joins them.
#pragma once

#include "scenes/scene.h"

namespace avbd::scenes {

std::vector<Scene> pileScenes();
std::vector<Scene> stackScenes();
std::vector<Scene> chainScenes();
std::vector<Scene> netScenes();
std::vector<Scene> softScenes();
std::vector<Scene> mixedScenes();
Scene softTorusScene();
std::vector<Scene> scissorScenes();
std::vector<Scene> ragdollScenes();
std::vector<Scene> sleeperScenes();

/// The classic house of five storeys of leaning cards, made in the order that this seed draws.
Model cardHouse(const Settings& settings, uint32_t seed);
/// Boxes of half extent 1 and 80 kg, ten high; lengths and masses times the given powers of two.
struct Scale {
  float length = 1, mass = 1;
};
Model tower10(const Settings& settings, Scale scale = {});
Model heavyOnLight(const Settings& settings, float mass, Scale scale = {});
Model slidingBox(const Settings& settings, float mu, Vec3 velocity, Scale scale = {});
Model pyramid10(const Settings& settings);
/// A semicircle of equal stones, mean radius 3 m, thickness 0.6 m; body 0 is the ground.
inline constexpr int kVoussoirs = 15;
Model archOfVoussoirs(const Settings& settings);

std::vector<Line> restLines();
std::vector<Line> frictionLines();
std::vector<Line> motionLines();
std::vector<Line> collisionLines();
std::vector<Line> continuousLines();
std::vector<Line> shapeLines();
std::vector<Line> scaleLines();
std::vector<Line> jointLines();
std::vector<Line> limitLines();
std::vector<Line> driveLines();
std::vector<Line> driveTypeLines();
std::vector<Line> couplingLines();
std::vector<Line> customLines();
std::vector<Line> breakLines();
std::vector<Line> mechanismLines();
std::vector<Line> treeLines();
std::vector<Line> treeDriveLines();
std::vector<Line> loopLines();
std::vector<Line> scissorLines();
std::vector<Line> inverseDynamicsLines();
std::vector<Line> ragdollLines();
std::vector<Line> stateLines();
std::vector<Line> rollbackLines();
std::vector<Line> sleepLines();
std::vector<Line> softLines();
std::vector<Line> clothLines();
std::vector<Line> selfLines();
std::vector<Line> mixedLines();
std::vector<Line> closedLines();
std::vector<Line> badInputLines();
/// What is not built yet, by name.
std::vector<Line> skippedLines();

}  // namespace avbd::scenes
