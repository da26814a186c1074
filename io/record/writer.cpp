// Frames into chunks, chunks into the file, the index at its end.
#include "io/record/writer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/record/chunk.h"
#include "io/record/limits.h"
#include "io/record/reader.h"
#include "io/record/softs.h"

namespace avbd {

using namespace record;

namespace {

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& range) {
  throw std::invalid_argument("Recording." + field + " = " + value + ": " + range);
}

constexpr uint64_t kIndexHeads = 5 * 12;  // of its fields

void checkReport(const std::vector<std::pair<std::string, std::string>>& report) {
  if (report.size() > kReportMost)
    refuse("report", std::to_string(report.size()) + " lines", "must be at most " + std::to_string(kReportMost));
}

void checkJoint(const RecordedJoint& joint, const std::string& name) {
  for (const RecordedLimit& limit : joint.limits)
    if (!(limit.lower <= limit.upper))
      refuse(name + "limits", std::to_string(limit.lower) + " " + std::to_string(limit.upper), "must be a range");
  for (const float limit : {joint.coneY, joint.coneZ})
    if (!(limit > 0)) refuse(name + "cone", std::to_string(limit), "must be > 0");
}

void checkTerms(const Recording& r, const RecordedJoint& joint, const std::string& name) {
  for (const RecordedTerm& term : joint.terms) {
    if (term.joint != kNotRecorded && term.joint >= r.joints.size())
      refuse(name + "terms[].joint", std::to_string(term.joint),
             "must be below the number of joints, " + std::to_string(r.joints.size()));
    if (term.axis > JointAxis::SwingZ)
      refuse(name + "terms[].axis", std::to_string(static_cast<int>(term.axis)), "must be one of JointAxis");
  }
}

void checkHead(const Recording& r) {
  checkReport(r.report);
  const float up = length(r.up);
  if (!(up > 0) || !std::isfinite(up)) refuse("up", "zero or not finite", "must be a direction");
  const std::string range = "must be below the number of bodies, " + std::to_string(r.bodies.size());
  for (size_t i = 0; i < r.shapes.size(); ++i)
    if (r.shapes[i].body >= r.bodies.size())
      refuse("shapes[" + std::to_string(i) + "].body", std::to_string(r.shapes[i].body), range);
  for (size_t i = 0; i < r.joints.size(); ++i)
    for (const uint32_t body :
         {r.joints[i].bodyA, r.joints[i].bodyB, r.joints[i].moreBodies[0], r.joints[i].moreBodies[1]})
      if (body != kNotRecorded && body >= r.bodies.size())
        refuse("joints[" + std::to_string(i) + "].body", std::to_string(body), range);
  checkSofts(r);
  for (size_t i = 0; i < r.joints.size(); ++i) {
    const std::string name = "joints[" + std::to_string(i) + "].";
    checkJoint(r.joints[i], name);
    checkTerms(r, r.joints[i], name);
  }
}

Recording withoutFrames(const Recording& r) {
  return {r.title, r.engine, r.up, r.dt, r.bodies, r.shapes, r.joints, {}, r.report, r.softs};
}

const Recording& checked(const Recording& r) {
  checkHead(r);
  return r;
}

}  // namespace

// What a reader would refuse is not written. Content that packs too well to be told from a bomb is not packed.
std::vector<RecordWriter::Part> RecordWriter::partsOf(const Recording& r, bool compress) {
  std::vector<Part> parts;
  uint64_t raw = 0, size = kFileHeadBytes;
  bool plausible = true;
  const auto add = [&](uint32_t type, const char* name, const Bytes& content, size_t things = 0) {
    if (content.size() > kChunkMost)
      refuse(name, std::to_string(content.size()) + " bytes", "must be at most " + std::to_string(kChunkMost));
    parts.push_back({type, chunkBytes(type, content, compress)});
    raw += content.size();
    size += parts.back().chunk.size();
    plausible = plausible && raw <= headMost(size) && things <= thingsMost(size);
  };
  add(kMeta, "title", metaContent(r));
  add(kBodies, "bodies", bodiesContent(r), r.bodies.size());
  Surfaces surfaces;
  const Bytes shapes = shapesContent(r, surfaces);
  for (const Surfaces::Data& data : surfaces.all()) add(kSurfaces, "shapes[].data", surfaceContent(data));
  add(kShapes, "shapes", shapes, r.shapes.size());
  if (!r.softs.empty()) add(kSofts, "softs", softsContent(r), r.bodies.size());
  add(kJoints, "joints", jointsContent(r), r.joints.size());
  return plausible || !compress ? parts : partsOf(r, false);
}

RecordWriter::RecordWriter(const std::filesystem::path& path, const Recording& head, const RecordOptions& options)
    : RecordWriter(path, head, options, partsOf(checked(head), options.compress)) {}

RecordWriter::RecordWriter(const std::filesystem::path& path, const Recording& head, const RecordOptions& options,
                           const std::vector<Part>& parts)
    : file_(path, FileBytes::Access::Create), options_(options), head_(withoutFrames(head)) {
  append(fileHead());
  for (const Part& part : parts) write(part.type, part.chunk);
  open_ = true;
}

RecordWriter::RecordWriter(FileBytes file, Recording head, Index index, uint64_t at, const RecordOptions& options)
    : file_(std::move(file)),
      options_(options),
      head_(std::move(head)),
      index_(std::move(index)),
      at_(at),
      open_(true) {
  file_.cut(at);
  for (size_t i = 0; i < index_.offsets.size(); ++i) next_ = std::max(next_, index_.firsts[i] + index_.counts[i]);
}

RecordWriter RecordWriter::reopen(const std::filesystem::path& path, const RecordOptions& options) {
  const RecordReader reader(path);
  return {FileBytes(path, FileBytes::Access::Extend), reader.head(), reader.index(), reader.contentEnd(), options};
}

RecordWriter::~RecordWriter() {
  if (!open_ || file_.name().empty()) return;
  try {
    finish();
  } catch (const std::exception&) {
    // What was flushed stays readable; whoever wants to know calls finish().
  }
}

// All of it or nothing: what was written in part would stand in the way of what comes next.
void RecordWriter::append(const Bytes& bytes) {
  try {
    file_.append(bytes);
  } catch (const FileError&) {
    try {
      file_.cut(at_);
    } catch (const FileError&) {
      // A device has no length to cut; why it could not be written says more.
    }
    throw;
  }
  at_ += bytes.size();
}

void RecordWriter::write(uint32_t type, const Bytes& chunk) {
  const uint64_t offset = at_;
  append(chunk);
  index_.offsets.push_back(offset);
  index_.types.push_back(type);
  index_.firsts.push_back(type == kFrames ? block_.first : 0);
  index_.counts.push_back(type == kFrames ? static_cast<uint32_t>(block_.size()) : 0);
}

void RecordWriter::check(const RecordedFrame& f) const {
  const std::string name = "frames[" + std::to_string(frameCount()) + "].";
  const double last = block_.size() > 0 ? block_.times.back() : index_.times.empty() ? -INFINITY : index_.times.back();
  if (!(f.time >= last) || !std::isfinite(f.time))
    refuse(name + "time", std::to_string(f.time), "must be finite and not before the last frame");
  const size_t bodies = head_.bodies.size(), shapes = head_.shapes.size();
  const std::string range = "must be as many as the bodies, " + std::to_string(bodies);
  if (f.poses.size() != bodies) refuse(name + "poses", std::to_string(f.poses.size()), range);
  if (!f.velocities.empty() && f.velocities.size() != bodies)
    refuse(name + "velocities", std::to_string(f.velocities.size()), range);
  if (!f.joints.empty() && f.joints.size() != head_.joints.size())
    refuse(name + "joints", std::to_string(f.joints.size()),
           "must be as many as the joints, " + std::to_string(head_.joints.size()));
  if (!f.residuals.empty() && (f.joints.empty() || f.residuals.size() != residualCount(head_)))
    refuse(
        name + "residuals", std::to_string(f.residuals.size()),
        "must be as many as the joints have, " + std::to_string(residualCount(head_)) + ", where frames have joints");
  const auto checkShapes = [&](const char* list, const auto& items) {
    for (const auto& item : items)
      for (const uint32_t shape : {item.shapeA, item.shapeB})
        if (shape != kNotRecorded && shape >= shapes)
          refuse(name + list, std::to_string(shape), "must name one of the shapes, " + std::to_string(shapes));
  };
  checkShapes("contacts[].shape", f.contacts);
  checkShapes("events[].shape", f.events);
  for (const RecordedEvent& e : f.events)
    if (e.kind > RecordedEventKind::Hit)
      refuse(name + "events[].kind", std::to_string(static_cast<int>(e.kind)), "must be one of RecordedEventKind");
  const size_t bytes = FrameBlock().bytes() + FrameBlock::bytesOf(f);
  if (bytes > kChunkMost || f.events.size() > kEventsMost)
    refuse(name + "contacts and events", std::to_string(bytes) + " bytes", "must fit a chunk of 2^28, and 2^22 events");
  const uint64_t frames = frameCount() + 1, index = kIndexHeads + 8 * frames + 24 * (index_.offsets.size() + 8);
  if (frames > framesMost(at_) || index > std::min<uint64_t>(indexMost(at_), kChunkMost))
    refuse("frames", std::to_string(frames), "must not be so many in one file: their index could not be read");
}

void RecordWriter::add(const RecordedFrame& f) {
  if (!open_) throw std::logic_error("RecordWriter::add after finish");
  check(f);
  if (block_.size() > 0 &&
      (block_.hasVelocities != !f.velocities.empty() || block_.joints != f.joints.size() ||
       block_.residualsEach != f.residuals.size() || block_.bytes() + FrameBlock::bytesOf(f) > kChunkMost ||
       block_.eventKind.size() + f.events.size() > kEventsMost))
    flush();
  if (block_.size() == 0) block_.first = next_;
  block_.add(f, head_);
  if (block_.size() >= options_.framesPerChunk || block_.bytes() >= options_.bytesPerChunk) flush();
}

void RecordWriter::flush() {
  if (block_.size() == 0) return;
  write(kFrames, chunkBytes(kFrames, framesContent(block_), options_.compress));
  index_.times.insert(index_.times.end(), block_.times.begin(), block_.times.end());
  next_ = block_.first + block_.size();
  block_ = {};
}

void RecordWriter::addChunk(uint32_t type, const Bytes& content) {
  if (!open_) throw std::logic_error("RecordWriter::addChunk after finish");
  write(type, chunkBytes(type, content, options_.compress));
}

void RecordWriter::finish(const std::vector<std::pair<std::string, std::string>>& report) {
  if (!open_) return;
  checkReport(report);
  flush();
  if (!report.empty()) {
    head_.report = report;
    write(kMeta, chunkBytes(kMeta, metaContent(head_), options_.compress));
  }
  Bytes end = chunkBytes(kIndex, indexContent(index_), options_.compress);
  const Bytes footer = footerBytes({at_, index_.times.size()});
  end.insert(end.end(), footer.begin(), footer.end());
  append(end);
  open_ = false;
}

}  // namespace avbd
