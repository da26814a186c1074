// Soft bodies as the page takes them: surfaces in the head, places of their points in the frames.
#include "io/record/softs.h"
#include "viewer/head.h"

namespace avbd::page {
namespace {

void writeSoft(std::ostream& out, const RecordedSoft& soft, const std::array<Range, 3>* range) {
  std::vector<float> points;
  std::vector<uint32_t> corners;
  for (const Vec3 p : soft.points) append(points, p);
  for (const auto& face : soft.surface) corners.insert(corners.end(), face.begin(), face.end());
  out << "{\"name\":" << jsonText(soft.name) << ",\"cloth\":" << (soft.cloth ? "true" : "false")
      << ",\"elements\":" << soft.elements << ",\"radius\":\"" << base64Of(std::vector<float>{soft.radius})
      << "\",\"points\":\"" << base64Of(points) << "\",\"surface\":\"" << base64Of(corners) << '"';
  if (const auto& c = soft.color) out << ",\"color\":[" << +c->red << ',' << +c->green << ',' << +c->blue << ']';
  if (range) {
    std::vector<double> numbers;
    for (const Range& axis : *range) numbers.insert(numbers.end(), {axis.low, axis.step});
    out << ",\"range\":\"" << base64Of(numbers) << '"';
  }
  out << '}';
}

}  // namespace

PlaceRanges placeRangesOf(const Recording& r) {
  PlaceRanges ranges;
  for (const RecordedSoft& soft : r.softs) {
    Bounds bounds;
    for (const RecordedFrame& f : r.frames)
      for (size_t i = 0; i < soft.points.size(); ++i) bounds.add(f.poses[soft.firstBody + i].position);
    ranges.push_back(bounds.ranges());
  }
  return ranges;
}

void writeSofts(Head& head, const Recording& r, const PlaceRanges& ranges) {
  if (r.softs.empty()) return;
  size_t number = 0;
  head.list("softs", r.softs, [&](std::ostream& out, const RecordedSoft& soft) {
    writeSoft(out, soft, ranges.empty() ? nullptr : &ranges[number++]);
  });
}

void appendPlaces(Bytes& out, const Recording& r, const RecordedFrame& f, const PlaceRanges& ranges,
                  std::vector<Vec3d>& last) {
  size_t point = 0;
  for (size_t s = 0; s < r.softs.size(); ++s) {
    const RecordedSoft& soft = r.softs[s];
    for (size_t i = 0; i < soft.points.size(); ++i, ++point) {
      const Vec3d place = f.poses[soft.firstBody + i].position;
      if (isFinite(place)) last[point] = place;
      appendPlace(out, ranges[s].data(), last[point]);
    }
  }
}

}  // namespace avbd::page
