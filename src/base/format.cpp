// Numbers and vectors as text (format.h).
#include "base/format.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

namespace avbd {
namespace {

template <class Real>
std::string shortest(Real value) {
  // A NaN's sign depends on the processor that made it; the text must not.
  if (value != value) return "nan";
  char buffer[32];
#ifdef __cpp_lib_to_chars
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
#else  // libc++ 14 and older: of integers only
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(buffer, sizeof(buffer), "%.*g", digits, static_cast<double>(value));
    if (static_cast<Real>(std::strtod(buffer, nullptr)) == value) break;
  }
  return buffer;
#endif
}

template <class Real>
std::string list(std::initializer_list<Real> values) {
  std::string text = "(";
  for (const Real value : values) {
    if (text.size() > 1) text += ", ";
    text += shortest(value);
  }
  return text + ")";
}

}  // namespace

std::string toText(float value) { return shortest(value); }
std::string toText(double value) { return shortest(value); }
std::string toText(Vec3 v) { return list({v.x, v.y, v.z}); }
std::string toText(Vec3d v) { return list({v.x, v.y, v.z}); }
std::string toText(Quat q) { return list({q.w, q.x, q.y, q.z}); }
std::string toText(const SymMat3& m) { return list({m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}); }

}  // namespace avbd
