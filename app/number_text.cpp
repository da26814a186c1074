// Numbers by std::to_chars.
#include "app/number_text.h"

#include <charconv>

namespace avbd::cli {
namespace {

template <class T>
void append(std::string& to, T value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  to.append(buffer, end);
}

}  // namespace

std::string digits(double value, int significant) {
  char buffer[48];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, significant).ptr;
  return {buffer, end};
}

void appendExact(std::string& to, double value) { append(to, value); }
void appendExact(std::string& to, float value) { append(to, value); }

std::string padded(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string paddedLeft(const std::string& text, size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

}  // namespace avbd::cli
