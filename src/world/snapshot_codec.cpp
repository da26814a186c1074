// Where a snapshot does not fit (snapshot_codec.h).
#include "world/snapshot_codec.h"

#include <algorithm>

namespace avbd::snapshot {

void Writer::makeRoom(size_t size) {
  if (grows_) {
    const size_t at = static_cast<size_t>(at_ - begin_), least = at + size;
    // By half, so that a world that grows is not copied for each of its bodies.
    grows_->resize(std::max({least, grows_->capacity(), at + at / 2 + spare_.size()}));
    begin_ = grows_->data();
    at_ = begin_ + at;
    end_ = begin_ + grows_->size();
    return;
  }
  settle();
  if (static_cast<size_t>(end_ - at_) >= size || size > kSpare) return;
  before_ += static_cast<size_t>(at_ - begin_);
  rest_ = {at_, end_};
  spared_ = true;
  begin_ = at_ = spare_.data();
  end_ = begin_ + kSpare;
}

void Writer::settle() {
  if (!spared_) return;
  spared_ = false;
  const auto size = static_cast<size_t>(at_ - begin_);
  before_ += size;
  if (size > rest_.size())
    over_ = true, rest_ = {};
  else if (size > 0)
    std::memcpy(rest_.data(), spare_.data(), size), rest_ = rest_.subspan(size);
  begin_ = at_ = rest_.data();
  end_ = at_ + rest_.size();
}

void Writer::giveUp(size_t size) {
  before_ += static_cast<size_t>(at_ - begin_) + size;
  over_ = true;
  begin_ = at_ = end_;
}

}  // namespace avbd::snapshot
