// The same pair put to libccd, for tests and benchmarks that link it.
#pragma once

#include <ccd/ccd.h>

#include "collide/collide_convex_oracle.h"

namespace avbd::oracle {

struct CcdShape {
  const ShapeGeom* shape;
  const NearPose* pose;
  double more = 0;  ///< [m] added all round
};

inline void ccdSupport(const void* what, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const CcdShape& s = *static_cast<const CcdShape*>(what);
  const Vec3d d{direction->v[0], direction->v[1], direction->v[2]};
  const Vec3 local = support(*s.shape, toFloat(unitRotate(Asked::back(s.pose->q), d)));
  const Vec3d p = unitRotate(s.pose->q, toDouble(local)) + s.pose->p + d * ((s.shape->radius + s.more) / length(d));
  out->v[0] = p.x, out->v[1] = p.y, out->v[2] = p.z;
}

inline ccd_t ccdSettings() {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccdSupport;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-6;
  return ccd;
}

/// The direction in which libccd parts them; zero where it sees no overlap.
inline Vec3d ccdDirection(const Asked& s) {
  const CcdShape a{&s.a, &s.poseA}, b{&s.b, &s.poseB};
  const ccd_t ccd = ccdSettings();
  ccd_real_t depth;
  ccd_vec3_t direction, position;
  if (ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &position) != 0) return {};
  const Vec3d d{direction.v[0], direction.v[1], direction.v[2]};
  return length(d) > 1e-9 ? unitOf(d) : Vec3d{};
}

/// Whether libccd sees an overlap when one shape has `more` all round.
inline bool ccdOverlap(const Asked& s, double more = 0) {
  const CcdShape a{&s.a, &s.poseA, more}, b{&s.b, &s.poseB};
  const ccd_t ccd = ccdSettings();
  return ccdGJKIntersect(&a, &b, &ccd) != 0;
}

/// Distance of shapes that do not overlap, at most `most`: how much more makes them overlap.
inline double ccdDistance(const Asked& s, double most) {
  double low = 0, high = most;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (ccdOverlap(s, middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace avbd::oracle
