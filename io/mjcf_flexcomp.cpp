// Points and elements that <flexcomp> makes by itself.
#include "io/mjcf_flexcomp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace avbd::mjcf {

namespace {

size_t size(int n) { return static_cast<size_t>(n); }

Vec3d scaled(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// -1 .. 1 along an axis.
double along(int i, int count) { return count > 1 ? 2.0 * i / (count - 1) - 1 : 0; }

Vec3d halfSize(const FlexPattern& p) {
  return scaled({double{1} * (p.count[0] - 1), double{1} * (p.count[1] - 1), double{1} * (p.count[2] - 1)},
                p.spacing * 0.5);
}

/// Two triangles of a quad a, b, c, d whose diagonal is a-c, or b-d.
void addQuad(FlexShape& shape, const std::array<uint32_t, 4>& q, bool turned = false) {
  if (turned) {
    shape.elements.push_back({q[0], q[1], q[3], 0});
    shape.elements.push_back({q[1], q[2], q[3], 0});
  } else {
    shape.elements.push_back({q[0], q[1], q[2], 0});
    shape.elements.push_back({q[0], q[2], q[3], 0});
  }
}

FlexShape grid(const FlexPattern& p) {
  FlexShape out{p.dim, {}, {}};
  const int nx = p.count[0], ny = p.dim > 1 ? p.count[1] : 1, nz = p.dim > 2 ? p.count[2] : 1;
  const auto id = [&](int x, int y, int z) {
    return static_cast<uint32_t>((size(x) * size(ny) + size(y)) * size(nz) + size(z));
  };
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z)
        out.points.push_back(scaled({x - 0.5 * (nx - 1), y - 0.5 * (ny - 1), z - 0.5 * (nz - 1)}, p.spacing));
  // A cell's six tetrahedra share the diagonal from b to c and have one edge each of the ring around it.
  constexpr int kRing[][3] = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}, {0, 0, 0}};
  for (int x = 0; x + 1 < nx; ++x) {
    if (p.dim == 1) out.elements.push_back({id(x, 0, 0), id(x + 1, 0, 0), 0, 0});
    for (int y = 0; y + 1 < ny; ++y) {
      if (p.dim == 2) addQuad(out, {id(x, y, 0), id(x + 1, y, 0), id(x + 1, y + 1, 0), id(x, y + 1, 0)});
      for (int z = 0; z + 1 < nz; ++z)
        for (int k = 0; k < 6; ++k) {
          const auto corner = [&](int i) { return id(x + kRing[i][0], y + kRing[i][1], z + kRing[i][2]); };
          out.elements.push_back({id(x + 1, y, z), id(x, y + 1, z + 1), corner(k), corner(k + 1)});
        }
    }
  }
  return out;
}

/// Numbers the points of a box's shell in the order in which they are asked for first.
class Shell {
 public:
  Shell(const FlexPattern& pattern, FlexShape& shape) : p_(pattern), shape_(shape) {
    ids_.resize(size(p_.count[0]) * size(p_.count[1]) * size(p_.count[2]), 0);
  }

  uint32_t operator()(int x, int y, int z) {
    uint32_t& id = ids_[(size(x) * size(p_.count[1]) + size(y)) * size(p_.count[2]) + size(z)];
    if (id == 0) {
      shape_.points.push_back(
          scaled(place({along(x, p_.count[0]), along(y, p_.count[1]), along(z, p_.count[2])}), halfSize(p_)));
      id = static_cast<uint32_t>(shape_.points.size());  // one more than its number: 0 is none yet
    }
    return id - 1;
  }

 private:
  /// Of a point of the cube from -1 to 1.
  Vec3d place(Vec3d v) const {
    if (p_.kind == FlexKind::Ellipsoid) return v * (1 / length(v));
    if (p_.kind != FlexKind::Cylinder) return v;
    const double wide = std::max(std::abs(v.x), std::abs(v.y)), far = std::sqrt(v.x * v.x + v.y * v.y);
    return far > 0 ? Vec3d{v.x * wide / far, v.y * wide / far, v.z} : v;
  }

  const FlexPattern& p_;
  FlexShape& shape_;
  std::vector<uint32_t> ids_;
};

FlexShape box(const FlexPattern& p) {
  const bool solid = p.dim == 3;
  FlexShape out{p.dim, {}, {}};
  if (solid) out.points.push_back({});
  Shell id(p, out);
  const int nx = p.count[0], ny = p.count[1], nz = p.count[2], last = solid ? nz - 1 : nz;
  // First the lower and the upper face, then the rest of the four sides.
  for (const int z : {0, nz - 1})
    for (int x = 0; x < nx && (z == 0 || solid); ++x)
      for (int y = 0; y < ny; ++y) id(x, y, z);
  for (const int y : {0, ny - 1})
    for (int x = 0; x < nx; ++x)
      for (int z = 1; z < last; ++z) id(x, y, z);
  for (const int x : {0, nx - 1})
    for (int y = 0; y < ny; ++y)
      for (int z = 1; z < last; ++z) id(x, y, z);
  for (int x = 0; x + 1 < nx; ++x)
    for (int y = 0; y + 1 < ny; ++y) {
      addQuad(out, {id(x, y, 0), id(x, y + 1, 0), id(x + 1, y + 1, 0), id(x + 1, y, 0)});
      const int z = nz - 1;
      if (solid) addQuad(out, {id(x, y, z), id(x + 1, y, z), id(x + 1, y + 1, z), id(x, y + 1, z)});
    }
  for (int z = 0; z + 1 < nz; ++z) {
    for (int x = 0; x + 1 < nx; ++x) {
      const int y = ny - 1;
      addQuad(out, {id(x, 0, z), id(x + 1, 0, z), id(x + 1, 0, z + 1), id(x, 0, z + 1)});
      addQuad(out, {id(x, y, z), id(x, y, z + 1), id(x + 1, y, z + 1), id(x + 1, y, z)}, !solid);
    }
    for (int y = 0; y + 1 < ny; ++y) {
      const int x = nx - 1;
      addQuad(out, {id(0, y, z), id(0, y, z + 1), id(0, y + 1, z + 1), id(0, y + 1, z)}, !solid);
      addQuad(out, {id(x, y, z), id(x, y + 1, z), id(x, y + 1, z + 1), id(x, y, z + 1)});
    }
  }
  if (solid)
    for (FlexElement& e : out.elements) e = {0, e[0], e[1], e[2]};
  return out;
}

FlexShape disc(const FlexPattern& p) {
  FlexShape out{2, {}, {}};
  const int nx = p.count[0], ny = p.count[1];
  const Vec3d half = halfSize(p);
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y) {
      const Vec3d at{along(x, nx) * half.x, along(y, ny) * half.y, 0};
      const double wide = std::max(std::abs(at.x), std::abs(at.y)), far = length(at);
      // The half size counts twice: so it does in MuJoCo.
      out.points.push_back(far > 0 ? scaled(at * (wide / far), half) : at);
    }
  const auto id = [&](int x, int y) { return static_cast<uint32_t>(size(x) * size(ny) + size(y)); };
  for (int x = 0; x + 1 < nx; ++x)
    for (int y = 0; y + 1 < ny; ++y)
      addQuad(out, {id(x, y), id(x + 1, y), id(x + 1, y + 1), id(x, y + 1)}, (x < nx / 2) != (y < ny / 2));
  return out;
}

FlexShape circle(const FlexPattern& p) {
  FlexShape out{1, {}, {}};
  const int n = p.count[0] - 1;
  const double radius = p.spacing.x / (2 * std::sin(std::numbers::pi / n));
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    out.points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    out.elements.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>((i + 1) % n), 0, 0});
  }
  return out;
}

}  // namespace

double pointCount(const FlexPattern& p) {
  const double x = p.count[0], y = p.count[1], z = p.count[2];
  switch (p.kind) {
    case FlexKind::Circle:
      return x - 1;
    case FlexKind::Square:
    case FlexKind::Disc:
      return x * y;
    case FlexKind::Grid:
      return x * (p.dim > 1 ? y : 1) * (p.dim > 2 ? z : 1);
    default:
      // The inner ones are numbered for a moment, too.
      return x * y * z;
  }
}

FlexShape flexShape(const FlexPattern& pattern) {
  switch (pattern.kind) {
    case FlexKind::Box:
    case FlexKind::Cylinder:
    case FlexKind::Ellipsoid:
      return box(pattern);
    case FlexKind::Disc:
      return disc(pattern);
    case FlexKind::Circle:
      return circle(pattern);
    default:
      return grid(pattern);
  }
}

FlexShape solidAbout(Vec3d origin, const FlexShape& surface) {
  FlexShape out{3, {origin}, {}};
  out.points.insert(out.points.end(), surface.points.begin(), surface.points.end());
  for (const FlexElement& e : surface.elements) out.elements.push_back({0, e[0] + 1, e[1] + 1, e[2] + 1});
  return out;
}

std::vector<uint32_t> dropUnused(FlexShape& shape) {
  constexpr uint32_t kNone = ~0u;
  std::vector<uint32_t> now(shape.points.size(), kNone), before;
  const size_t corners = size(shape.dim) + 1;
  for (const FlexElement& e : shape.elements)
    for (size_t k = 0; k < corners; ++k) now[e[k]] = 0;
  std::vector<Vec3d> points;
  for (uint32_t i = 0; i < now.size(); ++i) {
    if (now[i] == kNone) continue;
    now[i] = static_cast<uint32_t>(before.size());
    before.push_back(i);
    points.push_back(shape.points[i]);
  }
  for (FlexElement& e : shape.elements)
    for (size_t k = 0; k < corners; ++k) e[k] = now[e[k]];
  shape.points = std::move(points);
  return before;
}

}  // namespace avbd::mjcf
