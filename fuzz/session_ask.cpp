// Questions: answers name what lives, lie within range, and the forms of one question agree.
#include <algorithm>
#include <array>

#include "fuzz/session.h"
#include "fuzz/session_attempt.h"

namespace avbd::fuzz {
namespace {

template <class Hit>
void checkAscending(const std::vector<Hit>& hits) {
  for (size_t i = 1; i < hits.size(); ++i)
    require(hits[i - 1].distance <= hits[i].distance, "answers that are not in order");
}

void checkAscending(const std::vector<ShapeId>& ids) {
  for (size_t i = 1; i < ids.size(); ++i) require(ids[i - 1] < ids[i], "shapes that are not in order");
}

template <class Hit>
bool same(const Hit& a, const Hit& b) {
  return a.shape == b.shape && a.distance == b.distance && a.element == b.element && a.normal == b.normal;
}

}  // namespace

void Session::read() {
  attempt([&] {
    const BodyId body = anyBody();
    require(std::isfinite(world_.mass(body)), "a mass that is not finite");
    require(isFinite(world_.worldCenterOfMass(body)), "a centre that is not finite");
    (void)world_.inertia(body);
    require(!std::isnan(world_.kineticEnergy(body)), "an energy that is not a number");
    for (const ShapeId shape : world_.shapes(body)) require(world_.body(shape) == body, "a shape of another body");
  });
  attempt([&] {
    const ShapeId shape = anyShape();
    (void)world_.geometry(shape);
    (void)world_.localPose(shape);
    (void)world_.material(shape);
    (void)world_.filter(shape);
    require(world_.isAlive(world_.body(shape)), "a shape of a dead body");
  });
  readJoints();
  require(!std::isnan(length(world_.momentum())), "a momentum that is not a number");
  require(!std::isnan(length(world_.angularMomentum())), "an angular momentum that is not a number");
  require(!std::isnan(world_.kineticEnergy()), "an energy that is not a number");
  for (const auto& pair : world_.excludedPairs())
    require(world_.isAlive(pair[0]) && world_.isAlive(pair[1]) && pair[0].index < pair[1].index, "a pair of no bodies");
  require(world_.bodies().size() == bodies_.size() && world_.joints().size() == joints_.size(), "lists that differ");
}

void Session::readJoints() {
  for (const JointId joint : joints_) {
    require(!std::isnan(world_.gap(joint)), "a gap that is not a number");
    require(!std::isnan(world_.angleError(joint)), "an angle that is not a number");
    attempt([&] { (void)world_.ballJoint(joint); });
    attempt([&] { (void)world_.tetVolume(joint); });
  }
}

QueryFilter Session::queryFilter() {
  QueryFilter filter;
  const uint8_t flags = in_.byte();
  if (flags < 128) return filter;
  filter.statics = flags & 1;
  filter.kinematics = flags & 2;
  filter.dynamics = flags & 4;
  filter.triggers = flags & 8;
  filter.backFaces = flags & 16;
  if (flags & 32) filter.ignore = anyBody();
  if (flags & 64) filter.accept = [](ShapeId shape) { return shape.index % 2 == 0; };
  return filter;
}

void Session::checkSeen(ShapeId shape, BodyId body, const QueryFilter& filter) const {
  require(world_.isAlive(shape) && world_.body(shape) == body, "an answer of a dead shape");
  require(!filter.ignore || body != filter.ignore, "an answer that was to be ignored");
  require(filter.triggers || !world_.isTrigger(shape), "a trigger answers");
  const BodyType type = world_.type(body);
  require(type == BodyType::Static      ? filter.statics
          : type == BodyType::Kinematic ? filter.kinematics
                                        : filter.dynamics,
          "an answer of a kind that was left out");
  require(!filter.accept || filter.accept(shape), "an answer that was not accepted");
}

void Session::checkHit(const CastHit& hit, double way, const QueryFilter& filter) const {
  if (!hit) return;
  checkSeen(hit.shape, hit.body, filter);
  require(hit.distance >= 0 && hit.distance <= way * (1 + 1e-6), "a hit out of range");
  require(isFinite(hit.position) && isUnit(hit.normal), "a hit that is not finite");
}

void Session::checkNear(const NearHit& hit, float most, const QueryFilter& filter) const {
  if (!hit.shape) return;
  checkSeen(hit.shape, hit.body, filter);
  require(std::isfinite(hit.distance) && hit.distance <= most, "a near shape that is far");
  require(isFinite(hit.onQuery) && isFinite(hit.onShape) && isUnit(hit.normal), "a near point that is not finite");
}

void Session::askRays(const QueryFilter& filter) {
  const Ray ray{place(), in_.vector(), in_.byte() < 200 ? 100 : in_.number()};
  const CastHit closest = world_.rayClosest(ray, filter);
  const std::vector<CastHit> all = world_.rayAll(ray, filter);
  checkHit(closest, ray.length, filter);
  for (const CastHit& hit : all) checkHit(hit, ray.length, filter);
  checkAscending(all);
  require(static_cast<bool>(closest) == !all.empty(), "the closest and all disagree about a ray");
  require(all.empty() || same(closest, all[0]), "the closest is not the first of all along a ray");
  require(world_.rayAny(ray, filter) == !all.empty(), "any and all disagree about a ray");
}

void Session::askCasts(const QueryFilter& filter) {
  const ShapeCast cast{in_.byte() < 240 ? convexGeometry() : geometry(), placePose(), in_.vector()};
  const CastHit closest = world_.castClosest(cast, filter);
  const std::vector<CastHit> all = world_.castAll(cast, filter);
  const double way = length(toDouble(cast.motion));
  checkHit(closest, way, filter);
  for (const CastHit& hit : all) checkHit(hit, way, filter);
  checkAscending(all);
  require(static_cast<bool>(closest) == !all.empty(), "the closest and all disagree about a cast");
  require(all.empty() || same(closest, all[0]), "the closest is not the first of all along a cast");
  require(world_.castAny(cast, filter) == !all.empty(), "any and all disagree about a cast");
}

void Session::askPlaces(const QueryFilter& filter) {
  const Geometry placed = in_.byte() < 240 ? convexGeometry() : geometry();
  const Pose pose = placePose();
  const float most = in_.positive();
  const std::vector<ShapeId> over = world_.overlaps(placed, pose, filter);
  checkAscending(over);
  for (const ShapeId shape : over) checkSeen(shape, world_.body(shape), filter);
  require(world_.overlapsAny(placed, pose, filter) == !over.empty(), "any and all disagree about overlaps");
  const std::vector<NearHit> near = world_.nearest(placed, pose, most, filter);
  checkAscending(near);
  for (const NearHit& hit : near) checkNear(hit, most, filter);
  const NearHit nearest = world_.nearestClosest(placed, pose, most, filter);
  require(static_cast<bool>(nearest.shape) == !near.empty(), "the closest and all disagree about the nearest");
  require(near.empty() || same(nearest, near[0]), "the closest is not the first of the nearest");
  const std::vector<ShapeId> holds = world_.containing(pose.position, filter);
  checkAscending(holds);
  for (const ShapeId shape : holds) checkSeen(shape, world_.body(shape), filter);
}

/// Bulk forms say what the single ones say.
void Session::askMany(const QueryFilter& filter) {
  std::array<Ray, 3> rays;
  for (Ray& ray : rays) ray = {place(), in_.vector(), 50};
  const size_t given = in_.byte() < 240 ? rays.size() : 2;
  std::array<CastHit, 3> hits;
  std::array<uint8_t, 3> any{};
  world_.raysClosest(rays, std::span(hits).first(given), filter);
  world_.raysAny(rays, std::span(any).first(given), filter);
  for (size_t i = 0; i < rays.size(); ++i) {
    require(same(hits[i], world_.rayClosest(rays[i], filter)), "a ray among many meets something else");
    require((any[i] == 1) == static_cast<bool>(hits[i]), "any and the closest disagree about a ray");
  }
  std::array<PlacedGeometry, 2> places{{{convexGeometry(), placePose()}, {convexGeometry(), placePose()}}};
  std::array<uint8_t, 2> overlap{};
  world_.overlapTests(places, overlap, filter);
  for (size_t i = 0; i < places.size(); ++i)
    require((overlap[i] == 1) == world_.overlapsAny(places[i].geometry, places[i].pose, filter),
            "an overlap among many is another");
  std::array<NearHit, 2> near;
  world_.nearestOfEach(places, 20, near, filter);
  const std::array<Vec3d, 2> points{places[0].pose.position, places[1].pose.position};
  std::array<uint8_t, 2> held{};
  world_.pointTests(points, held, filter);
  for (size_t i = 0; i < places.size(); ++i) {
    require(same(near[i], world_.nearestClosest(places[i].geometry, places[i].pose, 20, filter)),
            "the nearest of one among many is another");
    require((held[i] == 1) == !world_.containing(points[i], filter).empty(), "a point among many is elsewhere");
  }
  std::array<ShapeCast, 2> casts{
      {{places[0].geometry, places[0].pose, {0, -3, 0}}, {places[1].geometry, places[1].pose, {1, -2, 0}}}};
  world_.castsClosest(casts, std::span(hits).first(2), filter);
  for (size_t i = 0; i < casts.size(); ++i)
    require(same(hits[i], world_.castClosest(casts[i], filter)), "a cast among many meets something else");
}

void Session::ask() {
  const QueryFilter filter = queryFilter();
  const uint64_t before = world_.hash();
  switch (in_.below(4)) {
    case 0:
      attempt([&] { askRays(filter); });
      break;
    case 1:
      attempt([&] { askCasts(filter); });
      break;
    case 2:
      attempt([&] { askPlaces(filter); });
      break;
    default:
      attempt([&] { askMany(filter); });
  }
  require(world_.hash() == before, "a question changed the world");
}

/// The mover makes many casts of its own.
void Session::walk() {
  attempt([&] {
    if (!mover_ || in_.byte() > 240) {
      MoverDef def{.position = place()};
      if (in_.byte() > 200) def = {.position = def.position, .radius = in_.number(), .height = in_.number()};
      if (in_.byte() > 220) def.up = in_.vector();
      if (in_.byte() > 220) def.mass = in_.number();
      if (in_.byte() > 220) def.maxSlope = in_.number();
      if (in_.byte() > 220) def.skin = in_.number() * 0.01f;
      if (in_.byte() > 220) def.stepHeight = in_.number();
      def.filter = queryFilter();
      mover_ = Mover(def);
    }
    const Vec3 velocity = in_.vector();
    mover_->move(world_, velocity, in_.byte() < 245 ? 1.0f / 60 : in_.number());
  });
  if (!mover_) return;
  require(isFinite(mover_->position()) && isFinite(mover_->velocity()), "a mover that is not finite");
  const MoverGround& ground = mover_->ground();
  require(!ground.onGround || isUnit(ground.normal), "ground without a normal");
}

}  // namespace avbd::fuzz
