// How much of a file's unpacked content is held at a time. A few packed bytes stand for gigabytes, so whatever is kept
// must stay in proportion to the file or below a fixed size. A writer keeps to the same limits.
#pragma once

#include <cstdint>

namespace avbd::record {

/// Bytes of all META, BODY, SURF, SHAP and JOIN chunks together, unpacked, in a file of this size.
constexpr uint64_t headMost(uint64_t fileBytes) { return (uint64_t{16} << 20) + 64 * fileBytes; }
/// Bodies, shapes and joints, each.
constexpr uint64_t thingsMost(uint64_t fileBytes) { return (uint64_t{1} << 18) + fileBytes; }
constexpr uint64_t framesMost(uint64_t fileBytes) { return (uint64_t{1} << 22) + fileBytes; }
/// Bytes of an index, unpacked: a chunk takes 24 of them and more in the file.
constexpr uint64_t indexMost(uint64_t fileBytes) { return 8 * framesMost(fileBytes) + fileBytes + 4096; }
/// Lines of a report.
inline constexpr uint32_t kReportMost = 1u << 16;
/// Events of a chunk of frames: they may take a byte each.
inline constexpr uint32_t kEventsMost = 1u << 22;

}  // namespace avbd::record
