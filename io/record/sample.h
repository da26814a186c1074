// For tests: a small recording with something of everything, and files that vanish.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "io/record/recording.h"

namespace avbd::record {

/// Numbers that look like chance and are the same everywhere.
class Chance {
 public:
  /// In -1 .. 1.
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) / static_cast<double>(1ull << 52) - 1;
  }
  float real() { return static_cast<float>(next()); }
  Vec3 vector() { return {real(), real(), real()}; }

 private:
  uint64_t state_ = 1;
};

/// One of which everything is known, one of which only the anchors are.
inline std::vector<RecordedJoint> sampleJoints() {
  RecordedJoint known{0, 1, {{1, 2, 3}, {0.6f, 0, 0.8f, 0}}, {{4, 5, 6}, {0, 0, 0, 1}}, JointType::D6, "hip, \"x\""};
  known.freeAxes = 0x39;
  known.limits[0] = {-0.25f, 0.5f};
  known.limits[3].upper = 7;
  known.coneY = 0.5f;
  return {known, {kNotRecorded, 1, {{1e6, 0, 0}, {}}, {{0, 0, 0.1}, {}}}};
}

/// A pulley, a coupling of the hip with what is not recorded, and a custom joint of two rows and three bodies.
inline std::vector<RecordedJoint> sampleLinks() {
  RecordedJoint pulley{0, 1, {{0, 1, 0}, {}}, {{0, 0, 2}, {}}, JointType::Pulley, "hoist"};
  pulley.wheels = {{{1e6, 2, 3}, {1e6, 5, 6}}};
  pulley.ratio = 2.5f;
  pulley.limits[0] = {0, 7};
  pulley.residuals = 1;
  RecordedJoint coupling{kNotRecorded, kNotRecorded, {}, {}, JointType::Coupling};
  coupling.terms = {{0, JointAxis::SwingZ, {1, 0.5f, 0, -2}}, {kNotRecorded, JointAxis::LinearY, {0, 0, 3, 0}}};
  coupling.rest = 0.1;
  coupling.residuals = 1;
  RecordedJoint custom{1, kNotRecorded, {}, {}, JointType::Custom};
  custom.family = "screw, \"left\"";
  custom.moreBodies = {2, kNotRecorded};
  custom.residuals = 2;
  return {pulley, coupling, custom};
}

inline Recording sampleHead(size_t bodies = 3) {
  Recording r;
  r.title = "sample \"ä\" \n";
  r.engine = "avbd test";
  r.up = {0, 0, 1};
  r.dt = 0.01;
  const Geometry kinds[] = {Sphere{0.25f},           Box{0.1f, 0.2f, 0.3f, 0.05f}, HalfSpace{},
                            Capsule{0.1f, 0.4f},     Cylinder{0.5f, 0.25f, 0.01f}, Cone{0.5f, 0.75f, 0.02f},
                            Ellipsoid{0.1f, 0.2f, 1}};
  for (size_t i = 0; i < bodies; ++i) {
    r.bodies.push_back({i == 0 ? "" : "body, " + std::to_string(i), i == 0 ? BodyType::Static : BodyType::Dynamic});
    r.shapes.push_back(
        {static_cast<uint32_t>(i), kinds[i % 7], {{0.1 * static_cast<double>(i), 0, 1e9}, {0, 1, 0, 0}}, i % 2 == 1});
  }
  if (bodies > 2) r.shapes[1].color = Color{12, 200, 255, 128};
  if (bodies > 1) r.joints = sampleJoints();
  return r;
}

inline RecordedFrame sampleFrame(const Recording& head, size_t number, bool velocities = true) {
  Chance chance;
  for (size_t i = 0; i < number; ++i) chance.next();
  RecordedFrame f;
  f.time = static_cast<double>(number) / 60;
  for (size_t i = 0; i < head.bodies.size(); ++i) {
    const Vec3d p{1e6 + chance.next(), chance.next(), chance.next()};
    f.poses.push_back(i == 0 ? Pose{} : Pose{p, {chance.real(), chance.real(), chance.real(), chance.real()}});
    if (velocities) f.velocities.push_back(i == 0 ? Velocity{} : Velocity{chance.vector(), chance.vector()});
  }
  for (size_t i = 0; i < number % 3 && head.shapes.size() > 1; ++i)
    f.contacts.push_back({f.poses[1].position + chance.vector(), chance.vector(), {0, 1, 0}, -0.01f, 1, 0});
  f.contactsLeftOut = static_cast<uint32_t>(number % 4);
  if (number % 2 == 1) f.events.push_back({RecordedEventKind::Hit, 0, 1, {1e6, 2, 3}, {0, 0, 1}, 3.5f, 0.25f});
  if (number % 4 == 3) f.events.push_back({RecordedEventKind::TouchEnd, 1, 0, {7, 8, 9}, {0, -1, 0}, 0, 0.75f});
  f.kineticEnergy = chance.next();
  f.penetrationMax = 1e-3;
  f.jointGapMax = 1e-6 * static_cast<double>(number);
  if (number % 16 == 15) return f;  // of joints nothing is known
  f.limitExcessMax = 1e-3 * static_cast<double>(number);
  f.limitExcessAngleMax = 0.25;
  for (size_t i = 0; i < head.joints.size(); ++i)
    f.joints.push_back({{{static_cast<float>(number), 1, -2}, {0, 0, 3}}, (number + i) % 3 != 0});
  for (size_t i = 0; i < residualCount(head); ++i) f.residuals.push_back(1e-3f * static_cast<float>(number + i));
  return f;
}

/// Removed with all that is in it.
class Folder {
 public:
  Folder() {
    std::string pattern = ((std::filesystem::is_directory("/dev/shm") ? std::filesystem::path("/dev/shm")
                                                                      : std::filesystem::temp_directory_path()) /
                           "avbd_record_XXXXXX")
                              .string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }
  static std::string read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path path_;
};

}  // namespace avbd::record
