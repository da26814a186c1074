// Soft bodies: into a recording, and to fields and back.
#include "io/record/softs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/file_error.h"
#include "io/record/content.h"

namespace avbd {
namespace {

constexpr int kStepBits = 20;  // of the body's size

double stepOf(const std::vector<Vec3>& points) {
  float size = 0;
  for (const float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                                 [&](const Vec3& a, const Vec3& b) { return a.*axis < b.*axis; });
    if (low != points.end()) size = std::max(size, *high.*axis - *low.*axis);
  }
  return size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::ilogb(size) - kStepBits) : std::ldexp(1.0, -kStepBits);
}

[[noreturn]] void refuse(size_t soft, const char* field, const std::string& value, const std::string& range) {
  throw std::invalid_argument("Recording.softs[" + std::to_string(soft) + "]." + field + " = " + value + ": " + range);
}

void checkSoft(const Recording& r, size_t number, size_t body, size_t shape) {
  const RecordedSoft& soft = r.softs[number];
  const size_t balls = surfacePoints(soft).size();
  if (soft.firstBody != body || body + soft.points.size() > r.bodies.size())
    refuse(number, "firstBody", std::to_string(soft.firstBody),
           "its points must be bodies behind those before, " + std::to_string(body));
  if (soft.firstShape != shape || shape + balls > r.shapes.size())
    refuse(number, "firstShape", std::to_string(soft.firstShape),
           "its balls must be shapes behind those before, " + std::to_string(shape));
  if (!(soft.step > 0) || !std::isfinite(soft.step))
    refuse(number, "step", std::to_string(soft.step), "must be > 0 and finite");
  if (!(soft.radius >= 0) || !std::isfinite(soft.radius))
    refuse(number, "radius", std::to_string(soft.radius), "must be >= 0 and finite");
  for (const auto& face : soft.surface)
    for (const uint32_t point : face)
      if (point >= soft.points.size())
        refuse(number, "surface", std::to_string(point),
               "must be below the number of points, " + std::to_string(soft.points.size()));
}

}  // namespace

std::vector<uint32_t> surfacePoints(const RecordedSoft& soft) {
  std::vector<uint32_t> points;
  for (const auto& face : soft.surface) points.insert(points.end(), face.begin(), face.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

void appendSoft(Recording& r, RecordedSoft soft) {
  soft.firstBody = static_cast<uint32_t>(r.bodies.size());
  soft.firstShape = static_cast<uint32_t>(r.shapes.size());
  if (soft.step == 0) soft.step = stepOf(soft.points);
  for (size_t i = 0; i < soft.points.size(); ++i)
    r.bodies.push_back({soft.name + "_" + std::to_string(i), BodyType::Dynamic});
  for (const uint32_t point : surfacePoints(soft))
    r.shapes.push_back({soft.firstBody + point, Sphere{soft.radius}, {}, false, soft.color});
  r.softs.push_back(std::move(soft));
}

void checkSofts(const Recording& r) {
  if (r.softs.empty()) return;
  size_t body = r.softs[0].firstBody, shape = r.softs[0].firstShape;
  for (size_t i = 0; i < r.softs.size(); ++i) {
    checkSoft(r, i, body, shape);
    body += r.softs[i].points.size();
    shape += surfacePoints(r.softs[i]).size();
  }
  if (body != r.bodies.size() || shape != r.shapes.size())
    refuse(r.softs.size() - 1, "points", std::to_string(body),
           "soft bodies must hold the last bodies and shapes, of which there are " + std::to_string(r.bodies.size()) +
               " and " + std::to_string(r.shapes.size()));
}

const RecordedSoft* softOf(const Recording& r, uint32_t body) {
  const auto after = std::upper_bound(r.softs.begin(), r.softs.end(), body,
                                      [](uint32_t at, const RecordedSoft& soft) { return at < soft.firstBody; });
  if (after == r.softs.begin()) return nullptr;
  const RecordedSoft& soft = *(after - 1);
  return body - soft.firstBody < soft.points.size() ? &soft : nullptr;
}

namespace record {
namespace {

enum SoftField : uint16_t {
  kNames = 1,
  kCloth = 3,
  kPointCounts = 4,
  kPoints = 5,
  kFaceCounts = 6,
  kFaces = 7,
  kElements = 8,
  kRadius = 9,
  kStep = 10,
  kColor = 11,
};

size_t sum(const std::vector<uint32_t>& counts) {
  size_t total = 0;
  for (const uint32_t count : counts) total += count;
  return total;
}

/// A list for each field.
struct Columns {
  std::vector<std::string> names;
  std::vector<uint8_t> cloth;
  std::vector<uint32_t> pointCounts, faceCounts, faces, elements, colors;
  std::vector<float> points, radii;
  std::vector<double> steps;

  void add(const RecordedSoft& soft) {
    names.push_back(soft.name);
    cloth.push_back(soft.cloth ? 1 : 0);
    pointCounts.push_back(static_cast<uint32_t>(soft.points.size()));
    faceCounts.push_back(static_cast<uint32_t>(soft.surface.size()));
    for (const Vec3 p : soft.points) points.insert(points.end(), {p.x, p.y, p.z});
    for (const auto& face : soft.surface) faces.insert(faces.end(), face.begin(), face.end());
    elements.push_back(soft.elements);
    radii.push_back(soft.radius);
    steps.push_back(soft.step);
    colors.push_back(packedColor(soft.color));
  }

  /// Of one whose points and faces come behind these.
  RecordedSoft soft(size_t i, size_t point, size_t face) const {
    RecordedSoft out{names[i], !cloth.empty() && cloth[i] != 0};
    for (size_t k = 3 * point; k < 3 * (point + pointCounts[i]); k += 3)
      out.points.push_back({points[k], points[k + 1], points[k + 2]});
    for (size_t k = 3 * face; k < 3 * (face + faceCounts[i]); k += 3)
      out.surface.push_back({faces[k], faces[k + 1], faces[k + 2]});
    out.elements = elements.empty() ? 0 : elements[i];
    out.radius = radii[i];
    out.step = steps[i];
    if (!colors.empty()) out.color = unpackedColor(colors[i]);
    return out;
  }
};

Columns columnsOf(const FieldReader& f) {
  Columns c;
  c.names = f.texts(kNames);
  const size_t n = c.names.size();
  c.cloth = f.listOf<uint8_t>(kCloth, n);
  c.pointCounts = f.listOf<uint32_t>(kPointCounts, n);
  c.faceCounts = f.listOf<uint32_t>(kFaceCounts, n);
  c.points = f.listOf<float>(kPoints, 3 * sum(c.pointCounts));
  c.faces = f.listOf<uint32_t>(kFaces, 3 * sum(c.faceCounts));
  c.elements = f.listOf<uint32_t>(kElements, n);
  c.radii = f.listOf<float>(kRadius, n);
  c.steps = f.listOf<double>(kStep, n);
  c.colors = f.listOf<uint32_t>(kColor, n);
  if (n > 0 && (c.pointCounts.empty() || c.faceCounts.empty() || c.radii.empty() || c.steps.empty()))
    f.refuse(kNames, "stands alone");
  if (c.points.size() != 3 * sum(c.pointCounts)) f.refuse(kPoints, "is missing");
  if (c.faces.size() != 3 * sum(c.faceCounts)) f.refuse(kFaces, "is missing");
  for (const float radius : c.radii)
    if (!(radius >= 0) || !std::isfinite(radius)) f.refuse(kRadius, "holds what is no radius");
  for (const double step : c.steps)
    if (!(step > 0) || !std::isfinite(step)) f.refuse(kStep, "holds what is no step");
  return c;
}

}  // namespace

int64_t stepsOf(double x, double step) {
  constexpr double kMost = 4611686018427387904.0;
  const double steps = std::nearbyint(x / step);
  return std::isnan(steps) ? 0 : static_cast<int64_t>(std::clamp(steps, -kMost, kMost));
}

namespace {

// What the frames before let expect of number i.
uint64_t expectedOf(const std::vector<int64_t>& places, size_t i, size_t each) {
  if (i < each) return 0;
  const auto last = static_cast<uint64_t>(places[i - each]);
  return i < 2 * each ? last : 2 * last - static_cast<uint64_t>(places[i - 2 * each]);
}

}  // namespace

std::vector<int64_t> secondDifferences(const std::vector<int64_t>& places, size_t each) {
  std::vector<int64_t> out(places.size());
  for (size_t i = 0; i < places.size(); ++i)
    out[i] = static_cast<int64_t>(static_cast<uint64_t>(places[i]) - expectedOf(places, i, each));
  return out;
}

std::vector<int64_t> sumsOf(std::vector<int64_t> all, size_t each) {
  for (size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<int64_t>(static_cast<uint64_t>(all[i]) + expectedOf(all, i, each));
  return all;
}

Bytes softsContent(const Recording& r) {
  Columns c;
  for (const RecordedSoft& soft : r.softs) c.add(soft);
  FieldWriter out;
  out.texts(kNames, c.names);
  out.list(kCloth, c.cloth);
  out.list(kPointCounts, c.pointCounts);
  out.list(kPoints, c.points, Encoding::Shuffled);
  out.list(kFaceCounts, c.faceCounts);
  out.list(kFaces, c.faces, Encoding::Delta, 3);
  out.list(kElements, c.elements);
  out.list(kRadius, c.radii);
  out.list(kStep, c.steps);
  if (std::any_of(c.colors.begin(), c.colors.end(), [](uint32_t color) { return color != 0; }))
    out.list(kColor, c.colors);
  return out.bytes();
}

void HeadReader::takeSofts(const FieldReader& f) {
  if (f.count(kPoints) / 3 + recording.bodies.size() > thingsMost || f.count(kNames) > thingsMost)
    f.refuse(kPoints, "has more elements than a file of this size may hold");
  const Columns c = columnsOf(f);
  size_t point = 0, face = 0;
  for (size_t i = 0; i < c.names.size(); ++i) {
    for (size_t k = 3 * face; k < 3 * (face + c.faceCounts[i]); ++k)
      if (c.faces[k] >= c.pointCounts[i]) f.refuse(kFaces, "names a point that there is not");
    appendSoft(recording, c.soft(i, point, face));
    point += c.pointCounts[i];
    face += c.faceCounts[i];
  }
}

}  // namespace record
}  // namespace avbd
