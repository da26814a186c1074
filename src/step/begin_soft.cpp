// Elements of soft bodies: their edges at the start of the step, and what they are made of.
#include <algorithm>
#include <cmath>

#include "geom/soft_mesh_parts.h"
#include "step/begin_rows.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr float kLeastWarp = 1e-3f;     ///< of its length: what of the warp lies in a triangle
constexpr float kLoadStrain = 0.01f;    ///< beyond its limit cloth holds the load of before by at most so much more
constexpr float kSlackStrain = 0.005f;  ///< below its limit cloth has lost all tension of the step before

/// From a corner of an element to another.
struct Corners {
  const WorldData& world;
  const SoftData& soft;
  const uint32_t* corner;
  rows::V3<float> edge(size_t from, size_t to) const {
    const auto at = [&](size_t i) { return world.bodies[soft.bodies[corner[i]]].position; };
    return toRow(at(to) - at(from));
  }
  /// Its change in a time by the velocities.
  rows::V3<float> motion(size_t from, size_t to, float h) const {
    const auto at = [&](size_t i) { return world.bodies[soft.bodies[corner[i]]].linearVelocity; };
    return toRow((at(to) - at(from)) * h);
  }
};

/// t / h of solid.h. The step itself damps as one of its length would, which is part of what is asked for.
float dampingOf(const SoftMaterial& material, float h) { return std::max(0.0f, material.damping / h - 1); }

template <template <class> class Tet>
Tet<float> tetRows(const WorldData& world, float h, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const Corners corners{world, soft, soft.mesh->tets()[element.index].data()};
  const TetAtRest& rest = soft.mesh->parts().tetsAtRest[element.index];
  const Elasticity elasticity = elasticityOf(soft.material);
  Tet<float> rows;
  rows.ab = corners.edge(0, 1), rows.ac = corners.edge(0, 2), rows.ad = corners.edge(0, 3);
  rows.gb = toRow(rest.gb), rows.gc = toRow(rest.gc), rows.gd = toRow(rest.gd);
  rows.mu = elasticity.tetMu * rest.volume, rows.lambda = elasticity.tetLambda * rest.volume;
  rows.damping = dampingOf(soft.material, h);
  return rows;
}

template <template <class> class Star>
Star<float> starRows(const WorldData& world, float h, const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const SoftMeshData::Parts& mesh = soft.mesh->parts();
  const Elasticity elasticity = elasticityOf(soft.material);
  const auto at = [&](uint32_t point) { return world.bodies[soft.bodies[point]].position; };
  const Vec3d center = at(element.index);
  const rows::V3<float> none = rows::zeroV3<float>();
  Star<float> rows{};
  rows.start = {none, none, none};
  for (uint32_t i = mesh.starBegin[element.index]; i < mesh.starBegin[element.index + 1]; ++i) {
    const StarPoint& star = mesh.starPoints[i];
    const rows::V3<float> arm = toRow(at(star.point) - center);
    rows.start.x += arm * star.gradient.x, rows.start.y += arm * star.gradient.y, rows.start.z += arm * star.gradient.z;
  }
  const float volume = mesh.starVolumes[element.index];
  rows.mu = elasticity.starMu * volume, rows.lambda = elasticity.starLambda * volume;
  rows.damping = dampingOf(soft.material, h);
  if constexpr (requires { rows.pressure; }) {
    rows.share = elasticity.starShare;
    if (!soft.memory.pressures.empty()) rows.pressure = soft.memory.pressures[element.index];
  }
  return rows;
}

/// The gradients of a triangle in the frame along the warp, or as they are where it stands across the triangle.
TriangleAtRest alongWarp(const SoftMeshData& mesh, uint32_t triangle, Vec3 warp) {
  TriangleAtRest rest = mesh.parts().trianglesAtRest[triangle];
  const auto& t = mesh.triangles()[triangle];
  const Vec3 b = mesh.points()[t[1]] - mesh.points()[t[0]], c = mesh.points()[t[2]] - mesh.points()[t[0]];
  const Vec3 normal = cross(b, c), across = cross(normal, b);
  const float x = dot(warp, b) / length(b), y = dot(warp, across) / length(across), size = std::sqrt(x * x + y * y);
  if (!(size > kLeastWarp * length(warp))) return rest;
  const float u = x / size, v = y / size;
  const TriangleAtRest turned{u * rest.bx + v * rest.by, u * rest.by - v * rest.bx, u * rest.cx + v * rest.cy,
                              u * rest.cy - v * rest.cx, rest.area};
  return turned;
}

/// What stopped a stretch is no guess for the step after it, and would throw back what hangs on the cloth: a limit
/// keeps of its tension what the strain that it goes on to leaves it.
float keptTension(const rows::TriangleElastic<float>& rows, const rows::V3<float>& b, const rows::V3<float>& c) {
  const rows::Plane<float> goesTo = rows::squares(b * rows.bx + c * rows.cx, b * rows.by + c * rows.cy);
  const rows::Plane<float>& t = rows.tension;
  const float trace = t.xx + t.yy;
  if (!(trace > 0)) return 0;
  const float strain = 0.5f * ((t.xx * goesTo.xx + t.yy * goesTo.yy + 2 * t.xy * goesTo.xy) / trace - 1);
  return std::min(1.0f, std::max(0.0f, 1 + (strain - rows.most) / kSlackStrain));
}

float largest(const rows::Plane<float>& m) {
  const float half = (m.xx - m.yy) * 0.5f;
  return (m.xx + m.yy) * 0.5f + std::sqrt(half * half + m.xy * m.xy);
}

rows::TriangleElastic<float> triangleRows(const WorldData& world, const StepData& step,
                                          const StepData::Element& element) {
  const SoftData& soft = world.softs[element.soft];
  const SoftMaterial& material = soft.material;
  const Corners corners{world, soft, soft.mesh->triangles()[element.index].data()};
  const TriangleAtRest rest = isWoven(material) ? alongWarp(*soft.mesh, element.index, material.warp)
                                                : soft.mesh->parts().trianglesAtRest[element.index];
  const SheetElasticity sheet = sheetOf(material);
  rows::TriangleElastic<float> rows{};
  rows.ab = corners.edge(0, 1), rows.ac = corners.edge(0, 2);
  rows.bx = rest.bx, rows.by = rest.by, rows.cx = rest.cx, rows.cy = rest.cy;
  rows.mu = sheet.mu * rest.area, rows.lambda = sheet.lambda * rest.area;
  rows.warp = sheet.warp * rest.area, rows.weft = sheet.weft * rest.area, rows.shear = sheet.shear * rest.area;
  rows.damping = dampingOf(material, step.h);
  if (material.maxStrain < 0) return rows;
  rows.most = material.maxStrain + 0.5f * material.maxStrain * material.maxStrain;
  // What is beyond it goes back as slowly as other rows' violations do.
  const rows::Plane<float> start =
      rows::squares(rows.ab * rows.bx + rows.ac * rows.cx, rows.ab * rows.by + rows.ac * rows.cy);
  rows.most += step.alpha * std::max(0.0f, 0.5f * (largest(start) - 1) - rows.most);
  rows.floor = 1;  // prepareOthers puts the stiffness
  rows.load = 1 / kLoadStrain;
  const Vec3 tension = soft.memory.tensions[element.index];
  rows.tension = {tension.x, tension.y, tension.z};
  const float kept = keptTension(rows, rows.ab + corners.motion(0, 1, step.h), rows.ac + corners.motion(0, 2, step.h));
  rows.tension = {tension.x * kept, tension.y * kept, tension.z * kept};
  return rows;
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

template <template <class> class Tet, template <class> class TetOp, template <class> class Star,
          template <class> class StarOp>
void fillSolids(const WorldData& world, const StepData& step, StepData::Solids<Tet, TetOp, Star, StarOp>& solids) {
  fill(step, solids.tets, solids.tetTiles, [&](const StepData::Element& e) { return tetRows<Tet>(world, step.h, e); });
  fill(step, solids.stars, solids.starTiles,
       [&](const StepData::Element& e) { return starRows<Star>(world, step.h, e); });
}

}  // namespace

void fillElements(const WorldData& world, StepData& step) {
  fillSolids(world, step, step.elastic);
  fillSolids(world, step, step.corotational);
  fill(step, step.triangles, step.triangleTiles,
       [&](const StepData::Element& e) { return triangleRows(world, step, e); });
  fill(step, step.hinges, step.bendTiles, [&](const StepData::Element& e) { return bendRows(world, e); });
}

void publishElements(WorldData& world, const StepData& step) {
  for (size_t lane = 0; lane < step.elastic.stars.size(); ++lane) {
    const StepData::Element& star = step.elastic.stars[lane];
    if (star.soft == kNone || world.softs[star.soft].memory.pressures.empty()) continue;
    const rows::StarElastic<float> rows = step.elastic.starTiles[lane / kTile].get(static_cast<int>(lane % kTile));
    world.softs[star.soft].memory.pressures[star.index] = rows.pressure;
  }
  for (size_t lane = 0; lane < step.triangles.size(); ++lane) {
    const StepData::Element& triangle = step.triangles[lane];
    if (triangle.soft == kNone || world.softs[triangle.soft].memory.tensions.empty()) continue;
    const rows::Plane<float> t = step.triangleTiles[lane / kTile].get(static_cast<int>(lane % kTile)).tension;
    world.softs[triangle.soft].memory.tensions[triangle.index] = {t.xx, t.yy, t.xy};
  }
}

}  // namespace avbd
