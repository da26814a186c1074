// Hulls of arbitrary points: refused by name, or closed, convex and around all points.
#include <avbd/error.h>
#include <avbd/hull.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "fuzz/bytes.h"
#include "fuzz/check.h"

namespace avbd::fuzz {
namespace {

Vec3 point(Bytes& in, uint32_t kind) {
  if (kind == 0) return in.vector();
  if (kind == 1) return {in.raw<float>(), in.raw<float>(), in.raw<float>()};
  const auto cell = [&] { return static_cast<float>(static_cast<int8_t>(in.byte()) / 32); };  // coplanar ones abound
  const Vec3 p{cell(), cell(), cell()};
  return kind == 2 ? p : p * 1e-3f + Vec3{100, -50, 25};
}

void checkClosed(const HullData& hull) {
  std::map<std::pair<int, int>, int> sides;
  size_t corners = 0;
  for (const HullData::Face& f : hull.faces()) {
    require(f.count >= 3, "a face of fewer than three corners");
    for (int i = 0; i < f.count; ++i) {
      const uint8_t a = hull.loops()[f.first + static_cast<size_t>(i)];
      const uint8_t b = hull.loops()[f.first + static_cast<size_t>((i + 1) % f.count)];
      require(a < hull.vertices().size() && b < hull.vertices().size() && a != b, "an edge without two ends");
      require(++sides[{a, b}] == 1, "an edge twice in one direction");
      ++corners;
    }
  }
  for (const auto& [edge, count] : sides) require(sides.count({edge.second, edge.first}) == 1, "a hole");
  require(corners == 2 * hull.edges().size(), "edges and loops disagree");
  require(hull.vertices().size() + hull.faces().size() == hull.edges().size() + 2, "Euler's count");
}

double largest(Vec3 v) { return std::max({std::fabs(double(v.x)), std::fabs(double(v.y)), std::fabs(double(v.z))}); }

/// What a float's rounding of plane offsets may come to (src/geom/hull_builder.h).
double roundingOf(const HullData& hull) { return 0x1p-22 * std::max(largest(hull.lower()), largest(hull.upper())); }

/// Height over a face's plane.
double above(const HullData::Face& f, Vec3 p) { return dot(toDouble(f.normal), toDouble(p)) - double(f.offset); }

/// Corners hold something up, are given points, and lie where the planes and bounds say.
void checkConvex(const HullData& hull, const std::vector<Vec3>& points, double tolerance) {
  const double rounding = roundingOf(hull);
  Vec3 lower = hull.vertices()[0], upper = lower;
  for (int i = 0; i < static_cast<int>(hull.vertices().size()); ++i) {
    const Vec3 v = hull.vertices()[static_cast<size_t>(i)];
    require(std::find(points.begin(), points.end(), v) != points.end(), "a vertex that was not given");
    lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
    upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
    const auto next = hull.neighbors(i);
    require(next.size() >= 3, "a vertex that holds nothing up");
    require(std::adjacent_find(next.begin(), next.end(), std::greater_equal<>()) == next.end(),
            "neighbours in disorder");
  }
  require(lower == hull.lower() && upper == hull.upper(), "bounds of something else");
  for (const HullData::Face& f : hull.faces()) {
    require(std::fabs(length(f.normal) - 1) < 1e-5f, "a normal that is not unit");
    for (const Vec3 v : hull.vertices()) require(above(f, v) <= rounding, "a vertex outside a face");
    for (int i = 0; i < f.count; ++i) {
      const Vec3 v = hull.vertices()[hull.loops()[f.first + static_cast<size_t>(i)]];
      require(above(f, v) >= -tolerance / 4 - rounding, "a corner far below its face");
    }
    require(above(f, hull.center()) <= rounding - double(hull.innerRadius()), "an inner ball that looks out");
  }
  require(hull.innerRadius() > 0, "no room inside");
  require(hull.massProperties(1).mass > 0, "no volume");
}

/// `limited`: the limit on vertices may have made the error larger than the tolerance.
void checkAround(const HullData& hull, const std::vector<Vec3>& points, double tolerance, bool limited) {
  double far = roundingOf(hull);
  for (const Vec3 p : points) far = std::max(far, 0x1p-22 * largest(p));
  require(limited || hull.error() <= tolerance * (1 + 1e-6) + far, "an error beyond the tolerance");
  for (const HullData::Face& f : hull.faces())
    for (const Vec3 p : points)
      require(above(f, p) <= double(hull.error()) * (1 + 1e-6) + 2 * far, "a point outside by more than the error");
}

/// Neither the order of the points nor a doubling of all lengths makes another hull.
void checkLaws(const HullData& hull, const HullDef& def) {
  std::vector<Vec3> points(def.points.rbegin(), def.points.rend());
  HullDef other = def;
  other.points = points;
  require(makeHull(other)->contentHash() == hull.contentHash(), "another order, another hull");
  bool exact = true;  // doubled, nothing may come near the bounds of numbers
  for (Vec3& p : points)
    for (float* x : {&p.x, &p.y, &p.z}) {
      exact = exact && (*x == 0 || (std::fabs(*x) > 1e-20f && std::fabs(*x) < 4e5f));
      *x *= 2;
    }
  if (!exact || def.tolerance > 4e5f) return;
  other.tolerance *= 2;
  const auto doubled = makeHull(other);
  require(doubled->vertices().size() == hull.vertices().size(), "a doubled hull of another number of vertices");
  for (size_t i = 0; i < hull.vertices().size(); ++i)
    require(doubled->vertices()[i] == hull.vertices()[i] * 2, "a doubled hull of other vertices");
}

}  // namespace
}  // namespace avbd::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace avbd;
  fuzz::Bytes in(data, size);
  const uint32_t kind = in.below(4);
  HullDef def;
  def.maxVertices = in.flag() ? 64 : static_cast<int>(in.byte());
  def.tolerance = in.flag() ? 0 : in.number() * 0.01f;
  std::vector<Vec3> points;
  while (!in.empty() && points.size() < 400) points.push_back(fuzz::point(in, kind));
  def.points = points;
  std::shared_ptr<const HullData> hull;
  try {
    hull = makeHull(def);
  } catch (const Error&) {
    return 0;
  }
  fuzz::require(def.maxVertices >= 4 && hull->vertices().size() <= static_cast<size_t>(def.maxVertices),
                "too many vertices");
  const Vec3 span = hull->upper() - hull->lower();
  const double extent = std::max({double(span.x), double(span.y), double(span.z)}) + 2 * double(hull->error());
  const double tolerance = std::max(def.tolerance > 0 ? double(def.tolerance) : 1e-4 * extent, 1e-9 * extent);
  fuzz::checkClosed(*hull);
  fuzz::checkConvex(*hull, points, tolerance);
  fuzz::checkAround(*hull, points, tolerance, points.size() > static_cast<size_t>(def.maxVertices));
  fuzz::checkLaws(*hull, def);
  return 0;
}
