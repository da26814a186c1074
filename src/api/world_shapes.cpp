// Shapes: making and what they carry.
#include "api/world_impl.h"
#include "world/bodies.h"
#include "world/check.h"
#include "world/mass.h"
#include "world/pairs.h"
#include "world/sleep.h"

namespace avbd {
namespace {

ShapeData& shapeOf(WorldData& data, ShapeId id, const char* call) {
  return data.shapes[slotOf(data, id, Path(call) / "id")];
}

bool massFollowsShapes(const BodyData& body) { return body.type == BodyType::Dynamic && !body.massGiven; }

}  // namespace

ShapeId World::create(BodyId id, const ShapeDef& def) {
  WorldData& data = impl_->data;
  const uint32_t body = slotOf(data, id, Path("World::create") / "body");
  const Path path("ShapeDef");
  const ShapeDef shape = checkedShape(path, def, data.bodies[body].type, data.def.lengthUnit);
  MassProperties mass;
  mass.mass = 0;
  if (massFollowsShapes(data.bodies[body])) {
    std::vector<ShapeDef> all = shapeDefs(data, body);
    all.push_back(shape);
    mass = shapesMass(all, data.bodies[body].massScale);
    if (mass.mass != 0) checkShapesMass(path / "density", mass);
  }
  if (isDynamic(data, body)) wakeBody(data, body);
  const uint32_t slot = addShape(data, body, shape);
  if (mass.mass != 0) setMass(data, body, mass);
  return data.shapeIds.id(slot);
}

void World::destroy(ShapeId id) {
  WorldData& data = impl_->data;
  const Path path("World::destroy");
  const uint32_t slot = slotOf(data, id, path / "id"), body = data.shapes[slot].body;
  MassProperties mass;
  mass.mass = 0;
  if (massFollowsShapes(data.bodies[body])) {
    std::vector<ShapeDef> rest = shapeDefs(data, body);
    const std::vector<uint32_t> slots = shapeSlots(data, body);
    for (size_t i = 0; i < slots.size(); ++i) {
      if (slots[i] != slot) continue;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    mass = shapesMass(rest, data.bodies[body].massScale);
    if (mass.mass != 0) checkShapesMass(path / "id", mass);
  }
  wakeBody(data, body);
  forgetPairsOfShape(data, slot);
  removeShape(data, slot);
  // A body never becomes massless: without shapes that have mass it keeps what it had.
  if (mass.mass != 0) setMass(data, body, mass);
  placeShapes(data, body);
}

BodyId World::body(ShapeId id) const { return impl_->data.bodyIds.id(shapeOf(impl_->data, id, "World::body").body); }
Geometry World::geometry(ShapeId id) const { return shapeOf(impl_->data, id, "World::geometry").geometry; }
Pose World::localPose(ShapeId id) const { return shapeOf(impl_->data, id, "World::localPose").local; }
Material World::material(ShapeId id) const { return shapeOf(impl_->data, id, "World::material").material; }

void World::setMaterial(ShapeId id, const Material& material) {
  ShapeData& shape = shapeOf(impl_->data, id, "World::setMaterial");
  const Path path("World::setMaterial");
  checkMaterial(path / "material", material);
  wakeBody(impl_->data, shape.body);
  shape.material = material;
}

std::vector<Material> World::materials(ShapeId id) const {
  return shapeOf(impl_->data, id, "World::materials").materials;
}

void World::setMaterials(ShapeId id, std::span<const Material> materials) {
  ShapeData& shape = shapeOf(impl_->data, id, "World::setMaterials");
  checkMaterials(Path("World::setMaterials") / "materials", materials, shape.geometry);
  wakeBody(impl_->data, shape.body);
  shape.materials.assign(materials.begin(), materials.end());
}

Filter World::filter(ShapeId id) const { return shapeOf(impl_->data, id, "World::filter").filter; }

void World::setFilter(ShapeId id, const Filter& filter) {
  const uint32_t slot = slotOf(impl_->data, id, Path("World::setFilter") / "id");
  const uint32_t body = impl_->data.shapes[slot].body;
  wakeBody(impl_->data, body);
  impl_->data.shapes[slot].filter = filter;
  forgetPairsOfShape(impl_->data, slot);
  markUnpaired(impl_->data, slot);
  if (!isDynamic(impl_->data, body)) wakeAround(impl_->data, body);
}

uint64_t World::userData(ShapeId id) const { return shapeOf(impl_->data, id, "World::userData").userData; }
void World::setUserData(ShapeId id, uint64_t data) { shapeOf(impl_->data, id, "World::setUserData").userData = data; }

}  // namespace avbd
