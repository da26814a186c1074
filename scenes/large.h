// Scenes that are too large for every test: benchmarks alone run them.
#pragma once

#include "scenes/scene.h"

namespace avbd::scenes {

/// In the order in which they are listed; `find` knows them too.
const std::vector<Scene>& large();

std::vector<Scene> crowdScenes();
Scene manyRagdolls();

}  // namespace avbd::scenes
