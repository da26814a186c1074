// Names by edit distance.
#include "app/near_names.h"

#include <algorithm>
#include <numeric>

namespace avbd::cli {
namespace {

constexpr size_t kMost = 5;
constexpr size_t kLongest = 100;  // of a name worth comparing

size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<std::string> nearNames(std::string_view name, const std::vector<std::string>& names) {
  std::vector<std::pair<size_t, std::string>> ranked;
  if (name.empty() || name.size() > kLongest) return {};
  // Two swapped letters count as two changes.
  const size_t allowed = name.size() < 4 ? 1 : std::max<size_t>(2, name.size() / 3);
  for (const std::string& candidate : names) {
    const bool contained = candidate.find(name) != std::string::npos || name.find(candidate) != std::string_view::npos;
    const size_t distance = contained && candidate.size() > 2 ? 1 : editDistance(name, candidate);
    if (distance <= allowed) ranked.emplace_back(distance, candidate);
  }
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::min(ranked.size(), kMost));
  std::vector<std::string> out;
  for (auto& [distance, candidate] : ranked) out.push_back(std::move(candidate));
  return out;
}

std::string nearText(std::string_view name, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& candidate : nearNames(name, names)) text += (text.empty() ? " (near: " : ", ") + candidate;
  return text.empty() ? text : text + ")";
}

}  // namespace avbd::cli
