// Escapes and numbers, in any locale the same.
#include "io/record/json.h"

#include <charconv>
#include <cmath>

namespace avbd::record {
namespace {

/// Length of the UTF-8 sequence at `at`, or 0 if there is none (RFC 3629).
size_t sequence(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const size_t length = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                        : first < 0xf5 ? 4
                                       : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  if (length < 3) return length;
  const unsigned char second = byte(at + 1);
  const bool bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                   (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  return bad ? 0 : length;
}

template <class T>
std::string shortest(T value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

}  // namespace

std::string jsonText(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    const size_t length = sequence(text, at);
    if (length == 0) {
      out += "\\ufffd";
      ++at;
      continue;
    }
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out += std::string("\\u00") + kHex[c >> 4] + kHex[c & 15];
    else
      out += text.substr(at, length);
    at += length;
  }
  return out + '"';
}

std::string jsonNumber(double value) { return shortest(value); }
std::string jsonNumber(float value) { return shortest(value); }

std::string jsonList(Vec3 v) {
  std::string out = "[";
  for (const float x : {v.x, v.y, v.z}) out.append(out.size() > 1 ? "," : "").append(jsonNumber(x));
  return out.append("]");
}
std::string jsonList(Vec3d v) {
  std::string out = "[";
  for (const double x : {v.x, v.y, v.z}) out.append(out.size() > 1 ? "," : "").append(jsonNumber(x));
  return out.append("]");
}

std::string jsonObject(Vec3d v) {
  std::string out = "{\"x\":";
  out.append(jsonNumber(v.x)).append(",\"y\":").append(jsonNumber(v.y)).append(",\"z\":").append(jsonNumber(v.z));
  return out.append("}");
}
std::string jsonObject(Quat q) {
  // Of the floats themselves: as doubles they would have more digits.
  std::string out = "{\"x\":";
  out.append(jsonNumber(q.x)).append(",\"y\":").append(jsonNumber(q.y)).append(",\"z\":").append(jsonNumber(q.z));
  return out.append(",\"w\":").append(jsonNumber(q.w)).append("}");
}

std::string_view geometryName(const Geometry& geometry) {
  constexpr std::string_view kNames[] = {"sphere", "capsule",   "box",  "half_space", "cylinder",
                                         "cone",   "ellipsoid", "hull", "mesh",       "height_field"};
  return kNames[geometry.index()];
}

std::string_view bodyTypeName(BodyType type) {
  return type == BodyType::Static ? "static" : type == BodyType::Kinematic ? "kinematic" : "dynamic";
}

std::string_view jointTypeName(JointType type) {
  constexpr std::string_view kNames[] = {"ball", "fixed",    "tet_volume", "hinge",    "slider",
                                         "d6",   "distance", "pulley",     "coupling", "custom"};
  const auto i = static_cast<size_t>(type);
  return i < std::size(kNames) ? kNames[i] : "unknown";
}

std::string_view eventName(RecordedEventKind kind) {
  constexpr std::string_view kNames[] = {"touch_begin", "touch_end", "trigger_enter", "trigger_leave", "hit"};
  const auto i = static_cast<size_t>(kind);
  return i < std::size(kNames) ? kNames[i] : "unknown";
}

}  // namespace avbd::record
