// Soft bodies between steps (soft.h).
#include "world/soft.h"

#include <algorithm>

#include "geom/soft_mesh_parts.h"
#include "world/bodies.h"
#include "world/check.h"
#include "world/rotation.h"

namespace avbd {
namespace {

using soft_mesh::crossOf;

struct Edges {
  Vec3d b, c, d;
  double sixVolumes() const { return dot(b, crossOf(c, d)); }
};

Edges edgesAtRest(const SoftMeshData& mesh, size_t tet) {
  const auto& t = mesh.tets()[tet];
  const auto at = [&](int i) { return toDouble(mesh.points()[t[static_cast<size_t>(i)]]); };
  return {at(1) - at(0), at(2) - at(0), at(3) - at(0)};
}

BodyDef particleOf(const SoftDef& def, Vec3 point, float mass) {
  const Vec3d arm = rotate(def.pose.rotation, toDouble(point));
  BodyDef body;
  body.position = def.pose.position + arm;
  body.linearVelocity = def.velocity.linear + cross(def.velocity.angular, toFloat(arm));
  const float inertia = particleInertia(mass, def.radius);
  body.massProperties = MassProperties{mass, {}, {inertia, inertia, inertia, 0, 0, 0}};
  body.continuous = false;
  body.canSleep = def.canSleep;
  return body;
}

}  // namespace

std::vector<float> softMasses(const SoftMeshData& mesh, const SoftMaterial& material) {
  std::vector<double> volume(mesh.points().size());
  for (size_t i = 0; i < mesh.tets().size(); ++i)
    for (const uint32_t p : mesh.tets()[i]) volume[p] += edgesAtRest(mesh, i).sixVolumes() / 24;
  for (size_t i = 0; i < mesh.triangles().size(); ++i)
    for (const uint32_t p : mesh.triangles()[i])
      volume[p] += double{mesh.parts().trianglesAtRest[i].area} * double{material.thickness} / 3;
  std::vector<float> masses;
  for (const double v : volume) masses.push_back(static_cast<float>(v * double{material.density}));
  return masses;
}

uint32_t addSoft(WorldData& data, const SoftDef& def) {
  const uint32_t slot = data.softIds.slot(data.softIds.create());
  if (slot >= data.softs.size()) data.softs.resize(slot + 1);
  SoftData& soft = data.softs[slot];
  soft = {def.mesh, def.material, def.radius, def.selfContact, {}, def.userData, {}};
  soft.memory.pressures.assign(pressuresOf(*def.mesh, def.material), 0);
  soft.memory.tensions.assign(tensionsOf(*def.mesh, def.material), {});
  const SoftMeshData& mesh = *def.mesh;
  const std::vector<float> masses = softMasses(mesh, def.material);
  std::vector<uint8_t> outside(mesh.points().size());
  for (const auto& face : mesh.surface())
    for (const uint32_t p : face) outside[p] = 1;
  const ShapeDef shape{.geometry = Sphere{def.radius},
                       .density = 0,
                       .material = def.surface,
                       .filter = def.filter,
                       .contactEvents = def.contactEvents,
                       .hitEvents = def.hitEvents};
  for (size_t i = 0; i < masses.size(); ++i) {
    BodyDef body = particleOf(def, mesh.points()[i], masses[i]);
    if (outside[i]) body.shapes.push_back(shape);
    const uint32_t particle = addBody(data, body, checkedBody(body, data.def.lengthUnit));
    data.bodies[particle].soft = slot;
    data.bodies[particle].acceleration = data.def.gravity;
    soft.bodies.push_back(particle);
  }
  return slot;
}

void removeSoft(WorldData& data, uint32_t slot) {
  const std::vector<uint32_t> bodies = std::move(data.softs[slot].bodies);
  data.softs[slot] = {};
  std::erase_if(data.softTouches, [&](const SoftTouch& touch) {
    return touch.second == slot || (touch.kind != TouchKind::ShapeFace && touch.first == slot);
  });
  for (const uint32_t body : bodies) removeBody(data, body);
  data.softIds.destroy(data.softIds.id(slot));
}

double volumeOf(const WorldData& data, const SoftData& soft) {
  double six = 0;
  for (const auto& t : soft.mesh->tets()) {
    const auto at = [&](size_t i) { return data.bodies[soft.bodies[t[i]]].position; };
    six += Edges{at(1) - at(0), at(2) - at(0), at(3) - at(0)}.sixVolumes();
  }
  return six / 6;
}

namespace {

struct Lame {
  double mu, lambda;  ///< [Pa]
};

Lame lameOf(const SoftMaterial& material) {
  const double e = double{material.youngsModulus}, nu = double{material.poissonRatio};
  return {e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))};
}

/// Of mu and lambda, the part that tetrahedra carry: with a quarter the sag of beams is nearest to theory, in meshes of
/// five and of six tetrahedra a cell. What can hardly be compressed is locked by less of them.
double tetShare(double nu) { return 0.125 * (1 + std::min(1.0, 5 * (1 - 2 * nu))); }

constexpr double kMostLambda = 30;  ///< of mu: with more than that pressures are augmented
constexpr double kAugmented = 20;   ///< of mu: the stiffness in use then
constexpr double kTetLambda = 2;    ///< of mu: at most, of tetrahedra, which more would lock

/// So hard to compress that its pressures are augmented.
bool isAugmented(const SoftMaterial& material) {
  const Lame lame = lameOf(material);
  return material.model == SolidModel::NeoHookean && lame.lambda > kMostLambda * lame.mu;
}

}  // namespace

size_t pressuresOf(const SoftMeshData& mesh, const SoftMaterial& material) {
  return !mesh.isCloth() && isAugmented(material) ? mesh.points().size() : 0;
}

size_t tensionsOf(const SoftMeshData& mesh, const SoftMaterial& material) {
  return material.maxStrain >= 0 ? mesh.triangles().size() : 0;
}

Elasticity elasticityOf(const SoftMaterial& material) {
  const auto [mu, lambda] = lameOf(material);
  const double share = tetShare(double{material.poissonRatio});
  const double tetMu = share * mu, tetLambda = share * std::min(lambda, kTetLambda * mu);
  const double starMu = mu - tetMu;
  if (material.model == SolidModel::Corotational)
    return {static_cast<float>(tetMu), static_cast<float>(tetLambda), static_cast<float>(starMu),
            static_cast<float>(lambda - tetLambda), 0};
  const double whole = lambda - tetLambda + starMu, used = kAugmented * mu;
  const bool augmented = isAugmented(material);
  return {static_cast<float>(tetMu), static_cast<float>(tetLambda + tetMu), static_cast<float>(starMu),
          static_cast<float>(augmented ? whole * used / (whole + used) : whole),
          static_cast<float>(augmented ? whole / (whole + used) : 0)};
}

/// Of an orthotropic sheet, nu the contraction of its softer way by the stiffer; so much of it as is the same all ways
/// is the sheet, and what is left of each way its threads.
SheetElasticity sheetOf(const SoftMaterial& material) {
  const double nu = double{material.poissonRatio}, thickness = double{material.thickness};
  const double warp = double{material.youngsModulus} * thickness;
  const double weft = material.weftModulus >= 0 ? double{material.weftModulus} * thickness : warp;
  const double least = std::min(warp, weft), most = std::max(warp, weft), part = 1 - nu * nu * least / most;
  const double shear = material.shearModulus >= 0 ? double{material.shearModulus} * thickness : least / (2 * (1 + nu));
  const double lambda = nu * least / part, mu = std::min(shear, (1 - nu) * least / (2 * part));
  SheetElasticity sheet{static_cast<float>(mu), static_cast<float>(lambda + mu), 0, 0, 0};
  if (!isWoven(material)) return sheet;
  sheet.warp = static_cast<float>(warp / part - lambda - 2 * mu);
  sheet.weft = static_cast<float>(weft / part - lambda - 2 * mu);
  sheet.shear = static_cast<float>(shear - mu);
  return sheet;
}

float bendingOf(const SoftMaterial& material) {
  if (material.bending >= 0) return material.bending;
  const float h = material.thickness, nu = material.poissonRatio;
  return material.youngsModulus * h * h * h / (12 * (1 - nu * nu));
}

}  // namespace avbd
