// What stands in a recording, in lines for a person.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <span>

#include "io/record/chunk.h"
#include "io/record/json.h"
#include "io/record/reader.h"

namespace avbd {
namespace {

constexpr std::ptrdiff_t kJointsLine = 6;  // of the description
constexpr size_t kSoftsTold = 8;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string bodiesText(const Recording& head) {
  std::array<size_t, 3> counts{};
  for (const RecordedBody& body : head.bodies) ++counts[static_cast<size_t>(body.type)];
  return std::to_string(counts[2]) + " dynamic, " + std::to_string(counts[1]) + " kinematic, " +
         std::to_string(counts[0]) + " static";
}

std::string shapesText(const Recording& head) {
  constexpr const char* kNames[] = {"sphere", "capsule",   "box",  "half-space", "cylinder",
                                    "cone",   "ellipsoid", "hull", "mesh",       "height field"};
  std::array<size_t, std::size(kNames)> counts{};
  size_t triggers = 0;
  for (const RecordedShape& shape : head.shapes) {
    ++counts[shape.geometry.index()];
    triggers += shape.trigger;
  }
  std::string text;
  for (size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) text += (text.empty() ? "" : ", ") + std::to_string(counts[i]) + " " + kNames[i];
  if (triggers > 0) text += "; " + std::to_string(triggers) + " of them triggers";
  return text.empty() ? "none" : text;
}

std::string jointsText(const Recording& head) {
  std::map<JointType, size_t> counts;
  for (const RecordedJoint& joint : head.joints)
    if (joint.type) ++counts[*joint.type];
  std::string text = std::to_string(head.joints.size());
  const char* comma = ": ";
  for (const auto& [type, count] : counts) {
    text.append(comma).append(std::to_string(count)).append(" ").append(record::jointTypeName(type));
    comma = ", ";
  }
  return text;
}

std::string softsText(const Recording& head) {
  std::string text = std::to_string(head.softs.size());
  const char* comma = ": ";
  for (const RecordedSoft& soft : std::span(head.softs).first(std::min(kSoftsTold, head.softs.size()))) {
    text.append(comma).append(soft.name).append(soft.cloth ? " (cloth, " : " (solid, ");
    text.append(std::to_string(soft.points.size())).append(" particles, ");
    text.append(std::to_string(soft.elements)).append(soft.cloth ? " triangles)" : " tetrahedra)");
    comma = ", ";
  }
  return head.softs.size() > kSoftsTold ? text + ", ..." : text;
}

std::string framesText(const RecordingInfo& info) {
  const std::string count = std::to_string(info.frames);
  return info.frames == 0 ? count : count + ", " + number(info.firstTime) + " s to " + number(info.lastTime) + " s";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describeRecording(const std::filesystem::path& path) {
  RecordReader reader(path);
  const RecordingInfo& info = reader.info();
  const Recording& head = reader.head();
  std::vector<std::pair<std::string, std::string>> lines{
      {"recording", head.title},
      {"written by", head.engine.empty() ? "not said" : head.engine},
      {"version", std::to_string(info.versionMajor) + "." + std::to_string(info.versionMinor)},
      {"size", number(static_cast<double>(info.bytes) * 1e-6) + " MB in " + std::to_string(info.chunks) + " chunks"},
      {"bodies", bodiesText(head)},
      {"shapes", shapesText(head)},
      {"joints", jointsText(head)},
      {"frames", framesText(info)},
      {"finished", info.finished ? "yes" : "no"},
  };
  if (!head.softs.empty()) lines.insert(lines.begin() + kJointsLine + 1, {"soft bodies", softsText(head)});
  if (head.dt > 0) lines.emplace_back("step", number(head.dt) + " s");
  // The run's own report counts bodies and shapes, too.
  for (const auto& [label, value] : head.report) lines.emplace_back("run: " + label, value);
  for (const std::string& note : info.notes) lines.emplace_back("note", note);
  for (const std::string& damage : reader.verify()) lines.emplace_back("damage", damage);
  return lines;
}

bool isRecording(const std::filesystem::path& path) {
  char head[sizeof record::kMagic] = {};
  std::ifstream in(path, std::ios::binary);
  in.read(head, sizeof head);
  return in.gcount() == sizeof head && std::memcmp(head, record::kMagic, sizeof head) == 0;
}

}  // namespace avbd
