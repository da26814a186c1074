// What the user may have meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace avbd::cli {

/// At most five of `names` that begin with or contain `name` or differ from it in few letters, nearest first.
std::vector<std::string> nearNames(std::string_view name, const std::vector<std::string>& names);
/// " (near: a, b)", or "" where nothing is near.
std::string nearText(std::string_view name, const std::vector<std::string>& names);

}  // namespace avbd::cli
