// Drawing the bar.
#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

#include "app/number_text.h"

namespace avbd::cli {
namespace {

constexpr int kWidth = 40;
constexpr auto kEvery = std::chrono::milliseconds(100);

}  // namespace

Progress::Progress(std::ostream& out)
    : out_(&out == &std::cerr && isatty(STDERR_FILENO) != 0 ? &out : nullptr), next_(Clock::now() + kEvery) {}

Progress::~Progress() {
  if (drawn_) *out_ << "\r\x1b[K" << std::flush;
}

void Progress::show(int64_t step, int64_t steps, double time) {
  if (out_ == nullptr || Clock::now() < next_) return;
  next_ = Clock::now() + kEvery;
  drawn_ = true;
  const double share = static_cast<double>(step) / static_cast<double>(std::max<int64_t>(1, steps));
  const int full = static_cast<int>(share * kWidth);
  *out_ << "\r[" << std::string(static_cast<size_t>(full), '#') << std::string(static_cast<size_t>(kWidth - full), ' ')
        << "] " << static_cast<int>(share * 100) << " %  " << digits(time, 4) << " s\x1b[K" << std::flush;
}

}  // namespace avbd::cli
