// Meta, bodies and the index.
#include "io/record/content.h"

#include <cmath>

#include "io/file_error.h"
#include "io/record/chunk.h"
#include "io/record/limits.h"
#include "io/record/softs.h"

namespace avbd::record {
namespace {

enum MetaField : uint16_t { kTitle = 1, kEngine = 2, kUp = 3, kDt = 4, kLabels = 10, kValues = 12 };
enum BodyField : uint16_t { kNames = 1, kTypes = 3 };
enum IndexField : uint16_t { kOffsets = 1, kChunkTypes = 2, kFirsts = 3, kCounts = 4, kTimes = 5 };

}  // namespace

Bytes metaContent(const Recording& r) {
  FieldWriter out;
  out.text(kTitle, r.title);
  out.text(kEngine, r.engine);
  out.list(kUp, std::vector<float>{r.up.x, r.up.y, r.up.z});
  out.value(kDt, r.dt);
  std::vector<std::string> labels, values;
  for (const auto& [label, value] : r.report) {
    labels.push_back(label);
    values.push_back(value);
  }
  out.texts(kLabels, labels);
  out.texts(kValues, values);
  return out.bytes();
}

Bytes bodiesContent(const Recording& r) {
  FieldWriter out;
  std::vector<std::string> names;
  std::vector<uint8_t> types;
  for (const RecordedBody& body : std::span(r.bodies).first(solidBodies(r))) {
    names.push_back(body.name);
    types.push_back(static_cast<uint8_t>(body.type));
  }
  out.texts(kNames, names);
  out.list(kTypes, types);
  return out.bytes();
}

bool HeadReader::take(uint32_t type, const FieldReader& fields) {
  if (type == kMeta)
    takeMeta(fields);
  else if (type == kBodies)
    takeBodies(fields);
  else if (type == kSurfaces)
    takeSurface(fields);
  else if (type == kShapes)
    takeShapes(fields);
  else if (type == kJoints)
    takeJoints(fields);
  else if (type == kSofts)
    takeSofts(fields);
  else
    return false;
  return true;
}

// A later one replaces what it says anew.
void HeadReader::takeMeta(const FieldReader& f) {
  if (f.has(kTitle)) recording.title = f.text(kTitle);
  if (f.has(kEngine)) recording.engine = f.text(kEngine);
  recording.dt = f.value(kDt, recording.dt);
  if (f.has(kUp)) {
    const std::vector<float> up = f.listOf<float>(kUp, 3);
    const Vec3 v{up[0], up[1], up[2]};
    if (!(length(v) > 0) || !std::isfinite(length(v))) f.refuse(kUp, "is no direction");
    recording.up = v;
  }
  const std::vector<std::string> labels = f.texts(kLabels, kReportMost), values = f.texts(kValues, kReportMost);
  if (labels.size() != values.size()) f.refuse(kLabels, "does not fit the values");
  if (labels.empty()) return;
  recording.report.clear();
  for (size_t i = 0; i < labels.size(); ++i) recording.report.emplace_back(labels[i], values[i]);
}

void HeadReader::refuseMore(const FieldReader& f, uint16_t id, size_t held) const {
  if (held + f.count(id) > thingsMost) f.refuse(id, "has more elements than a file of this size may hold");
}

void HeadReader::takeBodies(const FieldReader& f) {
  refuseMore(f, kNames, recording.bodies.size());
  if (!recording.softs.empty()) f.refuse(kNames, "adds bodies behind soft bodies");
  const std::vector<std::string> names = f.texts(kNames);
  const std::vector<uint8_t> types = f.listOf<uint8_t>(kTypes, names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    const uint8_t type = types.empty() ? static_cast<uint8_t>(BodyType::Dynamic) : types[i];
    if (type > static_cast<uint8_t>(BodyType::Dynamic)) f.refuse(kTypes, "names a type of body that there is not");
    recording.bodies.push_back({names[i], static_cast<BodyType>(type)});
  }
}

Bytes indexContent(const Index& index) {
  FieldWriter out;
  out.list(kOffsets, index.offsets, Encoding::Line, 1);
  out.list(kChunkTypes, index.types, Encoding::Delta, 1);
  out.list(kFirsts, index.firsts, Encoding::Line, 1);
  out.list(kCounts, index.counts, Encoding::Delta, 1);
  out.list(kTimes, index.times, Encoding::Line, 1);
  return out.bytes();
}

Index indexOf(const FieldReader& f) {
  Index index;
  index.offsets = f.list<uint64_t>(kOffsets);
  const size_t count = index.offsets.size();
  index.types = f.listOf<uint32_t>(kChunkTypes, count);
  index.firsts = f.listOf<uint64_t>(kFirsts, count);
  index.counts = f.listOf<uint32_t>(kCounts, count);
  index.times = f.list<double>(kTimes);
  if (index.types.size() != count || index.firsts.size() != count || index.counts.size() != count)
    f.refuse(kOffsets, "stands alone");
  uint64_t frames = 0;
  for (size_t i = 0; i < count; ++i) frames += index.counts[i];
  if (frames != index.times.size()) f.refuse(kTimes, "does not fit the number of frames");
  return index;
}

}  // namespace avbd::record
