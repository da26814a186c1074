// What lines of soft bodies share: one in a world, with what their figures are made of.
#pragma once

#include <cmath>

#include "scenes/build.h"

namespace avbd::scenes {

inline constexpr float kSoftDensity = 1000;

inline WorldDef weightless() {
  WorldDef def;
  def.gravity = {};
  return def;
}

/// One soft body in a world, with what its figures are made of.
struct Soft {
  World world;
  SoftId id;
  std::shared_ptr<const SoftMeshData> mesh;
  std::vector<BodyId> particles;
  float dt = 1.0f / 60;

  Soft(const Settings& settings, const WorldDef& def, std::shared_ptr<const SoftMeshData> of, SoftMaterial material,
       Velocity velocity = {})
      : world(apply(settings, def)), mesh(std::move(of)) {
    id = world.create(SoftDef{.mesh = mesh, .velocity = velocity, .material = material});
    particles = world.particles(id);
  }
  Soft(const Settings& settings, const WorldDef& def, Vec3 half, std::array<int, 3> cells, SoftMaterial material,
       Velocity velocity = {})
      : Soft(settings, def, makeTetBox(half, cells[0], cells[1], cells[2]), material, velocity) {}
  /// f(particle, its place at rest) for all.
  template <class F>
  void each(F&& f) const {
    for (size_t i = 0; i < particles.size(); ++i) f(particles[i], mesh->points()[i]);
  }
  Vec3d at(BodyId particle) const { return world.pose(particle).position; }
  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds / double{dt}); ++i) world.step(dt);
  }
  /// Mean of a figure over the particles that `is` chooses by their places at rest.
  template <class Is, class Of>
  double mean(Is&& is, Of&& of) const {
    double sum = 0;
    int count = 0;
    each([&](BodyId p, Vec3 rest) {
      if (is(rest)) sum += of(at(p), rest), ++count;
    });
    return sum / count;
  }
};

/// How far the tip of a beam of 1 m and 0.1 m thickness sinks, of what Timoshenko says.
double sagOfBeam(const Settings& settings, int across, double nu = 0.3, double seconds = 6, float dt = 1.0f / 60,
                 SolidModel model = SolidModel::NeoHookean);

/// What soft bodies are made of: damping, incompressibility, limits of strain, threads.
std::vector<Line> materialLines();

}  // namespace avbd::scenes
