// Soft bodies between steps (soft.h).
#include "world/soft.h"

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
  soft = {def.mesh, def.material, def.radius, def.selfContact, {}, def.userData};
  const SoftMeshData& mesh = *def.mesh;
  const std::vector<float> masses = softMasses(mesh, def.material);
  std::vector<uint8_t> outside(mesh.points().size());
  for (const auto& face : mesh.surface())
    for (const uint32_t p : face) outside[p] = 1;
  const ShapeDef shape{.geometry = Sphere{def.radius}, .density = 0, .material = def.surface, .filter = def.filter};
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

Elasticity elasticityOf(const SoftMaterial& material) {
  const double e = double{material.youngsModulus}, nu = double{material.poissonRatio};
  const double mu = e / (2 * (1 + nu)), lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
  return {static_cast<float>(mu), static_cast<float>(lambda + mu)};
}

Elasticity sheetOf(const SoftMaterial& material) {
  const double e = double{material.youngsModulus} * double{material.thickness}, nu = double{material.poissonRatio};
  const double mu = e / (2 * (1 + nu)), lambda = e * nu / (1 - nu * nu);
  return {static_cast<float>(mu), static_cast<float>(lambda + mu)};
}

float bendingOf(const SoftMaterial& material) {
  if (material.bending >= 0) return material.bending;
  const float h = material.thickness, nu = material.poissonRatio;
  return material.youngsModulus * h * h * h / (12 * (1 - nu * nu));
}

}  // namespace avbd
