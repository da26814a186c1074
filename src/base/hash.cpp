// Four independent lanes of xor, multiply, rotate; folded at the end (hash.h).
#include "base/hash.h"

#include <bit>
#include <cstring>

namespace avbd {
namespace {

static_assert(std::endian::native == std::endian::little, "the hash reads words as they lie in memory");

// Odd multipliers without structure: fractional bits of the square roots of 2, 3, 5, 7, 11, with the last bit set.
constexpr uint64_t kLane[4] = {0x6a09e667f3bcc909u, 0xbb67ae8584caa73bu, 0x3c6ef372fe94f82bu, 0xa54ff53a5f1d36f1u};
constexpr uint64_t kFold = 0x510e527fade682d1u;

uint64_t load(const unsigned char* p) {
  uint64_t word;
  std::memcpy(&word, p, sizeof(word));
  return word;
}

// For a given word a bijection of the lane: nothing that entered is forgotten.
uint64_t mix(uint64_t lane, uint64_t word, uint64_t multiplier) { return std::rotl((lane ^ word) * multiplier, 29); }

uint64_t avalanche(uint64_t x) {
  x = (x ^ (x >> 32)) * kFold;
  x = (x ^ (x >> 29)) * kLane[1];
  return x ^ (x >> 32);
}

}  // namespace

Hash64::Hash64(uint64_t seed) {
  for (size_t i = 0; i < 4; ++i) lanes_[i] = avalanche(seed + kLane[i]);
}

void Hash64::mixBlock(const unsigned char* block) {
  for (size_t i = 0; i < 4; ++i) lanes_[i] = mix(lanes_[i], load(block + 8 * i), kLane[i]);
}

void Hash64::bytes(const void* data, size_t size) {
  if (size == 0) return;
  const unsigned char* p = static_cast<const unsigned char*>(data);
  const size_t held = size_ % kBlock;
  size_ += size;
  if (held + size < kBlock) {
    std::memcpy(tail_ + held, p, size);
    return;
  }
  if (held > 0) {
    const size_t missing = kBlock - held;
    std::memcpy(tail_ + held, p, missing);
    mixBlock(tail_);
    p += missing;
    size -= missing;
  }
  // In registers: in memory each block would wait for the one before to be stored.
  uint64_t a = lanes_[0], b = lanes_[1], c = lanes_[2], d = lanes_[3];
  for (; size >= kBlock; p += kBlock, size -= kBlock) {
    a = mix(a, load(p), kLane[0]);
    b = mix(b, load(p + 8), kLane[1]);
    c = mix(c, load(p + 16), kLane[2]);
    d = mix(d, load(p + 24), kLane[3]);
  }
  lanes_[0] = a, lanes_[1] = b, lanes_[2] = c, lanes_[3] = d;
  if (size > 0) std::memcpy(tail_, p, size);
}

uint64_t Hash64::digest() const {
  Hash64 last = *this;
  const size_t held = size_ % kBlock;
  if (held > 0) {
    std::memset(last.tail_ + held, 0, kBlock - held);  // the size below tells zeros given from zeros filled in
    last.mixBlock(last.tail_);
  }
  uint64_t result = size_;
  for (size_t i = 0; i < 4; ++i) result = avalanche(mix(result, last.lanes_[i], kFold));
  return result;
}

uint64_t hash64(const void* data, size_t size, uint64_t seed) {
  Hash64 hash(seed);
  hash.bytes(data, size);
  return hash.digest();
}

}  // namespace avbd
