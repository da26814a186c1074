// A soft ring made of its surface, that falls on the ground and carries that surface.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trig.h"

namespace avbd::scenes {
namespace {

struct Surface {
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// A torus about the y axis, 0.5 m across.
Surface torus() {
  constexpr double kTurn = 6.283185307179586, kRing = 0.175, kTube = 0.075;
  constexpr uint32_t kAround = 48, kAbout = 24;
  Surface s;
  for (uint32_t i = 0; i < kAround; ++i)
    for (uint32_t k = 0; k < kAbout; ++k) {
      const double a = kTurn * i / kAround, b = kTurn * k / kAbout, r = kRing + kTube * cosine(b);
      s.points.push_back(toFloat(Vec3d{r * cosine(a), kTube * sine(b), r * sine(a)}));
      const uint32_t next = (i + 1) % kAround * kAbout, up = (k + 1) % kAbout;
      const uint32_t p = i * kAbout + k, q = i * kAbout + up, u = next + up, v = next + k;
      s.triangles.push_back({p, q, u});
      s.triangles.push_back({p, u, v});
    }
  return s;
}

/// The ring, made once: its surface, the lattice within, and how the one follows the other.
struct Ring {
  Surface surface = torus();
  std::shared_ptr<const SoftMeshData> mesh =
      makeTetLattice({.points = surface.points, .triangles = surface.triangles, .cellSize = 0.04f});
  SurfaceBinding binding{{mesh, surface.points}};
};

const Ring& ring() {
  static const Ring made;
  return made;
}

Model softTorus(const Settings& settings) {
  Build build("soft_torus", settings);
  build.ground();
  build.soft("ring", {.mesh = ring().mesh,
                      .pose = {{0, 0.6, 0}, turned({0.6, 0, 0.8}, 0.9)},
                      .material = {.youngsModulus = 5e4f},
                      .radius = 0.005f});
  return build.take();
}

double sixVolumes(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  return dot(u, Vec3d{v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x});
}

double volumeOf(std::span<const Vec3d> points) {
  double six = 0;
  for (const auto& t : ring().surface.triangles) six += sixVolumes({}, points[t[0]], points[t[1]], points[t[2]]);
  return six / 6;
}

/// At the end, how many tetrahedra are inverted, and what the surface that the ring carries holds.
void observe(Evidence& e, const Layout& layout, std::span<const Pose> poses, int left) {
  if (left > 0) return;
  std::vector<Vec3d> points, fine(ring().surface.points.size());
  for (size_t i = 0; i < poses.size(); ++i)
    if (layout.dynamic[i]) points.push_back(poses[i].position);
  double inverted = 0;
  for (const auto& t : ring().mesh->tets())
    inverted += sixVolumes(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) > 0 ? 0 : 1;
  e.own["inverted"] = inverted;
  ring().binding.skin(points, fine);
  const double now = volumeOf(fine);
  for (size_t i = 0; i < fine.size(); ++i) fine[i] = toDouble(ring().surface.points[i]);
  e.own["carried_volume"] = now / volumeOf(fine);
}

/// A run that ended before its last step has none: no figure passes with that.
double ownFigure(const Evidence& e, const char* name) {
  const auto found = e.own.find(name);
  return found == e.own.end() ? std::nan("") : found->second;
}

std::vector<Figure> check(const Evidence& e) {
  return {holds("finite", e.finite), atMost("inverted", ownFigure(e, "inverted"), 0, "tetrahedra"),
          atMost("penetration", e.penetration.max, 0.005, "m"),
          within("carried_volume", ownFigure(e, "carried_volume"), 1, 0.05, "of rest"),
          holds("lies", e.top > 0.1 && e.top < 0.16)};
}

}  // namespace

Scene softTorusScene() {
  Scene scene{"soft_torus", "",   "a soft ring of 0.5 m, a lattice made of its surface, that falls on the ground",
              softTorus,    0,    300,
              {},           check};
  scene.watch.observe = observe;
  return scene;
}

}  // namespace avbd::scenes
