// JSON text, a piece at a time.
#pragma once

#include <string>
#include <string_view>

#include "io/record/recording.h"

namespace avbd::record {

/// With quotes. Bytes that are no UTF-8 become the replacement character.
std::string jsonText(std::string_view text);
/// The shortest text that reads back as the same number; null for what is not finite.
std::string jsonNumber(double value);
std::string jsonNumber(float value);
/// [x,y,z]
std::string jsonList(Vec3 v);
std::string jsonList(Vec3d v);
/// {"x":..,"y":..,"z":..}; {"x":..,"y":..,"z":..,"w":..}
std::string jsonObject(Vec3d v);
std::string jsonObject(Quat q);

std::string_view geometryName(const Geometry& geometry);
std::string_view bodyTypeName(BodyType type);
std::string_view jointTypeName(JointType type);
std::string_view eventName(RecordedEventKind kind);

}  // namespace avbd::record
