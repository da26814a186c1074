// A body-centred cubic lattice: its points, its tetrahedra, and a solid that is cut out of it (soft_lattice.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/function_ref.h"
#include "geom/hull_math.h"

namespace avbd {

/// Cubes of equal size. Its points are their corners and, behind them in number, their middles.
class Lattice {
 public:
  Lattice(Vec3d origin, double cell, std::array<int, 3> cubes) : origin_(origin), cell_(cell), cubes_(cubes) {}

  double cell() const { return cell_; }
  int cubes(int axis) const { return cubes_[static_cast<size_t>(axis)]; }
  uint32_t cornerCount() const { return count(1); }
  uint32_t pointCount() const { return count(1) + count(0); }
  uint32_t corner(int x, int y, int z) const { return index(x, y, z, 1); }
  uint32_t middle(int x, int y, int z) const { return cornerCount() + index(x, y, z, 0); }
  Vec3d at(uint32_t point) const;

  /// The four tetrahedra about the face between a cube and the next one along an axis. Corners 0 and 1 are the cubes'
  /// middles, 2 and 3 ends of a side of the face; these two edges are long (a cell), the others short.
  std::array<std::array<uint32_t, 4>, 4> tetsAcross(int x, int y, int z, int axis) const;
  /// Calls f for the tetrahedra of all faces between cubes.
  template <class F>
  void forEachTet(F&& f) const {
    for (int axis = 0; axis < 3; ++axis)
      for (int z = 0; z + (axis == 2) < cubes_[2]; ++z)
        for (int y = 0; y + (axis == 1) < cubes_[1]; ++y)
          for (int x = 0; x + (axis == 0) < cubes_[0]; ++x)
            for (const auto& tet : tetsAcross(x, y, z, axis)) f(tet);
  }
  bool isLong(uint32_t a, uint32_t b) const { return (a < cornerCount()) == (b < cornerCount()); }

 private:
  uint32_t count(int more) const {
    return static_cast<uint32_t>((cubes_[0] + more) * (cubes_[1] + more) * (cubes_[2] + more));
  }
  uint32_t index(int x, int y, int z, int more) const {
    return static_cast<uint32_t>((z * (cubes_[1] + more) + y) * (cubes_[0] + more) + x);
  }

  Vec3d origin_;
  double cell_;
  std::array<int, 3> cubes_;
};

struct LatticeMesh {
  std::vector<Vec3d>
      points;  ///< of the lattice, moved where they lie near the surface, and behind them points of edges
  std::vector<std::array<uint32_t, 4>> tets;  ///< of positive volume
};

/// How far a point lies inside the solid; negative outside. It changes by no more than one goes.
using Depth = FunctionRef<double(Vec3d)>;

/// The part of the lattice where the depth is positive.
LatticeMesh cutLattice(const Lattice& lattice, Depth depth);
/// The lattice's tetrahedra into which the solid reaches by more than about a 30th of a cell.
LatticeMesh coverLattice(const Lattice& lattice, Depth depth);

/// Replaces tetrahedra that the surface cuts. side: by lattice point 1 inside, 0 on the surface, -1 outside. cut: the
/// point where the surface cuts an edge of the lattice, from its end inside to its end outside.
class Stencils {
 public:
  using Tet = std::array<uint32_t, 4>;
  Stencils(const Lattice& lattice, const std::vector<int8_t>& side, FunctionRef<uint32_t(uint32_t, uint32_t)> cut,
           std::vector<Tet>& out)
      : lattice_(lattice), side_(side), cut_(cut), out_(out) {}
  void add(Tet tet);

 private:
  void emit(uint32_t a, uint32_t b, uint32_t c, uint32_t d);
  bool startsAtFirst(uint32_t a, uint32_t b, uint32_t outside) const;
  void addPrism(const std::array<uint32_t, 3>& low, const std::array<uint32_t, 3>& high,
                const std::array<std::array<bool, 3>, 3>& before);
  void addThreeInside(const Tet& t);
  void addTwoInside(const Tet& t, bool third);

  const Lattice& lattice_;
  const std::vector<int8_t>& side_;
  FunctionRef<uint32_t(uint32_t, uint32_t)> cut_;
  std::vector<Tet>& out_;
  bool odd_ = false;
};

}  // namespace avbd
