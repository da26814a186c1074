// Acceptance trials that run at any step size: each returns its figures for one set of parameters.
#pragma once

#include "scenes/scene.h"

namespace avbd::scenes {

std::vector<Figure> trySlide(const Settings& settings, float mu, double dt);
std::vector<Figure> tryRoll(const Settings& settings, double dt);
std::vector<Figure> tryBounce(const Settings& settings, float restitution, double dt);
std::vector<Figure> tryTower(const Settings& settings, double dt);

/// How many steps of dt make this time.
inline int stepsFor(double seconds, double dt) { return static_cast<int>(seconds / dt + 0.5); }

inline constexpr double kDt = 1.0 / 60;

}  // namespace avbd::scenes
