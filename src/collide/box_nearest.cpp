// Box against box, apart: the nearest points, where no face or crossing of edges holds them.
//
// Every such pair of points has one on an edge of b (or of a, by its corners): the nearest points of b's twelve edges
// to box a and of a's eight corners to box b are all that there can be.
#include <limits>

#include "collide/box_pair.h"
#include "collide/segment_box.h"

namespace avbd {
namespace {

constexpr float kParallel = 0.01f;  // sine between edges that touch along a stretch

struct Nearest {
  float squared = std::numeric_limits<float>::infinity();
  Axes onA, onB;  // both in a's frame
  Axes localB;    // onB in b's frame
};

Axes toA(const BoxPair& p, const Axes& b) {
  Axes r;
  for (int i = 0; i < 3; ++i) r[i] = p.da[i] + (p.r[i][0] * b[0] + p.r[i][1] * b[1] + p.r[i][2] * b[2]);
  return r;
}

Axes toB(const BoxPair& p, const Axes& a) {
  Axes r;
  for (int j = 0; j < 3; ++j) r[j] = p.r[0][j] * a[0] + p.r[1][j] * a[1] + p.r[2][j] * a[2] - p.db[j];
  return r;
}

Axes within(const Axes& x, const float* h) {
  return {{clampTo(x[0], -h[0], h[0]), clampTo(x[1], -h[1], h[1]), clampTo(x[2], -h[2], h[2])}};
}

float squaredDistance(const Axes& a, const Axes& b) {
  const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

void tryEdgesOfB(const BoxPair& p, Nearest& best) {
  const Axes ha{{p.ha[0], p.ha[1], p.ha[2]}};
  for (int j = 0; j < 3; ++j) {
    const Axes half{{p.hb[j] * p.r[0][j], p.hb[j] * p.r[1][j], p.hb[j] * p.r[2][j]}};
    for (int k = 0; k < 4; ++k) {
      Axes local{};
      local[kNext[j]] = k & 1 ? p.hb[kNext[j]] : -p.hb[kNext[j]];
      local[kLast[j]] = k & 2 ? p.hb[kLast[j]] : -p.hb[kLast[j]];
      const Axes middle = toA(p, local);
      // Nothing of an edge is nearer than its bounds.
      float bound = 0;
      for (int i = 0; i < 3; ++i) {
        const float gap = larger(magnitude(middle[i]) - magnitude(half[i]) - p.ha[i], 0);
        bound += gap * gap;
      }
      if (bound >= best.squared) continue;
      const float t = nearestToBox(middle, half, ha);
      const Axes on{{middle[0] + t * half[0], middle[1] + t * half[1], middle[2] + t * half[2]}};
      const Axes onA = within(on, p.ha);
      const float squared = squaredDistance(on, onA);
      if (!(squared < best.squared)) continue;
      local[j] = t * p.hb[j];
      best = {squared, onA, on, local};
    }
  }
}

void tryCornersOfA(const BoxPair& p, Nearest& best) {
  for (int k = 0; k < 8; ++k) {
    const Axes corner{{k & 1 ? p.ha[0] : -p.ha[0], k & 2 ? p.ha[1] : -p.ha[1], k & 4 ? p.ha[2] : -p.ha[2]}};
    const Axes local = toB(p, corner), onB = within(local, p.hb);
    const float squared = squaredDistance(local, onB);
    if (squared < best.squared) best = {squared, corner, toA(p, onB), onB};
  }
}

/// Which corner, edge or face a point is on: per axis on the low side, between, on the high side.
uint32_t place(const Axes& x, const float* h) {
  uint32_t name = 0;
  for (int i = 0; i < 3; ++i) name = name * 3 + (x[i] <= -h[i] ? 0u : (x[i] >= h[i] ? 2u : 1u));
  return name;
}

/// The axis of the edge that a point is on, -1 if it is on none that lies across the normal.
int edgeOf(const Axes& x, const float* h, const Axes& normal) {
  for (int i = 0; i < 3; ++i) {
    const bool atEdge = magnitude(x[kNext[i]]) >= h[kNext[i]] && magnitude(x[kLast[i]]) >= h[kLast[i]];
    if (atEdge && magnitude(normal[i]) < kParallel) return i;
  }
  return -1;
}

/// Both ends of the stretch that two parallel edges share.
bool addStretch(const BoxPair& p, const Nearest& at, uint32_t name, Manifold& out) {
  const Axes n = axes(out.normal);
  Axes inB;
  for (int k = 0; k < 3; ++k) inB[k] = p.r[0][k] * n[0] + p.r[1][k] * n[1] + p.r[2][k] * n[2];
  const int i = edgeOf(at.onA, p.ha, n), j = edgeOf(at.localB, p.hb, inB);
  if (i < 0 || j < 0) return false;
  const float sine2 = p.r[kNext[i]][j] * p.r[kNext[i]][j] + p.r[kLast[i]][j] * p.r[kLast[i]][j];
  if (sine2 > kParallel * kParallel) return false;
  Axes local = at.localB;
  local[j] = 0;
  const Axes middle = toA(p, local);
  const float reach = p.hb[j] * p.absR[i][j];
  const float low = larger(-p.ha[i], middle[i] - reach), high = smaller(p.ha[i], middle[i] + reach);
  if (!(low < high)) return false;
  for (int end = 0; end < 2; ++end) {
    Axes onA = at.onA;
    onA[i] = end == 0 ? low : high;
    const float t = (onA[i] - middle[i]) / p.r[i][j];
    const Vec3 a = vec(onA), b{middle[0] + t * p.r[0][j], middle[1] + t * p.r[1][j], middle[2] + t * p.r[2][j]};
    const float separation = dot(out.normal, b - a);
    if (separation > p.margin) continue;
    addPoint(out, (a + b) * 0.5f, separation, name | (end == 0 ? 1024u : 2048u));
  }
  return out.count > 0;
}

}  // namespace

float touchNearest(const BoxPair& p, Manifold& out) {
  Nearest best;
  tryEdgesOfB(p, best);
  tryCornersOfA(p, best);
  const Vec3 gap = vec(best.onB) - vec(best.onA);
  const float distance = length(gap);
  const uint32_t name = 0x30000u | place(best.localB, p.hb) << 5 | place(best.onA, p.ha);
  out.count = 0;
  if (distance >= p.tolerance) {
    out.normal = gap * (1 / distance);
    if (addStretch(p, best, name, out)) return distance;
  }
  addPoint(out, (vec(best.onA) + vec(best.onB)) * 0.5f, distance, name);
  return distance;
}

}  // namespace avbd
