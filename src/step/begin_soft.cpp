// Elements of soft bodies: their edges at the start of the step, and what they are made of.
#include "step/begin_rows.h"
#include "world/soft.h"

namespace avbd {

namespace {

rows::TetElastic<float> elementRows(const WorldData& world, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const auto& corner = soft.mesh->tets()[element.tet];
  const auto at = [&](size_t i) { return world.bodies[soft.bodies[corner[i]]].position; };
  const ElementAtRest rest = elementAtRest(*soft.mesh, element.tet);
  const Elasticity elasticity = elasticityOf(soft.material);
  rows::TetElastic<float> rows;
  rows.ab = toRow(at(1) - at(0)), rows.ac = toRow(at(2) - at(0)), rows.ad = toRow(at(3) - at(0));
  rows.gb = toRow(rest.gb), rows.gc = toRow(rest.gc), rows.gd = toRow(rest.gd);
  rows.mu = elasticity.mu * rest.volume, rows.lambda = elasticity.lambda * rest.volume;
  return rows;
}

}  // namespace

void fillElements(const WorldData& world, StepData& step) {
  step.jobs->forRange(static_cast<uint32_t>(step.elements.size()), 256, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      rows::TetElastic<float> rows{};
      if (step.elements[i].soft != kNone) rows = elementRows(world, step.elements[i]);
      step.elastic[i / kTile].set(static_cast<int>(i % kTile), rows);
    }
  });
}

}  // namespace avbd
