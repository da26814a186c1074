// Recordings: refused by FileError, or one in which every frame fits the bodies or is refused by its chunk.
//
// The first byte says what is done with the rest. Checksums would stop nearly every change, so they can be made right
// again: of a file as it is, or of a list of chunks' contents without any heads at all.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "fuzz/check.h"
#include "io/record/chunk.h"
#include "io/record/content.h"
#include "io/record/crc.h"
#include "io/record/reader.h"
#include "io/record/softs.h"

namespace avbd::fuzz {
namespace {

using record::Bytes;

/// A file without a folder.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("fuzz", 0)) { require(file_ >= 0, "no memory for a file"); }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }
  void fill(std::span<const uint8_t> bytes) const {
    require(ftruncate(file_, 0) == 0, "no file");
    require(pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()), "no file");
  }

 private:
  int file_;
};

void putSum(Bytes& file, size_t from, size_t length) {
  const uint32_t sum = record::crc32c(std::span(file).subspan(from, length));
  std::memcpy(file.data() + from + length, &sum, sizeof sum);
}

/// All checksums right, as far as the chunks' own lengths lead.
void seal(Bytes& file) {
  using namespace record;
  if (file.size() >= kFileHeadBytes) putSum(file, 0, 12);
  size_t at = kFileHeadBytes;
  while (at + kChunkHeadBytes <= file.size()) {
    const size_t stored = take<uint32_t>(file, at + 12), begin = at + kChunkHeadBytes;
    if (std::memcmp(file.data() + at, "CHNK", 4) != 0 || stored > file.size() - begin) break;
    const uint32_t sum = crc32c(std::span(file).subspan(begin, stored));
    std::memcpy(file.data() + at + 20, &sum, sizeof sum);
    putSum(file, at, 24);
    at = begin + stored;
  }
  if (file.size() >= at + kFooterBytes) putSum(file, file.size() - kFooterBytes, 20);
}

/// Chunks of contents: a byte for the type, two for the length. Packed where `compress` says so; with an index if the
/// input holds one.
Bytes chunksOf(std::span<const uint8_t> in, bool compress) {
  using namespace record;
  static constexpr uint32_t kTypes[] = {kMeta, kBodies, kSurfaces, kShapes, kJoints, kFrames, kFrames, kSofts};
  Bytes file = fileHead();
  while (in.size() >= 3) {
    const size_t length = std::min<size_t>(take<uint16_t>(in, 1), in.size() - 3);
    const Bytes chunk = chunkBytes(kTypes[in[0] % 8], in.subspan(3, length), compress);
    file.insert(file.end(), chunk.begin(), chunk.end());
    in = in.subspan(3 + length);
  }
  return file;
}

void checkFrame(const RecordedFrame& frame, const Recording& head) {
  require(frame.poses.size() == head.bodies.size(), "poses that do not fit the bodies");
  require(frame.velocities.empty() || frame.velocities.size() == head.bodies.size(), "velocities that do not fit");
  require(frame.joints.empty() || frame.joints.size() == head.joints.size(), "what joints did that there are not");
  const auto fits = [&](uint32_t shape) { return shape == kNotRecorded || shape < head.shapes.size(); };
  require(frame.residuals.empty() || frame.residuals.size() == residualCount(head), "residuals of no joint");
  for (const RecordedContact& c : frame.contacts)
    require(fits(c.shapeA) && fits(c.shapeB), "a contact of a shape that there is not");
  for (const RecordedEvent& e : frame.events) {
    require(fits(e.shapeA) && fits(e.shapeB), "an event of a shape that there is not");
    require(e.kind <= RecordedEventKind::Hit, "an event of no kind");
  }
}

void checkHead(const Recording& head) {
  checkSofts(head);  // what it throws nobody catches
  for (const RecordedShape& s : head.shapes) {
    require(s.body < head.bodies.size(), "a shape of a body that there is not");
    if (const auto* hull = std::get_if<Hull>(&s.geometry)) require(hull->data != nullptr, "a hull without data");
    if (const auto* mesh = std::get_if<Mesh>(&s.geometry)) require(mesh->data != nullptr, "a mesh without data");
    if (const auto* f = std::get_if<HeightField>(&s.geometry)) require(f->data != nullptr, "a field without data");
  }
  for (const RecordedJoint& j : head.joints)
    for (const uint32_t body : {j.bodyA, j.bodyB, j.moreBodies[0], j.moreBodies[1]})
      require(body == kNotRecorded || body < head.bodies.size(), "a joint of a body that there is not");
  for (const RecordedJoint& j : head.joints) {
    for (const RecordedLimit& limit : j.limits) require(limit.lower <= limit.upper, "a limit that is no range");
    require(j.coneY > 0 && j.coneZ > 0, "a cone that is none");
    require(!j.type || *j.type <= JointType::Custom, "a joint of no type");
    for (const RecordedTerm& term : j.terms) {
      require(term.joint == kNotRecorded || term.joint < head.joints.size(), "a term of a joint that there is not");
      require(term.axis <= JointAxis::SwingZ, "a term of no coordinate");
    }
  }
}

/// Returns whether every frame could be read.
bool readFrames(RecordReader& reader) {
  constexpr uint64_t kMostFrames = 500;
  bool all = true;
  double last = -INFINITY;
  for (uint64_t i = 0; i < std::min(reader.frameCount(), kMostFrames); ++i) {
    require(std::isfinite(reader.times()[i]) && reader.times()[i] >= last, "times that do not ascend");
    last = reader.times()[i];
    try {
      checkFrame(reader.frame(i), reader.head());
    } catch (const FileError&) {
      all = false;
    }
  }
  return all;
}

void readInput(const Bytes& bytes, const MemoryFile& file) {
  try {
    file.fill(bytes);
    RecordReader reader(file.path());
    require(reader.info().frames == reader.frameCount(), "frames that are not counted");
    require(reader.frameAt(0) == 0 || reader.frameAt(0) < reader.frameCount(), "a frame beyond the last");
    checkHead(reader.head());
    const bool all = readFrames(reader);
    const bool sound = reader.verify().empty();
    require(all || !sound, "verify() finds nothing, but a frame cannot be read");
    const uint64_t before = reader.frameCount();
    require(!reader.refresh() && reader.frameCount() == before, "frames came of nothing");
    file.fill(std::span(bytes).first(bytes.size() / 2));
    reader.refresh();
    checkHead(reader.head());
    readFrames(reader);
    file.fill(bytes);
    reader.refresh();
    checkHead(reader.head());
    readFrames(reader);
  } catch (const FileError&) {
  }
}

}  // namespace
}  // namespace avbd::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace avbd::fuzz;
  static const MemoryFile file;
  if (size == 0) return 0;
  const std::span<const uint8_t> rest(data + 1, size - 1);
  Bytes bytes(rest.begin(), rest.end());
  if (data[0] % 4 == 1) seal(bytes);
  if (data[0] % 4 >= 2) bytes = chunksOf(rest, data[0] % 4 == 3);
  readInput(bytes, file);
  return 0;
}
