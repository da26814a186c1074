// Queries: arguments are checked, the tree is fitted, the answers get their ids.
#include "api/world_impl.h"
#include "query/query.h"
#include "world/check.h"
#include "world/limits.h"

namespace avbd {
namespace {

/// Several first queries after a step may come at the same time; one fits the tree, the others wait. The compiler's
/// calls, as libc++ has no std::atomic_ref.
const WorldData& fitted(WorldData& data, std::mutex& mutex) {
  if (!__atomic_load_n(&data.treeBehind, __ATOMIC_ACQUIRE)) return data;
  const std::lock_guard lock(mutex);
  if (__atomic_load_n(&data.treeBehind, __ATOMIC_RELAXED)) {
    freshenTree(data);
    __atomic_store_n(&data.treeBehind, false, __ATOMIC_RELEASE);
  }
  return data;
}

Sight sightOf(const WorldData& data, const QueryFilter& filter, const Path& call) {
  if (!filter.ignore) return {data, filter};
  const Path path = call / "filter";
  return {data, filter, slotOf(data, filter.ignore, path / "ignore")};
}

/// A ray with its direction made unit.
struct CheckedRay {
  Vec3d from;
  Way way;
};

CheckedRay checkedRay(const Path& path, const Ray& ray, float unit) {
  check(path / "origin", ray.origin, symmetric(kMaxPosition * unit));
  const Vec3d d = toDouble(ray.direction);
  const double size = length(d);
  if (!(size > 0 && std::isfinite(size)))
    (path / "direction").refuse(toText(ray.direction), "must be finite and not zero");
  if (!(ray.length > 0 && std::isfinite(ray.length)))
    (path / "length").refuse(toText(ray.length), "must be finite and > 0");
  return {ray.origin, {d * (1 / size), ray.length}};
}

/// A convex geometry at a pose that was checked, with its rotation made exact.
struct CheckedShape {
  const Geometry& geometry;
  Pose pose;

  CheckedShape(const Path& path, const Geometry& g, const Pose& p, float unit) : geometry(g) {
    const Path geometryPath = path / "geometry";
    checkGeometry(geometryPath, geometry, unit);
    if (isOnlyFixed(geometry)) geometryPath.refuse(geometryName(geometry), "must be convex and bounded");
    pose = checkedPose(path / "pose", p, kMaxPosition * unit);
  }
};

/// The same as plain data; holds what that points to.
struct ReadyShape {
  std::shared_ptr<const HullData> keep;
  Placed placed;

  ReadyShape(const CheckedShape& shape, ScaledHulls& hulls) : placed{{}, shape.pose} {
    const Hull* hull = std::get_if<Hull>(&shape.geometry);
    if (!hull || hull->scale == Vec3{1, 1, 1}) {
      placed.geom = toShapeGeom(shape.geometry);
    } else {
      keep = hulls.find(hull->data, hull->scale);
      placed.geom = {ShapeType::Hull, hull->rounding, {}, keep.get()};
    }
  }
};

Way checkedMotion(const Path& path, Vec3 motion, float unit) {
  check(path, motion, symmetric(2 * kMaxPosition * unit));
  const Vec3d m = toDouble(motion);
  const double size = length(m);
  if (!(size > 0)) path.refuse(toText(motion), "must not be zero");
  return {m * (1 / size), size};
}

CastHit toPublic(const WorldData& data, const WayHit& hit) {
  if (!hit) return {};
  return {data.shapeIds.id(hit.slot),
          data.bodyIds.id(data.shapes[hit.slot].body),
          hit.element,
          static_cast<float>(hit.distance),
          hit.position,
          toFloat(hit.normal)};
}

NearHit toPublic(const WorldData& data, const GapHit& hit) {
  if (!hit) return {};
  return {data.shapeIds.id(hit.slot),
          data.bodyIds.id(data.shapes[hit.slot].body),
          hit.element,
          hit.distance,
          hit.onPlaced,
          hit.onShape,
          hit.normal};
}

ShapeId toPublic(const WorldData& data, uint32_t slot) { return data.shapeIds.id(slot); }

template <class Internal>
auto listOf(const WorldData& data, const std::vector<Internal>& hits) {
  std::vector<decltype(toPublic(data, hits[0]))> list;
  list.reserve(hits.size());
  for (const Internal& hit : hits) list.push_back(toPublic(data, hit));
  return list;
}

void checkCount(const Path& path, size_t size, size_t wanted, const char* what) {
  if (size != wanted)
    path.refuse(toText(size) + " values", std::string("must be as many as ") + what + ": " + toText(wanted));
}

}  // namespace

CastHit World::rayClosest(const Ray& ray, const QueryFilter& filter) const {
  const Path call("World::rayClosest");
  const CheckedRay r = checkedRay(call / "ray", ray, impl_->data.def.lengthUnit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return toPublic(data, avbd::rayClosest(sightOf(data, filter, call), r.from, r.way));
}

bool World::rayAny(const Ray& ray, const QueryFilter& filter) const {
  const Path call("World::rayAny");
  const CheckedRay r = checkedRay(call / "ray", ray, impl_->data.def.lengthUnit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return avbd::rayAny(sightOf(data, filter, call), r.from, r.way);
}

std::vector<CastHit> World::rayAll(const Ray& ray, const QueryFilter& filter) const {
  const Path call("World::rayAll");
  const CheckedRay r = checkedRay(call / "ray", ray, impl_->data.def.lengthUnit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return listOf(data, avbd::rayAll(sightOf(data, filter, call), r.from, r.way));
}

namespace {

struct CheckedCast {
  CheckedShape shape;
  Way way;

  CheckedCast(const Path& path, const ShapeCast& cast, float unit)
      : shape(path, cast.geometry, cast.pose, unit), way(checkedMotion(path / "motion", cast.motion, unit)) {}
};

}  // namespace

CastHit World::castClosest(const ShapeCast& cast, const QueryFilter& filter) const {
  const Path call("World::castClosest");
  const CheckedCast c(call / "cast", cast, impl_->data.def.lengthUnit);
  const ReadyShape ready(c.shape, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return toPublic(data, avbd::castClosest(sightOf(data, filter, call), ready.placed, c.way));
}

CastHit World::castClosest(const Geometry& geometry, const Pose& pose, Vec3 motion, const QueryFilter& filter) const {
  return castClosest({geometry, pose, motion}, filter);
}

bool World::castAny(const ShapeCast& cast, const QueryFilter& filter) const {
  const Path call("World::castAny");
  const CheckedCast c(call / "cast", cast, impl_->data.def.lengthUnit);
  const ReadyShape ready(c.shape, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return avbd::castAny(sightOf(data, filter, call), ready.placed, c.way);
}

std::vector<CastHit> World::castAll(const ShapeCast& cast, const QueryFilter& filter) const {
  const Path call("World::castAll");
  const CheckedCast c(call / "cast", cast, impl_->data.def.lengthUnit);
  const ReadyShape ready(c.shape, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return listOf(data, avbd::castAll(sightOf(data, filter, call), ready.placed, c.way));
}

std::vector<CastHit> World::castAll(const Geometry& geometry, const Pose& pose, Vec3 motion,
                                    const QueryFilter& filter) const {
  return castAll({geometry, pose, motion}, filter);
}

std::vector<ShapeId> World::overlaps(const Geometry& geometry, const Pose& pose, const QueryFilter& filter) const {
  const Path call("World::overlaps");
  const ReadyShape shape({call, geometry, pose, impl_->data.def.lengthUnit}, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return listOf(data, overlapping(sightOf(data, filter, call), shape.placed));
}

bool World::overlapsAny(const Geometry& geometry, const Pose& pose, const QueryFilter& filter) const {
  const Path call("World::overlapsAny");
  const ReadyShape shape({call, geometry, pose, impl_->data.def.lengthUnit}, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return avbd::overlapsAny(sightOf(data, filter, call), shape.placed);
}

std::vector<NearHit> World::nearest(const Geometry& geometry, const Pose& pose, float maxDistance,
                                    const QueryFilter& filter) const {
  const Path call("World::nearest");
  const float unit = impl_->data.def.lengthUnit;
  const CheckedShape checked(call, geometry, pose, unit);
  check(call / "maxDistance", maxDistance, notNegative(2 * kMaxPosition * unit));
  const ReadyShape shape(checked, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return listOf(data, nearestAll(sightOf(data, filter, call), shape.placed, maxDistance));
}

NearHit World::nearestClosest(const Geometry& geometry, const Pose& pose, float maxDistance,
                              const QueryFilter& filter) const {
  const Path call("World::nearestClosest");
  const float unit = impl_->data.def.lengthUnit;
  const CheckedShape checked(call, geometry, pose, unit);
  check(call / "maxDistance", maxDistance, notNegative(2 * kMaxPosition * unit));
  const ReadyShape shape(checked, impl_->scaledHulls);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return toPublic(data, avbd::nearestClosest(sightOf(data, filter, call), shape.placed, maxDistance));
}

std::vector<ShapeId> World::containing(Vec3d point, const QueryFilter& filter) const {
  const Path call("World::containing");
  check(call / "point", point, symmetric(kMaxPosition * impl_->data.def.lengthUnit));
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  return listOf(data, avbd::containing(sightOf(data, filter, call), point));
}

// Bulk. Everything is checked before the first answer is written.

void World::raysClosest(std::span<const Ray> rays, std::span<CastHit> out, const QueryFilter& filter) const {
  const Path call("World::raysClosest"), entries = call / "rays";
  const float unit = impl_->data.def.lengthUnit;
  checkCount(call / "out", out.size(), rays.size(), "rays");
  for (size_t i = 0; i < rays.size(); ++i) checkedRay(entries[i], rays[i], unit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < rays.size(); ++i) {
    const CheckedRay r = checkedRay(entries[i], rays[i], unit);
    out[i] = toPublic(data, avbd::rayClosest(sight, r.from, r.way));
  }
}

void World::raysAny(std::span<const Ray> rays, std::span<uint8_t> out, const QueryFilter& filter) const {
  const Path call("World::raysAny"), entries = call / "rays";
  const float unit = impl_->data.def.lengthUnit;
  checkCount(call / "out", out.size(), rays.size(), "rays");
  for (size_t i = 0; i < rays.size(); ++i) checkedRay(entries[i], rays[i], unit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < rays.size(); ++i) {
    const CheckedRay r = checkedRay(entries[i], rays[i], unit);
    out[i] = avbd::rayAny(sight, r.from, r.way) ? 1 : 0;
  }
}

void World::castsClosest(std::span<const ShapeCast> casts, std::span<CastHit> out, const QueryFilter& filter) const {
  const Path call("World::castsClosest"), entries = call / "casts";
  const float unit = impl_->data.def.lengthUnit;
  checkCount(call / "out", out.size(), casts.size(), "casts");
  for (size_t i = 0; i < casts.size(); ++i) CheckedCast(entries[i], casts[i], unit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < casts.size(); ++i) {
    const CheckedCast c(entries[i], casts[i], unit);
    out[i] = toPublic(data, avbd::castClosest(sight, ReadyShape(c.shape, impl_->scaledHulls).placed, c.way));
  }
}

void World::overlapTests(std::span<const PlacedGeometry> placed, std::span<uint8_t> out,
                         const QueryFilter& filter) const {
  const Path call("World::overlapTests"), entries = call / "placed";
  const float unit = impl_->data.def.lengthUnit;
  checkCount(call / "out", out.size(), placed.size(), "placed");
  for (size_t i = 0; i < placed.size(); ++i) CheckedShape(entries[i], placed[i].geometry, placed[i].pose, unit);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < placed.size(); ++i) {
    const ReadyShape shape({entries[i], placed[i].geometry, placed[i].pose, unit}, impl_->scaledHulls);
    out[i] = avbd::overlapsAny(sight, shape.placed) ? 1 : 0;
  }
}

void World::nearestOfEach(std::span<const PlacedGeometry> placed, float maxDistance, std::span<NearHit> out,
                          const QueryFilter& filter) const {
  const Path call("World::nearestOfEach"), entries = call / "placed";
  const float unit = impl_->data.def.lengthUnit;
  checkCount(call / "out", out.size(), placed.size(), "placed");
  for (size_t i = 0; i < placed.size(); ++i) CheckedShape(entries[i], placed[i].geometry, placed[i].pose, unit);
  check(call / "maxDistance", maxDistance, notNegative(2 * kMaxPosition * unit));
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < placed.size(); ++i) {
    const ReadyShape shape({entries[i], placed[i].geometry, placed[i].pose, unit}, impl_->scaledHulls);
    out[i] = toPublic(data, avbd::nearestClosest(sight, shape.placed, maxDistance));
  }
}

void World::pointTests(std::span<const Vec3d> points, std::span<uint8_t> out, const QueryFilter& filter) const {
  const Path call("World::pointTests"), entries = call / "points";
  const Range range = symmetric(kMaxPosition * impl_->data.def.lengthUnit);
  checkCount(call / "out", out.size(), points.size(), "points");
  for (size_t i = 0; i < points.size(); ++i) check(entries[i], points[i], range);
  const WorldData& data = fitted(impl_->data, impl_->treeMutex);
  const Sight sight = sightOf(data, filter, call);
  for (size_t i = 0; i < points.size(); ++i) out[i] = containsAny(sight, points[i]) ? 1 : 0;
}

}  // namespace avbd
