// The colour that a file gives a shape: for whoever draws it, nothing to the world.
#pragma once

#include <cmath>
#include <cstdint>

namespace avbd {

/// sRGB; alpha 255 is opaque.
struct Color {
  uint8_t red = 0, green = 0, blue = 0, alpha = 255;
  friend bool operator==(const Color&, const Color&) = default;
};

/// From numbers of 0 .. 1; beyond that as 0 or 1, as a screen shows them.
inline Color colorOf(double red, double green, double blue, double alpha) {
  const auto byte = [](double v) { return static_cast<uint8_t>(std::lround(255 * (v < 0 ? 0 : v > 1 ? 1 : v))); };
  return {byte(red), byte(green), byte(blue), byte(alpha)};
}

}  // namespace avbd
