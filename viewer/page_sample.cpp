// Writes made-up recordings for the browser test:
// page_sample FILE.html [pyramid | pile | hostile | shapes | joints | soft].
#include <array>
#include <cmath>
#include <iostream>

#include "io/record/softs.h"
#include "viewer/page.h"

namespace avbd {
namespace {

uint32_t add(Recording& r, const std::string& name, BodyType type, const Geometry& geometry, const Pose& pose = {}) {
  const auto body = static_cast<uint32_t>(r.bodies.size());
  r.bodies.push_back({name, type});
  r.shapes.push_back({body, geometry, pose});
  return body;
}

Quat turn(Vec3 axis, float angle) {
  const float s = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

/// Height over the rest height of something dropped from `height`, bouncing.
double bounce(double height, double time) {
  double fall = std::sqrt(2 * height / 9.81);
  if (time < fall) return height - 4.905 * time * time;
  time -= fall;
  for (int i = 0; i < 6; ++i) {
    fall *= 0.5;
    if (time < 2 * fall) return 9.81 * fall * time - 4.905 * time * time;
    time -= 2 * fall;
  }
  return 0;
}

/// z is up: 55 boxes that settle into a pyramid, three capsules on a chain, two balls.
Recording pyramid() {
  Recording r;
  r.title = "Pyramid & pendulum: 55 boxes, 3 capsules, 2 balls";
  r.up = {0, 0, 1};
  add(r, "floor", BodyType::Static, HalfSpace{}, {{}, turn({1, 0, 0}, 1.57079633f)});
  add(r, "post", BodyType::Static, Box{0.15f, 0.15f, 2.6f});
  add(r, "ramp", BodyType::Static, Box{1.6f, 1.0f, 0.1f});
  for (int row = 0; row < 10; ++row) {
    for (int i = 0; i < 10 - row; ++i) {
      add(r, "box_" + std::to_string(row) + "_" + std::to_string(i), BodyType::Dynamic, Box{0.25f, 0.25f, 0.25f});
    }
  }
  for (int i = 0; i < 3; ++i) {
    const uint32_t link = add(r, "link_" + std::to_string(i), BodyType::Dynamic, Capsule{0.12f, 0.3f},
                              {{}, turn({1, 0, 0}, 1.57079633f)});
    const Vec3d above = i == 0 ? Vec3d{0, -0.4, 2.4} : Vec3d{0, 0, -0.45};
    r.joints.push_back({i == 0 ? 1u : link - 1, link, {above, {}}, {{0, 0, 0.45}, {}}});
  }
  add(r, "ball_heavy", BodyType::Dynamic, Sphere{0.45f});
  add(r, "ball_rolling", BodyType::Dynamic, Sphere{0.35f});
  r.joints.push_back({60, 61, {{0, 0, -0.45}, {}}, {{0, 0, 0.55}, {}}});
  return r;
}

void addPyramidPoses(RecordedFrame& f, double t) {
  f.poses = {{}, {{3.4, 0.4, 2.6}, {}}, {{-4.2, 0.2, 0.75}, turn({0, 1, 0}, 0.35f)}};
  for (int row = 0; row < 10; ++row) {
    for (int i = 0; i < 10 - row; ++i) {
      const double late = std::max(0.0, t - 0.12 * row);
      const double height = bounce(0.25 + 0.3 * row, late);
      const float twist = 0.25f * static_cast<float>(height) * ((row + i) % 2 == 0 ? 1.0f : -1.0f);
      f.poses.push_back({{(i - (9 - row) * 0.5) * 0.54, 0.25, 0.25 + row * 0.5 + height}, turn({0, 0, 1}, twist)});
    }
  }
  const double swing = 0.9 * std::cos(2.1 * t) * std::exp(-0.05 * t);
  Vec3d pin{3.4, 0, 5};
  const Vec3d down{std::sin(swing), 0, -std::cos(swing)};
  for (int i = 0; i < 4; ++i) {
    const double reach = i < 3 ? 0.45 : 0.55;
    f.poses.push_back({pin + down * reach, turn({0, 1, 0}, static_cast<float>(-swing))});
    pin = pin + down * (2 * reach);
  }
  const double along = std::min(0.25 * 3.1 * t * t, 8.0);
  const double x = -5.4 + along, ground = 0.35;
  const double slope = 0.75 - std::tan(0.35) * (x + 4.2) + 0.1 / std::cos(0.35) + 0.35 / std::cos(0.35);
  f.poses.push_back({{x, 0.2 - 1.2 * std::max(0.0, x + 2.6), std::max(slope, ground)},
                     turn({0, 1, 0}, static_cast<float>(along / 0.35))});
}

void addPyramidFigures(RecordedFrame& f, double t) {
  for (int row = 0; row < 10; ++row) {
    for (int i = 0; i < 10 - row; ++i) {
      if (t < 0.12 * row + 0.4) continue;
      const Pose& pose = f.poses[static_cast<size_t>(3 + row * 10 - row * (row - 1) / 2 + i)];
      for (int corner = 0; corner < 4; ++corner) {
        const Vec3d arm{corner % 2 == 0 ? -0.2 : 0.2, corner < 2 ? -0.2 : 0.2, -0.25};
        f.contacts.push_back(
            {pose.position + rotate(pose.rotation, arm), {4.0f * static_cast<float>(corner), 0, 60.0f * (10 - row)}});
      }
    }
  }
  f.kineticEnergy = 4200 * std::exp(-1.4 * t) * (1 + 0.6 * std::sin(9 * t)) + 60 * std::pow(std::sin(2.1 * t), 2);
  f.penetrationMax = 0.004 + 0.011 * std::exp(-2.5 * t) * std::fabs(std::sin(14 * t));
  f.jointGapMax = 2e-5 * (1 + std::fabs(std::sin(2.1 * t)));
}

Recording pyramidRun() {
  Recording r = pyramid();
  for (int i = 0; i <= 240; ++i) {
    RecordedFrame f;
    f.time = i / 60.0;
    addPyramidPoses(f, f.time);
    addPyramidFigures(f, f.time);
    r.frames.push_back(std::move(f));
  }
  r.report = {{"bodies", "60 dynamic, 3 static"}, {"contact points", "220"},         {"steps", "240 of 16.67 ms"},
              {"step time, median", "0.412 ms"},  {"step time, p95", "0.655 ms"},    {"real-time factor", "40.5"},
              {"penetration, largest", "4.1 mm"}, {"joint gap, largest", "0.02 mm"}, {"hash", "6f1e0c93a7d2b845"}};
  return r;
}

/// y is up: 2000 boxes, balls and capsules that move in every frame.
Recording pileRun() {
  Recording r;
  r.title = "Pile of 2000";
  add(r, "ground", BodyType::Static, HalfSpace{});
  for (int i = 0; i < 2000; ++i) {
    const Geometry kinds[3] = {Box{0.2f, 0.2f, 0.2f}, Sphere{0.22f}, Capsule{0.14f, 0.15f}};
    add(r, "body " + std::to_string(i), BodyType::Dynamic, kinds[i % 3]);
  }
  for (int i = 0; i < 300; ++i) {
    RecordedFrame f;
    f.time = i / 60.0;
    f.poses.emplace_back();
    for (int k = 0; k < 2000; ++k) {
      const double wave = 0.1 * std::sin(3 * f.time + 0.37 * k) + 0.1;
      f.poses.push_back({{(k % 15 - 7) * 0.5, 0.25 + (k / 225) * 0.55 + wave, (k / 15 % 15 - 7) * 0.5},
                         turn({1, 0.3f, 0.2f}, static_cast<float>(0.02 * k + 0.4 * f.time))});
      if (k < 225) f.contacts.push_back({f.poses.back().position + Vec3d{0, -0.2, 0}, {0, 30, 0}});
    }
    f.kineticEnergy = 900 + 100 * std::sin(6 * f.time);
    r.frames.push_back(std::move(f));
  }
  return r;
}

/// Names that try to break out of the page, poses that are not finite, a scene far from the origin, one frame.
Recording hostile() {
  Recording r;
  r.title = "</title><script>window.broken=1</script>\"'&";
  r.up = {1, 1, 0};
  add(r, "</script><script>window.broken=2</script>", BodyType::Static, HalfSpace{});
  add(r, "<!--<script>\"'\\\n\t\xff\xfe", BodyType::Dynamic, Box{0.5f, 0.5f, 0.5f});
  add(r, "<img src=x onerror=window.broken=3>", BodyType::Dynamic, Sphere{NAN});
  add(r, "", BodyType::Kinematic, Capsule{0.2f, 0});
  r.bodies.push_back({"no shape", BodyType::Dynamic});
  RecordedFrame f;
  f.poses = {{{1e6, 1e6, -1e6}, {}},
             {{1e6 + 1, 1e6 + 1, -1e6}, {}},
             {{NAN, 0, 0}, {NAN, 0, 0, 0}},
             {{1e6 - 1, 1e6 + 2, -1e6 + 2}, {0, 0, 0, 0}},
             {{1e6, 1e6, 1e6}, {}}};
  f.contacts = {{{NAN, 0, 0}, {INFINITY, 0, 0}}, {{1e6, 1e6, -1e6}, {0, 1e30f, 0}}};
  f.kineticEnergy = NAN;
  f.penetrationMax = INFINITY;
  r.frames.push_back(f);
  r.joints.push_back({1, 0xffffffffu, {}, {{1e6, 1e6, -1e6}, {NAN, 0, 0, 0}}, JointType::D6, "</script>"});
  r.joints[0].freeAxes = 0x3f;
  r.joints[0].limits[3] = {-INFINITY, 1e30f};
  r.joints[0].limits[0].lower = -1e30f;
  r.frames[0].joints = {{{{NAN, INFINITY, 0}, {}}, true}};
  r.report = {{"<b>label</b>", "</script><script>window.broken=4</script>"}};
  return r;
}

/// A pebble.
std::shared_ptr<const HullData> pebble() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 14; ++i) {
    const float angle = 2.4f * static_cast<float>(i), y = -0.45f + 0.069f * static_cast<float>(i);
    const float wide = 0.55f * std::sqrt(1 - 2.5f * y * y);
    corners.push_back({wide * std::cos(angle), y, wide * std::sin(angle)});
  }
  return makeHull({corners});
}

/// A torus.
std::shared_ptr<const MeshData> torus() {
  std::vector<Vec3> ring;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 0; i < 24; ++i) {
    for (uint32_t k = 0; k < 12; ++k) {
      const float u = 0.2617994f * static_cast<float>(i), v = 0.5235988f * static_cast<float>(k);
      const float wide = 0.4f + 0.15f * std::cos(v);
      ring.push_back({wide * std::cos(u), 0.15f * std::sin(v), wide * std::sin(u)});
      const uint32_t a = 12 * i + k, b = 12 * i + (k + 1) % 12, c = 12 * ((i + 1) % 24) + k;
      triangles.push_back({a, b, c});
      triangles.push_back({b, 12 * ((i + 1) % 24) + (k + 1) % 12, c});
    }
  }
  return makeMesh({ring, triangles});
}

std::shared_ptr<const HeightFieldData> waves() {
  std::vector<float> heights;
  for (int row = 0; row < 24; ++row)
    for (int column = 0; column < 40; ++column)
      heights.push_back(0.25f * std::sin(0.5f * static_cast<float>(column)) * std::cos(0.4f * static_cast<float>(row)));
  return makeHeightField({.columns = 40, .rows = 24, .spacingX = 0.25f, .spacingZ = 0.15f, .heights = heights});
}

/// Every type of shape in a row, round and sharp, mirrored and translucent; y is up.
Recording shapesRun() {
  Recording r;
  r.title = "Every shape";
  add(r, "ground", BodyType::Static, HalfSpace{});
  const auto hull = pebble();
  const auto mesh = torus();
  const std::pair<const char*, Geometry> all[] = {
      {"sphere", Sphere{0.5f}},
      {"capsule", Capsule{0.3f, 0.3f}},
      {"box", Box{0.4f, 0.4f, 0.4f}},
      {"box_rounded", Box{0.25f, 0.25f, 0.25f, 0.2f}},
      {"cylinder", Cylinder{0.45f, 0.4f}},
      {"cylinder_rounded", Cylinder{0.3f, 0.3f, 0.15f}},
      {"cone", Cone{0.5f, 0.5f}},
      {"cone_rounded", Cone{0.35f, 0.3f, 0.12f}},
      {"ellipsoid", Ellipsoid{0.55f, 0.25f, 0.4f}},
      {"hull", Hull{hull}},
      {"hull_mirrored", Hull{hull, {-0.9f, 1.1f, 0.9f}}},
      {"hull_rounded", Hull{hull, {0.75f, 0.75f, 0.75f}, 0.12f}},
      {"ring", Mesh{mesh}},
      {"ring_scaled", Mesh{mesh, {0.8f, 2, 0.8f}}},
  };
  for (const auto& [name, geometry] : all) add(r, name, BodyType::Dynamic, geometry);
  r.shapes.push_back({add(r, "gate", BodyType::Static, Box{0.6f, 0.9f, 0.6f}), Sphere{0.2f}, {{0, 1.2, 0}, {}}, true});
  r.shapes[r.shapes.size() - 2].trigger = true;
  r.shapes[3].color = Color{255, 24, 24};  // the box
  add(r, "terrain", BodyType::Static, HeightField{waves()});
  for (int i = 0; i < 60; ++i) {
    RecordedFrame f;
    f.time = i / 30.0;
    f.poses.emplace_back();
    for (int k = 0; k < 14; ++k)
      f.poses.push_back(
          {{(k % 7 - 3) * 1.4, 0.9, k < 7 ? 0.0 : 1.8}, turn({0.2f, 1, 0.1f}, 0.02f * static_cast<float>(i))});
    f.poses.push_back({{5.8, 0.9, 0.9}, {}});
    f.poses.push_back({{0, 0.6, -3}, {}});
    r.frames.push_back(std::move(f));
  }
  return r;
}

RecordedJoint jointOf(uint32_t body, const Pose& frameA, const Pose& frameB, JointType type, uint8_t free) {
  RecordedJoint joint{kNotRecorded, body, frameA, frameB, type};
  joint.freeAxes = free;
  return joint;
}

/// Two buckets on a rope over two wheels, the door coupled to the drawer, and a joint of the user's own.
void addCouplings(Recording& r) {
  const uint32_t a = add(r, "bucket_a", BodyType::Dynamic, Cylinder{0.2f, 0.2f});
  const uint32_t b = add(r, "bucket_b", BodyType::Dynamic, Cylinder{0.2f, 0.2f});
  RecordedJoint rope{a, b, {{0, 0.2, 0}, {}}, {{0, 0.2, 0}, {}}, JointType::Pulley, "hoist"};
  rope.wheels = {{{-1, 3, -1.5}, {0.5, 3, -1.5}}};
  rope.residuals = 1;
  RecordedJoint coupling{kNotRecorded, kNotRecorded, {}, {}, JointType::Coupling};
  coupling.terms = {{0, JointAxis::Twist, {0.5f, 0, 0, 0}}, {1, JointAxis::LinearX, {-1, 0, 0.25f, 0}}};
  coupling.rest = 0.1;
  coupling.residuals = 1;
  RecordedJoint custom{1, 3, {}, {}, JointType::Custom};
  custom.family = "<b>rail</b>";
  custom.moreBodies = {2, kNotRecorded};
  custom.residuals = 2;
  r.joints.insert(r.joints.end(), {rope, coupling, custom});
}

/// A door on a hinge, a drawer on a slider, an arm in a cone, a ball on a rope that breaks; y is up.
Recording jointsRun() {
  Recording r;
  r.title = "Joints";
  add(r, "ground", BodyType::Static, HalfSpace{});
  const uint32_t door = add(r, "door", BodyType::Dynamic, Box{0.5f, 0.8f, 0.05f});
  const uint32_t drawer = add(r, "drawer", BodyType::Dynamic, Box{0.3f, 0.2f, 0.3f});
  const uint32_t arm = add(r, "arm", BodyType::Dynamic, Capsule{0.12f, 0.4f});
  const uint32_t ball = add(r, "ball", BodyType::Dynamic, Sphere{0.25f});
  const Quat xToY = turn({0, 0, 1}, 1.57079633f), xToMinusY = turn({0, 0, 1}, -1.57079633f);
  r.joints = {jointOf(door, {{-3, 1, 0}, xToY}, {{-0.5, 0, 0}, xToY}, JointType::Hinge, 8),
              jointOf(drawer, {{-0.6, 0.5, 0}, {}}, {}, JointType::Slider, 1),
              jointOf(arm, {{1.5, 1.8, 0}, xToMinusY}, {{0, 0.5, 0}, xToMinusY}, JointType::D6, 0x38),
              jointOf(ball, {{3, 2.4, 0}, {}}, {}, JointType::Distance, 0x3f)};
  r.joints[0].limits[3] = {-0.5f, 1.6f};
  r.joints[0].name = "door_hinge";
  r.joints[1].limits[0] = {-0.5f, 0.8f};
  r.joints[2].coneY = 0.6f;
  r.joints[2].coneZ = 0.9f;
  r.joints[2].limits[3] = {-0.3f, 0.3f};
  r.joints[3].limits[0] = {0, 1};
  addCouplings(r);
  for (int i = 0; i <= 120; ++i) {
    RecordedFrame f;
    f.time = i / 60.0;
    const double wave = std::sin(3 * f.time);
    const Quat opened = turn({0, 1, 0}, static_cast<float>(0.5 + wave));
    const Quat leaning = turn({1, 0, 0}, static_cast<float>(0.6 * wave));
    const double fallen = std::max(0.0, f.time - 1);
    f.poses = {{},
               {Vec3d{-3, 1, 0} + rotate(opened, Vec3d{0.5, 0, 0}), opened},
               {{-0.6 + 0.7 * wave, 0.5, 0}, {}},
               {Vec3d{1.5, 1.8, 0} - rotate(leaning, Vec3d{0, 0.5, 0}), leaning},
               {{3, 1.4 - std::min(1.15, 4.9 * fallen * fallen), 0}, {}},
               {{-1, 1.5 + 0.5 * wave, -1.5}, {}},
               {{0.5, 1.5 - 0.5 * wave, -1.5}, {}}};
    const auto pull = static_cast<float>(wave);
    f.joints = {{{{20 * pull, -80, 0}, {}}, true},
                {{{0, -40, 0}, {}}, true},
                {{{0, -60, 30 * pull}, {}}, true},
                {{{0, -90, 0}, {}}, i <= 60},
                {{{0, 50, 0}, {}}, true},
                {{{}, {2, 0, 0}}, true},
                {{}, i <= 60}};
    f.residuals = {static_cast<float>(1e-4 * wave), static_cast<float>(-0.002 * wave), 0.25f, -3e-6f};
    f.limitExcessMax = 0.002 * std::max(0.0, wave - 0.8);
    f.limitExcessAngleMax = 0.01 * std::max(0.0, -wave - 0.5);
    f.jointGapMax = 1e-4 * std::fabs(wave);
    r.frames.push_back(std::move(f));
  }
  return r;
}

RecordedSoft softOfMesh(const std::string& name, const SoftMeshData& mesh) {
  RecordedSoft soft{name, mesh.isCloth()};
  soft.points.assign(mesh.points().begin(), mesh.points().end());
  soft.surface.assign(mesh.surface().begin(), mesh.surface().end());
  soft.elements = mesh.report().elements;
  soft.radius = 0.03f;
  return soft;
}

/// A cloth of 2 x 2 m that is stretched along x, by a tenth at most; a cube that is pressed flat; a box. z is up.
Recording softRun() {
  Recording r;
  r.title = "Soft";
  r.up = {0, 0, 1};
  add(r, "floor", BodyType::Static, HalfSpace{}, {{}, turn({1, 0, 0}, 1.57079633f)});
  add(r, "box", BodyType::Dynamic, Box{0.4f, 0.4f, 0.4f});
  RecordedSoft cloth = softOfMesh("<b>flag</b>", *makeClothGrid(1, 1, 20, 20));
  appendSoft(r, cloth);
  RecordedSoft cube = softOfMesh("cube", *makeTetBox({0.5f, 0.5f, 0.5f}, 4, 4, 4));
  cube.color = Color{255, 32, 32};
  appendSoft(r, cube);
  for (int i = 0; i <= 60; ++i) {
    RecordedFrame f;
    f.time = i / 60.0;
    f.poses = {{}, {{2.2, 0, 0.4 + 0.2 * f.time}, {}}};
    const double pressed = 1 - 0.25 * f.time;
    for (const Vec3 p : cloth.points)
      f.poses.push_back(
          {{p.x * (1 + 0.1 * f.time) - 2.4, double{p.z}, 1.2 + 0.2 * std::sin(3.0 * p.z + 2 * f.time)}, {}});
    for (const Vec3 p : cube.points) f.poses.push_back({{double{p.x}, double{p.y}, (0.5 + p.z) * pressed}, {}});
    r.frames.push_back(std::move(f));
  }
  return r;
}

}  // namespace
}  // namespace avbd

int main(int argc, char** argv) {
  const std::string kind = argc > 2 ? argv[2] : "pyramid";
  if (argc < 2) {
    std::cerr << "page_sample FILE.html [pyramid | pile | hostile | shapes | joints | soft]\n";
    return 2;
  }
  const avbd::Recording r = kind == "pile"      ? avbd::pileRun()
                            : kind == "hostile" ? avbd::hostile()
                            : kind == "shapes"  ? avbd::shapesRun()
                            : kind == "joints"  ? avbd::jointsRun()
                            : kind == "soft"    ? avbd::softRun()
                                                : avbd::pyramidRun();
  avbd::writePage(argv[1], r);
  return 0;
}
