// Comparing an MJCF file as read here with what MuJoCo makes of it, for tests.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {

struct Loaded {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data{nullptr, mj_deleteData};
  std::string error;
};

/// MuJoCo's own reading, with the poses of the file.
Loaded load(const std::string& file);
/// Writes the text to a file of the test's folder; its path.
/// Of this process alone, gone when it ends: tests of several run at the same time.
const std::string& folder();
/// Writes a file there.
std::string write(const std::string& text, const std::string& name = "avbd_oracle.xml");
void expectNear(Vec3d a, const mjtNum* b, double tolerance, const std::string& what);
/// Where a mesh weighs by its density, MuJoCo 2.2 by default takes the volume of the box that has the mesh's inertia,
/// 39% too much for a tetrahedron; later versions take the mesh's own, as we do.
enum class MeshWeight { Same, BoxOfInertia };
/// Bodies, masses, inertias, poses, geoms, keyframes, and the world that is made of them (that only with Same).
void compare(const std::string& file, MeshWeight weight = MeshWeight::Same);

}  // namespace avbd::mjcf
