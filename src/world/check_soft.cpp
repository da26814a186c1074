// Soft bodies (check.h).
#include <cmath>

#include "world/check.h"
#include "world/limits.h"
#include "world/rotation.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr double kMaxModulus = 1e13, kLeastPoisson = -0.9, kMostPoisson = 0.4999;
constexpr double kMostCorotational = 0.48;  ///< Poisson ratio: what pressures are not augmented for
constexpr double kMaxDamping = 1e6, kMaxStrain = 100, kMaxWarp = 1e6;
constexpr float kMinWarp = 1e-6f;

void checkThreads(const Path& path, const SoftMaterial& material) {
  if (!(material.weftModulus < 0)) check(path / "weftModulus", material.weftModulus, positive(kMaxModulus));
  if (!(material.shearModulus < 0)) check(path / "shearModulus", material.shearModulus, positive(kMaxModulus));
  check(path / "warp", material.warp, symmetric(kMaxWarp));
  if (isWoven(material) && !(dot(material.warp, material.warp) > kMinWarp * kMinWarp))
    (path / "warp")
        .refuse(toText(material.warp),
                "must be longer than " + toText(kMinWarp) + " where weftModulus or shearModulus is given");
}

void checkSoftMaterial(const Path& path, const SoftMaterial& material, float unit) {
  check(path / "youngsModulus", material.youngsModulus, positive(kMaxModulus));
  check(path / "poissonRatio", material.poissonRatio, Range{kLeastPoisson, kMostPoisson});
  if (material.model != SolidModel::NeoHookean && material.model != SolidModel::Corotational)
    (path / "model").refuse(toText(static_cast<int>(material.model)), "must be NeoHookean or Corotational");
  if (material.model == SolidModel::Corotational && double{material.poissonRatio} > kMostCorotational)
    (path / "poissonRatio")
        .refuse(toText(material.poissonRatio),
                "must be at most " + toText(kMostCorotational) + " where model is Corotational: NeoHookean takes more");
  check(path / "density", material.density, positive(kMaxDensity));
  check(path / "thickness", material.thickness, Range{kMinSize * unit, kMaxSize * unit});
  check(path / "bending", material.bending, symmetric(kMaxModulus));
  check(path / "damping", material.damping, notNegative(kMaxDamping));
  if (!(material.maxStrain < 0)) check(path / "maxStrain", material.maxStrain, positive(kMaxStrain));
  checkThreads(path, material);
}

/// What each particle will be: a body in the range that the solver can work with.
void checkParticles(const Path& path, const SoftDef& def, float unit) {
  const double farthest = kMaxPosition * double{unit}, fastest = kMaxSpeed * double{unit};
  const auto isIn = [](Vec3d v, double bound) {
    return std::fabs(v.x) <= bound && std::fabs(v.y) <= bound && std::fabs(v.z) <= bound;
  };
  for (const float mass : softMasses(*def.mesh, def.material)) {
    if (!(mass >= kMinMass && mass <= kMaxMass))
      (path / "material" / "density")
          .refuse(toText(def.material.density),
                  "must give each point a mass of " + toText(kMinMass) + " to " + toText(kMaxMass) + " kg");
    const float inertia = particleInertia(mass, def.radius);
    if (!(inertia >= kMinInertia && inertia <= kMaxInertia))
      (path / "radius")
          .refuse(toText(def.radius), "must give each point, as a ball, a moment of inertia of " + toText(kMinInertia) +
                                          " to " + toText(kMaxInertia) + " kg m^2");
  }
  for (const Vec3 point : def.mesh->points()) {
    const Vec3d arm = rotate(def.pose.rotation, toDouble(point));
    if (!isIn(def.pose.position + arm, farthest))
      (path / "pose").refuse(toText(def.pose.position), "must keep all points within +-" + toText(farthest));
    if (!isIn(toDouble(def.velocity.linear + cross(def.velocity.angular, toFloat(arm))), fastest))
      (path / "velocity").refuse(toText(def.velocity.angular), "must keep all points below " + toText(fastest));
  }
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
  checkParticles(path, checked, unit);
  return checked;
}

}  // namespace avbd
