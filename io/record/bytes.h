// Numbers in runs of bytes, little endian.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace avbd::record {

static_assert(std::endian::native == std::endian::little, "recordings are written as numbers lie in memory");

using Bytes = std::vector<uint8_t>;

template <class T>
void put(Bytes& out, T value) {
  const size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}

/// The bytes from `at` on must be there.
template <class T>
T take(std::span<const uint8_t> bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

}  // namespace avbd::record
