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

#include "collide/collide_convex_oracle.h"

#ifdef AVBD_CCD
#include "collide/collide_ccd.h"
#endif

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
#ifdef AVBD_CCD
  const Vec3d d = oracle::ccdDirection(s);
  if (!(length(d) > 0)) return;
  ++e.ccdAnswers;
  const double theirs = std::max(s.gap(d), s.gap(d * -1.0)) - s.gap(normal);
  e.ccdBetter = std::max(e.ccdBetter, theirs / size);
  e.ccdWorse += theirs < -1e-4 * size;
#endif
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
