// Heads, sums and compression.
#include "io/record/chunk.h"

#include <algorithm>
#include <cstring>

#ifdef AVBD_ZSTD
#include <zstd.h>
#endif

#include "io/file_error.h"
#include "io/record/crc.h"

namespace avbd::record {
namespace {

constexpr uint8_t kSync[4] = {'C', 'H', 'N', 'K'};
constexpr uint8_t kEnd[8] = {'A', 'V', 'B', 'D', 'E', 'N', 'D', '\n'};

}  // namespace

bool hasZstd() {
#ifdef AVBD_ZSTD
  return true;
#else
  return false;
#endif
}

Bytes zstdBytes(std::span<const uint8_t> content) {
#ifdef AVBD_ZSTD
  constexpr int kLevel = 3;
  Bytes packed(ZSTD_compressBound(content.size()));
  const size_t size = ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), kLevel);
  packed.resize(ZSTD_isError(size) ? 0 : size);
  return packed;
#else
  (void)content;
  return {};
#endif
}

std::string typeName(uint32_t type) {
  std::string name;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(type >> (8 * i) & 0xff);
    name += c > ' ' && c < 127 ? c : '?';
  }
  return name;
}

Bytes fileHead() {
  Bytes out(std::begin(kMagic), std::end(kMagic));
  put(out, kMajor);
  put(out, kMinor);
  put(out, crc32c(out));
  return out;
}

void checkFileHead(std::span<const uint8_t> bytes, const std::string& file) {
  const size_t magic = std::min(bytes.size(), sizeof kMagic);
  if (bytes.empty()) throw FileError(file + ": is empty, no AVBD recording", file);
  if (std::memcmp(bytes.data(), kMagic, magic) != 0) throw FileError(file + ": is no AVBD recording", file);
  if (bytes.size() < kFileHeadBytes) throw FileError(file + ": is cut off within its first 16 bytes", file);
  if (take<uint32_t>(bytes, 12) != crc32c(bytes.first(12)))
    throw FileError(file + ": the file's head is damaged: its checksum does not fit", file);
  const auto major = take<uint16_t>(bytes, 8);
  if (major != kMajor)
    throw FileError(file + ": is of version " + std::to_string(major) + "." + std::to_string(minorOf(bytes)) +
                        "; this program reads version " + std::to_string(kMajor),
                    file);
}

uint16_t minorOf(std::span<const uint8_t> head) { return take<uint16_t>(head, 10); }

Bytes chunkBytes(uint32_t type, std::span<const uint8_t> content, bool compress) {
  std::span<const uint8_t> stored = content;
  Codec codec = Codec::None;
  Bytes packed;
  if (compress) packed = zstdBytes(content);
  if (!packed.empty() && packed.size() < content.size()) {
    stored = packed;
    codec = Codec::Zstd;
  }
  Bytes out(std::begin(kSync), std::end(kSync));
  put(out, type);
  put(out, static_cast<uint8_t>(codec));
  put(out, uint8_t{0});
  put(out, uint16_t{0});
  put(out, static_cast<uint32_t>(stored.size()));
  put(out, static_cast<uint32_t>(content.size()));
  put(out, crc32c(stored));
  put(out, crc32c(out));
  out.insert(out.end(), stored.begin(), stored.end());
  return out;
}

std::optional<ChunkHead> chunkHead(std::span<const uint8_t> bytes) {
  if (bytes.size() < kChunkHeadBytes || std::memcmp(bytes.data(), kSync, sizeof kSync) != 0) return {};
  if (take<uint32_t>(bytes, 24) != crc32c(bytes.first(24))) return {};
  return ChunkHead{take<uint32_t>(bytes, 4), bytes[8], take<uint32_t>(bytes, 12), take<uint32_t>(bytes, 16),
                   take<uint32_t>(bytes, 20)};
}

Bytes unpack(const ChunkHead& head, std::span<const uint8_t> stored, const std::string& place) {
  if (crc32c(stored) != head.sum) throw FileError(place + " is damaged: its checksum does not fit");
  if (head.raw > kChunkMost) throw FileError(place + " claims " + std::to_string(head.raw) + " bytes, too many");
  if (head.codec == static_cast<uint8_t>(Codec::None)) {
    if (head.raw != stored.size()) throw FileError(place + ": its two sizes differ");
    return {stored.begin(), stored.end()};
  }
  if (head.codec != static_cast<uint8_t>(Codec::Zstd))
    throw FileError(place + " is packed by method " + std::to_string(head.codec) + ", which is not known here");
#ifdef AVBD_ZSTD
  if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != head.raw)
    throw FileError(place + " cannot be unpacked: another size than its head says");
  Bytes out(head.raw);
  const size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
  if (ZSTD_isError(size) || size != head.raw)
    throw FileError(place + " cannot be unpacked: " + (ZSTD_isError(size) ? ZSTD_getErrorName(size) : "too short"));
  return out;
#else
  throw FileError(place + " is packed with zstd, which this program was built without");
#endif
}

Bytes footerBytes(const Footer& footer) {
  Bytes out;
  put(out, footer.index);
  put(out, footer.frames);
  put(out, uint32_t{0});
  put(out, crc32c(out));
  out.insert(out.end(), std::begin(kEnd), std::end(kEnd));
  return out;
}

std::optional<Footer> footerOf(std::span<const uint8_t> bytes) {
  if (bytes.size() != kFooterBytes || std::memcmp(bytes.data() + 24, kEnd, sizeof kEnd) != 0) return {};
  if (take<uint32_t>(bytes, 20) != crc32c(bytes.first(20))) return {};
  return Footer{take<uint64_t>(bytes, 0), take<uint64_t>(bytes, 8)};
}

}  // namespace avbd::record
