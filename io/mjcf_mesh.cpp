// Integrals over meshes (MuJoCo 2.2's rules), and primitives fitted to them.
#include "io/mjcf_mesh.h"

#include <algorithm>
#include <cmath>

namespace avbd::mjcf {

namespace {

// Sum of the outer products that a triangle's corners make: with the weight V / 20 the integral of x x^T over the
// tetrahedron with a tip at 0, with A / 12 that over the triangle.
Sym3d products(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d s = a + b + c;
  const auto of = [&](double Vec3d::*i, double Vec3d::*j) {
    return a.*i * a.*j + b.*i * b.*j + c.*i * c.*j + s.*i * s.*j;
  };
  return {of(&Vec3d::x, &Vec3d::x), of(&Vec3d::y, &Vec3d::y), of(&Vec3d::z, &Vec3d::z),
          of(&Vec3d::x, &Vec3d::y), of(&Vec3d::x, &Vec3d::z), of(&Vec3d::y, &Vec3d::z)};
}

Sym3d inertiaOf(const Sym3d& p) { return {p.yy + p.zz, p.xx + p.zz, p.xx + p.yy, -p.xy, -p.xz, -p.yz}; }

template <class Each>
void forTriangles(const MeshAsset& mesh, Vec3d from, const Each& each) {
  for (const auto& t : mesh.triangles) {
    each(mesh.vertices[t[0]] - from, mesh.vertices[t[1]] - from, mesh.vertices[t[2]] - from);
  }
}

double areaOf(Vec3d a, Vec3d b, Vec3d c) { return length(cross(b - a, c - a)) / 2; }

struct Pyramids {
  bool exact;
  double operator()(Vec3d a, Vec3d b, Vec3d c) const {
    const double volume = dot(a, cross(b, c)) / 6;
    return exact ? volume : std::abs(volume);
  }
};

}  // namespace

Mass shellMass(const MeshAsset& mesh) {
  Mass out;
  forTriangles(mesh, {}, [&](Vec3d a, Vec3d b, Vec3d c) {
    const double area = areaOf(a, b, c);
    out.mass += area;
    out.center = out.center + (a + b + c) * (area / 3);
  });
  if (!(out.mass > 0)) return {};
  out.center = out.center * (1 / out.mass);
  Sym3d sum;
  forTriangles(mesh, out.center,
               [&](Vec3d a, Vec3d b, Vec3d c) { sum = sum + products(a, b, c) * (areaOf(a, b, c) / 12); });
  out.inertia = inertiaOf(sum);
  return out;
}

Mass solidMass(const MeshAsset& mesh, bool exact) {
  const Pyramids volumeOf{exact};
  const Vec3d tip = shellMass(mesh).center;
  Mass out;
  forTriangles(mesh, tip, [&](Vec3d a, Vec3d b, Vec3d c) {
    const double volume = volumeOf(a, b, c);
    out.mass += volume;
    out.center = out.center + (a + b + c) * (volume / 4);
  });
  if (!(out.mass > 0)) return {};
  out.center = tip + out.center * (1 / out.mass);
  Sym3d sum;
  double again = 0;  // pyramids over the new centre; another volume where not all of them point outwards
  forTriangles(mesh, out.center, [&](Vec3d a, Vec3d b, Vec3d c) {
    const double volume = volumeOf(a, b, c);
    again += volume;
    sum = sum + products(a, b, c) * (volume / 20);
  });
  if (!(again > 0)) return {};
  out.inertia = inertiaOf(sum) * (out.mass / again);
  return out;
}

namespace {

// Principal moments, largest first, and the turn to their axes.
Principal ordered(const Mass& mass) {
  Sym3d m = mass.inertia;
  // What rounding leaves off the diagonal would turn the axes of a symmetric mesh by any angle.
  const double tiny = 1e-12 * (m.xx + m.yy + m.zz);
  for (double* off : {&m.xy, &m.xz, &m.yz}) *off = std::abs(*off) < tiny ? 0 : *off;
  Principal p = principal(m);
  for (size_t i = 0; i < 2; ++i) {
    for (size_t k = 0; k + 1 < 3; ++k) {
      if (p.values[k] < p.values[k + 1]) {
        std::swap(p.values[k], p.values[k + 1]);
        std::swap(p.axes[k], p.axes[k + 1]);
      }
    }
  }
  p.axes[2] = cross(p.axes[0], p.axes[1]);
  return p;
}

}  // namespace

void fitToInertia(const MeshAsset& mesh, Geom& geom) {
  const Mass& mass = geom.isShell ? mesh.shell : mesh.solid;
  const Principal p = ordered(mass);
  const auto half = [&](size_t a, size_t b, size_t c) {
    return std::sqrt(std::max(0.0, 6 * (p.values[a] + p.values[b] - p.values[c]) / mass.mass)) / 2;
  };
  const Vec3d box{half(1, 2, 0), half(0, 2, 1), half(0, 1, 2)};
  Vec3d size = box;
  if (geom.kind == GeomKind::Sphere) size = {(box.x + box.y + box.z) / 3, 0, 0};
  if (geom.kind == GeomKind::Capsule) size = {(box.x + box.y) / 2, std::max(0.0, box.z - (box.x + box.y) / 4), 0};
  if (geom.kind == GeomKind::Cylinder) size = {(box.x + box.y) / 2, box.z, 0};
  geom.size = size;
  geom.pose = geom.pose * Posed{mass.center, fromAxes(p.axes[0], p.axes[1], p.axes[2])};
}

void fitAround(const MeshAsset& mesh, Geom& geom) {
  const Mass& mass = geom.isShell ? mesh.shell : mesh.solid;
  const Principal p = ordered(mass);
  const Posed frame{mass.center, fromAxes(p.axes[0], p.axes[1], p.axes[2])};
  std::vector<Vec3d> points = mesh.vertices;
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  for (Vec3d& v : points) {
    v = rotate(conjugate(frame.rotation), v - frame.position);
    lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
    upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
  }
  const Vec3d center = (lower + upper) * 0.5;
  Vec3d size = (upper - lower) * 0.5;
  double radius = 0, across = 0, along = 0;
  for (const Vec3d& v : points) {
    const Vec3d d = v - center;
    radius = std::max(radius, length(d));
    across = std::max(across, std::sqrt(d.x * d.x + d.y * d.y));
    along = std::max(along, std::abs(d.z));
  }
  if (geom.kind == GeomKind::Sphere) size = {radius, 0, 0};
  if (geom.kind == GeomKind::Cylinder) size = {across, along, 0};
  if (geom.kind == GeomKind::Capsule) {
    double half = 0;  // so that the ends, too, lie around every vertex
    for (const Vec3d& v : points) {
      const Vec3d d = v - center;
      const double end = std::sqrt(std::max(0.0, across * across - d.x * d.x - d.y * d.y));
      half = std::max(half, std::abs(d.z) - end);
    }
    size = {across, half, 0};
  }
  geom.size = size;
  geom.pose = geom.pose * frame * Posed{center, {}};
}

}  // namespace avbd::mjcf
