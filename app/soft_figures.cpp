// Measuring soft bodies.
#include "app/soft_figures.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "app/number_text.h"
#include "scenes/crossings.h"

namespace avbd::cli {
namespace {

template <size_t N>
void measureStrain(std::span<const std::array<uint32_t, N>> elements, std::span<const Vec3> rest,
                   std::span<const Vec3d> now, double& most) {
  for (const auto& element : elements)
    for (size_t i = 0; i < N; ++i)
      for (size_t k = 0; k < i; ++k) {
        const double before = length(toDouble(rest[element[i]] - rest[element[k]]));
        const double strain = length(now[element[i]] - now[element[k]]) / before - 1;
        if (!(std::fabs(strain) <= std::fabs(most))) most = strain;  // a NaN is kept
      }
}

SoftFigures figuresOf(const World& world, SoftId id, std::string name) {
  const auto mesh = world.mesh(id);
  std::vector<Vec3d> now(mesh->points().size());
  world.getPoints(id, now);
  SoftFigures f{std::move(name), mesh->isCloth(), now.size(), mesh->report().elements};
  if (f.cloth)
    measureStrain(mesh->triangles(), mesh->points(), std::span<const Vec3d>(now), f.strainMax);
  else
    measureStrain(mesh->tets(), mesh->points(), std::span<const Vec3d>(now), f.strainMax);
  f.volume = world.volume(id);
  return f;
}

}  // namespace

std::vector<SoftFigures> softFiguresOf(const Model& model) {
  std::vector<SoftFigures> all;
  for (const SoftId id : model.world.softBodies()) {
    std::string name = "soft_" + std::to_string(all.size());
    for (const NamedSoft& soft : model.softs)
      if (soft.id == id) name = soft.name;
    all.push_back(figuresOf(model.world, id, std::move(name)));
  }
  return all;
}

SoftContactFigures softContactsOf(const World& world) {
  SoftContactFigures figures;
  for (const Contact& contact : world.contacts()) {
    if (!contact.softA || !contact.softB) continue;
    for (int i = 0; i < contact.pointCount; ++i)
      figures.overlapMax = std::max(figures.overlapMax, -double{contact.points[static_cast<size_t>(i)].separation});
  }
  figures.crossings = scenes::crossings(world);
  return figures;
}

std::string softContactsText(const SoftContactFigures& figures) {
  return digits(1000 * figures.overlapMax, 4) + " mm of overlap, " + std::to_string(figures.crossings) + " crossings";
}

std::string softsText(const std::vector<SoftFigures>& softs) {
  size_t particles = 0, elements = 0;
  double strain = 0;
  for (const SoftFigures& soft : softs) {
    particles += soft.particles;
    elements += soft.elements;
    if (!(std::fabs(soft.strainMax) <= std::fabs(strain))) strain = soft.strainMax;
  }
  return std::to_string(softs.size()) + ": " + std::to_string(particles) + " particles, " + std::to_string(elements) +
         " elements, largest strain " + digits(100 * strain, 3) + " %";
}

std::string softText(const SoftFigures& soft) {
  const std::string counts = std::to_string(soft.particles) + " particles, " + std::to_string(soft.elements);
  if (soft.cloth) return soft.name + ": cloth, " + counts + " triangles";
  return soft.name + ": solid, " + counts + " tetrahedra, " + digits(soft.volume, 4) + " m^3";
}

}  // namespace avbd::cli
