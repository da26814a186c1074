// For the tests: gaps of any two convex shapes in double by trying directions, sharing no code with the engine.
//
// Along a direction n the gap of two shapes is what separates them; the largest gap over all directions is their
// distance, or minus their depth. Any direction gives a lower bound of it, exact where it is the best one.
#pragma once

#include "collide/collide_oracle.h"
#include "collide/convex.h"

namespace avbd::oracle {

/// Farthest along a direction in the shape's frame, radius included.
inline double reach(const ShapeGeom& g, Vec3d n) {
  const double across = std::hypot(n.x, n.z), x = g.extent.x, y = g.extent.y, z = g.extent.z;
  double far = -1e300;
  switch (g.type) {
    case ShapeType::Sphere:
      far = 0;
      break;
    case ShapeType::Capsule:
      far = std::fabs(n.y) * y;
      break;
    case ShapeType::Cylinder:
      far = across * x + std::fabs(n.y) * y;
      break;
    case ShapeType::Cone:
      far = std::max(n.y * y, across * x - n.y * y);
      break;
    case ShapeType::Ellipsoid:
      far = std::hypot(n.x * x, n.y * y, n.z * z);
      break;
    case ShapeType::Hull:
      for (const Vec3& v : g.hull().vertices()) far = std::max(far, dot(n, toDouble(v)));
      break;
    case ShapeType::Triangle:
      for (int i = 0; i < 3; ++i) far = std::max(far, dot(n, toDouble(g.triangle()[i])));
      break;
    default:
      far = std::fabs(n.x) * x + std::fabs(n.y) * y + std::fabs(n.z) * z;
  }
  return far + g.radius * length(n);
}

/// A pair to be asked about directions.
struct Asked {
  ShapeGeom a, b;
  NearPose poseA, poseB;
  static Quat back(Quat q) { return {q.w, -q.x, -q.y, -q.z}; }
  double gap(Vec3d n) const {
    return dot(n, toDouble(poseB.p) - toDouble(poseA.p)) - reach(b, unitRotate(back(poseB.q), n * -1.0)) -
           reach(a, unitRotate(back(poseA.q), n));
  }
};

inline Vec3d unitOf(Vec3d v) { return v * (1 / length(v)); }

/// Normals and edges of a shape's flat parts, in the pair's frame.
inline void flatParts(const ShapeGeom& g, Quat q, std::vector<Vec3d>& normals, std::vector<Vec3d>& edges) {
  const auto axis = [&](std::vector<Vec3d>& to, Vec3d v) {
    if (length(v) > 0) to.push_back(unitOf(unitRotate(q, v)));
  };
  const Vec3d unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (g.type == ShapeType::Box || g.type == ShapeType::RoundedBox) {
    for (const Vec3d& u : unit) axis(normals, u), axis(normals, u * -1.0), axis(edges, u);
  }
  if (g.type == ShapeType::Capsule) axis(edges, unit[1]);
  if (g.type == ShapeType::Cylinder || g.type == ShapeType::Cone) {
    axis(normals, unit[1]), axis(normals, unit[1] * -1.0), axis(edges, unit[1]);
  }
  if (g.type == ShapeType::Triangle) {
    const Vec3* v = g.triangle();
    const Vec3d n = crossOf(toDouble(v[1]) - v[0], toDouble(v[2]) - v[0]);
    axis(normals, n), axis(normals, n * -1.0);
    for (int i = 0; i < 3; ++i) axis(edges, toDouble(v[(i + 1) % 3]) - v[i]);
  }
  if (g.type == ShapeType::Hull) {
    for (const auto& f : g.hull().faces()) {
      // All triangles of the face: merged faces are not quite plane.
      const auto at = [&](int i) {
        return toDouble(g.hull().vertices()[g.hull().loops()[static_cast<size_t>(f.first + i)]]);
      };
      for (int i = 1; i + 1 < f.count; ++i) axis(normals, crossOf(at(i) - at(0), at(i + 1) - at(0)));
      axis(normals, toDouble(f.normal));
    }
    for (const auto& e : g.hull().edges()) {
      axis(edges, toDouble(g.hull().vertices()[e.vertex[0]]) - g.hull().vertices()[e.vertex[1]]);
    }
  }
}

/// Distances of cores that are apart have directions that no list holds: climbed to from the best so far.
inline double climb(const Asked& s, Vec3d& n, double step, int rounds, std::mt19937& random) {
  std::normal_distribution<double> normal;
  double best = s.gap(n);
  for (int i = 0; i < rounds && step > 1e-9; ++i) {
    const Vec3d to = unitOf(n + Vec3d{normal(random), normal(random), normal(random)} * step);
    const double gap = s.gap(to);
    if (gap > best) {
      best = gap;
      n = to;
      step *= 1.6;
    } else {
      step *= 0.93;
    }
  }
  return best;
}

/// The largest gap found: all faces, all pairs of edges, directions all round, and climbing from the best few.
/// `hint`: a direction to climb from, too.
inline double largestGap(const Asked& s, Vec3d hint, int spread, std::mt19937& random) {
  std::vector<Vec3d> normals, edges, edgesB;
  flatParts(s.a, s.poseA.q, normals, edges);
  flatParts(s.b, s.poseB.q, normals, edgesB);
  for (const Vec3d& ea : edges) {
    for (const Vec3d& eb : edgesB) {
      const Vec3d n = crossOf(ea, eb);
      if (length(n) < 1e-7) continue;
      normals.push_back(unitOf(n));
      normals.push_back(normals.back() * -1.0);
    }
  }
  for (int i = 0; i < spread; ++i) {  // a spiral over the sphere
    const double y = 1 - (2.0 * i + 1) / spread, r = std::sqrt(1 - y * y), t = i * 2.399963229728653;
    normals.push_back({r * std::cos(t), y, r * std::sin(t)});
  }
  if (length(hint) > 0) normals.push_back(unitOf(hint));
  constexpr int kTop = 3;
  Vec3d top[kTop];
  double gaps[kTop] = {-1e300, -1e300, -1e300};
  for (const Vec3d& n : normals) {
    const double gap = s.gap(n);
    for (int k = 0; k < kTop; ++k) {
      if (gap <= gaps[k]) continue;
      if (k > 0 && dot(n, top[k - 1]) > 0.999) break;
      for (int j = kTop - 1; j > k; --j) top[j] = top[j - 1], gaps[j] = gaps[j - 1];
      top[k] = n, gaps[k] = gap;
      break;
    }
  }
  double best = gaps[0];
  for (Vec3d n : top) {
    if (length(n) > 0) best = std::max(best, climb(s, n, 0.1, 250, random));
  }
  return best;
}

/// How far a point sticks out of a shape at most, over directions all round: 0 or less where it is within.
inline double sticksOut(const ShapeGeom& g, const NearPose& pose, Vec3d p, int spread) {
  const Vec3d local = unitRotate(Asked::back(pose.q), p - pose.p);
  double out = -1e300;
  for (int i = 0; i < spread; ++i) {
    const double y = 1 - (2.0 * i + 1) / spread, r = std::sqrt(1 - y * y), t = i * 2.399963229728653;
    const Vec3d n{r * std::cos(t), y, r * std::sin(t)};
    out = std::max(out, dot(n, local) - reach(g, n));
  }
  return out;
}

}  // namespace avbd::oracle
