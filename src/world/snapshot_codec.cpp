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
  gone_ += static_cast<size_t>(at_ - begin_);
  over_ = true;
  begin_ = at_ = spare_.data();
  end_ = begin_ + spare_.size();
}

}  // namespace avbd::snapshot
