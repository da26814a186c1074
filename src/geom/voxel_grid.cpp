// Voxels of a solid (voxel_grid.h).
#include "geom/voxel_grid.h"

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

/// Whether a triangle touches a cube about the origin: no axis of the boxes', the triangle's or their edges' products
/// parts them (separating axes of two convex sets).
bool touchesCube(std::array<Vec3d, 3> v, double half) {
  const auto parted = [&](Vec3d axis) {
    const double a = dot(axis, v[0]), b = dot(axis, v[1]), c = dot(axis, v[2]);
    const double reach = half * (std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
    return std::fmin(a, std::fmin(b, c)) > reach || std::fmax(a, std::fmax(b, c)) < -reach;
  };
  const Vec3d sides[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]}, axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3d& axis : axes) {
    if (parted(axis)) return false;
    for (const Vec3d& side : sides) {
      if (parted(cross(axis, side))) return false;
    }
  }
  return !parted(cross(sides[0], sides[1]));
}

}  // namespace

VoxelGrid::VoxelGrid(const ClosedSurface& surface, int resolution, bool sealed) {
  const Vec3d size = surface.upper() - surface.lower();
  cell_ = std::fmax(size.x, std::fmax(size.y, size.z)) / resolution;
  const auto cells = [this](double extent) { return static_cast<int>(std::floor(extent / cell_)) + 1 + 2; };
  size_ = {cells(size.x), cells(size.y), cells(size.z)};
  // The solid in the middle of its cells.
  const Vec3d middle = (surface.lower() + surface.upper()) * 0.5;
  origin_ = middle - Vec3d{size_[0] * cell_, size_[1] * cell_, size_[2] * cell_} * 0.5;
  voxels_.assign(static_cast<size_t>(size_[0]) * size_[1] * size_[2], Voxel::Inside);
  for (size_t i = 0; i < surface.size(); ++i) markTriangle(surface.triangle(i));
  fillInside();
  if (sealed) sealHollows();
  findDistances();
}

Cell VoxelGrid::cellOf(Vec3d p) const {
  const Vec3d d = p - origin_;
  const auto place = [this](double v, int count) {
    return std::clamp(static_cast<int>(std::floor(v / cell_)), 0, count - 1);
  };
  return {place(d.x, size_[0]), place(d.y, size_[1]), place(d.z, size_[2])};
}

void VoxelGrid::markTriangle(const std::array<Vec3d, 3>& v) {
  const auto low = [&](auto f) { return std::fmin(f(v[0]), std::fmin(f(v[1]), f(v[2]))); };
  const auto high = [&](auto f) { return std::fmax(f(v[0]), std::fmax(f(v[1]), f(v[2]))); };
  const auto x = [](Vec3d p) { return p.x; };
  const auto y = [](Vec3d p) { return p.y; };
  const auto z = [](Vec3d p) { return p.z; };
  const Cell a = cellOf({low(x), low(y), low(z)}), b = cellOf({high(x), high(y), high(z)});
  for (int k = a.z; k <= b.z; ++k) {
    for (int j = a.y; j <= b.y; ++j) {
      for (int i = a.x; i <= b.x; ++i) {
        Voxel& voxel = voxels_[index(i, j, k)];
        if (voxel == Voxel::Surface) continue;
        const Vec3d middle = corner(i, j, k) + Vec3d{cell_, cell_, cell_} * 0.5;
        if (touchesCube({v[0] - middle, v[1] - middle, v[2] - middle}, cell_ / 2)) voxel = Voxel::Surface;
      }
    }
  }
}

/// What the outer layer reaches is outside.
void VoxelGrid::fillInside() {
  std::vector<Cell> front;
  const auto visit = [&](int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return;
    Voxel& voxel = voxels_[index(x, y, z)];
    if (voxel != Voxel::Inside) return;
    voxel = Voxel::Outside;
    front.push_back({x, y, z});
  };
  visit(0, 0, 0);
  while (!front.empty()) {
    const Cell c = front.back();
    front.pop_back();
    visit(c.x - 1, c.y, c.z);
    visit(c.x + 1, c.y, c.z);
    visit(c.x, c.y - 1, c.z);
    visit(c.x, c.y + 1, c.z);
    visit(c.x, c.y, c.z - 1);
    visit(c.x, c.y, c.z + 1);
  }
}

void VoxelGrid::sealHollows() {
  std::vector<size_t> hidden;
  for (int z = 1; z + 1 < size_[2]; ++z) {
    for (int y = 1; y + 1 < size_[1]; ++y) {
      for (int x = 1; x + 1 < size_[0]; ++x) {
        if (at(x, y, z) != Voxel::Surface) continue;
        bool open = false;
        for (int n = 0; n < 27; ++n) open |= !isSolid(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
        if (!open) hidden.push_back(index(x, y, z));
      }
    }
  }
  for (size_t i : hidden) voxels_[i] = Voxel::Inside;
}

/// Two sweeps with steps of 3, 4 and 5 thirds to faces, edges and corners (Borgefors' chamfer distance).
void VoxelGrid::findDistances() {
  distance_.assign(voxels_.size(), 0);
  for (size_t i = 0; i < voxels_.size(); ++i) {
    if (voxels_[i] == Voxel::Outside) distance_[i] = 60000;
  }
  const auto sweep = [&](bool forward) {
    const int step = forward ? -1 : 1;
    for (int n = 0; n < size_[2]; ++n) {
      const int z = forward ? n : size_[2] - 1 - n;
      for (int m = 0; m < size_[1]; ++m) {
        const int y = forward ? m : size_[1] - 1 - m;
        for (int l = 0; l < size_[0]; ++l) {
          const int x = forward ? l : size_[0] - 1 - l;
          int best = distance_[index(x, y, z)];
          const auto look = [&](int dx, int dy, int dz) {
            const int i = x + dx, j = y + dy, k = z + dz;
            if (i < 0 || j < 0 || k < 0 || i >= size_[0] || j >= size_[1] || k >= size_[2]) return;
            best = std::min(best, distance_[index(i, j, k)] + 2 + (dx != 0) + (dy != 0) + (dz != 0));
          };
          for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) look(dx, dy, step);
          }
          for (int dx = -1; dx <= 1; ++dx) look(dx, step, 0);
          look(step, 0, 0);
          distance_[index(x, y, z)] = static_cast<uint16_t>(best);
        }
      }
    }
  };
  sweep(true);
  sweep(false);
  below_.reserve(voxels_.size() + static_cast<size_t>(size_[1]) * size_[2]);
  for (int z = 0; z < size_[2]; ++z) {
    for (int y = 0; y < size_[1]; ++y) {
      uint32_t sum = 0;
      below_.push_back(0);
      for (int x = 0; x < size_[0]; ++x) below_.push_back(sum += distance_[index(x, y, z)]);
    }
  }
}

double VoxelGrid::volume() const {
  double cells = 0;
  for (Voxel v : voxels_) cells += v == Voxel::Inside ? 1 : v == Voxel::Surface ? 0.5 : 0;
  return cells * cell_ * cell_ * cell_;
}

}  // namespace avbd
