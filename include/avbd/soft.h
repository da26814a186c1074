// Soft bodies: elastic solids of tetrahedra, and cloth of triangles.
//
// Each point of the mesh is a particle: a dynamic body of its share of the mass that does not turn. So what holds for
// bodies holds for particles: ball and distance joints attach them to other bodies or to the world and may break,
// forces act on them, they rest, collide and rub with their surface, and they are named in events and contacts.
#pragma once

#include <avbd/body.h>
#include <avbd/soft_mesh.h>

#include <memory>

namespace avbd {

/// Energy of a solid by its deformation F = dx/dX, with Lame's mu and lambda of E and nu. All are Hooke's law at small
/// strain, and none resists a turn.
enum class SolidModel : uint8_t {
  /// Stable Neo-Hookean (Smith, de Goes, Kim 2018), whose lambda is Lame's plus mu: mu/2 (|F|^2 - 3) + lambda/2 (det F
  /// -
  /// 1 - mu/lambda)^2. Softens as rubber does where it is stretched, and keeps its volume however far it is.
  NeoHookean,
  /// Co-rotational (Mueller, Gross 2004; McAdams et al. 2011): mu |F - R|^2 + lambda/2 (tr(R^T F) - 3)^2, R the
  /// rotation
  /// nearest to F. Stress goes linearly with strain however large. What is turned far inside out may stay so.
  Corotational
};

struct SoftMaterial {
  float youngsModulus = 1e5f;  ///< [Pa] > 0; of woven cloth along the warp
  float poissonRatio = 0.3f;   ///< -0.9 .. 0.4999; of a co-rotational solid up to 0.48
  float density = 1000;        ///< [kg/m^3] > 0
  float thickness = 0.002f;    ///< [m] > 0, of cloth
  /// [N m] >= 0, of cloth: moment by length and curvature. Less than 0: that of a plate, E h^3 / 12 (1 - nu^2).
  float bending = -1;
  /// [s] >= 0: viscous stress is this times the rate at which elastic stress changes, so that a vibration of angular
  /// frequency w decays by w^2 damping / 2. A (sub)step damps as its own length would: no less can be had than that.
  float damping = 0;
  /// Of cloth: no direction of it stretches by more than this. Less than 0: there is no limit; else > 0.
  float maxStrain = -1;
  // Of woven cloth, which is not as stiff across its warp as along it.
  Vec3 warp{};              ///< direction in the mesh, projected on each triangle; zero: cloth is the same all ways
  float weftModulus = -1;   ///< [Pa] > 0 across the warp. Less than 0: youngsModulus.
  float shearModulus = -1;  ///< [Pa] > 0 between warp and weft. Less than 0: E / 2 (1 + nu), E the lesser modulus.
  SolidModel model = SolidModel::NeoHookean;  ///< of a solid
};

struct SoftDef {
  std::shared_ptr<const SoftMeshData> mesh{};
  Pose pose{};          ///< where the mesh lies, unstrained
  Velocity velocity{};  ///< of the whole: linear at the pose's origin, angular about it
  SoftMaterial material{};
  float radius = 0.01f;  ///< [m] > 0: points of the surface touch as balls of this radius
  Material surface{};    ///< friction of those
  Filter filter{};
  /// Parts of it do not pass through each other; of a solid unless its surface already does.
  bool selfContact = true;
  bool contactEvents = true;  ///< as in ShapeDef, of the whole
  bool hitEvents = false;     ///< likewise
  bool canSleep = true;
  uint64_t userData = 0;
};

}  // namespace avbd
