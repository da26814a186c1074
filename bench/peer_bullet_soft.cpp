// Bullet's deformable world as a peer for scenes with soft bodies.
#include "bench/peer_bullet_soft.h"

#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace avbd::bench {
namespace {

constexpr btScalar kFar = 1000;  ///< [m] what is farther away has flown apart

btVector3 toBullet(Vec3d v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }

/// Every edge of the elements once.
std::set<std::array<uint32_t, 2>> edgesOf(const SoftMeshData& mesh) {
  std::set<std::array<uint32_t, 2>> edges;
  const auto add = [&](const auto& element) {
    for (size_t i = 0; i < element.size(); ++i)
      for (size_t k = 0; k < i; ++k) edges.insert({std::min(element[i], element[k]), std::max(element[i], element[k])});
  };
  for (const auto& t : mesh.triangles()) add(t);
  for (const auto& t : mesh.tets()) add(t);
  return edges;
}

}  // namespace

BulletSofts::BulletSofts(btDispatcher* dispatcher, btBroadphaseInterface* broadphase,
                         btCollisionConfiguration* configuration) {
  solver_.setDeformableSolver(&deformable_);
  world_ = std::make_unique<btDeformableMultiBodyDynamicsWorld>(dispatcher, broadphase, &solver_, configuration,
                                                                &deformable_);
  world_->setImplicit(true);
  world_->setUseProjection(true);  // the other way does not step implicitly
}

BulletSofts::~BulletSofts() {
  for (const auto& body : bodies_) {
    world_->removeSoftBodyForce(body.get());
    world_->removeSoftBody(body.get());
  }
}

void BulletSofts::add(const World& source, const scenes::Layout& layout) {
  const Vec3 g = source.definition().gravity;
  world_->getWorldInfo().m_gravity = {g.x, g.y, g.z};
  // Distances to rigid shapes are interpolated in cells of this size: no coarser than the meshes are.
  float cell = 0.25f;
  for (const SoftId id : source.softBodies()) cell = std::min(cell, source.mesh(id)->faceSize());
  world_->getWorldInfo().m_sparsesdf.setDefaultVoxelsz(cell);
  world_->getWorldInfo().m_sparsesdf.Reset();
  for (size_t i = 0; i < layout.bodies.size(); ++i) slots_[layout.bodies[i].index] = i;
  for (const SoftId id : source.softBodies()) addOne(source, id);
}

void BulletSofts::addOne(const World& source, SoftId id) {
  const std::vector<BodyId> particles = source.particles(id);
  for (const BodyId p : particles)
    if (source.locks(p) != 0) throw Error("benchBullet", "locks", "some", "must be none of a particle");
  btSoftBody* body = makeBody(source, id);
  std::vector<size_t>& places = places_.emplace_back();
  Filter filter;
  for (size_t i = 0; i < particles.size(); ++i) {
    places.push_back(slots_.at(particles[i].index));
    const Vec3 v = source.velocity(particles[i]).linear;
    btSoftBody::Node& node = body->m_nodes[static_cast<int>(i)];
    node.m_v = node.m_vn = {v.x, v.y, v.z};
  }
  const std::vector<ShapeId> shapes = source.shapes(particles[0]);
  if (!shapes.empty()) {
    filter = source.filter(shapes[0]);
    body->m_cfg.kDF = btScalar(std::sqrt(source.material(shapes[0]).friction));
    body->setFriction(body->m_cfg.kDF);
  }
  world_->addSoftBody(body, static_cast<int>(filter.category), static_cast<int>(filter.mask));
  addForces(source, id, body);
}

btSoftBody* BulletSofts::makeBody(const World& source, SoftId id) {
  const SoftMeshData& mesh = *source.mesh(id);
  const std::vector<BodyId> particles = source.particles(id);
  std::vector<btVector3> points;
  std::vector<btScalar> masses;
  for (const BodyId p : particles) {
    points.push_back(toBullet(source.pose(p).position));
    masses.push_back(source.mass(p));
  }
  const int count = static_cast<int>(points.size());
  auto body = std::make_unique<btSoftBody>(&world_->getWorldInfo(), count, points.data(), masses.data());
  const auto at = [](uint32_t i) { return static_cast<int>(i); };
  for (const auto& f : mesh.surface()) body->appendFace(at(f[0]), at(f[1]), at(f[2]));
  for (const auto& t : mesh.tets()) body->appendTetra(at(t[0]), at(t[1]), at(t[2]), at(t[3]));
  // Of a solid they bear nothing; Bullet builds the tree of faces along them.
  for (const auto& e : edgesOf(mesh)) body->appendLink(at(e[0]), at(e[1]));
  body->m_tetraScratches.resize(body->m_tetras.size());
  body->m_tetraScratchesTn.resize(body->m_tetras.size());
  body->initializeDmInverse();
  body->getCollisionShape()->setMargin(source.radius(id));
  body->m_cfg.kKHR = body->m_cfg.kCHR = 1;
  body->m_cfg.collisions =
      btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN | btSoftBody::fCollision::VF_DD;
  body->m_sleepingThreshold = 0;
  body->initializeFaceTree();
  body->setActivationState(DISABLE_DEACTIVATION);
  bodies_.push_back(std::move(body));
  return bodies_.back().get();
}

template <class Force>
void BulletSofts::addForce(btSoftBody* body, std::unique_ptr<Force> force) {
  world_->addForce(body, force.get());
  forces_.push_back(std::move(force));
}

void BulletSofts::addForces(const World& source, SoftId id, btSoftBody* body) {
  addForce(body, std::make_unique<btDeformableGravityForce>(world_->getWorldInfo().m_gravity));
  const SoftMaterial m = source.material(id);
  if (source.mesh(id)->isCloth()) {
    addForce(body, std::make_unique<btDeformableMassSpringForce>(m.youngsModulus * m.thickness, btScalar(0), true));
    return;
  }
  const float shear = m.youngsModulus / (2 * (1 + m.poissonRatio));
  const float lambda = m.youngsModulus * m.poissonRatio / ((1 + m.poissonRatio) * (1 - 2 * m.poissonRatio));
  addForce(body, std::make_unique<btDeformableNeoHookeanForce>(shear, lambda, btScalar(0)));
}

void BulletSofts::poses(std::span<Pose> out) const {
  for (size_t s = 0; s < bodies_.size(); ++s)
    for (size_t i = 0; i < places_[s].size(); ++i) {
      const btVector3& x = bodies_[s]->m_nodes[static_cast<int>(i)].m_x;
      out[places_[s][i]] = {{x.x(), x.y(), x.z()}, {}};
    }
}

void BulletSofts::checkFinite() const {
  for (const auto& body : bodies_)
    for (int i = 0; i < body->m_nodes.size(); ++i)
      if (!(body->m_nodes[i].m_x.length2() < kFar * kFar)) throw NonFiniteError("bullet", static_cast<uint32_t>(i), 0);
}

}  // namespace avbd::bench
