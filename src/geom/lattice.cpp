// Points and tetrahedra of the lattice, and where a surface cuts it (lattice.h).
#include "geom/lattice.h"

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

/// Parts of a long and of a short edge: a point that the surface cuts an edge nearer to is moved there, to the nearest
/// such cut. Larger parts distort what lies around, smaller ones leave thin tetrahedra; with these the least angle that
/// any sides and cuts were found to give is greatest.
constexpr double kNearOfLong = 0.26, kNearOfShort = 0.42;
constexpr int kCoverLevels = 4;  // halvings in search of what of a tetrahedron lies in the solid
constexpr double kOn = 1e-6;     // [of a cell] nearer to the surface is on it

/// Where the surface cuts an edge whose ends lie inside and outside.
struct Cut {
  uint32_t inside, outside;
  double part;  // of the way from the end inside
  Vec3d at;
};

/// A point that a cut lies near to.
struct Pull {
  uint32_t point;
  double distance;
  uint32_t cut;
};

class Cutting {
 public:
  Cutting(const Lattice& lattice, Depth depth) : lattice_(lattice), depth_(depth) {}

  LatticeMesh run() {
    findDepths();
    findCuts();
    movePoints();
    return fill();
  }

  LatticeMesh runCover() {
    findDepths();
    LatticeMesh out{points_, {}};
    lattice_.forEachTet([&](const std::array<uint32_t, 4>& t) {
      std::array<Vec3d, 4> corners;
      double deepest = -1e300;
      for (size_t i = 0; i < 4; ++i) {
        corners[i] = points_[t[i]];
        deepest = std::fmax(deepest, side_[t[i]] == 0 ? 0 : depths_[t[i]]);
      }
      if (deepest > 0 || (deepest > -lattice_.cell() && reaches(corners, kCoverLevels))) out.tets.push_back(t);
    });
    return out;
  }

 private:
  bool reaches(const std::array<Vec3d, 4>& corners, int levels) const;
  void findDepths();
  void findDepths(uint32_t first, int count);
  void findCuts();
  Cut cutOf(uint32_t inside, uint32_t outside) const;
  void movePoints();
  LatticeMesh fill();

  const Lattice& lattice_;
  Depth depth_;
  std::vector<Vec3d> points_;
  std::vector<double> depths_;
  std::vector<int8_t> side_;
  std::vector<Cut> cuts_;  // by end inside, then outside
};

void Cutting::findDepths() {
  const uint32_t count = lattice_.pointCount();
  points_.reserve(count);
  for (uint32_t i = 0; i < count; ++i) points_.push_back(lattice_.at(i));
  depths_.resize(count);
  side_.resize(count);
  const int nx = lattice_.cubes(0), ny = lattice_.cubes(1), nz = lattice_.cubes(2);
  for (int z = 0; z <= nz; ++z)
    for (int y = 0; y <= ny; ++y) findDepths(lattice_.corner(0, y, z), nx + 1);
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y) findDepths(lattice_.middle(0, y, z), nx);
}

/// Of a row. Far from the surface the side is all that is needed, and a depth says it of the next points too.
void Cutting::findDepths(uint32_t first, int count) {
  const double cell = lattice_.cell();
  double known = 0;
  for (uint32_t i = first; i < first + static_cast<uint32_t>(count); ++i) {
    known = std::fabs(known) - cell > cell ? known - std::copysign(cell, known) : depth_(points_[i]);
    depths_[i] = known;
    side_[i] = static_cast<int8_t>(std::fabs(known) <= kOn * cell ? 0 : known > 0 ? 1 : -1);
  }
}

void Cutting::findCuts() {
  std::vector<std::array<uint32_t, 2>> edges;
  lattice_.forEachTet([&](const std::array<uint32_t, 4>& t) {
    const int sum = side_[t[0]] + side_[t[1]] + side_[t[2]] + side_[t[3]];
    if (sum == 4 || sum == -4) return;
    for (const uint32_t a : t)
      for (const uint32_t b : t)
        if (side_[a] > 0 && side_[b] < 0) edges.push_back({a, b});
  });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  cuts_.reserve(edges.size());
  for (const auto& [a, b] : edges) cuts_.push_back(cutOf(a, b));
}

/// False position that halves the weight of an end that stays (Illinois).
Cut Cutting::cutOf(uint32_t inside, uint32_t outside) const {
  const Vec3d a = points_[inside], way = points_[outside] - a;
  double low = 0, high = 1, atLow = depths_[inside], atHigh = depths_[outside], part = 0.5;
  int stayed = 0;
  for (int i = 0; i < 16; ++i) {
    part = low + (high - low) * (atLow / (atLow - atHigh));
    const double depth = depth_(a + way * part);
    if (std::fabs(depth) <= kOn * lattice_.cell()) break;
    if (depth > 0) {
      low = part, atLow = depth;
      if (stayed == 1) atHigh /= 2;
      stayed = 1;
    } else {
      high = part, atHigh = depth;
      if (stayed == -1) atLow /= 2;
      stayed = -1;
    }
  }
  return {inside, outside, part, a + way * part};
}

/// Moves points onto the cuts that are nearest to them. A point on the surface has no cuts any more.
void Cutting::movePoints() {
  std::vector<Pull> pulls;
  for (uint32_t i = 0; i < cuts_.size(); ++i) {
    const Cut& cut = cuts_[i];
    const bool isLong = lattice_.isLong(cut.inside, cut.outside);
    const double most = isLong ? kNearOfLong : kNearOfShort, size = isLong ? 1 : std::sqrt(0.75);
    if (cut.part < most) pulls.push_back({cut.inside, cut.part * size, i});
    if (1 - cut.part < most) pulls.push_back({cut.outside, (1 - cut.part) * size, i});
  }
  std::sort(pulls.begin(), pulls.end(), [](const Pull& a, const Pull& b) {
    if (a.point != b.point) return a.point < b.point;
    return a.distance != b.distance ? a.distance < b.distance : a.cut < b.cut;
  });
  for (const Pull& pull : pulls) {
    const Cut& cut = cuts_[pull.cut];
    if (side_[cut.inside] == 0 || side_[cut.outside] == 0) continue;
    points_[pull.point] = cut.at;
    side_[pull.point] = 0;
  }
}

/// Whether a tetrahedron reaches into the solid. A part of it that lies farther outside than it is large does not.
bool Cutting::reaches(const std::array<Vec3d, 4>& c, int levels) const {
  const Vec3d middle = (c[0] + c[1] + c[2] + c[3]) * 0.25;
  const double depth = depth_(middle);
  if (depth > kOn * lattice_.cell()) return true;
  double size = 0;
  for (const Vec3d& corner : c) size = std::fmax(size, length(corner - middle));
  if (-depth > size || levels == 0) return false;
  // Four at the corners, and four of the octahedron between them about one of its diagonals.
  const auto half = [&](size_t i, size_t k) { return (c[i] + c[k]) * 0.5; };
  const Vec3d m01 = half(0, 1), m02 = half(0, 2), m03 = half(0, 3), m12 = half(1, 2), m13 = half(1, 3),
              m23 = half(2, 3);
  const std::array<Vec3d, 4> parts[] = {{c[0], m01, m02, m03}, {m01, c[1], m12, m13}, {m02, m12, c[2], m23},
                                        {m03, m13, m23, c[3]}, {m01, m23, m02, m03},  {m01, m23, m03, m13},
                                        {m01, m23, m13, m12},  {m01, m23, m12, m02}};
  for (const auto& each : parts)
    if (reaches(each, levels - 1)) return true;
  return false;
}

LatticeMesh Cutting::fill() {
  LatticeMesh out{std::move(points_), {}};
  const uint32_t first = static_cast<uint32_t>(out.points.size());
  for (const Cut& cut : cuts_) out.points.push_back(cut.at);
  const auto cutAt = [&](uint32_t inside, uint32_t outside) {
    const auto found = std::lower_bound(cuts_.begin(), cuts_.end(), std::pair(inside, outside),
                                        [](const Cut& cut, const std::pair<uint32_t, uint32_t>& ends) {
                                          return std::pair(cut.inside, cut.outside) < ends;
                                        });
    return first + static_cast<uint32_t>(found - cuts_.begin());
  };
  Stencils stencils(lattice_, side_, cutAt, out.tets);
  lattice_.forEachTet([&](const std::array<uint32_t, 4>& tet) { stencils.add(tet); });
  return out;
}

}  // namespace

Vec3d Lattice::at(uint32_t point) const {
  const bool isCorner = point < cornerCount();
  const int more = isCorner ? 1 : 0;
  uint32_t rest = isCorner ? point : point - cornerCount();
  const uint32_t nx = static_cast<uint32_t>(cubes_[0] + more), ny = static_cast<uint32_t>(cubes_[1] + more);
  const double x = rest % nx, y = rest / nx % ny, z = rest / nx / ny, off = isCorner ? 0 : 0.5;
  return origin_ + Vec3d{x + off, y + off, z + off} * cell_;
}

std::array<std::array<uint32_t, 4>, 4> Lattice::tetsAcross(int x, int y, int z, int axis) const {
  const std::array<int, 3> from{x, y, z};
  std::array<int, 3> to = from;
  ++to[static_cast<size_t>(axis)];
  const uint32_t a = middle(x, y, z), b = middle(to[0], to[1], to[2]);
  // Corners of the face, anticlockwise seen against the axis.
  std::array<uint32_t, 4> face;
  constexpr int kAround[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (size_t i = 0; i < 4; ++i) {
    std::array<int, 3> c = to;
    c[static_cast<size_t>(axis + 1) % 3] += kAround[i][0];
    c[static_cast<size_t>(axis + 2) % 3] += kAround[i][1];
    face[i] = corner(c[0], c[1], c[2]);
  }
  std::array<std::array<uint32_t, 4>, 4> tets;
  for (size_t i = 0; i < 4; ++i) tets[i] = {a, b, face[i], face[(i + 1) % 4]};
  return tets;
}

LatticeMesh cutLattice(const Lattice& lattice, Depth depth) { return Cutting(lattice, depth).run(); }

LatticeMesh coverLattice(const Lattice& lattice, Depth depth) { return Cutting(lattice, depth).runCover(); }

}  // namespace avbd
