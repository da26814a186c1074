// How the page's data is stored; src/recording.js reads it.
#include "viewer/encode.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace avbd::page {

namespace {

void append(Bytes& out, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

int8_t toSignedByte(float unit) { return static_cast<int8_t>(std::lround(std::clamp(unit, -1.0f, 1.0f) * 127)); }

}  // namespace

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = bytes.size() - i;
    const uint32_t group = bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    out += kDigits[group >> 18];
    out += kDigits[group >> 12 & 63];
    out += left > 1 ? kDigits[group >> 6 & 63] : '=';
    out += left > 2 ? kDigits[group & 63] : '=';
  }
  return out;
}

std::string jsonText(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<uint8_t>(c);
    // '<' would let a name close the script element that holds the data.
    if (byte < 0x20 || byte == 0x7f || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&') {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string htmlText(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += static_cast<uint8_t>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

Range rangeOf(double low, double high) {
  if (!(low <= high)) return {};
  return {low, (high - low) / kRangeSteps};
}

uint32_t quantise(const Range& range, double value) {
  if (!(range.step > 0)) return 0;
  const double steps = std::round((value - range.low) / range.step);
  if (!(steps > 0)) return 0;  // also NaN
  return steps < kRangeSteps ? static_cast<uint32_t>(steps) : kRangeSteps;
}

uint64_t packRotation(Quat q) {
  float c[4] = {q.w, q.x, q.y, q.z};
  float squared = 0;
  for (const float v : c) squared += v * v;
  if (!(squared > 1e-12f) || !std::isfinite(squared)) {
    c[0] = 1;
    c[1] = c[2] = c[3] = 0;
    squared = 1;
  }
  int largest = 0;
  for (int i = 1; i < 4; ++i) {
    if (std::fabs(c[i]) > std::fabs(c[largest])) largest = i;
  }
  // q and -q are one rotation: with the largest positive, the reader finds it from the other three.
  const float scale = (c[largest] < 0 ? -1.0f : 1.0f) / std::sqrt(squared);
  uint64_t packed = static_cast<uint64_t>(largest);
  for (int i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const float unit = std::clamp(c[i] * scale * 1.41421356f, -1.0f, 1.0f);
    packed = packed << 15 | static_cast<uint64_t>(std::lround((unit + 1) * 16383));
  }
  return packed;
}

void appendPlace(Bytes& out, const Range range[3], Vec3d p) {
  append(out, quantise(range[0], p.x), 3);
  append(out, quantise(range[1], p.y), 3);
  append(out, quantise(range[2], p.z), 3);
}

void appendPose(Bytes& out, const Range range[3], const Pose& pose) {
  appendPlace(out, range, pose.position);
  append(out, packRotation(pose.rotation), 6);
}

uint16_t packMagnitude(float value) {
  if (!(value > 0)) return 0;
  const float code = std::round((std::log2(std::min(value, 1e13f)) + 20) * 1024) + 1;
  return static_cast<uint16_t>(std::clamp(code, 1.0f, 65534.0f));
}

namespace {

void appendForce(Bytes& out, Vec3 force) {
  float size = length(force);
  if (!std::isfinite(size)) size = 0;
  // Octahedral direction: the sphere unfolded onto a square.
  const float sum = std::fabs(force.x) + std::fabs(force.y) + std::fabs(force.z);
  float u = size > 0 ? force.x / sum : 0, v = size > 0 ? force.y / sum : 0;
  if (size > 0 && force.z < 0) {
    const float foldedU = (1 - std::fabs(v)) * (u < 0 ? -1.0f : 1.0f);
    v = (1 - std::fabs(u)) * (v < 0 ? -1.0f : 1.0f);
    u = foldedU;
  }
  out.push_back(static_cast<uint8_t>(toSignedByte(u)));
  out.push_back(static_cast<uint8_t>(toSignedByte(v)));
  append(out, packMagnitude(size), 2);
}

}  // namespace

void appendContact(Bytes& out, const Range range[3], Vec3d position, Vec3 force) {
  appendPlace(out, range, position);
  appendForce(out, force);
}

void appendJoint(Bytes& out, Vec3 force, bool enabled) {
  if (enabled) return appendForce(out, force);
  append(out, 0, 2);
  append(out, kJointOff, 2);
}

void appendFloat(Bytes& out, float value) { append(out, std::bit_cast<uint32_t>(value), 4); }

}  // namespace avbd::page
