// Attributes of an MJCF element: numbers, keywords, flags.
#include "io/mjcf_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace avbd::mjcf {

namespace {

constexpr std::string_view kSpace = " \t\r\n";

// Beyond this nothing physical is meant, and squares and cubes of the numbers would leave the range of float.
constexpr double kMostMagnitude = 1e15;

const char* readNumber(std::string_view token, double& out) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), out);
  if (end != token.data() + token.size() || error == std::errc::invalid_argument) return "is not a number";
  if (error != std::errc() || !std::isfinite(out)) return "must be finite: 0, or from 1e-300 to 1e15 in magnitude";
  return std::abs(out) <= kMostMagnitude ? nullptr : "must be at most 1e15 in magnitude";
}

std::string countText(size_t least, size_t most) {
  if (least == most) return std::to_string(least) + (least == 1 ? " number" : " numbers");
  return std::to_string(least) + " to " + std::to_string(most) + " numbers";
}

}  // namespace

bool readNumbers(std::string_view text, size_t most, std::vector<double>& out, NumberFault& fault) {
  for (;;) {
    const size_t start = text.find_first_not_of(kSpace);
    if (start == std::string_view::npos) return true;
    const size_t end = std::min(text.find_first_of(kSpace, start), text.size());
    const std::string_view token = text.substr(start, end - start);
    double value = 0;
    fault = {token, out.size() == most ? "is one number too many" : readNumber(token, value)};
    if (fault.reason) return false;
    out.push_back(value);
    text.remove_prefix(end);
  }
}

const Attr* Attributes::find(std::string_view name) const {
  for (const Attr& attr : attrs_) {
    if (attr.name == name) return &attr;
  }
  return nullptr;
}

void Attributes::fail(std::string_view name, const std::string& range) const {
  const Attr* attr = find(name);
  if (!attr) source_.fail(elem_, std::string(name) + " is missing: " + range);
  source_.fail(attr->from, name, attr->value, range);
}

std::vector<double> Attributes::numbers(std::string_view name, size_t least, size_t most) const {
  std::vector<double> out;
  const Attr* attr = find(name);
  if (!attr) return out;
  NumberFault fault;
  if (!readNumbers(attr->value, most, out, fault)) {
    const bool many = out.size() == most;
    fail(name, many ? "must be " + countText(least, most) : quoted(fault.token) + " " + fault.reason);
  }
  if (out.size() < least) fail(name, "must be " + countText(least, most));
  return out;
}

double Attributes::number(std::string_view name, double otherwise) const {
  const std::vector<double> values = numbers(name, 1, 1);
  return values.empty() ? otherwise : values[0];
}

int Attributes::integer(std::string_view name, int otherwise) const {
  const std::vector<double> values = numbers(name, 1, 1);
  if (values.empty()) return otherwise;
  // Bit masks are often written as unsigned 32 bit numbers.
  if (values[0] != std::floor(values[0]) || values[0] < -2147483648.0 || values[0] > 4294967295.0) {
    fail(name, "must be a whole number of 32 bits");
  }
  return static_cast<int>(static_cast<int64_t>(values[0]));
}

std::string Attributes::text(std::string_view name) const {
  const Attr* attr = find(name);
  return attr ? std::string(attr->value) : std::string();
}

std::string Attributes::requiredText(std::string_view name) const {
  std::string out = text(name);
  if (out.empty()) fail(name, "must be given");
  return out;
}

bool Attributes::flag(std::string_view name, bool otherwise) const {
  return keyword(name, {"false", "true"}, otherwise ? 1 : 0) == 1;
}

bool Attributes::enabled(std::string_view name) const { return keyword(name, {"disable", "enable"}, 1) == 1; }

int Attributes::keyword(std::string_view name, const std::vector<std::string_view>& words, int otherwise) const {
  const Attr* attr = find(name);
  if (!attr) return otherwise;
  std::string list;
  for (size_t i = 0; i < words.size(); ++i) {
    if (attr->value == words[i]) return static_cast<int>(i);
    list += (i == 0 ? "" : ", ") + std::string(words[i]);
  }
  fail(name, "must be one of " + list);
}

}  // namespace avbd::mjcf
