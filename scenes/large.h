// Scenes that are too large for every test: benchmarks alone run them.
#pragma once

#include "scenes/scene.h"

namespace avbd::scenes {

/// In the order in which they are listed; `find` knows them too.
const std::vector<Scene>& large();

std::vector<Scene> crowdScenes();
/// A soft slab of about 1000 to 100,000 tetrahedra.
std::vector<Scene> slabScenes();
Scene manyRagdolls();

}  // namespace avbd::scenes
