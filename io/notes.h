// What a reader left out or changed: one line each, equal ones counted instead of repeated.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace avbd {

class Notes {
 public:
  /// `where` is that of the first time; notes are equal if `what` and `about` are.
  void add(const std::string& where, const std::string& what, std::string_view about = {}) {
    const auto [it, isNew] = byText_.try_emplace(std::string(about) + '\n' + what, lines_.size());
    if (!isNew) {
      ++lines_[it->second].more;
    } else if (lines_.size() < kMost) {
      lines_.push_back({where + ": " + what, 0});
    } else {
      byText_.erase(it);
      ++dropped_;
    }
  }

  std::vector<std::string> lines() const {
    std::vector<std::string> out;
    for (const Line& line : lines_) {
      out.push_back(line.more == 0 ? line.text : line.text + " (and " + std::to_string(line.more) + " more)");
    }
    if (dropped_ > 0) out.push_back(std::to_string(dropped_) + " further notes");
    return out;
  }

 private:
  static constexpr size_t kMost = 1000;  // beyond that nobody reads them, and a broken file could make millions
  struct Line {
    std::string text;
    size_t more;
  };
  std::vector<Line> lines_;
  std::unordered_map<std::string, size_t> byText_;
  size_t dropped_ = 0;
};

}  // namespace avbd
