// Scanning text of mesh files.
#include <charconv>
#include <cmath>
#include <cstring>

#include "io/mesh_file_parts.h"

namespace avbd::mesh_file {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

bool parseNumber(std::string_view text, double& out) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (end != text.data() + text.size()) return false;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
    out = tiny ? 0 : HUGE_VAL;
    return true;
  }
  return error == std::errc{};
}

uint32_t word(std::string_view bytes, size_t at) {
  uint32_t out = 0;
  for (size_t i = 0; i < 4; ++i) out |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return out;
}

float real(std::string_view bytes, size_t at) {
  const uint32_t bits = word(bytes, at);
  float out;
  std::memcpy(&out, &bits, sizeof out);
  return out;
}

void TextScan::skipBlanks() {
  while (at_ < end_) {
    if (isBlank(*at_)) {
      ++at_;
    } else if (*at_ == '\\' && end_ - at_ > 1 && at_[1] == '\n') {
      at_ += 2;
      ++line_;
    } else if (*at_ == '\\' && end_ - at_ > 2 && at_[1] == '\r' && at_[2] == '\n') {
      at_ += 3;
      ++line_;
    } else {
      return;
    }
  }
}

std::string_view TextScan::token() {
  skipBlanks();
  const char* first = at_;
  while (at_ < end_ && *at_ != '\n' && !isBlank(*at_)) {
    // A backslash joins lines only where a line ends behind it.
    if (*at_ == '\\' && at_ + 1 < end_ && (at_[1] == '\n' || at_[1] == '\r')) break;
    ++at_;
  }
  return {first, static_cast<size_t>(at_ - first)};
}

bool TextScan::nextLine() {
  const void* found = at_ < end_ ? std::memchr(at_, '\n', static_cast<size_t>(end_ - at_)) : nullptr;
  if (!found) {
    at_ = end_;
    return false;
  }
  at_ = static_cast<const char*>(found) + 1;
  ++line_;
  return at_ < end_;
}

std::string_view TextScan::tokenAnywhere() {
  for (;;) {
    const std::string_view found = token();
    if (!found.empty() || !nextLine()) return found;
  }
}

float TextScan::number(std::string_view what) {
  const std::string_view text = token();
  if (text.empty()) failAt(line_, std::string(what) + " is missing: must be a finite number");
  double value = 0;
  const bool isNumber = parseNumber(text, value);
  const float out = static_cast<float>(value);
  if (!isNumber || !std::isfinite(out)) fail(what, text, "must be a finite number within the range of float");
  return out;
}

void TextScan::failAt(int line, const std::string& message) const {
  throw FileError(name_ + ":" + std::to_string(line) + ": " + message, name_, line);
}

void TextScan::fail(std::string_view what, std::string_view value, const std::string& range) const {
  constexpr size_t kMost = 60;
  std::string shown;
  for (const char c : value.substr(0, kMost)) shown += c >= ' ' && c <= '~' ? c : '?';
  failAt(line_, std::string(what) + " = \"" + shown + (value.size() > kMost ? "...\": " : "\": ") + range);
}

}  // namespace avbd::mesh_file
