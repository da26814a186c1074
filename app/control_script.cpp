// What actuators are given over time.
#include "app/control_script.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/near_names.h"
#include "app/number_text.h"
#include "io/file_error.h"

namespace avbd::cli {
namespace {

constexpr uintmax_t kMostBytes = 64 << 20;
constexpr const char* kColumns[] = {"time", "actuator", "value"};
constexpr const char* kHeader = "time,actuator,value";

std::string_view trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

class ControlParser {
 public:
  ControlParser(const std::string& name, const std::vector<Actuator>& actuators) : name_(name), actuators_(actuators) {
    for (const Actuator& actuator : actuators) names_.push_back(actuator.name);
  }
  std::vector<ControlRow> parse(std::string_view text);

 private:
  std::vector<std::string> fieldsOf(std::string_view line) const;
  ControlRow rowOf(const std::vector<std::string>& fields) const;
  size_t actuatorOf(const std::string& field) const;
  double numberOf(const std::string& field, size_t column) const;
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(name_ + ":" + std::to_string(line_) + ": " + message, name_, line_);
  }
  [[noreturn]] void fail(size_t column, const std::string& field, const std::string& range) const {
    fail("column " + std::to_string(column + 1) + " (" + kColumns[column] + ") = \"" + field.substr(0, 100) +
         "\": " + range);
  }

  const std::string& name_;
  const std::vector<Actuator>& actuators_;
  std::vector<std::string> names_;
  int line_ = 0;
};

std::vector<std::string> ControlParser::fieldsOf(std::string_view line) const {
  std::vector<std::string> out;
  for (;;) {
    line = trimmed(line);
    std::string field;
    if (line.starts_with('"')) {
      size_t at = 1;
      for (; at < line.size(); ++at) {
        if (line[at] != '"') {
          field += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          field += line[at++];
        } else {
          break;
        }
      }
      if (at == line.size()) fail("column " + std::to_string(out.size() + 1) + ": a quote without an end");
      line = trimmed(line.substr(at + 1));
      if (!line.empty() && line[0] != ',') {
        fail("column " + std::to_string(out.size() + 1) + ": text after a quote: must be a comma");
      }
    } else {
      const size_t comma = std::min(line.find(','), line.size());
      field = trimmed(line.substr(0, comma));
      line.remove_prefix(comma);
    }
    out.push_back(std::move(field));
    if (line.empty()) return out;
    line.remove_prefix(1);
  }
}

double ControlParser::numberOf(const std::string& field, size_t column) const {
  double value = 0;
  const char* begin = field.data() + (field.starts_with('+') ? 1 : 0);
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) fail(column, field, "must be a finite number");
  return value;
}

size_t ControlParser::actuatorOf(const std::string& field) const {
  for (size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == field) return i;
  }
  size_t index = 0;
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, index);
  const bool isIndex = !field.empty() && stop == end && error == std::errc();
  if (isIndex && index < names_.size()) return index;
  const std::string there = std::to_string(names_.size()) + (names_.size() == 1 ? " actuator" : " actuators");
  if (isIndex) fail(1, field, "there are " + there + ", numbered from 0");
  fail(1, field, "must name one of the " + there + nearText(field, names_) + "; `avbd info FILE` lists them");
}

ControlRow ControlParser::rowOf(const std::vector<std::string>& fields) const {
  if (fields.size() != std::size(kColumns)) {
    fail(std::to_string(fields.size()) + (fields.size() == 1 ? " column" : " columns") + ": must be 3, " + kHeader);
  }
  ControlRow row;
  row.line = line_;
  row.time = numberOf(fields[0], 0);
  if (row.time < 0) fail(0, fields[0], "must be finite and >= 0");
  row.actuator = actuatorOf(fields[1]);
  row.value = numberOf(fields[2], 2);
  return row;
}

std::vector<ControlRow> ControlParser::parse(std::string_view text) {
  std::vector<ControlRow> rows;
  bool isFirst = true;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_;
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> fields = fieldsOf(line);
    const bool isHeader = isFirst && fields[0] == kColumns[0];
    isFirst = false;
    if (isHeader) {
      if (!std::equal(fields.begin(), fields.end(), std::begin(kColumns), std::end(kColumns))) {
        fail("the header must be " + std::string(kHeader));
      }
      continue;
    }
    rows.push_back(rowOf(fields));
    if (rows.size() < 2) continue;
    const ControlRow& before = rows[rows.size() - 2];
    if (rows.back().time >= before.time) continue;
    fail(0, fields[0], "must not be less than " + digits(before.time, 12) + " of line " + std::to_string(before.line));
  }
  return rows;
}

}  // namespace

void ControlScript::apply(Model& model, double time, double dt) {
  // 0.1 s is a whole number of steps of 1/60 s, but not in binary.
  const double due = time + 1e-6 * dt;
  for (; next_ < rows_.size() && rows_[next_].time <= due; ++next_) {
    const ControlRow& row = rows_[next_];
    try {
      setControl(model, row.actuator, row.value);
    } catch (const Error& error) {
      throw FileError(
          file_ + ":" + std::to_string(row.line) + ": column 3 (value) = " + digits(row.value, 9) + ": " + error.what(),
          file_, row.line);
    }
  }
}

ControlScript parseControlScript(std::string_view text, const std::string& name,
                                 const std::vector<Actuator>& actuators) {
  return {name, ControlParser(name, actuators).parse(text)};
}

ControlScript readControlScript(const std::string& file, const std::vector<Actuator>& actuators) {
  const auto refuse = [&](const std::string& message) { throw FileError("--control " + file + ": " + message, file); };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse("no such file");
  if (!std::filesystem::is_regular_file(file, error)) refuse("not a regular file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) refuse("cannot be read");
  if (size > kMostBytes) refuse("larger than " + std::to_string(kMostBytes >> 20) + " MiB");
  if (actuators.empty()) refuse("there are no actuators to control");
  std::string text(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in && size > 0) refuse("cannot be read");
  return parseControlScript(text, file, actuators);
}

}  // namespace avbd::cli
