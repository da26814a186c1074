// Records of pairs in blocks that never move: more of them cost no copy of those that there are, and a record stays
// where it is.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/jobs.h"
#include "world/pair_data.h"

namespace avbd {

class PairRecords {
 public:
  PairRecords() = default;
  PairRecords(const PairRecords& other) { *this = other; }
  PairRecords(PairRecords&& other) noexcept { swap(other); }
  PairRecords& operator=(const PairRecords& other) {
    if (this == &other) return *this;
    resize(other.size_);
    for (size_t i = 0; i < size_; i += kBlock)
      std::copy_n(other.blocks_[i / kBlock].get(), std::min(kBlock, size_ - i), blocks_[i / kBlock].get());
    return *this;
  }
  PairRecords& operator=(PairRecords&& other) noexcept { return swap(other), *this; }
  ~PairRecords() = default;

  size_t size() const { return size_; }
  PairData& operator[](size_t i) { return blocks_[i / kBlock][i % kBlock]; }
  const PairData& operator[](size_t i) const { return blocks_[i / kBlock][i % kBlock]; }
  /// New records hold what was there before. Memory is kept.
  void resize(size_t size) {
    while (blocks_.size() * kBlock < size) blocks_.emplace_back(new PairData[kBlock]);
    size_ = size;
  }
  /// The same, the memory found and first written by the threads of the jobs.
  void resize(size_t size, Jobs& jobs) {
    const size_t had = blocks_.size();
    blocks_.resize(std::max(had, (size + kBlock - 1) / kBlock));
    jobs.forRange(static_cast<uint32_t>(blocks_.size() - had), 1, [&](uint32_t begin, uint32_t end, int) {
      for (size_t i = had + begin; i < had + end; ++i) blocks_[i].reset(new PairData[kBlock]);
    });
    size_ = size;
  }
  void swap(PairRecords& other) noexcept {
    blocks_.swap(other.blocks_);
    std::swap(size_, other.size_);
  }

 private:
  static constexpr size_t kBlock = 64;
  std::vector<std::unique_ptr<PairData[]>> blocks_;
  size_t size_ = 0;
};

}  // namespace avbd
