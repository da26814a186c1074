// How values become bytes of a snapshot and values again: one order of fields for both ways.
//
// A record is coded against another one that it is likely to resemble, mostly the one before it: a bit for each field
// says whether it differs, and only then its bytes follow. Worlds hold many equal things, so most fields cost nothing,
// and no thought is needed about which. Fields are those that snapshot_fields.h lists; a struct that is a field is a
// record of its own. Values lie as little-endian machines hold them, without padding.
#pragma once

#include <avbd/id.h>
#include <avbd/types.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "geom/aabb.h"
#include "geom/shape.h"

namespace avbd::snapshot {

static_assert(std::endian::native == std::endian::little, "a snapshot's numbers lie as they do in memory");

/// What is copied byte by byte: it has no padding.
template <class T>
inline constexpr bool kIsLeaf = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool kIsLeaf<Vec3> = sizeof(Vec3) == 3 * sizeof(float);
template <>
inline constexpr bool kIsLeaf<Vec3d> = sizeof(Vec3d) == 3 * sizeof(double);
template <>
inline constexpr bool kIsLeaf<Quat> = sizeof(Quat) == 4 * sizeof(float);
template <>
inline constexpr bool kIsLeaf<SymMat3> = sizeof(SymMat3) == 6 * sizeof(float);
template <>
inline constexpr bool kIsLeaf<Pose> = sizeof(Pose) == sizeof(Vec3d) + sizeof(Quat);
template <>
inline constexpr bool kIsLeaf<NearPose> = sizeof(NearPose) == sizeof(Vec3) + sizeof(Quat);
template <>
inline constexpr bool kIsLeaf<Aabb> = sizeof(Aabb) == 2 * sizeof(Vec3);
template <class Tag>
inline constexpr bool kIsLeaf<Id<Tag>> = sizeof(Id<Tag>) == 2 * sizeof(uint32_t);
template <class T, size_t n>
inline constexpr bool kIsLeaf<T[n]> = kIsLeaf<T>;
template <class T, size_t n>
inline constexpr bool kIsLeaf<std::array<T, n>> = kIsLeaf<T>;

template <class T>
struct IsRow : std::false_type {};
template <class T, size_t n>
struct IsRow<T[n]> : std::true_type {};
template <class T, size_t n>
struct IsRow<std::array<T, n>> : std::true_type {};
/// An array of records: each is a field.
template <class T>
inline constexpr bool kIsRow = IsRow<T>::value && !kIsLeaf<T>;

template <class T>
constexpr size_t countOf() {
  if constexpr (kIsRow<T>)
    return sizeof(T) / sizeof(std::declval<T&>()[0]);
  else
    return 1;
}
template <class... T>
constexpr size_t countOfAll(const std::tuple<T&...>*) {
  return (countOf<std::remove_const_t<T>>() + ... + 0);
}
/// How many bits a record's mask needs. `Parts`: a tuple of references to its fields.
template <class Parts>
inline constexpr size_t kBits = countOfAll(static_cast<const Parts*>(nullptr));
template <size_t bits>
using Mask = std::conditional_t<
    (bits <= 8), uint8_t,
    std::conditional_t<(bits <= 16), uint16_t, std::conditional_t<(bits <= 32), uint32_t, uint64_t>>>;

/// Calls f(x, y) for the fields of two records of one type, side by side.
template <class A, class B, class F>
void zip(const A& a, const B& b, F&& f) {
  [&]<size_t... i>(std::index_sequence<i...>) { (f(std::get<i>(a), std::get<i>(b)), ...); }
  (std::make_index_sequence<std::tuple_size_v<A>>());
}

/// Of a record all fields; of a leaf its bytes.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (kIsLeaf<T>) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
  } else if constexpr (kIsRow<T>) {
    for (size_t i = 0; i < countOf<T>(); ++i)
      if (!same(a[i], b[i])) return false;
    return true;
  } else {
    bool all = true;
    zip(snapshotParts(a), snapshotParts(b), [&](const auto& x, const auto& y) { all = all && same(x, y); });
    return all;
  }
}

/// What a record's list names, and nothing else.
template <class T>
void copyFields(T& to, const T& from) {
  zip(snapshotParts(to), snapshotParts(from),
      [](auto& x, const auto& y) { std::memcpy(static_cast<void*>(&x), &y, sizeof(x)); });
}

/// Fills memory of the caller's: a vector that grows, or a span, where what does not fit is counted all the same.
///
/// Who asks for room() mostly uses less. Where a span has no such room left, what is written goes to spare memory and
/// from there to the span, if it fits.
class Writer {
 public:
  static constexpr bool kReads = false;
  static constexpr size_t kSpare = 4096;
  explicit Writer(std::vector<std::byte>& out)
      : grows_(&out), begin_(out.data()), at_(begin_), end_(begin_ + out.size()) {}
  explicit Writer(std::span<std::byte> out) : begin_(out.data()), at_(begin_), end_(begin_ + out.size()) {}

  size_t size() const { return before_ + static_cast<size_t>(at_ - begin_); }
  /// When all is written.
  bool fits() {
    settle();
    return !over_;
  }
  template <class T>
  void put(const T& value) {
    static_assert(kIsLeaf<T>);
    raw(&value, sizeof(T));
  }
  void raw(const void* bytes, size_t size) {
    if (static_cast<size_t>(end_ - at_) < size) makeRoom(size);
    if (static_cast<size_t>(end_ - at_) < size) return giveUp(size);
    if (size > 0) std::memcpy(at_, bytes, size);
    at_ += size;
  }
  /// A number that is mostly small: seven bits a byte.
  void number(uint64_t n) {
    for (; n >= 128; n >>= 7) put(static_cast<uint8_t>(n | 128));
    put(static_cast<uint8_t>(n));
  }
  /// Where `size` bytes in one piece, at most kSpare, may be written, of which advance() takes what was used.
  std::byte* room(size_t size) {
    if (static_cast<size_t>(end_ - at_) < size) makeRoom(size);
    return at_;
  }
  void advance(std::byte* to) { at_ = to; }

  template <class T>
  void record(const T& now, const T& before) {
    static_assert(kNested + sizeof(T) <= kSpare);
    room(kNested + sizeof(T));  // all in one piece, so that masks can be written after their fields
    inner(now, before);
  }

 private:
  static constexpr size_t kNested = 256;  ///< most that the masks of a record and of those within it take

  template <class T>
  void inner(const T& now, const T& before) {
    const auto fields = snapshotParts(now);
    Mask<kBits<std::remove_const_t<decltype(fields)>>> mask = 0;
    std::byte* const head = at_;
    at_ += sizeof(mask);
    int bit = 0;
    zip(fields, snapshotParts(before), [&](const auto& x, const auto& y) {
      eachOf(x, y, [&](const auto& a, const auto& b) {
        if (!same(a, b)) mask = static_cast<decltype(mask)>(mask | decltype(mask)(1) << bit), field(a, b);
        ++bit;
      });
    });
    std::memcpy(head, &mask, sizeof(mask));
  }
  template <class T>
  void field(const T& now, const T& before) {
    if constexpr (kIsLeaf<T>)
      put(now);
    else
      inner(now, before);
  }
  template <class T, class F>
  static void eachOf(const T& a, const T& b, F&& f) {
    if constexpr (kIsRow<T>)
      for (size_t i = 0; i < countOf<T>(); ++i) f(a[i], b[i]);
    else
      f(a, b);
  }
  void makeRoom(size_t size);
  void settle();             ///< from spare memory to the span
  void giveUp(size_t size);  ///< of what is longer than all the room there is

  std::vector<std::byte>* grows_ = nullptr;
  std::byte *begin_, *at_, *end_;
  size_t before_ = 0;          ///< written before begin_
  std::span<std::byte> rest_;  ///< of the span, while spare memory is written
  bool spared_ = false;
  bool over_ = false;
  std::array<std::byte, kSpare> spare_;
};

/// What a snapshot's bytes are found to break; becomes an Error.
struct Unsound {
  const char* what;
};
inline void require(bool holds, const char* what) {
  if (!holds) throw Unsound{what};
}

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::span<const std::byte> in) : at_(in.data()), end_(at_ + in.size()) {}

  size_t left() const { return static_cast<size_t>(end_ - at_); }
  template <class T>
  void put(T& value) {
    static_assert(kIsLeaf<T>);
    if constexpr (std::is_same_v<T, bool>) {
      uint8_t byte = 0;
      raw(&byte, 1);
      require(byte <= 1, "a yes or no that is neither");
      value = byte != 0;
    } else {
      raw(&value, sizeof(T));
    }
  }
  template <class T>
  T take() {
    T value{};
    put(value);
    return value;
  }
  void raw(void* bytes, size_t size) {
    if (left() < size) throw Unsound{"it ends within a value"};
    if (size > 0) std::memcpy(bytes, at_, size);
    at_ += size;
  }
  /// The next `most` bytes, at most kPiece, with zeros where there are fewer; advance() takes what was used.
  const std::byte* piece(size_t most) {
    if (left() >= most) return at_;
    tail_.fill(std::byte{0});
    if (left() > 0) std::memcpy(tail_.data(), at_, left());
    return tail_.data();
  }
  void advance(size_t size) {
    require(size <= left(), "it ends within a value");
    at_ += size;
  }
  static constexpr size_t kPiece = 1024;

  uint64_t number() {
    uint64_t n = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const uint8_t byte = take<uint8_t>();
      n |= uint64_t(byte & 127) << shift;
      if (byte < 128) return n;
    }
    throw Unsound{"a number without end"};
  }
  /// How many things follow, each of at least `bytes`: never more than there is room for.
  size_t count(size_t bytes) {
    const uint64_t n = number();
    require(n <= left() / (bytes > 0 ? bytes : 1), "more things than bytes");
    return static_cast<size_t>(n);
  }

  template <class T>
  void record(T& now, const T& before) {
    const auto fields = snapshotParts(now);
    Mask<kBits<std::remove_const_t<decltype(fields)>>> mask = 0;
    put(mask);
    int bit = 0;
    zip(fields, snapshotParts(before), [&](auto& x, const auto& y) {
      eachOf(x, y, [&](auto& a, const auto& b) {
        if (mask >> bit & 1)
          field(a, b);
        else
          copy(a, b);
        ++bit;
      });
    });
    require((mask >> (bit - 1)) <= 1, "a mask of fields that there are not");
  }

 private:
  template <class T>
  void field(T& now, const T& before) {
    if constexpr (kIsLeaf<T>)
      put(now);
    else
      record(now, before);
  }
  template <class T>
  static void copy(T& now, const T& before) {
    std::memcpy(static_cast<void*>(&now), &before, sizeof(T));
  }
  template <class T, class F>
  static void eachOf(T& a, const T& b, F&& f) {
    if constexpr (kIsRow<T>)
      for (size_t i = 0; i < countOf<T>(); ++i) f(a[i], b[i]);
    else
      f(a, b);
  }

  const std::byte *at_, *end_;
  std::array<std::byte, kPiece> tail_;
};

// Lists: how many, then each.

template <class T>
void list(Writer& out, const std::vector<T>& all) {
  out.number(all.size());
  out.raw(all.data(), all.size() * sizeof(T));
}
template <class T>
void list(Reader& in, std::vector<T>& all) {
  static_assert(kIsLeaf<T> && !std::is_same_v<T, bool>);
  all.resize(in.count(sizeof(T)));
  in.raw(all.data(), all.size() * sizeof(T));
}

template <class T>
void recordList(Writer& out, const std::vector<T>& all) {
  const T first{};
  out.number(all.size());
  for (size_t i = 0; i < all.size(); ++i) out.record(all[i], i > 0 ? all[i - 1] : first);
}
template <class T>
void recordList(Reader& in, std::vector<T>& all) {
  const T first{};
  all.resize(in.count(1));
  for (size_t i = 0; i < all.size(); ++i) in.record(all[i], i > 0 ? all[i - 1] : first);
}

}  // namespace avbd::snapshot
