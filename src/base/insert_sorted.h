// Things put to their places in an ascending list, in its own memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace avbd {

/// Makes room for `more` things, which ascend as the list does: isBehind(item, i) tells whether an item of the list
/// stands behind thing i, make(i) gives it. From the end on, so that nothing is overwritten before it has moved; what
/// stands between two things moves at once.
template <class T, class IsBehind, class Make>
void insertSorted(std::vector<T>& list, size_t more, IsBehind&& isBehind, Make&& make) {
  size_t left = list.size();
  list.resize(left + more);
  const auto begin = list.begin();
  while (more > 0) {
    --more;
    const auto end = begin + static_cast<std::ptrdiff_t>(left);
    const auto at = std::partition_point(begin, end, [&](const T& item) { return !isBehind(item, more); });
    std::move_backward(at, end, end + static_cast<std::ptrdiff_t>(more + 1));
    left = static_cast<size_t>(at - begin);
    list[left + more] = make(more);
  }
}

}  // namespace avbd
