// Queries, movers and debug draw with bad arguments (bad_input.h).
#include <cmath>
#include <limits>

#include "scenes/bad_input.h"
#include "scenes/build.h"

namespace avbd::scenes {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using List = std::vector<BadCall>;

void add(List& list, const char* definition, const char* field, std::string value, std::function<void(Victim&)> call) {
  list.push_back({definition, field, std::move(value), std::move(call)});
}

void addRays(List& list) {
  for (const float bad : {kNan, kInfinity}) {
    const std::string value = text(bad);
    add(list, "World::rayClosest", "ray.origin", value, [=](Victim& v) {
      v.world.rayClosest({{0, static_cast<double>(bad), 0}});
    });
    add(list, "World::rayAny", "ray.direction", value, [=](Victim& v) { v.world.rayAny({{}, {bad, 0, 0}}); });
    add(list, "World::rayAll", "ray.length", value, [=](Victim& v) { v.world.rayAll({{}, {0, 1, 0}, bad}); });
  }
  add(list, "World::rayClosest", "ray.direction", "0", [](Victim& v) { v.world.rayClosest({{}, {0, 0, 0}}); });
  add(list, "World::rayClosest", "ray.length", "0", [](Victim& v) { v.world.rayClosest({{}, {0, 1, 0}, 0}); });
  add(list, "World::rayClosest", "ray.length", "-1", [](Victim& v) { v.world.rayClosest({{}, {0, 1, 0}, -1}); });
  add(list, "World::rayClosest", "filter.ignore", "dead",
      [](Victim& v) { v.world.rayClosest({}, {.ignore = v.deadBody}); });
  add(list, "World::raysClosest", "rays[1].direction", "nan", [](Victim& v) {
    const Ray rays[2] = {{}, {{}, {kNan, 0, 0}}};
    CastHit out[2];
    v.world.raysClosest(rays, out);
  });
  add(list, "World::raysAny", "out", "1 for 2", [](Victim& v) {
    const Ray rays[2];
    uint8_t out[1];
    v.world.raysAny(rays, out);
  });
}

void addCasts(List& list) {
  const Geometry fixed[] = {HalfSpace{}, Hull{}, Box{1, kNan, 1}};
  const char* fields[] = {"cast.geometry", "cast.geometry.data", "cast.geometry.y"};
  const char* values[] = {"HalfSpace", "null", "nan"};
  for (int i = 0; i < 3; ++i)
    add(list, "World::castClosest", fields[i], values[i], [g = fixed[i]](Victim& v) {
      v.world.castClosest(g, {}, {0, -1, 0});
    });
  add(list, "World::castClosest", "cast.motion", "0", [](Victim& v) { v.world.castClosest(Sphere{}, {}, {}); });
  add(list, "World::castAll", "cast.motion", "inf", [](Victim& v) {
    v.world.castAll(Sphere{}, {}, {kInfinity, 0, 0});
  });
  add(list, "World::castAny", "cast.pose.rotation", "0", [](Victim& v) {
    v.world.castAny({Sphere{}, {{}, {0, 0, 0, 0}}, {0, 1, 0}});
  });
  add(list, "World::castClosest", "cast.pose.position", "2e9", [](Victim& v) {
    v.world.castClosest(Sphere{}, {{2e9, 0, 0}, {}}, {0, 1, 0});
  });
  add(list, "World::castsClosest", "casts[0].motion", "nan", [](Victim& v) {
    const ShapeCast casts[1] = {{Sphere{}, {}, {0, 0, kNan}}};
    CastHit out[1];
    v.world.castsClosest(casts, out);
  });
}

void addPlaces(List& list) {
  add(list, "World::overlaps", "geometry", "HalfSpace", [](Victim& v) { v.world.overlaps(HalfSpace{}, {}); });
  add(list, "World::overlapsAny", "geometry.radius", "0", [](Victim& v) { v.world.overlapsAny(Sphere{0}, {}); });
  add(list, "World::overlaps", "geometry.data", "null mesh", [](Victim& v) { v.world.overlaps(Mesh{}, {}); });
  for (const float bad : {kNan, -1.0f, kInfinity}) {
    add(list, "World::nearest", "maxDistance", text(bad), [=](Victim& v) { v.world.nearest(Sphere{}, {}, bad); });
    add(list, "World::nearestOfEach", "maxDistance", text(bad), [=](Victim& v) { v.world.nearestOfEach({}, bad, {}); });
  }
  add(list, "World::nearestClosest", "pose.position", "nan", [](Victim& v) {
    v.world.nearestClosest(Sphere{}, {{0, 0, static_cast<double>(kNan)}, {}}, 1);
  });
  add(list, "World::containing", "point", "inf", [](Victim& v) {
    v.world.containing({static_cast<double>(kInfinity), 0, 0});
  });
  add(list, "World::pointTests", "points[1]", "nan", [](Victim& v) {
    const Vec3d points[2] = {{}, {0, static_cast<double>(kNan), 0}};
    uint8_t out[2];
    v.world.pointTests(points, out);
  });
  add(list, "World::pointTests", "out", "1 for 2", [](Victim& v) {
    const Vec3d points[2];
    uint8_t out[1];
    v.world.pointTests(points, out);
  });
  add(list, "World::overlapTests", "placed[0].geometry.halfHeight", "-1", [](Victim& v) {
    const PlacedGeometry placed[1] = {{Capsule{1, -1}, {}}};
    uint8_t out[1];
    v.world.overlapTests(placed, out);
  });
}

void addMovers(List& list) {
  const auto def = [&](const char* field, const char* value, MoverDef bad) {
    add(list, "MoverDef", field, value, [=](Victim&) { Mover{bad}; });
  };
  def("position", "nan", {.position = {static_cast<double>(kNan), 0, 0}});
  def("radius", "0", {.radius = 0});
  def("radius", "inf", {.radius = kInfinity});
  def("height", "below two radii", {.radius = 1, .height = 1.5f});
  def("up", "two long", {.up = {0, 2, 0}});
  def("up", "nan", {.up = {0, kNan, 0}});
  def("maxSlope", "-1", {.maxSlope = -1});
  def("stepHeight", "nan", {.stepHeight = kNan});
  def("skin", "0", {.skin = 0});
  def("skin", "above the radius", {.skin = 1});
  def("mass", "-70", {.mass = -70});
  for (const float bad : {kNan, kInfinity}) {
    add(list, "Mover::move", "velocity", text(bad), [=](Victim& v) { Mover({}).move(v.world, {0, bad, 0}, 0.01f); });
    add(list, "Mover::move", "dt", text(bad), [=](Victim& v) { Mover({}).move(v.world, {}, bad); });
  }
  add(list, "Mover::move", "dt", "-0.1", [](Victim& v) { Mover({}).move(v.world, {}, -0.1f); });
  add(list, "Mover::setPosition", "position", "nan", [](Victim&) {
    Mover({}).setPosition({0, 0, static_cast<double>(kNan)});
  });
}

void addDrawings(List& list) {
  const auto draw = [&](const char* field, const char* value, DebugDrawOptions bad) {
    add(list, "DebugDrawOptions", field, value, [=](Victim& v) {
      DebugLists lists;
      debugDraw(v.world, lists, bad);
    });
  };
  draw("segments", "3", {.segments = 3});
  draw("segments", "1000000", {.segments = 1000000});
  draw("size", "nan", {.size = kNan});
  draw("size", "-1", {.size = -1});
  draw("planeHalf", "0", {.planeHalf = 0});
  draw("lengthPerNewton", "inf", {.lengthPerNewton = kInfinity});
  draw("lengthPerSpeed", "nan", {.lengthPerSpeed = kNan});
  draw("origin", "nan", {.origin = {static_cast<double>(kNan), 0, 0}});
}

}  // namespace

std::vector<BadCall> badQuestions() {
  List list;
  addRays(list);
  addCasts(list);
  addPlaces(list);
  addMovers(list);
  addDrawings(list);
  return list;
}

}  // namespace avbd::scenes
