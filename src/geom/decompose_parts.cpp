// Parts of a solid (decompose_parts.h).
#include "geom/decompose_parts.h"

#include <avbd/error.h>

#include <algorithm>
#include <cmath>

#include "geom/hull_exact.h"

namespace avbd {
namespace {

int part(Cell c, int axis) { return axis == 0 ? c.x : axis == 1 ? c.y : c.z; }
double part(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double& part(Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
Vec3d smallest(Vec3d a, Vec3d b) { return {std::fmin(a.x, b.x), std::fmin(a.y, b.y), std::fmin(a.z, b.z)}; }
Vec3d largest(Vec3d a, Vec3d b) { return {std::fmax(a.x, b.x), std::fmax(a.y, b.y), std::fmax(a.z, b.z)}; }

/// Which connected set a cell of a box belongs to.
class Labels {
 public:
  explicit Labels(const std::vector<Cell>& cells) {
    low_ = high_ = cells[0];
    for (Cell c : cells) {
      low_ = {std::min(low_.x, c.x), std::min(low_.y, c.y), std::min(low_.z, c.z)};
      high_ = {std::max(high_.x, c.x), std::max(high_.y, c.y), std::max(high_.z, c.z)};
    }
    size_ = {high_.x - low_.x + 3, high_.y - low_.y + 3, high_.z - low_.z + 3};
    labels_.assign(static_cast<size_t>(size_.x) * size_.y * size_.z, kNone);
    for (Cell c : cells) labels_[index(c)] = kOpen;
    for (Cell c : cells) {
      if (labels_[index(c)] == kOpen) spread(c, count_++);
    }
  }
  int count() const { return count_; }
  int of(Cell c) const { return labels_[index(c)]; }

 private:
  static constexpr int kNone = -1, kOpen = -2;
  size_t index(Cell c) const {
    return (static_cast<size_t>(c.z - low_.z + 1) * size_.y + (c.y - low_.y + 1)) * size_.x + (c.x - low_.x + 1);
  }
  void spread(Cell from, int label) {
    std::vector<Cell> front{from};
    labels_[index(from)] = label;
    while (!front.empty()) {
      const Cell c = front.back();
      front.pop_back();
      for (int n = 0; n < 27; ++n) {
        const Cell next{c.x + n % 3 - 1, c.y + n / 3 % 3 - 1, c.z + n / 9 - 1};
        int& mark = labels_[index(next)];
        if (mark != kOpen) continue;
        mark = label;
        front.push_back(next);
      }
    }
  }

  Cell low_, high_, size_;
  std::vector<int> labels_;
  int count_ = 0;
};

/// The triangle's part between two planes across an axis (Sutherland and Hodgman).
void clip(std::vector<Vec3d>& polygon, int axis, double from, double to) {
  for (const bool lower : {true, false}) {
    const double plane = lower ? from : to, sign = lower ? 1 : -1;
    std::vector<Vec3d> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double da = sign * (part(a, axis) - plane), db = sign * (part(b, axis) - plane);
      if (da >= 0) kept.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon = kept;
  }
}

double polygonArea(const std::vector<Vec3d>& polygon) {
  Vec3d sum;
  for (size_t i = 2; i < polygon.size(); ++i) sum = sum + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return length(sum) / 2;
}

/// Whether a triangle lies on a side of the box and the solid behind it is beyond that side.
bool endsAt(const std::array<Vec3d, 3>& v, const Vec3d& lower, const Vec3d& upper) {
  const Vec3d n = cross(v[1] - v[0], v[2] - v[0]);
  for (int axis = 0; axis < 3; ++axis) {
    const double at = part(v[0], axis);
    if (at != part(v[1], axis) || at != part(v[2], axis)) continue;
    if ((at == part(lower, axis) && part(n, axis) > 0) || (at == part(upper, axis) && part(n, axis) < 0)) return true;
  }
  return false;
}

/// Triangles by where they begin along x, so that those near one of many parts are found without asking all.
class TrianglesAlong {
 public:
  TrianglesAlong(const ClosedSurface& surface, const std::vector<uint32_t>& triangles) {
    for (uint32_t t : triangles) {
      const auto v = surface.triangle(t);
      boxes_.push_back({smallest(v[0], smallest(v[1], v[2])), largest(v[0], largest(v[1], v[2])), t});
      widest_ = std::fmax(widest_, boxes_.back().upper.x - boxes_.back().lower.x);
    }
    std::sort(boxes_.begin(), boxes_.end(), [](const Box& l, const Box& r) {
      return l.lower.x != r.lower.x ? l.lower.x < r.lower.x : l.triangle < r.triangle;
    });
  }

  /// Those whose boxes meet a box, ascending.
  std::vector<uint32_t> near(const Vec3d& lower, const Vec3d& upper) const {
    std::vector<uint32_t> found;
    // One that ends within the box begins no farther before it than the widest is wide; twice that, as sums round.
    auto box = std::lower_bound(boxes_.begin(), boxes_.end(), lower.x - 2 * widest_,
                                [](const Box& b, double x) { return b.lower.x < x; });
    for (; box != boxes_.end() && box->lower.x <= upper.x; ++box) {
      if (box->upper.x >= lower.x && box->lower.y <= upper.y && box->upper.y >= lower.y && box->lower.z <= upper.z &&
          box->upper.z >= lower.z) {
        found.push_back(box->triangle);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  struct Box {
    Vec3d lower, upper;
    uint32_t triangle;
  };
  std::vector<Box> boxes_;
  double widest_ = 0;
};

/// Box, triangles and points of one connected set of cells.
void fillPart(const Solid3& solid, SolidPart& out, const TrianglesAlong& triangles, const Labels& labels) {
  out.low = out.high = out.cells[0];
  for (Cell c : out.cells) {
    out.low = {std::min(out.low.x, c.x), std::min(out.low.y, c.y), std::min(out.low.z, c.z)};
    out.high = {std::max(out.high.x, c.x + 1), std::max(out.high.y, c.y + 1), std::max(out.high.z, c.z + 1)};
  }
  const int own = labels.of(out.cells[0]);
  const Vec3d lower = largest(out.lower, solid.grid.corner(out.low.x, out.low.y, out.low.z));
  const Vec3d upper = smallest(out.upper, solid.grid.corner(out.high.x, out.high.y, out.high.z));
  out.lower = lower;
  out.upper = upper;
  const auto cellIn = [&](Vec3d p) {
    const Cell c = solid.grid.cellOf(p);
    return Cell{std::clamp(c.x, out.low.x, out.high.x - 1), std::clamp(c.y, out.low.y, out.high.y - 1),
                std::clamp(c.z, out.low.z, out.high.z - 1)};
  };
  for (uint32_t t : triangles.near(lower, upper)) {
    const auto corners = solid.surface.triangle(t);
    std::vector<Vec3d> polygon(corners.begin(), corners.end());
    for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) clip(polygon, axis, part(lower, axis), part(upper, axis));
    // What only meets a side of the box has neighbours that the box holds, or is the other side's.
    if (!(polygonArea(polygon) > 1e-9 * solid.grid.cellSize() * solid.grid.cellSize())) continue;
    out.triangles.push_back(t);
    if (solid.surface.openEdges().count == 0 && endsAt(corners, lower, upper)) continue;
    Vec3d middle;
    for (const Vec3d& p : polygon) middle = middle + p * (1.0 / static_cast<double>(polygon.size()));
    const int label = labels.of(cellIn(middle));
    if (label >= 0 && label != own) continue;
    for (const Vec3d& p : polygon) out.points.push_back(toFloat(p));
  }
  // Where two or three cuts meet inside the solid. (One on the surface is a triangle's.) A cell that no part took, as
  // it holds next to nothing on this side of a cut, is everyone's.
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
    const int label = labels.of(cellIn(corner));
    if ((label < 0 || label == own) && solid.outside(corner) < -1e-6 * solid.grid.cellSize())
      out.points.push_back(toFloat(corner));
  }
}

struct Region {
  Vec3d lower, upper;
};

std::vector<SolidPart> connectedParts(const Solid3& solid, const std::vector<Cell>& cells, const Region& box,
                                      const std::vector<uint32_t>& triangles) {
  if (cells.empty()) return {};
  const Labels labels(cells);
  std::vector<SolidPart> parts(labels.count());
  for (Cell c : cells) parts[labels.of(c)].cells.push_back(c);
  const TrianglesAlong along(solid.surface, triangles);
  for (SolidPart& p : parts) {
    p.lower = box.lower;
    p.upper = box.upper;
    fillPart(solid, p, along, labels);
  }
  // Cells that the surface only grazes hold nothing.
  std::erase_if(parts, [](const SolidPart& p) { return p.points.empty(); });
  return parts;
}

/// First and last cells of the rows along x: their hull is the cells'.
std::vector<Vec3d> rowEnds(const std::vector<Cell>& cells) {
  std::vector<Vec3d> ends;
  const auto at = [](Cell c) { return Vec3d{1.0 * c.x, 1.0 * c.y, 1.0 * c.z}; };
  for (size_t i = 0; i < cells.size(); ++i) {
    const auto newRow = [&](size_t l, size_t r) { return cells[l].y != cells[r].y || cells[l].z != cells[r].z; };
    const bool first = i == 0 || newRow(i - 1, i), last = i + 1 == cells.size() || newRow(i, i + 1);
    if (first || last) ends.push_back(at(cells[i]));
  }
  return ends;
}

struct Plane {
  Vec3d normal;
  double offset;
};

/// Faces of the points' hull. A layer of cells has one, too: it is made a quarter of a cell thicker each way.
std::vector<Plane> planesAround(const std::vector<Vec3d>& ends) {
  constexpr double kFine = 4;  // whole numbers as the exact hull wants them
  std::vector<Vec3d> points;
  for (const Vec3d& p : ends) points.push_back(p * kFine);
  if (ExactHull(points).begin(0) != ExactHull::Flat::No) {
    const size_t count = points.size();
    for (size_t i = 0; i < count; ++i) {
      for (const Vec3d& off : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        points.push_back(points[i] + off);
        points.push_back(points[i] - off);
      }
    }
  }
  ExactHull hull(points);
  std::vector<Plane> planes;
  hull.begin(0);
  hull.grow(0.25 * kFine, 80);
  for (const auto& t : hull.triangles()) {
    const Vec3d a = points[t.vertex[0]] * (1 / kFine),
                n = cross(points[t.vertex[1]] * (1 / kFine) - a, points[t.vertex[2]] * (1 / kFine) - a);
    planes.push_back({n, dot(n, a)});
  }
  return planes;
}

/// Cells times their distance from the solid within the hull of cells' middles.
double emptiness(const VoxelGrid& grid, const std::vector<Vec3d>& ends) {
  const std::vector<Plane> planes = planesAround(ends);
  int low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    double l = part(ends[0], k), h = l;
    for (const Vec3d& p : ends) l = std::fmin(l, part(p, k)), h = std::fmax(h, part(p, k));
    low[k] = static_cast<int>(l), high[k] = static_cast<int>(h);
  }
  double sum = 0;
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      double from = low[0], to = high[0];
      for (const Plane& p : planes) {
        const double rest = p.offset - p.normal.y * y - p.normal.z * z;
        if (p.normal.x > 0)
          to = std::fmin(to, rest / p.normal.x);
        else if (p.normal.x < 0)
          from = std::fmax(from, rest / p.normal.x);
        else if (rest < 0)
          to = -1;
      }
      const int first = static_cast<int>(std::ceil(from - 1e-9)), last = static_cast<int>(std::floor(to + 1e-9));
      if (first <= last) sum += grid.distanceBelow(last + 1, y, z) - grid.distanceBelow(first, y, z);
    }
  }
  return sum;
}

struct Cut {
  int axis = -1, at = 0;
  double cost = 1e300;
};

/// Emptiness of the two sides together.
double costOf(const Solid3& solid, const SolidPart& whole, int axis, int at) {
  std::vector<Cell> below, above;
  for (Cell c : whole.cells) (part(c, axis) < at ? below : above).push_back(c);
  return emptiness(solid.grid, rowEnds(below)) + emptiness(solid.grid, rowEnds(above));
}

/// Coarse places first, then finer about the best one.
Cut bestCut(const Solid3& solid, const SolidPart& whole) {
  Cut best;
  const int longest = std::max({whole.high.x - whole.low.x, whole.high.y - whole.low.y, whole.high.z - whole.low.z});
  const auto consider = [&](int axis, int at) {
    const int low = part(whole.low, axis), high = part(whole.high, axis);
    if (at <= low || at >= high) return;
    // Near the middle of a long side, if there is little between them: thin slices keep the hollow that they are cut
    // from.
    const double off = std::fabs(2.0 * at - low - high) / (high - low), slice = 1 - (high - low) / (1.0 * longest);
    const double cost = costOf(solid, whole, axis, at) * (1 + 0.1 * off + 0.5 * slice) + 1e-3 * (off + slice);
    if (cost < best.cost) best = {axis, at, cost};
  };
  int step = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int low = part(whole.low, axis), extent = part(whole.high, axis) - low;
    const int stride = std::max(1, extent / 8);
    step = std::max(step, stride);
    for (int at = low + stride; at < low + extent; at += stride) consider(axis, at);
  }
  for (step /= 2; step >= 1 && best.axis >= 0; step /= 2) {
    const Cut middle = best;
    consider(middle.axis, middle.at - step);
    consider(middle.axis, middle.at + step);
  }
  return best;
}

/// The place of the largest flat piece of the surface across the axis within two cells of the cut, or the cut itself:
/// the inner edge of an L lies on no border of cells, and cells tell a slope of one cell from none too late.
double flatNear(const Solid3& solid, const SolidPart& whole, const Cut& cut) {
  const double border = part(solid.grid.corner(cut.at, cut.at, cut.at), cut.axis), cell = solid.grid.cellSize();
  // Strictly between the ends, so that both sides get something.
  const double low = std::fmax(border - 2 * cell, part(whole.lower, cut.axis) + 0.1 * cell);
  const double high = std::fmin(border + 2 * cell, part(whole.upper, cut.axis) - 0.1 * cell);
  struct Flat {
    double at, area;
  };
  std::vector<Flat> flats;
  for (uint32_t t : whole.triangles) {
    const auto v = solid.surface.triangle(t);
    const double at = part(v[0], cut.axis);
    if (at != part(v[1], cut.axis) || at != part(v[2], cut.axis) || !(at > low) || !(at < high)) continue;
    flats.push_back({at, length(cross(v[1] - v[0], v[2] - v[0]))});
  }
  std::sort(flats.begin(), flats.end(), [](const Flat& l, const Flat& r) { return l.at < r.at; });
  double best = border, most = 0;
  for (size_t i = 0; i < flats.size();) {
    double area = 0;
    const double at = flats[i].at;
    for (; i < flats.size() && flats[i].at == at; ++i) area += flats[i].area;
    if (area > most) most = area, best = at;
  }
  return best;
}

}  // namespace

std::vector<SolidPart> wholeParts(const Solid3& solid) {
  std::vector<Cell> cells;
  for (int z = 0; z < solid.grid.size(2); ++z) {
    for (int y = 0; y < solid.grid.size(1); ++y) {
      for (int x = 0; x < solid.grid.size(0); ++x) {
        if (solid.grid.isSolid(x, y, z)) cells.push_back({x, y, z});
      }
    }
  }
  std::vector<uint32_t> all;
  for (uint32_t i = 0; i < solid.surface.size(); ++i) all.push_back(i);
  const VoxelGrid& grid = solid.grid;
  return connectedParts(solid, cells, {grid.corner(0, 0, 0), grid.corner(grid.size(0), grid.size(1), grid.size(2))},
                        all);
}

std::vector<SolidPart> cutPart(const Solid3& solid, const SolidPart& whole) {
  const Cut cut = bestCut(solid, whole);
  if (cut.axis < 0) return {whole};
  const double plane = flatNear(solid, whole, cut);
  Region low{whole.lower, whole.upper}, high = low;
  part(low.upper, cut.axis) = plane;
  part(high.lower, cut.axis) = plane;
  std::vector<Cell> below, above;
  // A cell that the plane divides goes where it holds some of the solid.
  const auto holds = [&](Cell c, double from, double to) {
    const double cell = solid.grid.cellSize();
    Vec3d middle = solid.grid.corner(c.x, c.y, c.z) + Vec3d{cell, cell, cell} * 0.5;
    part(middle, cut.axis) = (from + to) / 2;
    return solid.outside(middle) <= 0.45 * (to - from);
  };
  for (Cell c : whole.cells) {
    const int k = part(c, cut.axis);
    const double from = part(solid.grid.corner(k, k, k), cut.axis), to = from + solid.grid.cellSize();
    if (to <= plane || (from < plane && holds(c, from, plane))) below.push_back(c);
    if (from >= plane || (to > plane && holds(c, plane, to))) above.push_back(c);
  }
  std::vector<SolidPart> parts = connectedParts(solid, below, low, whole.triangles);
  for (SolidPart& p : connectedParts(solid, above, high, whole.triangles)) parts.push_back(std::move(p));
  return parts;
}

double emptiness(const Solid3& solid, const SolidPart& a, const SolidPart& b) {
  std::vector<Vec3d> ends = rowEnds(a.cells);
  for (const Vec3d& p : rowEnds(b.cells)) ends.push_back(p);
  return emptiness(solid.grid, ends);
}

std::shared_ptr<const HullData> hullOfPart(const std::vector<Vec3>& points, int maxVertices, double tolerance,
                                           double thickness) {
  const float t = static_cast<float>(tolerance), d = static_cast<float>(thickness);
  try {
    return makeHull({.points = points, .tolerance = t, .maxVertices = maxVertices});
  } catch (const Error&) {
    std::vector<Vec3> thick;
    for (const Vec3& p : points) {
      for (const Vec3 off : {Vec3{d, 0, 0}, Vec3{0, d, 0}, Vec3{0, 0, d}})
        thick.push_back(p + off), thick.push_back(p - off);
    }
    return makeHull({.points = thick, .tolerance = t, .maxVertices = maxVertices});
  }
}

}  // namespace avbd
