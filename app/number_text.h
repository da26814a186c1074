// Numbers as text, in any locale the same.
#pragma once

#include <string>

namespace avbd::cli {

/// With so many significant digits, without trailing zeros: "0.25", "1.2e-05".
std::string digits(double value, int significant);
/// The shortest text that reads back as the same number.
void appendExact(std::string& to, double value);
void appendExact(std::string& to, float value);

/// Padded with spaces to this width; longer text stays whole.
std::string padded(const std::string& text, size_t width);
std::string paddedLeft(const std::string& text, size_t width);

}  // namespace avbd::cli
