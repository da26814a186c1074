// Sines for scenes: the C library's differ in the last bit from one platform to another, and a scene starts the same on
// all.
#pragma once

namespace avbd::scenes {

/// Within 2e-16 for angles within 1e6 [rad].
double sine(double angle);
double cosine(double angle);

}  // namespace avbd::scenes
