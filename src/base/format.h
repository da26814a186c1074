// Values as text for error messages: the shortest text that reads back as the same number.
#pragma once

#include <avbd/id.h>
#include <avbd/types.h>

#include <concepts>
#include <string>

namespace avbd {

std::string toText(float value);   ///< "0.1", "1e+30", "nan", "inf", "-inf"
std::string toText(double value);  ///< as above
template <std::integral T>
std::string toText(T value) {
  return std::to_string(value);
}
inline std::string toText(bool value) { return value ? "true" : "false"; }
std::string toText(Vec3 value);            ///< "(1, 2.5, nan)"
std::string toText(Vec3d value);           ///< as above
std::string toText(Quat value);            ///< "(w, x, y, z)"
std::string toText(const SymMat3& value);  ///< "(xx, yy, zz, xy, xz, yz)"
template <class Tag>
std::string toText(Id<Tag> id) {  ///< "null" or "3 (generation 2)"
  return id ? toText(id.index) + " (generation " + toText(id.generation) + ")" : std::string("null");
}

}  // namespace avbd
