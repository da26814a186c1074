// Cyclic redundancy checks over bytes: CRC-32C for recordings, CRC-32 for MCAP.
#pragma once

#include <cstdint>
#include <span>

namespace avbd::record {

enum class Polynomial : uint32_t {
  Castagnoli = 0x82f63b78u,  ///< CRC-32C (RFC 3720, appendix B.4), bits reversed
  Ieee = 0xedb88320u,        ///< CRC-32 of zip, PNG and Ethernet (ISO 3309), bits reversed
};

/// `before`: the sum of the bytes that came earlier.
uint32_t crc32(std::span<const uint8_t> bytes, Polynomial polynomial, uint32_t before = 0);
inline uint32_t crc32c(std::span<const uint8_t> bytes) { return crc32(bytes, Polynomial::Castagnoli); }

}  // namespace avbd::record
