// Vectors whose data start on a cache line.
#pragma once

#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>
#include <vector>

namespace avbd {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlign{64};
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlign)); }
  void deallocate(T* p, size_t) { ::operator delete(p, kAlign); }
  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

/// Leaves new elements as the memory has them, so that the pages of a large array are touched first by who fills them,
/// and not all by who makes room. Builds with assertions fill them with what no arithmetic hides: NaN.
template <class T>
struct UnwrittenAllocator : AlignedAllocator<T> {
  static_assert(std::is_trivially_default_constructible_v<T>);
  UnwrittenAllocator() = default;
  template <class U>
  UnwrittenAllocator(const UnwrittenAllocator<U>&) {}
  template <class U>
  struct rebind {
    using other = UnwrittenAllocator<U>;
  };
  T* allocate(size_t n) {
    T* data = AlignedAllocator<T>::allocate(n);
#ifdef AVBD_ASSERTS
    std::memset(static_cast<void*>(data), 0xff, n * sizeof(T));
#endif
    return data;
  }
  void construct(T*) {}
  void construct(T* to, const T& from) { ::new (static_cast<void*>(to)) T(from); }
};

template <class T>
using UnwrittenVector = std::vector<T, UnwrittenAllocator<T>>;

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace avbd
