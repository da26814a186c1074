// Frames into chunks, chunks into the file, the index at its end.
#include "io/record/writer.h"

#include <cmath>
#include <stdexcept>

#include "io/record/chunk.h"
#include "io/record/reader.h"

namespace avbd {

using namespace record;

namespace {

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& range) {
  throw std::invalid_argument("Recording." + field + " = " + value + ": " + range);
}

void checkHead(const Recording& r) {
  const float up = length(r.up);
  if (!(up > 0) || !std::isfinite(up)) refuse("up", "zero or not finite", "must be a direction");
  const std::string range = "must be below the number of bodies, " + std::to_string(r.bodies.size());
  for (size_t i = 0; i < r.shapes.size(); ++i)
    if (r.shapes[i].body >= r.bodies.size())
      refuse("shapes[" + std::to_string(i) + "].body", std::to_string(r.shapes[i].body), range);
  for (size_t i = 0; i < r.joints.size(); ++i)
    for (const uint32_t body : {r.joints[i].bodyA, r.joints[i].bodyB})
      if (body != kNotRecorded && body >= r.bodies.size())
        refuse("joints[" + std::to_string(i) + "].body", std::to_string(body), range);
}

Recording withoutFrames(const Recording& r) {
  return {r.title, r.engine, r.up, r.dt, r.bodies, r.shapes, r.joints, {}, r.report};
}

const Recording& checked(const Recording& r) {
  checkHead(r);
  return r;
}

}  // namespace

RecordWriter::RecordWriter(const std::filesystem::path& path, const Recording& head, const RecordOptions& options)
    : file_((checked(head), path), FileBytes::Access::Create), options_(options), head_(withoutFrames(head)) {
  open_ = true;
  file_.append(fileHead());
  at_ = kFileHeadBytes;
  write(kMeta, metaContent(head_));
  write(kBodies, bodiesContent(head_));
  Surfaces surfaces;
  const Bytes shapes = shapesContent(head_, surfaces);
  for (const Surfaces::Data& data : surfaces.all()) write(kSurfaces, surfaceContent(data));
  write(kShapes, shapes);
  write(kJoints, jointsContent(head_));
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

void RecordWriter::write(uint32_t type, const Bytes& content) {
  const Bytes bytes = chunkBytes(type, content, options_.compress);
  file_.append(bytes);
  if (type != kIndex) {
    index_.offsets.push_back(at_);
    index_.types.push_back(type);
    index_.firsts.push_back(type == kFrames ? block_.first : 0);
    index_.counts.push_back(type == kFrames ? static_cast<uint32_t>(block_.size()) : 0);
  }
  at_ += bytes.size();
}

void RecordWriter::add(const RecordedFrame& f) {
  const std::string name = "frames[" + std::to_string(frameCount()) + "].";
  if (!open_) throw std::logic_error("RecordWriter::add after finish");
  const double last = block_.size() > 0 ? block_.times.back() : index_.times.empty() ? -INFINITY : index_.times.back();
  if (!(f.time >= last) || !std::isfinite(f.time))
    refuse(name + "time", std::to_string(f.time), "must be finite and not before the last frame");
  const size_t bodies = head_.bodies.size();
  const std::string range = "must be as many as the bodies, " + std::to_string(bodies);
  if (f.poses.size() != bodies) refuse(name + "poses", std::to_string(f.poses.size()), range);
  if (!f.velocities.empty() && f.velocities.size() != bodies)
    refuse(name + "velocities", std::to_string(f.velocities.size()), range);
  if (block_.size() > 0 && block_.hasVelocities != !f.velocities.empty()) flush();
  if (block_.size() == 0) block_.first = next_;
  block_.add(f, head_);
  if (block_.size() >= options_.framesPerChunk || block_.bytes() >= options_.bytesPerChunk) flush();
}

void RecordWriter::flush() {
  if (block_.size() == 0) return;
  write(kFrames, framesContent(block_));
  index_.times.insert(index_.times.end(), block_.times.begin(), block_.times.end());
  next_ = block_.first + block_.size();
  block_ = {};
}

void RecordWriter::finish(const std::vector<std::pair<std::string, std::string>>& report) {
  if (!open_) return;
  flush();
  if (!report.empty()) {
    head_.report = report;
    write(kMeta, metaContent(head_));
  }
  const uint64_t index = at_;
  write(kIndex, indexContent(index_));
  file_.append(footerBytes({index, index_.times.size()}));
  open_ = false;
}

}  // namespace avbd
