// What one core of this machine can do at most: memory traffic of a = b + s c by the size of what it runs over, and
// multiplications and additions, not fused, in lanes of sixteen floats.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using Lanes = float __attribute__((vector_size(64)));

/// Least [s] of a few runs.
template <class F>
double least(F&& f) {
  double best = 1e9;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    f();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void triad(size_t bytes) {
  const size_t count = bytes / (3 * sizeof(Lanes)), repeats = std::max<size_t>(3, (size_t(1) << 30) / bytes);
  std::vector<Lanes> a(count), b(count, Lanes{} + 1), c(count, Lanes{} + 2);
  const double seconds = least([&] {
    for (size_t r = 0; r < repeats; ++r) {
      for (size_t i = 0; i < count; ++i) a[i] = b[i] + c[i] * 1.5f;
      asm volatile("" : : "r"(a.data()) : "memory");
    }
  });
  const double moved = static_cast<double>(repeats * count * 3 * sizeof(Lanes));
  std::printf("triad over %7zu KB  %6.1f GB/s\n", bytes >> 10, moved / seconds * 1e-9);
}

/// Keeps the compiler from knowing them.
template <class... V>
void use(V&... v) {
  (..., [&] { asm volatile("" : "+v"(v)); }());
}

void arithmetic() {
  constexpr int kRounds = 30000000, kOperations = 12;
  Lanes one = Lanes{} + 1, little = Lanes{} + 1e-6f;
  Lanes p0 = one, p1 = one, p2 = one, p3 = one, p4 = one, p5 = one;
  Lanes s0 = one, s1 = one, s2 = one, s3 = one, s4 = one, s5 = one;
  use(one, little);
  const double seconds = least([&] {
    for (int i = 0; i < kRounds; ++i) {
      p0 *= one, p1 *= one, p2 *= one, p3 *= one, p4 *= one, p5 *= one;
      s0 += little, s1 += little, s2 += little, s3 += little, s4 += little, s5 += little;
      use(p0, p1, p2, p3, p4, p5, s0, s1, s2, s3, s4, s5);
    }
  });
  std::printf("multiply, add         %6.1f Gflop/s\n", 16.0 * kOperations * kRounds / seconds * 1e-9);
}

}  // namespace

int main() {
  for (const size_t kilobytes : {24, 512, 8192, 262144}) triad(kilobytes << 10);
  arithmetic();
}
