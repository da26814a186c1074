// Scanning files of soft meshes (soft_mesh_file_parts.h).
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "io/mesh_file_parts.h"
#include "io/soft_mesh_file_parts.h"

namespace avbd::soft_mesh_file {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::string_view Scan::wordHere() {
  while (at_ < bytes_.size() && isBlank(bytes_[at_])) ++at_;
  if (at_ < bytes_.size() && comment != '\0' && bytes_[at_] == comment)
    at_ = std::min(bytes_.find('\n', at_), bytes_.size());
  const size_t first = at_;
  while (at_ < bytes_.size() && bytes_[at_] != '\n' && !isBlank(bytes_[at_])) ++at_;
  return bytes_.substr(first, at_ - first);
}

std::string_view Scan::word() {
  for (;;) {
    const std::string_view found = wordHere();
    if (!found.empty() || at_ >= bytes_.size()) return found;
    ++at_, ++line_;
  }
}

std::string_view Scan::line() {
  const size_t first = at_, end = std::min(bytes_.find('\n', at_), bytes_.size());
  at_ = std::min(end + 1, bytes_.size());
  ++line_;
  std::string_view out = bytes_.substr(first, end - first);
  if (out.ends_with('\r')) out.remove_suffix(1);
  return out;
}

void Scan::expect(std::string_view token) {
  if (const std::string_view found = word(); found != token) fail("statement", found, "must be " + std::string(token));
}

bool Scan::skipPast(std::string_view text) {
  const size_t found = bytes_.find(text, at_);
  if (found == std::string_view::npos) return false;
  line_ += static_cast<int>(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                                       bytes_.begin() + static_cast<std::ptrdiff_t>(found), '\n'));
  at_ = found + text.size();
  return true;
}

bool Scan::nextIs(std::string_view text) {
  size_t i = at_;
  while (i < bytes_.size() && (isBlank(bytes_[i]) || bytes_[i] == '\n')) ++i;
  return bytes_.substr(i).starts_with(text);
}

uint64_t Scan::raw(std::string_view what, size_t bytes) {
  if (left() < bytes) fail(std::string(what) + " is missing: the file ends");
  uint64_t out = 0;
  for (size_t i = 0; i < bytes; ++i) {
    const size_t place = numbers == Numbers::Little ? i : bytes - 1 - i;
    out |= uint64_t{static_cast<unsigned char>(bytes_[at_ + i])} << (8 * place);
  }
  at_ += bytes;
  return out;
}

int64_t Scan::integer(std::string_view what, int bytes, int64_t low, int64_t high) {
  int64_t value = 0;
  std::string shown;
  bool whole = true;
  if (isText()) {
    const std::string_view text = word();
    if (text.empty()) fail(std::string(what) + " is missing: the file ends");
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    whole = error == std::errc{} && end == text.data() + text.size();
    shown = text;
  } else {
    const uint64_t bits = raw(what, static_cast<size_t>(bytes));
    value = bytes == 4 ? int64_t{static_cast<int32_t>(static_cast<uint32_t>(bits))} : static_cast<int64_t>(bits);
    shown = std::to_string(value);
  }
  if (!whole || value < low || value > high)
    fail(what, shown, "must be a whole number of " + std::to_string(low) + " .. " + std::to_string(high));
  return value;
}

size_t Scan::count(std::string_view what, int bytes, size_t least) {
  const size_t most = left() / std::max<size_t>(least, 1);
  return static_cast<size_t>(integer(what, bytes, 0, static_cast<int64_t>(most)));
}

double Scan::number(std::string_view what, int bytes) {
  double value = 0;
  std::string shown;
  bool isNumber = true;
  if (isText()) {
    const std::string_view text = word();
    if (text.empty()) fail(std::string(what) + " is missing: the file ends");
    isNumber = mesh_file::parseNumber(text, value);
    shown = text;
  } else {
    const uint64_t bits = raw(what, static_cast<size_t>(bytes));
    value = bytes == 4 ? double{std::bit_cast<float>(static_cast<uint32_t>(bits))} : std::bit_cast<double>(bits);
    shown = std::to_string(value);
  }
  if (!isNumber || !std::isfinite(static_cast<float>(value)))
    fail(what, shown, "must be a finite number within the range of float");
  return value;
}

Vec3 Scan::point(int bytes) {
  const double x = number("x", bytes), y = number("y", bytes), z = number("z", bytes);
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

void Scan::skipNumbers(uint64_t count, size_t bytes) {
  if (count > left()) fail("data is missing: the file ends");
  if (isText()) {
    for (uint64_t i = 0; i < count; ++i)
      if (word().empty()) fail("data is missing: the file ends");
    return;
  }
  if (count * bytes > left()) fail("data is missing: the file ends");
  at_ += static_cast<size_t>(count) * bytes;
}

void Scan::fail(const std::string& message) const {
  if (isText()) throw FileError(name_ + ":" + std::to_string(line_) + ": " + message, name_, line_);
  throw FileError(name_ + ": byte " + std::to_string(at_) + ": " + message, name_);
}

void Scan::fail(std::string_view what, std::string_view value, const std::string& range) const {
  constexpr size_t kMost = 60;
  std::string shown;
  for (const char c : value.substr(0, kMost)) shown += c >= ' ' && c <= '~' ? c : '?';
  fail(std::string(what) + " = \"" + shown + (value.size() > kMost ? "...\": " : "\": ") + range);
}

void PointNames::finish(const Scan& scan) {
  for (size_t i = 1; i < byTag_.size(); ++i) inRow_ = inRow_ && byTag_[i].first == byTag_[i - 1].first + 1;
  if (inRow_) return;
  std::sort(byTag_.begin(), byTag_.end());
  for (size_t i = 1; i < byTag_.size(); ++i)
    if (byTag_[i].first == byTag_[i - 1].first)
      scan.fail("node", std::to_string(byTag_[i].first), "must not stand twice");
}

uint32_t PointNames::find(int64_t tag, const Scan& scan) const {
  const auto none = [&]() { scan.fail("node of an element", std::to_string(tag), "must be one of the file's nodes"); };
  if (byTag_.empty()) none();
  if (inRow_) {
    const int64_t first = byTag_.front().first;
    if (tag < first || tag > byTag_.back().first) none();
    return static_cast<uint32_t>(tag - first);
  }
  const auto found = std::lower_bound(byTag_.begin(), byTag_.end(), std::pair(tag, uint32_t{0}));
  if (found == byTag_.end() || found->first != tag) none();
  return found->second;
}

}  // namespace avbd::soft_mesh_file
