// Elements to bytes and back.
#include "io/record/fields.h"

#include <cstring>

#include "io/file_error.h"

namespace avbd::record {
namespace {

constexpr size_t kHeadBytes = 12;

// Small differences of either sign become small numbers.
template <class U>
U zigzag(U v) {
  return static_cast<U>(v << 1) ^ static_cast<U>(U(0) - (v >> (8 * sizeof(U) - 1)));
}
template <class U>
U unzigzag(U v) {
  return static_cast<U>(v >> 1) ^ static_cast<U>(U(0) - (v & 1));
}

// The element that the ones before it let expect.
template <class U>
U expected(const U* v, size_t i, size_t stride, Encoding encoding) {
  if (i < stride) return 0;
  const U last = v[i - stride];
  return encoding == Encoding::Line && i >= 2 * stride ? static_cast<U>(2 * last - v[i - 2 * stride]) : last;
}

template <class U>
void encodeAs(Bytes& out, const uint8_t* elements, size_t count, Encoding encoding, size_t stride) {
  std::vector<U> values(count);
  if (count > 0) std::memcpy(values.data(), elements, count * sizeof(U));
  const size_t at = out.size();
  out.resize(at + count * sizeof(U));
  for (size_t i = 0; i < count; ++i) {
    U v = values[i];
    if (encoding != Encoding::Shuffled) v = zigzag<U>(static_cast<U>(v - expected(values.data(), i, stride, encoding)));
    for (size_t byte = 0; byte < sizeof(U); ++byte)
      out[at + byte * count + i] = static_cast<uint8_t>(v >> (8 * byte) & 0xff);
  }
}

template <class U>
void decodeAs(const uint8_t* data, uint8_t* elements, size_t count, Encoding encoding, size_t stride) {
  std::vector<U> values(count);
  for (size_t i = 0; i < count; ++i) {
    U v = 0;
    for (size_t byte = 0; byte < sizeof(U); ++byte)
      v = static_cast<U>(v | static_cast<U>(static_cast<U>(data[byte * count + i]) << (8 * byte)));
    if (encoding != Encoding::Shuffled) v = static_cast<U>(unzigzag(v) + expected(values.data(), i, stride, encoding));
    values[i] = v;
  }
  if (count > 0) std::memcpy(elements, values.data(), count * sizeof(U));
}

}  // namespace

void FieldWriter::add(uint16_t id, std::span<const uint8_t> elements, uint8_t width, Encoding encoding,
                      uint32_t stride) {
  const size_t count = elements.size() / width;
  if (encoding != Encoding::Plain && width != 4 && width != 8) encoding = Encoding::Plain;
  if (encoding == Encoding::Delta || encoding == Encoding::Line) {
    if (stride == 0) encoding = Encoding::Shuffled;
  } else {
    stride = 0;
  }
  put(bytes_, id);
  put(bytes_, static_cast<uint8_t>(encoding));
  put(bytes_, width);
  put(bytes_, static_cast<uint32_t>(count));
  put(bytes_, stride);
  if (encoding == Encoding::Plain)
    bytes_.insert(bytes_.end(), elements.begin(), elements.end());
  else if (width == 4)
    encodeAs<uint32_t>(bytes_, elements.data(), count, encoding, stride);
  else
    encodeAs<uint64_t>(bytes_, elements.data(), count, encoding, stride);
}

void FieldWriter::text(uint16_t id, std::string_view text) {
  add(id, {reinterpret_cast<const uint8_t*>(text.data()), text.size()}, 1, Encoding::Plain, 0);
}

void FieldWriter::texts(uint16_t id, const std::vector<std::string>& all) {
  std::vector<uint32_t> lengths;
  std::string together;
  for (const std::string& one : all) {
    lengths.push_back(static_cast<uint32_t>(one.size()));
    together += one;
  }
  list(id, lengths);
  text(static_cast<uint16_t>(id + 1), together);
}

FieldReader::FieldReader(std::span<const uint8_t> bytes, std::string place) : place_(std::move(place)) {
  for (size_t at = 0; at < bytes.size();) {
    if (bytes.size() - at < kHeadBytes) throw FileError(place_ + ": a field is cut off");
    const uint8_t* head = bytes.data() + at;
    const auto id = take<uint16_t>(bytes, at);
    const Field field{static_cast<Encoding>(head[2]), head[3], take<uint32_t>(bytes, at + 4),
                      take<uint32_t>(bytes, at + 8), head + kHeadBytes};
    at += kHeadBytes;
    const uint64_t size = uint64_t{field.count} * field.width;
    if (field.width == 0 || size > bytes.size() - at) refuse(id, "is longer than its chunk");
    at += size;
    if (!fields_.emplace(id, field).second) refuse(id, "is there twice");
  }
}

size_t FieldReader::count(uint16_t id) const {
  const auto it = fields_.find(id);
  return it == fields_.end() ? 0 : it->second.count;
}

size_t FieldReader::countOf(uint16_t id, size_t width) const {
  const auto it = fields_.find(id);
  if (it == fields_.end()) return 0;
  const Field& f = it->second;
  if (f.width != width)
    refuse(id, "has elements of " + std::to_string(f.width) + " bytes instead of " + std::to_string(width));
  if (f.encoding > Encoding::Line) refuse(id, "has encoding " + std::to_string(static_cast<int>(f.encoding)));
  if (f.encoding != Encoding::Plain && width != 4 && width != 8) refuse(id, "cannot be shuffled");
  if (f.encoding >= Encoding::Delta && f.stride == 0) refuse(id, "has stride 0");
  return f.count;
}

void FieldReader::decode(uint16_t id, uint8_t* out) const {
  const auto it = fields_.find(id);
  if (it == fields_.end()) return;
  const Field& f = it->second;
  if (f.encoding == Encoding::Plain) {
    if (f.count > 0) std::memcpy(out, f.data, size_t{f.count} * f.width);
  } else if (f.width == 4) {
    decodeAs<uint32_t>(f.data, out, f.count, f.encoding, f.stride);
  } else {
    decodeAs<uint64_t>(f.data, out, f.count, f.encoding, f.stride);
  }
}

std::string FieldReader::text(uint16_t id) const {
  const std::vector<char> all = list<char>(id);
  return {all.begin(), all.end()};
}

std::vector<std::string> FieldReader::texts(uint16_t id, size_t most) const {
  if (count(id) > most)
    refuse(id, "has " + std::to_string(count(id)) + " elements, more than a file of this size may hold");
  const std::string together = text(static_cast<uint16_t>(id + 1));
  std::vector<std::string> out;
  size_t at = 0;
  for (const uint32_t length : list<uint32_t>(id)) {
    if (length > together.size() - at) refuse(id, "names more characters than there are");
    out.push_back(together.substr(at, length));
    at += length;
  }
  return out;
}

void FieldReader::refuse(uint16_t id, const std::string& why) const {
  throw FileError(place_ + ": field " + std::to_string(id) + " " + why);
}

void FieldReader::refuseCount(uint16_t id, size_t found, size_t wanted) const {
  refuse(id, "has " + std::to_string(found) + " elements instead of " + std::to_string(wanted));
}

}  // namespace avbd::record
