// A value's bits read as another type.
#pragma once

namespace avbd {

/// std::bit_cast, which emscripten's standard library lacks as Debian 12 has it.
template <class To, class From>
constexpr To bitsAs(const From& from) {
  return __builtin_bit_cast(To, from);
}

}  // namespace avbd
