// Fields: what the chunks of a recording hold. Each says its number, its encoding and its size, so that a reader skips
// those it does not know and does without those that an older writer did not write. Never raw structs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/record/bytes.h"

namespace avbd::record {

/// How the elements of a field became bytes.
enum class Encoding : uint8_t {
  Plain = 0,     ///< little endian, one after the other
  Shuffled = 1,  ///< first the lowest bytes of all elements, then the next ones ...
  Delta = 2,     ///< bits minus those of the element `stride` before, zigzag, shuffled
  Line = 3,      ///< bits minus twice those `stride` before plus those two strides before, zigzag, shuffled
};

class FieldWriter {
 public:
  template <class T>
  void list(uint16_t id, std::span<const T> all, Encoding encoding = Encoding::Plain, uint32_t stride = 0) {
    static_assert(std::is_arithmetic_v<T>);
    add(id, {reinterpret_cast<const uint8_t*>(all.data()), all.size_bytes()}, sizeof(T), encoding, stride);
  }
  template <class T>
  void list(uint16_t id, const std::vector<T>& all, Encoding encoding = Encoding::Plain, uint32_t stride = 0) {
    list(id, std::span<const T>(all), encoding, stride);
  }
  template <class T>
  void value(uint16_t id, T value) {
    list(id, std::span<const T>(&value, 1));
  }
  void text(uint16_t id, std::string_view text);
  /// Two fields: lengths under `id`, characters under `id + 1`.
  void texts(uint16_t id, const std::vector<std::string>& all);

  const Bytes& bytes() const { return bytes_; }

 private:
  void add(uint16_t id, std::span<const uint8_t> elements, uint8_t width, Encoding encoding, uint32_t stride);
  Bytes bytes_;
};

/// The fields of a chunk, which must outlive this. Throws FileError for bytes that are no fields, or a field asked for
/// with another width than it has; what() begins with `place`.
class FieldReader {
 public:
  FieldReader(std::span<const uint8_t> bytes, std::string place);

  bool has(uint16_t id) const { return fields_.count(id) != 0; }
  /// Elements of a field, before any of them is decoded; 0 if there is no such field.
  size_t count(uint16_t id) const;
  /// Empty if there is no such field.
  template <class T>
  std::vector<T> list(uint16_t id) const {
    static_assert(std::is_arithmetic_v<T>);
    std::vector<T> out(countOf(id, sizeof(T)));
    decode(id, reinterpret_cast<uint8_t*>(out.data()));
    return out;
  }
  /// A list that must have this length, if it is there at all.
  template <class T>
  std::vector<T> listOf(uint16_t id, size_t count) const {
    std::vector<T> out = list<T>(id);
    if (has(id) && out.size() != count) refuseCount(id, out.size(), count);
    return out;
  }
  template <class T>
  T value(uint16_t id, T otherwise) const {
    return has(id) ? listOf<T>(id, 1)[0] : otherwise;
  }
  std::string text(uint16_t id) const;
  /// No more than `most` of them.
  std::vector<std::string> texts(uint16_t id, size_t most = SIZE_MAX) const;
  const std::string& place() const { return place_; }
  [[noreturn]] void refuse(uint16_t id, const std::string& why) const;

 private:
  struct Field {
    Encoding encoding;
    uint8_t width;
    uint32_t count, stride;
    const uint8_t* data;
  };
  size_t countOf(uint16_t id, size_t width) const;
  void decode(uint16_t id, uint8_t* out) const;
  [[noreturn]] void refuseCount(uint16_t id, size_t found, size_t wanted) const;

  std::string place_;
  std::unordered_map<uint16_t, Field> fields_;
};

}  // namespace avbd::record
