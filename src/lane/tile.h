// Tile: 16 instances of a struct of reals, transposed to one register-wide line per field.
#pragma once

#include <utility>

#include "lane/wide.h"

namespace avbd::lane {

inline constexpr int kTile = 16;

/// Floats in one instance of T, a standard-layout template of R members only.
template <template <class> class T>
inline constexpr int kFields = sizeof(T<float>) / sizeof(float);

// Fields are written at constant offsets, not in a loop, so that the struct stays in registers.
template <class R, int... I>
AVBD_INLINE void loadFields(R* field, const float* tile, std::integer_sequence<int, I...>) {
  ((field[I] = load<R>(tile + I * kTile)), ...);
}
template <class R, int... I>
AVBD_INLINE void storeFields(float* tile, const R* field, std::integer_sequence<int, I...>) {
  (store(tile + I * kTile, field[I]), ...);
}

/// Instances laneOffset .. laneOffset + N - 1 of a tile laid out as float[kFields][16]; N = 1 gives T<float>.
/// The tile is aligned to 64 bytes, laneOffset is a multiple of N.
template <template <class> class T, int N>
AVBD_INLINE T<Real<N>> loadTile(const float* tile, int laneOffset) {
  static_assert(sizeof(T<Real<N>>) == kFields<T> * sizeof(Real<N>));
  T<Real<N>> value;
  loadFields(reinterpret_cast<Real<N>*>(&value), tile + laneOffset, std::make_integer_sequence<int, kFields<T>>());
  return value;
}
template <template <class> class T, int N>
AVBD_INLINE void storeTile(float* tile, int laneOffset, const Same<T<Real<N>>>& value) {
  static_assert(sizeof(T<Real<N>>) == kFields<T> * sizeof(Real<N>));
  storeFields(tile + laneOffset, reinterpret_cast<const Real<N>*>(&value),
              std::make_integer_sequence<int, kFields<T>>());
}

template <template <class> class T>
struct Tile {
  static constexpr int kCount = kFields<T>;
  alignas(64) float data[kCount][kTile];

  AVBD_INLINE T<float> get(int lane) const { return loadTile<T, 1>(data[0], lane); }
  AVBD_INLINE void set(int lane, const T<float>& value) { storeTile<T, 1>(data[0], lane, value); }
  template <int N>
  AVBD_INLINE T<Real<N>> load(int laneOffset) const {
    return loadTile<T, N>(data[0], laneOffset);
  }
  template <int N>
  AVBD_INLINE void store(int laneOffset, const Same<T<Real<N>>>& value) {
    storeTile<T, N>(data[0], laneOffset, value);
  }
};

/// One lane of a wide instance.
template <template <class> class T, int N>
AVBD_INLINE T<float> laneOf(const T<Wide<N>>& value, int lane) {
  T<float> one;
  for (int i = 0; i < kFields<T>; ++i)
    __builtin_memcpy(reinterpret_cast<char*>(&one) + 4 * i, reinterpret_cast<const char*>(&value) + 4 * (i * N + lane),
                     4);
  return one;
}

}  // namespace avbd::lane

namespace avbd {
using lane::kTile;
using lane::Tile;
}  // namespace avbd
