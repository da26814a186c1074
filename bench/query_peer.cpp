// Queries of a large world, answered by AVBD and by Bullet (query_peer.h).
#include "bench/query_peer.h"

#include <avbd/avbd.h>
#ifdef AVBD_HAS_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <btBulletCollisionCommon.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>

namespace avbd::bench {
namespace {

/// What is asked: the same for both.
struct Question {
  Vec3d from;
  Quat rotation;
  Vec3 motion;
};
constexpr float kReach = 1;
const Sphere kBall{0.3f};
const Box kBox{0.6f, 0.4f, 0.5f};
const Capsule kProbe{0.2f, 0.4f};

class Random {
 public:
  explicit Random(uint32_t seed) : random_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  float size() { return static_cast<float>(within(0.3, 0.6)); }
  Quat rotation() {
    std::normal_distribution<double> n;
    const double w = n(random_), x = n(random_), y = n(random_), z = n(random_);
    const double k = 1 / std::sqrt(w * w + x * x + y * y + z * z);
    return {float(w * k), float(x * k), float(y * k), float(z * k)};
  }
  Vec3 direction() { return rotate(rotation(), Vec3{1, 0, 0}); }

 private:
  std::mt19937 random_;
};

struct Scene {
  World world;
  double room;  ///< half side
  std::vector<Question> questions;

  Scene(int shapes, bool dense, int asked) {
    Random random(1);
    const int side = static_cast<int>(std::ceil(std::cbrt(double(shapes))));
    const double cell = dense ? 0.9 : 3.5;
    room = 0.5 * side * cell;
    std::vector<Vec3> cloud;
    for (int i = 0; i < 24; ++i) cloud.push_back(random.direction() * 0.5f);
    const std::shared_ptr<const HullData> hull = makeHull({.points = cloud});
    for (int i = 0; i < shapes; ++i) {
      const auto jitter = [&] { return random.within(-0.2, 0.2) * cell; };
      BodyDef def;
      def.position = {(i % side + 0.5) * cell - room + jitter(), (i / side % side + 0.5) * cell - room + jitter(),
                      (i / side / side + 0.5) * cell - room + jitter()};
      def.rotation = random.rotation();
      const float a = random.size(), b = random.size(), c = random.size();
      const Geometry kinds[4] = {Box{a, b, c}, Sphere{a}, Capsule{0.6f * a, b}, Hull{hull, {2 * a, 2 * b, 2 * c}}};
      def.shape = kinds[i % 4];
      world.create(def);
    }
    for (int i = 0; i < asked; ++i) {
      const Vec3d from{random.within(-room, room), random.within(-room, room), random.within(-room, room)};
      questions.push_back({from, random.rotation(), random.direction() * (dense ? 10.0f : 30.0f)});
    }
  }
};

/// Distance found, negative: nothing.
using Answers = std::vector<double>;

template <class F>
double timed(const Scene& scene, Answers& answers, F&& ask) {
  answers.assign(scene.questions.size(), -1);
  double best = 1e300;
  for (int round = 0; round < 3; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    for (size_t i = 0; i < scene.questions.size(); ++i) answers[i] = ask(scene.questions[i]);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    best = std::min(best, took.count() / double(scene.questions.size()));
  }
  return best;
}

double found(const CastHit& hit) { return hit ? double(hit.distance) : -1; }

double rayAvbd(const World& world, const Question& q) {
  return found(world.rayClosest({q.from, q.motion, length(q.motion)}));
}
double ballAvbd(const World& world, const Question& q) {
  return found(world.castClosest(kBall, {q.from, {}}, q.motion));
}
double boxCastAvbd(const World& world, const Question& q) {
  return found(world.castClosest(kBox, {q.from, q.rotation}, q.motion));
}
double overlapAvbd(const World& world, const Question& q) {
  const size_t count = world.overlaps(kBox, {q.from, q.rotation}).size();
  return count ? double(count) : -1;
}
double nearestAvbd(const World& world, const Question& q) {
  const NearHit hit = world.nearestClosest(kProbe, {q.from, q.rotation}, kReach);
  return hit.shape ? std::max(0.0, double(hit.distance)) : -1;
}

#ifdef AVBD_HAS_BULLET

btVector3 toBullet(Vec3d v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btVector3 toBullet(Vec3 v) { return {v.x, v.y, v.z}; }
btTransform toBullet(Vec3d p, Quat q) { return btTransform(btQuaternion(q.x, q.y, q.z, q.w), toBullet(p)); }

/// The same shapes as static objects, so that it keeps no pairs.
class Peer {
 public:
  explicit Peer(const World& world) {
    for (const BodyId id : world.bodies()) {
      shapes_.push_back(shapeOf(world.geometry(world.shapes(id)[0])));
      objects_.push_back(std::make_unique<btCollisionObject>());
      objects_.back()->setCollisionShape(shapes_.back().get());
      const Pose pose = world.pose(id);
      objects_.back()->setWorldTransform(toBullet(pose.position, pose.rotation));
      world_.addCollisionObject(objects_.back().get(), btBroadphaseProxy::StaticFilter, 0xffff);
    }
    world_.updateAabbs();
    for (int i = 0; i < 3; ++i) broadphase_.calculateOverlappingPairs(&dispatcher_);
    broadphase_.optimize();
    box_.setMargin(0);
    boxObject_.setCollisionShape(&box_);
  }
  ~Peer() {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }

  double ray(const Question& q) const {
    const btVector3 from = toBullet(q.from), to = from + toBullet(q.motion);
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world_.rayTest(from, to, hit);
    return hit.hasHit() ? double(hit.m_closestHitFraction) * double(length(q.motion)) : -1;
  }
  double cast(const btConvexShape& shape, const Question& q) const {
    const btTransform from = toBullet(q.from, q.rotation), to(from.getBasis(), from.getOrigin() + toBullet(q.motion));
    btCollisionWorld::ClosestConvexResultCallback hit(from.getOrigin(), to.getOrigin());
    world_.convexSweepTest(&shape, from, to, hit);
    return hit.hasHit() ? double(hit.m_closestHitFraction) * double(length(q.motion)) : -1;
  }
  double ball(const Question& q) const { return cast(ball_, q); }
  double boxCast(const Question& q) const { return cast(box_, q); }
  double overlap(const Question& q) {
    struct Count : btCollisionWorld::ContactResultCallback {
      const btCollisionObject* last = nullptr;
      int count = 0;
      btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                               const btCollisionObjectWrapper* b, int, int) override {
        const btCollisionObject* other =
            a->getCollisionObject()->getUserIndex() == 7 ? b->getCollisionObject() : a->getCollisionObject();
        if (point.getDistance() <= 0 && other != last) {
          ++count;
          last = other;
        }
        return 0;
      }
    } result;
    boxObject_.setUserIndex(7);
    boxObject_.setWorldTransform(toBullet(q.from, q.rotation));
    world_.contactTest(&boxObject_, result);
    return result.count ? result.count : -1;
  }
  /// Bullet has no such query: its tree and its distance of two convex shapes, put together.
  double nearest(const Question& q) {
    const btTransform at = toBullet(q.from, q.rotation);
    btVector3 lower, upper;
    capsule_.getAabb(at, lower, upper);
    struct Visit : btBroadphaseAabbCallback {
      const btCapsuleShape& capsule;
      btTransform at;
      btScalar best = kReach;
      bool found = false;
      btVoronoiSimplexSolver simplex;
      btGjkEpaPenetrationDepthSolver depth;
      Visit(const btCapsuleShape& c, const btTransform& t) : capsule(c), at(t) {}
      bool process(const btBroadphaseProxy* proxy) override {
        const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        btGjkPairDetector detector(&capsule, static_cast<const btConvexShape*>(object->getCollisionShape()), &simplex,
                                   &depth);
        btPointCollector result;
        btGjkPairDetector::ClosestPointInput input;
        input.m_transformA = at;
        input.m_transformB = object->getWorldTransform();
        input.m_maximumDistanceSquared = (best + 1) * (best + 1);
        detector.getClosestPoints(input, result, nullptr);
        if (result.m_hasResult && result.m_distance <= best) {
          best = std::max(btScalar(0), result.m_distance);
          found = true;
        }
        return true;
      }
    } visit(capsule_, at);
    const btVector3 grow(kReach, kReach, kReach);
    broadphase_.aabbTest(lower - grow, upper + grow, visit);
    return visit.found ? double(visit.best) : -1;
  }

 private:
  static std::unique_ptr<btConvexShape> shapeOf(const Geometry& geometry) {
    if (const auto* s = std::get_if<Box>(&geometry)) {
      // Its margin would round the corners.
      auto box = std::make_unique<btBoxShape>(btVector3(s->x, s->y, s->z));
      box->setMargin(0);
      return box;
    }
    if (const auto* s = std::get_if<Sphere>(&geometry)) return std::make_unique<btSphereShape>(s->radius);
    if (const auto* s = std::get_if<Capsule>(&geometry))
      return std::make_unique<btCapsuleShape>(s->radius, 2 * s->halfHeight);
    const Hull& hull = std::get<Hull>(geometry);
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Vec3 v : hull.data->vertices())
      shape->addPoint(btVector3(v.x * hull.scale.x, v.y * hull.scale.y, v.z * hull.scale.z), false);
    shape->recalcLocalAabb();
    shape->setMargin(0);
    return shape;
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
  std::vector<std::unique_ptr<btConvexShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  btSphereShape ball_{btScalar(kBall.radius)};
  btBoxShape box_{btVector3(kBox.x, kBox.y, kBox.z)};
  btCapsuleShape capsule_{btScalar(kProbe.radius), btScalar(2 * kProbe.halfHeight)};
  btCollisionObject boxObject_;
};

#else

class Peer {
 public:
  explicit Peer(const World&) {}
  double ray(const Question&) { return -1; }
  double ball(const Question&) { return -1; }
  double boxCast(const Question&) { return -1; }
  double overlap(const Question&) { return -1; }
  double nearest(const Question&) { return -1; }
};

#endif

template <class Ours, class Theirs>
QueryRow compare(const char* name, const Scene& scene, Ours&& ours, Theirs&& theirs) {
  QueryRow row;
  row.query = name;
  row.asked = scene.questions.size();
  Answers a, b;
  row.nanoseconds = timed(scene, a, ours);
  row.hits = size_t(std::count_if(a.begin(), a.end(), [](double d) { return d >= 0; }));
#ifdef AVBD_HAS_BULLET
  row.peerNanoseconds = timed(scene, b, theirs);
  std::vector<double> differences;
  for (size_t i = 0; i < a.size(); ++i) {
    // Bullet does not see what a ray starts in.
    if (a[i] == 0) continue;
    if ((a[i] < 0) != (b[i] < 0)) ++row.differ;
    if (a[i] < 0 || b[i] < 0) continue;
    differences.push_back(std::abs(a[i] - b[i]));
  }
  std::sort(differences.begin(), differences.end());
  if (!differences.empty()) {
    row.medianDifference = differences[differences.size() / 2];
    row.highDifference = differences[(differences.size() - 1) * 95 / 100];
    row.largestDifference = differences.back();
  }
#else
  static_cast<void>(theirs);
#endif
  return row;
}

}  // namespace

std::vector<QueryRow> compareQueries(int shapes, bool dense, int asked) {
  const Scene scene(shapes, dense, asked);
  const World& world = scene.world;
  Peer peer(world);
  using Q = const Question&;
  return {
      compare(
          "ray closest", scene, [&](Q q) { return rayAvbd(world, q); }, [&](Q q) { return peer.ray(q); }),
      compare(
          "sphere cast", scene, [&](Q q) { return ballAvbd(world, q); }, [&](Q q) { return peer.ball(q); }),
      compare(
          "box cast", scene, [&](Q q) { return boxCastAvbd(world, q); }, [&](Q q) { return peer.boxCast(q); }),
      compare(
          "box overlap", scene, [&](Q q) { return overlapAvbd(world, q); }, [&](Q q) { return peer.overlap(q); }),
      compare(
          "nearest", scene, [&](Q q) { return nearestAvbd(world, q); }, [&](Q q) { return peer.nearest(q); }),
  };
}

}  // namespace avbd::bench
