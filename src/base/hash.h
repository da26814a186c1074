// State hash: 64 bits over a stream of bytes, the same on every little-endian platform. Not for adversaries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace avbd {

/// Hashes what it is given in order; how the bytes are cut into calls does not matter.
class Hash64 {
 public:
  explicit Hash64(uint64_t seed = 0);
  void bytes(const void* data, size_t size);
  /// Bytes of a value. A type with padding would hash what the padding happens to hold: give its fields instead.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(const T& value) { bytes(&value, sizeof(T)); }
  /// All elements, and how many there are.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void values(std::span<const T> all) {
    value(static_cast<uint64_t>(all.size()));
    bytes(all.data(), all.size_bytes());
  }
  template <class T>
  void values(const std::vector<T>& all) {
    values(std::span<const T>(all));
  }
  uint64_t digest() const;  ///< of everything given so far

 private:
  static constexpr size_t kBlock = 32;
  void mixBlock(const unsigned char* block);

  uint64_t lanes_[4];
  unsigned char tail_[kBlock];
  uint64_t size_ = 0;
};

/// Hash of one run of bytes.
uint64_t hash64(const void* data, size_t size, uint64_t seed = 0);

}  // namespace avbd
