// Soft bodies (check.h).
#include "world/check.h"
#include "world/limits.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr double kMaxModulus = 1e13, kLeastPoisson = -0.9, kMostPoisson = 0.499;

void checkSoftMaterial(const Path& path, const SoftMaterial& material, float unit) {
  check(path / "youngsModulus", material.youngsModulus, positive(kMaxModulus));
  check(path / "poissonRatio", material.poissonRatio, Range{kLeastPoisson, kMostPoisson});
  check(path / "density", material.density, positive(kMaxDensity));
  check(path / "thickness", material.thickness, Range{kMinSize * unit, kMaxSize * unit});
  check(path / "bending", material.bending, symmetric(kMaxModulus));
}

}  // namespace

SoftDef checkedSoft(const WorldData& data, const SoftDef& def) {
  const Path path("SoftDef");
  const float unit = data.def.lengthUnit;
  if (!def.mesh) (path / "mesh").refuse("null", "must be a mesh of makeTetMesh() or makeClothMesh()");
  checkSoftMaterial(path / "material", def.material, unit);
  check(path / "radius", def.radius, Range{kMinSize * unit, kMaxSize * unit});
  checkMaterial(path / "surface", def.surface);
  checkVelocity(path / "velocity", def.velocity, unit);
  SoftDef checked = def;
  checked.pose = checkedPose(path / "pose", def.pose, kMaxPosition * unit);
  for (const float mass : softMasses(*def.mesh, def.material))
    if (!(mass >= kMinMass && mass <= kMaxMass))
      (path / "material" / "density")
          .refuse(toText(def.material.density),
                  "must give each point a mass of " + toText(kMinMass) + " to " + toText(kMaxMass) + " kg");
  return checked;
}

}  // namespace avbd
