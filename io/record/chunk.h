// Chunks: the blocks that a recording file is made of, each complete in itself and with its own checksums.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/record/fields.h"

namespace avbd::record {

/// Four letters, the first one lowest.
constexpr uint32_t typeOf(const char (&name)[5]) {
  return static_cast<uint32_t>(name[0]) | static_cast<uint32_t>(name[1]) << 8 | static_cast<uint32_t>(name[2]) << 16 |
         static_cast<uint32_t>(name[3]) << 24;
}
inline constexpr uint32_t kMeta = typeOf("META"), kBodies = typeOf("BODY"), kSurfaces = typeOf("SURF"),
                          kShapes = typeOf("SHAP"), kJoints = typeOf("JOIN"), kFrames = typeOf("FRAM"),
                          kIndex = typeOf("INDX"), kRun = typeOf("RUNA"), kSteps = typeOf("STEP"),
                          kSofts = typeOf("SOFT");
std::string typeName(uint32_t type);

// The file's head: magic, major and minor version, checksum.
inline constexpr uint8_t kMagic[8] = {0x89, 'A', 'V', 'B', 'D', '\r', '\n', 0x1a};
inline constexpr uint16_t kMajor = 1, kMinor = 3;
inline constexpr size_t kFileHeadBytes = 16;
Bytes fileHead();
/// Throws FileError, which names what is wrong: no recording, a damaged head, a version that this reader cannot read.
void checkFileHead(std::span<const uint8_t> bytes, const std::string& file);
uint16_t minorOf(std::span<const uint8_t> head);

inline constexpr size_t kChunkHeadBytes = 28;
/// Of one chunk before compression; a chunk that claims more is refused.
inline constexpr uint32_t kChunkMost = 256u << 20;

enum class Codec : uint8_t { None = 0, Zstd = 1 };

struct ChunkHead {
  uint32_t type = 0;
  uint8_t codec = 0;
  uint32_t stored = 0, raw = 0;  ///< bytes in the file, and when unpacked
  uint32_t sum = 0;              ///< of the stored bytes
};

/// A whole chunk, packed where that makes it smaller and `compress` is set.
Bytes chunkBytes(uint32_t type, std::span<const uint8_t> content, bool compress);
/// Nothing if these bytes are no sound chunk head.
std::optional<ChunkHead> chunkHead(std::span<const uint8_t> bytes);
/// Checks the sum and unpacks. Throws FileError that begins with `place`.
Bytes unpack(const ChunkHead& head, std::span<const uint8_t> stored, const std::string& place);

/// The last bytes of a finished file.
struct Footer {
  uint64_t index = 0;   ///< offset of the index chunk
  uint64_t frames = 0;  ///< in the whole file
};
inline constexpr size_t kFooterBytes = 32;
Bytes footerBytes(const Footer& footer);
std::optional<Footer> footerOf(std::span<const uint8_t> bytes);

/// A zstd frame; empty where this build has no zstd.
Bytes zstdBytes(std::span<const uint8_t> content);
/// Whether this build packs and unpacks zstd.
bool hasZstd();

}  // namespace avbd::record
