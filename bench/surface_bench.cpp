// Size and build time of meshes and height fields, and time per box query, ray and collideSurface on them, as tables.
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>

#include "collide/collide_surface.h"
#include "geom/triangles.h"

namespace avbd {
namespace {

/// Seconds that this thread has worked, so that other programs do not count.
double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds a call takes: the least of five runs of about 40 ms.
template <class F>
double timeOf(F&& f) {
  double best = 1e9;
  for (int run = 0; run < 5; ++run) {
    const double start = now();
    int calls = 0;
    do {
      for (int i = 0; i < 64; ++i) f();
      calls += 64;
    } while (now() - start < 0.04);
    best = std::min(best, (now() - start) / calls);
  }
  return best;
}

struct Source {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Ground 40 m wide in side x side cells of two triangles; `height` [m] of its bumps.
Source ground(int side, float height) {
  Source s;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  const float spacing = 40 / static_cast<float>(side);
  for (int r = 0; r <= side; ++r) {
    for (int c = 0; c <= side; ++c) {
      const float x = static_cast<float>(c) * spacing - 20, z = static_cast<float>(r) * spacing - 20;
      s.vertices.push_back({x, height * unit(random), z});
    }
  }
  const auto at = [&](int c, int r) { return static_cast<uint32_t>(r * (side + 1) + c); };
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      s.triangles.push_back({at(c, r), at(c, r + 1), at(c + 1, r + 1)});
      s.triangles.push_back({at(c, r), at(c + 1, r + 1), at(c + 1, r)});
    }
  }
  return s;
}

Geometry field(int side, float height) {
  const Source s = ground(side, height);
  std::vector<float> heights;
  for (const Vec3 v : s.vertices) heights.push_back(v.y);
  const float spacing = 40 / static_cast<float>(side);
  return HeightField{makeHeightField(
      {.columns = side + 1, .rows = side + 1, .spacingX = spacing, .spacingZ = spacing, .heights = heights})};
}

Geometry mesh(int side, float height) {
  const Source s = ground(side, height);
  return Mesh{makeMesh({.vertices = s.vertices, .triangles = s.triangles})};
}

void sizes() {
  std::printf("| triangles | bytes per triangle | of these the tree | build [ms] |\n|---|---|---|---|\n");
  for (const int side : {22, 71, 224, 707}) {
    const Source s = ground(side, 0.1f);
    const double start = now();
    const auto data = makeMesh({.vertices = s.vertices, .triangles = s.triangles});
    const double took = now() - start;
    const auto count = static_cast<double>(data->triangleCount());
    // Corners and neighbours 24, source 4, about half a vertex 6.
    const double vertices = 12.0 * static_cast<double>(s.vertices.size()) / count;
    const double bytes = static_cast<double>(data->report().bytes) / count;
    std::printf("| %u | %.1f | %.1f | %.2f |\n", data->triangleCount(), bytes, bytes - 28 - vertices, took * 1e3);
  }
  std::vector<float> heights(1025 * 1025, 0.0f);
  const double start = now();
  const auto data = makeHeightField({.columns = 1025, .rows = 1025, .heights = heights});
  std::printf("\nHeight field of 1025 x 1025: %.2f bytes per sample, made in %.2f ms.\n\n",
              static_cast<double>(data->bytes()) / (1025.0 * 1025), (now() - start) * 1e3);
}

void queries(const char* name, const Geometry& geometry) {
  const ShapeGeom geom = toShapeGeom(geometry);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Vec3> places;
  for (int i = 0; i < 1024; ++i) places.push_back({19 * unit(random), 0, 19 * unit(random)});
  size_t i = 0;
  uint64_t found = 0, boxes = 0;
  const auto next = [&] { return places[i++ & 1023]; };
  const double box = timeOf([&] {
    const Vec3 p = next(), e{0.5f, 0.5f, 0.5f};
    ++boxes;
    forEachTriangle(geom, {p - e, p + e}, [&](const SurfaceTriangle&) { return ++found != 0; });
  });
  // Nearest hit by the plane and sides of each triangle that is given.
  uint64_t hits = 0;
  const auto ray = [&](Vec3 from, Vec3 motion) {
    float least = 2;
    forEachTriangleAlong(geom, from, motion, {}, [&](const SurfaceTriangle& t, float fraction) {
      const float height = dot(t.normal, from - t.v[0]), speed = dot(t.normal, motion);
      const float at = -height / speed;
      if (!(at >= 0 && at < fraction)) return fraction;
      const Vec3 p = from + motion * at;
      for (int k = 0; k < 3; ++k) {
        if (dot(cross(t.v[(k + 1) % 3] - t.v[k], t.normal), p - t.v[k]) > 0) return fraction;
      }
      least = at;
      return at;
    });
    hits += least < 2 ? 1 : 0;
  };
  const double down = timeOf([&] { ray(next() + Vec3{0, 5, 0}, {0.3f, -10, 0.2f}); });
  const double slant = timeOf([&] { ray(next() + Vec3{0, 2, 0}, {15, -4, 10}); });
  std::printf("| %s | %.0f (%.1f found) | %.0f | %.0f |\n", name, box * 1e9,
              static_cast<double>(found) / static_cast<double>(boxes), down * 1e9, slant * 1e9);
}

void contacts(const char* name, const Geometry& surface) {
  std::vector<Vec3> points;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 60; ++i) {
    const Vec3 p{unit(random), unit(random), unit(random)};
    points.push_back(p * (0.5f / length(p)));
  }
  const Geometry shapes[] = {Sphere{0.5f}, Capsule{0.3f, 0.4f}, Box{0.5f, 0.5f, 0.5f}, Cylinder{0.5f, 0.5f},
                             Hull{makeHull({.points = points, .maxVertices = 32})}};
  const ShapeGeom geom = toShapeGeom(surface);
  std::printf("| %s |", name);
  std::vector<SurfacePatch> out;
  for (const Geometry& shape : shapes) {
    const ShapeGeom convex = toShapeGeom(shape);
    std::vector<NearPose> poses;
    for (int i = 0; i < 256; ++i) {
      const float a = 3 * unit(random);
      poses.push_back({{19 * unit(random), 0.5f, 19 * unit(random)}, {std::cos(a / 2), 0, std::sin(a / 2), 0}});
    }
    size_t i = 0, patches = 0, calls = 0;
    const double time = timeOf([&] {
      collideSurface(convex, poses[i++ & 255], geom, {}, 0.02f, out);
      patches += out.size();
      ++calls;
    });
    std::printf(" %.2f (%.1f) |", time * 1e6, static_cast<double>(patches) / static_cast<double>(calls));
  }
  std::printf("\n");
}

/// A slab 10 m wide over cells of 0.1 m: 20,000 triangles below it.
void slabs(const char* name, const Geometry& surface) {
  const ShapeGeom slab = toShapeGeom(Box{5, 0.25f, 5}), geom = toShapeGeom(surface);
  std::vector<SurfacePatch> out;
  std::printf("| %s |", name);
  for (const float depth : {0.0f, 0.002f, 0.05f}) {
    double best = 1e9;
    for (int run = 0; run < 3; ++run) {
      const double start = now();
      collideSurface(slab, {{0.03f, 0.25f - depth, 0.04f}, {0.9689f, 0, 0.2474f, 0}}, geom, {}, 0.02f, out);
      best = std::min(best, now() - start);
    }
    std::printf(" %.1f (%zu) |", best * 1e3, out.size());
  }
  std::printf("\n");
}

}  // namespace
}  // namespace avbd

int main() {
  using namespace avbd;
  sizes();
  std::printf("| surface | 1 m box [ns] | ray down [ns] | ray slant, 18 m [ns] |\n|---|---|---|---|\n");
  queries("mesh of 100k triangles, rough", mesh(224, 0.1f));
  queries("height field of 224 x 224 cells, rough", field(224, 0.1f));
  queries("mesh of 3200 triangles, rough", mesh(40, 0.1f));
  queries("height field of 40 x 40 cells, rough", field(40, 0.1f));
  std::printf("\n| surface, cells of 1 m; [us] (patches) | sphere | capsule | box | cylinder | hull of 32 |\n");
  std::printf("|---|---|---|---|---|---|\n");
  contacts("flat mesh", mesh(40, 0));
  contacts("rough mesh", mesh(40, 0.1f));
  contacts("flat height field", field(40, 0));
  contacts("rough height field", field(40, 0.1f));
  contacts("flat mesh, cells of 0.25 m", mesh(160, 0));
  contacts("rough mesh, cells of 0.25 m", mesh(160, 0.02f));
  std::printf(
      "\n| slab of 10 m on cells of 0.1 m; [ms] (patches) | at rest | 2 mm deep | 50 mm deep |\n|---|---|---|---|\n");
  slabs("flat mesh", mesh(400, 0));
  slabs("rough mesh", mesh(400, 0.002f));
  slabs("flat height field", field(400, 0));
  return 0;
}
