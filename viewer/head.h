// The JSON head of a page: all of a recording but its frames' poses, contacts and reactions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string_view>
#include <vector>

#include "io/record/recording.h"
#include "viewer/encode.h"

namespace avbd::page {

inline bool isFinite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Fields, one after the other.
class Head {
 public:
  explicit Head(std::ostream& out) : out_(out) { out_ << "{\"version\":1"; }
  void text(const char* name, std::string_view value) { out_ << ",\"" << name << "\":" << jsonText(value); }
  template <class T>
  void numbers(const char* name, const std::vector<T>& value) {
    out_ << ",\n\"" << name << "\":\"" << base64Of(value) << '"';
  }
  template <class List, class Print>
  void list(const char* name, const List& items, Print print) {
    out_ << ",\n\"" << name << "\":[";
    const char* comma = "";
    for (const auto& item : items) {
      out_ << comma;
      print(out_, item);
      comma = ",";
    }
    out_ << ']';
  }
  ~Head() { out_ << "}\n"; }

 private:
  std::ostream& out_;
};

void writeJoints(Head& head, const Recording& r);

/// Of each soft body where its points are over the recording; empty of a live page, which is sent floats.
using PlaceRanges = std::vector<std::array<Range, 3>>;
PlaceRanges placeRangesOf(const Recording& r);
void writeSofts(Head& head, const Recording& r, const PlaceRanges& ranges);
/// Places of all points at a frame. One that is not finite is where it was in `last`, which holds a place each.
void appendPlaces(Bytes& out, const Recording& r, const RecordedFrame& f, const PlaceRanges& ranges,
                  std::vector<Vec3d>& last);

/// Low and high corner of positions, those that are not finite left out.
struct Bounds {
  Vec3d low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(Vec3d p) {
    if (!isFinite(p)) return;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  std::array<Range, 3> ranges() const {
    return {rangeOf(low.x, high.x), rangeOf(low.y, high.y), rangeOf(low.z, high.z)};
  }
};

inline void append(std::vector<float>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }
inline void append(std::vector<float>& out, Quat q) { out.insert(out.end(), {q.w, q.x, q.y, q.z}); }
inline void append(std::vector<double>& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }

}  // namespace avbd::page
