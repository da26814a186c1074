// MCAP as its specification says (mcap.dev/spec, version 0): records of opcode, length and content; messages in chunks
// with their indexes; a summary that repeats what a reader needs first.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "io/record/chunk.h"
#include "io/record/crc.h"
#include "io/record/export.h"
#include "io/record/mcap_messages.h"

namespace avbd {

using namespace record;

namespace {

constexpr uint8_t kMcapMagic[8] = {0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'};
constexpr size_t kMcapChunk = 1u << 20;

enum Opcode : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

void putText(Bytes& out, std::string_view text) {
  put(out, static_cast<uint32_t>(text.size()));
  out.insert(out.end(), text.begin(), text.end());
}

void putRecord(Bytes& out, Opcode opcode, const Bytes& content) {
  put(out, static_cast<uint8_t>(opcode));
  put(out, static_cast<uint64_t>(content.size()));
  out.insert(out.end(), content.begin(), content.end());
}

Bytes schemaContent(uint16_t id, const McapTopic& topic) {
  Bytes out;
  put(out, id);
  putText(out, topic.schemaName);
  putText(out, "jsonschema");
  putText(out, topic.schema);
  return out;
}

Bytes channelContent(uint16_t id, const McapTopic& topic) {
  Bytes out;
  put(out, id);
  put(out, id);  // its schema has the same number
  putText(out, topic.name);
  putText(out, "json");
  put(out, uint32_t{0});  // no metadata
  return out;
}

struct ChunkFacts {
  uint64_t start = 0, end = 0, offset = 0, length = 0, indexLength = 0, compressed = 0, raw = 0;
  std::map<uint16_t, uint64_t> indexOffsets;
  std::string compression;
};

class McapFile {
 public:
  McapFile(std::ostream& out, bool compress) : out_(out), compress_(compress) {
    emit(Bytes(std::begin(kMcapMagic), std::end(kMcapMagic)));
    Bytes header, record;
    putText(header, "");
    putText(header, "avbd");
    putRecord(record, kHeader, header);
    emit(record);
  }

  void message(uint16_t channel, uint64_t time, std::string_view json) {
    if (indexes_.empty()) facts_.start = time;
    if (seen_.insert(channel).second) {
      // A channel's first message follows its schema and itself.
      putRecord(chunk_, kSchema, schemaContent(channel, mcapTopics()[channel - 1u]));
      putRecord(chunk_, kChannel, channelContent(channel, mcapTopics()[channel - 1u]));
    }
    facts_.end = time;
    indexes_[channel].emplace_back(time, chunk_.size());
    Bytes content;
    put(content, channel);
    put(content, static_cast<uint32_t>(counts_[channel]++));
    put(content, time);
    put(content, time);
    content.insert(content.end(), json.begin(), json.end());
    putRecord(chunk_, kMessage, content);
    if (chunk_.size() >= kMcapChunk) flush();
  }

  void finish() {
    flush();
    Bytes record;
    Bytes end;
    put(end, uint32_t{0});  // no sum over the data
    putRecord(record, kDataEnd, end);
    emit(record);
    writeSummary();
  }

 private:
  void emit(const Bytes& bytes) {
    out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
  }

  void flush() {
    if (chunk_.empty()) return;
    const Bytes packed = compress_ ? zstdBytes(chunk_) : Bytes();
    facts_.compression = packed.empty() ? "" : "zstd";
    const Bytes& stored = packed.empty() ? chunk_ : packed;
    facts_.raw = chunk_.size();
    facts_.compressed = stored.size();
    Bytes content, record;
    put(content, facts_.start);
    put(content, facts_.end);
    put(content, facts_.raw);
    put(content, crc32(chunk_, Polynomial::Ieee));
    putText(content, facts_.compression);
    put(content, static_cast<uint64_t>(stored.size()));
    content.insert(content.end(), stored.begin(), stored.end());
    putRecord(record, kChunk, content);
    facts_.offset = at_;
    facts_.length = record.size();
    emit(record);
    const uint64_t indexStart = at_;
    for (const auto& [channel, entries] : indexes_) {
      Bytes index, indexRecord;
      put(index, channel);
      put(index, static_cast<uint32_t>(16 * entries.size()));
      for (const auto& [time, offset] : entries) {
        put(index, time);
        put(index, static_cast<uint64_t>(offset));
      }
      facts_.indexOffsets[channel] = at_;
      putRecord(indexRecord, kMessageIndex, index);
      emit(indexRecord);
    }
    facts_.indexLength = at_ - indexStart;
    chunks_.push_back(facts_);
    facts_ = {};
    indexes_.clear();
    chunk_.clear();
  }

  Bytes chunkIndexContent(const ChunkFacts& c) const {
    Bytes out;
    put(out, c.start);
    put(out, c.end);
    put(out, c.offset);
    put(out, c.length);
    put(out, static_cast<uint32_t>(10 * c.indexOffsets.size()));
    for (const auto& [channel, offset] : c.indexOffsets) {
      put(out, channel);
      put(out, offset);
    }
    put(out, c.indexLength);
    putText(out, c.compression);
    put(out, c.compressed);
    put(out, c.raw);
    return out;
  }

  Bytes statisticsContent() const {
    uint64_t messages = 0, start = 0, end = 0;
    for (const auto& [channel, count] : counts_) messages += count;
    for (size_t i = 0; i < chunks_.size(); ++i) {
      start = i == 0 ? chunks_[i].start : std::min(start, chunks_[i].start);
      end = std::max(end, chunks_[i].end);
    }
    Bytes out;
    put(out, messages);
    put(out, static_cast<uint16_t>(seen_.size()));
    put(out, static_cast<uint32_t>(seen_.size()));
    put(out, uint32_t{0});
    put(out, uint32_t{0});
    put(out, static_cast<uint32_t>(chunks_.size()));
    put(out, start);
    put(out, end);
    put(out, static_cast<uint32_t>(10 * counts_.size()));
    for (const auto& [channel, count] : counts_) {
      put(out, channel);
      put(out, count);
    }
    return out;
  }

  // Groups of equal records, then where each group begins, then the footer with a sum over all of it.
  void writeSummary() {
    const uint64_t start = at_;
    Bytes summary, offsets;
    const auto group = [&](Opcode opcode, const auto& fill) {
      const size_t begin = summary.size();
      fill();
      if (summary.size() == begin) return;
      Bytes content;
      put(content, static_cast<uint8_t>(opcode));
      put(content, start + begin);
      put(content, static_cast<uint64_t>(summary.size() - begin));
      putRecord(offsets, kSummaryOffset, content);
    };
    group(kSchema, [&] {
      for (const uint16_t id : seen_) putRecord(summary, kSchema, schemaContent(id, mcapTopics()[id - 1u]));
    });
    group(kChannel, [&] {
      for (const uint16_t id : seen_) putRecord(summary, kChannel, channelContent(id, mcapTopics()[id - 1u]));
    });
    group(kStatistics, [&] { putRecord(summary, kStatistics, statisticsContent()); });
    group(kChunkIndex, [&] {
      for (const ChunkFacts& c : chunks_) putRecord(summary, kChunkIndex, chunkIndexContent(c));
    });
    const uint64_t offsetStart = start + summary.size();
    summary.insert(summary.end(), offsets.begin(), offsets.end());
    put(summary, static_cast<uint8_t>(kFooter));
    put(summary, uint64_t{20});
    put(summary, start);
    put(summary, offsetStart);
    put(summary, crc32(summary, Polynomial::Ieee));
    summary.insert(summary.end(), std::begin(kMcapMagic), std::end(kMcapMagic));
    emit(summary);
  }

  std::ostream& out_;
  bool compress_;
  uint64_t at_ = 0;
  Bytes chunk_;
  ChunkFacts facts_;
  std::map<uint16_t, std::vector<std::pair<uint64_t, size_t>>> indexes_;  // of the chunk: time, offset
  std::map<uint16_t, uint64_t> counts_;
  std::set<uint16_t> seen_;
  std::vector<ChunkFacts> chunks_;
};

}  // namespace

std::vector<std::string> exportMcap(RecordReader& reader, std::ostream& out, const McapOptions& options) {
  McapFile file(out, options.compress);
  const McapMessages messages(reader.head());
  bool first = true, touching = false;
  std::vector<std::string> leftOut = eachFrame(reader, [&](const RecordedFrame& f) {
    const auto time = static_cast<uint64_t>(std::llround(std::clamp(f.time, 0.0, 9e9) * 1e9));
    if (first) file.message(kMcapScene, time, messages.scene(time));
    first = false;
    if (!reader.head().softs.empty()) file.message(kMcapScene, time, messages.softs(f, time));
    file.message(kMcapTransforms, time, messages.transforms(f, time));
    file.message(kMcapFigures, time, messages.figures(f));
    // What is shown is the last message: an empty one takes contacts off that have ended.
    if (touching || !f.contacts.empty()) file.message(kMcapContacts, time, messages.contacts(f));
    touching = !f.contacts.empty();
    if (!f.events.empty()) file.message(kMcapEvents, time, messages.events(f));
    return static_cast<bool>(out);
  });
  file.finish();
  return leftOut;
}

}  // namespace avbd
