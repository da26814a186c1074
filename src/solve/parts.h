// The chunks and seams of a batch (batch.h), by one thread or many.
#pragma once

#include "base/jobs.h"
#include "solve/batch.h"

namespace avbd {

class Parts {
 public:
  Parts(const BatchView& view, Jobs* jobs) : v_(view), jobs_(view.chunks.size() > 1 ? jobs : nullptr) {}

  /// f(chunk) for all of them.
  template <class F>
  void chunks(F&& f) const {
    forAll(0, static_cast<uint32_t>(v_.chunks.size()), [&](uint32_t i) { f(v_.chunks[i]); });
  }
  /// f(tiles) for the seams, colour after colour.
  template <class F>
  void seams(F&& f) const {
    const auto count = static_cast<uint32_t>(v_.seams.size());
    for (uint32_t begin = 0, end; begin < count; begin = end) {
      for (end = begin; end < count && v_.seams[end].color == v_.seams[begin].color;) ++end;
      forAll(begin, end, [&](uint32_t i) { f(v_.seams[i].tiles); });
    }
  }

 private:
  template <class F>
  void forAll(uint32_t begin, uint32_t end, F&& f) const {
    if (jobs_ && end - begin > 1)
      jobs_->run(end - begin, [&](uint32_t i, int) { f(begin + i); });
    else
      for (uint32_t i = begin; i < end; ++i) f(i);
  }

  const BatchView& v_;
  Jobs* jobs_;
};

}  // namespace avbd
