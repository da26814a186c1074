// How the page's data is stored: base64, JSON and HTML text, and poses and contacts in a few bytes.
#pragma once

#include <avbd/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace avbd::page {

using Bytes = std::vector<uint8_t>;

std::string base64(std::span<const uint8_t> bytes);
/// Base64 of numbers as they lie in memory, little endian.
template <class T>
std::string base64Of(const std::vector<T>& numbers) {
  return base64({reinterpret_cast<const uint8_t*>(numbers.data()), numbers.size() * sizeof(T)});
}

/// A JSON string with its quotes; no character of it can end a script element.
std::string jsonText(std::string_view text);
/// Text for an HTML element or attribute.
std::string htmlText(std::string_view text);

/// The span of one coordinate over a recording, cut into 2^24 - 1 steps.
struct Range {
  double low = 0, step = 0;
};
constexpr uint32_t kRangeSteps = (1u << 24) - 1;
/// low > high gives a range of one point at zero.
Range rangeOf(double low, double high);
uint32_t quantise(const Range& range, double value);

/// Bytes of a place: three times 24 bits.
constexpr size_t kPlaceBytes = 9;
void appendPlace(Bytes& out, const Range range[3], Vec3d place);
/// Bytes of a pose: three times 24 bits, then the rotation's three smaller components in 15 bits each.
constexpr size_t kPoseBytes = 15;
uint64_t packRotation(Quat q);
void appendPose(Bytes& out, const Range range[3], const Pose& pose);

/// Bytes of a contact: three times 24 bits, direction of the force in two, its size in two.
constexpr size_t kContactBytes = 13;
/// Logarithmic: 0, or 2^((code - 1) / 1024 - 20); below kJointOff.
uint16_t packMagnitude(float value);
void appendContact(Bytes& out, const Range range[3], Vec3d position, Vec3 force);

/// Bytes of what a joint did: direction of the force on B in two, its size in two, or kJointOff.
constexpr size_t kJointBytes = 4;
constexpr uint16_t kJointOff = 65535;
void appendJoint(Bytes& out, Vec3 force, bool enabled);
void appendFloat(Bytes& out, float value);  ///< as it lies in memory, little endian

}  // namespace avbd::page
