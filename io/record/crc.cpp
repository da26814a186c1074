// Eight bytes at a time, over eight tables (Kounavis and Berry, "slicing-by-8", 2005).
#include "io/record/crc.h"

#include <array>
#include <cstring>

namespace avbd::record {
namespace {

using Tables = std::array<std::array<uint32_t, 256>, 8>;

constexpr Tables tablesOf(uint32_t polynomial) {
  Tables t{};
  for (uint32_t i = 0; i < 256; ++i) {
    uint32_t sum = i;
    for (int bit = 0; bit < 8; ++bit) sum = sum & 1 ? sum >> 1 ^ polynomial : sum >> 1;
    t[0][i] = sum;
  }
  for (size_t k = 1; k < 8; ++k)
    for (size_t i = 0; i < 256; ++i) t[k][i] = t[k - 1][i] >> 8 ^ t[0][t[k - 1][i] & 0xff];
  return t;
}

constexpr Tables kCastagnoli = tablesOf(static_cast<uint32_t>(Polynomial::Castagnoli));
constexpr Tables kIeee = tablesOf(static_cast<uint32_t>(Polynomial::Ieee));

}  // namespace

uint32_t crc32(std::span<const uint8_t> bytes, Polynomial polynomial, uint32_t before) {
  const Tables& t = polynomial == Polynomial::Castagnoli ? kCastagnoli : kIeee;
  uint32_t sum = ~before;
  const uint8_t* at = bytes.data();
  size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8) {
    uint32_t low, high;
    std::memcpy(&low, at, 4);
    std::memcpy(&high, at + 4, 4);
    low ^= sum;
    sum = t[7][low & 0xff] ^ t[6][low >> 8 & 0xff] ^ t[5][low >> 16 & 0xff] ^ t[4][low >> 24] ^ t[3][high & 0xff] ^
          t[2][high >> 8 & 0xff] ^ t[1][high >> 16 & 0xff] ^ t[0][high >> 24];
  }
  for (; left > 0; --left, ++at) sum = sum >> 8 ^ t[0][(sum ^ *at) & 0xff];
  return ~sum;
}

}  // namespace avbd::record
