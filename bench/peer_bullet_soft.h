// Bullet's deformable world as a peer for scenes with soft bodies.
//
// A solid's tetrahedra are stable neo-Hookean of the same Young's modulus and Poisson ratio. Cloth is a net of springs
// along the edges of its triangles, each of stiffness E t [N/m], which has the same uniaxial stiffness along a grid's
// edges; Bullet has no membrane and no bending by moment, so the net does not resist bending. Points weigh and touch
// as ours do: mass by point, margin the radius. Time is implicit, as in Bullet's own examples of stiff solids; the rest
// are its defaults: cloth does not touch itself, ten iterations.
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "scenes/measure.h"

namespace avbd::bench {

class BulletSofts {
 public:
  BulletSofts(btDispatcher* dispatcher, btBroadphaseInterface* broadphase, btCollisionConfiguration* configuration);
  ~BulletSofts();
  btDeformableMultiBodyDynamicsWorld& world() { return *world_; }

  /// All soft bodies of a world without joints between particles and others.
  void add(const World& source, const scenes::Layout& layout);
  /// Into the places of the layout's bodies that are particles.
  void poses(std::span<Pose> out) const;
  /// Throws NonFiniteError where a point has left a kilometre around the origin or is not finite.
  void checkFinite() const;

 private:
  void addOne(const World& source, SoftId id);
  btSoftBody* makeBody(const World& source, SoftId id);
  void addForces(const World& source, SoftId id, btSoftBody* body);
  template <class Force>
  void addForce(btSoftBody* body, std::unique_ptr<Force> force);

  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world_;
  std::vector<std::unique_ptr<btDeformableLagrangianForce>> forces_;
  std::vector<std::unique_ptr<btSoftBody>> bodies_;
  std::vector<std::vector<size_t>> places_;  ///< by soft body and point: the layout's body
  std::unordered_map<uint32_t, size_t> slots_;
};

}  // namespace avbd::bench
