// Largest errors of collision between any two convex shapes over random configurations, as a markdown table.
//
//   collide_errors [configurations per pair, 10000]
//
// depth: what some direction separates better than the answer's normal does, as the oracle (every face, every pair of
// edges, directions all round, climbing) finds it, in parts of the two shapes' size. own: difference between the answer
// and what its own normal shows. libccd: how much libccd's depth along its own direction is worse than ours at most,
// and how often its answer is worse than ours by over 1e-4 of the size; better: how much it ever is better.
#include <avbd/hull.h>

#include <cstdio>
#include <cstdlib>

#ifdef AVBD_HAS_CCD
#include <ccd/ccd.h>
#endif

#include "collide/collide_convex_oracle.h"

namespace avbd {
namespace {

using oracle::Asked;
using oracle::Random;

constexpr ShapeType kTypes[] = {ShapeType::Sphere, ShapeType::Capsule,   ShapeType::Box,        ShapeType::Cylinder,
                                ShapeType::Cone,   ShapeType::Ellipsoid, ShapeType::RoundedBox, ShapeType::Hull};
const char* const kNames[] = {"Sphere", "Capsule", "Box", "Cylinder", "Cone", "Ellipsoid", "RoundedBox", "Hull"};

struct Errors {
  double depth = 0, distance = 0, own = 0, ccdBetter = 0;
  int overlapping = 0, ccdWorse = 0, ccdAnswers = 0;
};

Asked randomPair(Random& random, ShapeType a, ShapeType b) {
  Asked s{random.shape(a), random.shape(b), {}, {}};
  s.poseA.q = random.usualRotation();
  s.poseB.q = random.usualRotation();
  const Vec3 d = random.below(4) ? rotate(random.rotation(), Vec3{1, 0, 0}) : Vec3{0, 1, 0};
  s.poseB.p = d * random.within(0, 1.6f);
  return s;
}

#ifdef AVBD_HAS_CCD
struct Sided {
  const ShapeGeom* shape;
  const NearPose* pose;
};

void ccdSupport(const void* what, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const Sided& s = *static_cast<const Sided*>(what);
  const Vec3d d{direction->v[0], direction->v[1], direction->v[2]};
  const Vec3 local = support(*s.shape, toFloat(oracle::unitRotate(Asked::back(s.pose->q), d)));
  const Vec3d p = oracle::unitRotate(s.pose->q, toDouble(local)) + s.pose->p + d * (s.shape->radius / length(d));
  out->v[0] = p.x, out->v[1] = p.y, out->v[2] = p.z;
}

/// The direction in which libccd parts them; zero where it sees no overlap.
Vec3d ccdDirection(const Asked& s) {
  const Sided a{&s.a, &s.poseA}, b{&s.b, &s.poseB};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccdSupport;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-6;
  ccd_real_t depth;
  ccd_vec3_t direction, position;
  if (ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &position) != 0) return {};
  const Vec3d d{direction.v[0], direction.v[1], direction.v[2]};
  return length(d) > 1e-9 ? oracle::unitOf(d) : Vec3d{};
}
#else
Vec3d ccdDirection(const Asked&) { return {}; }
#endif

void measure(Random& random, std::mt19937& climbing, ShapeType a, ShapeType b, Errors& e) {
  const Asked s = randomPair(random, a, b);
  const double size = oracle::size(s.a) + oracle::size(s.b);
  const Nearest n = nearest(s.a, s.poseA, s.b, s.poseB, 1e9f);
  const Vec3d normal = oracle::unitOf(toDouble(n.normal));
  e.own = std::max(e.own, std::fabs(s.gap(normal) - n.distance) / size);
  const double missed = (oracle::largestGap(s, normal, 200, climbing) - s.gap(normal)) / size;
  double& worst = n.distance < 0 ? e.depth : e.distance;
  worst = std::max(worst, missed);
  if (n.distance >= 0) return;
  ++e.overlapping;
  const Vec3d d = ccdDirection(s);
  if (!(length(d) > 0)) return;
  ++e.ccdAnswers;
  const double theirs = std::max(s.gap(d), s.gap(d * -1.0)) - s.gap(normal);
  e.ccdBetter = std::max(e.ccdBetter, theirs / size);
  e.ccdWorse += theirs < -1e-4 * size;
}

}  // namespace
}  // namespace avbd

int main(int argc, char** argv) {
  using namespace avbd;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 10000;
  std::printf(
      "| pair | overlapping | depth | distance | own | libccd better | libccd worse "
      "|\n|---|---|---|---|---|---|---|\n");
  for (int i = 0; i < 8; ++i) {
    for (int j = i; j < 8; ++j) {
      oracle::Random random(static_cast<uint32_t>(100 + 8 * i + j));
      std::mt19937 climbing(1);
      Errors e;
      for (int k = 0; k < rounds; ++k) measure(random, climbing, kTypes[i], kTypes[j], e);
      std::printf("| %s, %s | %d | %.1e | %.1e | %.1e | %.1e | %d of %d |\n", kNames[i], kNames[j], e.overlapping,
                  e.depth, e.distance, e.own, e.ccdBetter, e.ccdWorse, e.ccdAnswers);
      std::fflush(stdout);
    }
  }
  return 0;
}
