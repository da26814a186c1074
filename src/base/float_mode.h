// The rounding and denormal mode that every thread computes in: to nearest, denormals kept.
#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace avbd {

/// Sets the mode for its lifetime; the caller's own comes back after it.
class FloatMode {
 public:
#if defined(__SSE2__)
  FloatMode() : before_(_mm_getcsr()) { _mm_setcsr(kMode); }
  ~FloatMode() { _mm_setcsr(before_); }

 private:
  static constexpr uint32_t kMode = 0x1f80;  ///< as a thread starts: all exceptions masked, nothing flushed
  uint32_t before_;
#elif defined(__aarch64__)
  FloatMode() {
    asm volatile("mrs %0, fpcr" : "=r"(before_));
    set(0);
  }
  ~FloatMode() { set(before_); }

 private:
  static void set(uint64_t mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }
  uint64_t before_;
#else
  FloatMode() {}
  ~FloatMode() {}

 private:
#endif
 public:
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;
};

}  // namespace avbd
