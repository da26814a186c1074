// Elements of soft bodies: their edges at the start of the step, and what they are made of.
#include "geom/soft_mesh_parts.h"
#include "step/begin_rows.h"
#include "world/soft.h"

namespace avbd {

namespace {

/// From a corner of an element to another.
struct Corners {
  const WorldData& world;
  const SoftData& soft;
  const uint32_t* corner;
  rows::V3<float> edge(size_t from, size_t to) const {
    const auto at = [&](size_t i) { return world.bodies[soft.bodies[corner[i]]].position; };
    return toRow(at(to) - at(from));
  }
};

rows::TetElastic<float> tetRows(const WorldData& world, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const Corners corners{world, soft, soft.mesh->tets()[element.index].data()};
  const TetAtRest& rest = soft.mesh->parts().tetsAtRest[element.index];
  const Elasticity elasticity = elasticityOf(soft.material);
  rows::TetElastic<float> rows;
  rows.ab = corners.edge(0, 1), rows.ac = corners.edge(0, 2), rows.ad = corners.edge(0, 3);
  rows.gb = toRow(rest.gb), rows.gc = toRow(rest.gc), rows.gd = toRow(rest.gd);
  rows.mu = elasticity.mu * rest.volume, rows.lambda = elasticity.lambda * rest.volume;
  return rows;
}

rows::TriangleElastic<float> triangleRows(const WorldData& world, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const Corners corners{world, soft, soft.mesh->triangles()[element.index].data()};
  const TriangleAtRest& rest = soft.mesh->parts().trianglesAtRest[element.index];
  const Elasticity sheet = sheetOf(soft.material);
  return {corners.edge(0, 1),   corners.edge(0, 2),      rest.bx, rest.by, rest.cx, rest.cy,
          sheet.mu * rest.area, sheet.lambda * rest.area};
}

rows::ClothBend<float> bendRows(const WorldData& world, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const Corners corners{world, soft, soft.mesh->hinges()[element.index].data()};
  const HingeAtRest& rest = soft.mesh->parts().hingesAtRest[element.index];
  rows::ClothBend<float> rows;
  for (size_t i = 0; i < 4; ++i) rows.weight[i] = rest.weight[i];
  rows.bent =
      corners.edge(0, 1) * rest.weight[1] + corners.edge(0, 2) * rest.weight[2] + corners.edge(0, 3) * rest.weight[3];
  rows.k = bendingOf(soft.material) / rest.areas;
  return rows;
}

template <template <class> class Family, class Rows>
void fill(const StepData& step, const std::vector<StepData::Element>& elements, UnwrittenVector<Tile<Family>>& tiles,
          Rows&& rowsOf) {
  step.jobs->forRange(static_cast<uint32_t>(elements.size()), 256, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i)
      tiles[i / kTile].set(static_cast<int>(i % kTile),
                           elements[i].soft == kNone ? Family<float>{} : rowsOf(elements[i]));
  });
}

}  // namespace

void fillElements(const WorldData& world, StepData& step) {
  fill(step, step.elements, step.elastic, [&](const StepData::Element& e) { return tetRows(world, e); });
  fill(step, step.triangles, step.triangleTiles, [&](const StepData::Element& e) { return triangleRows(world, e); });
  fill(step, step.hinges, step.bendTiles, [&](const StepData::Element& e) { return bendRows(world, e); });
}

}  // namespace avbd
