// Things put to their places in an ascending list, in its own memory.
#pragma once

#include <cstddef>
#include <vector>

namespace avbd {

/// Makes room for `more` things, which ascend as the list does: isBehind(item, i) tells whether an item of the list
/// stands behind thing i, make(i) gives it. From the end on, so that nothing is overwritten before it has moved.
template <class T, class IsBehind, class Make>
void insertSorted(std::vector<T>& list, size_t more, IsBehind&& isBehind, Make&& make) {
  size_t from = list.size(), to = from + more;
  list.resize(to);
  while (more > 0) {
    --to;
    if (from > 0 && isBehind(list[from - 1], more - 1))
      list[to] = list[--from];
    else
      list[to] = make(--more);
  }
}

}  // namespace avbd
