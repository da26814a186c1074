// What a user's family needs besides its rows: building J, and the law tests (avbd/custom_joint.h).
#include <avbd/custom_joint.h>

#include <algorithm>
#include <cmath>

#include "step/free_motion.h"

namespace avbd {
namespace {

Vec3d crossd(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double component(Vec3d v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
Vec3d unitVector(int i) { return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; }

std::vector<CustomRow> rowsAt(const CustomFamily& family, std::span<const CustomBody> bodies,
                              std::span<const float> constants, std::span<const float> memory) {
  std::vector<CustomRow> rows(static_cast<size_t>(std::clamp(family.rowCount(), 0, kCustomRows)));
  family.evaluate(bodies, bodies, 0, constants, memory, rows);
  return rows;
}

/// The body moved along axis 0 .. 2, or turned about its centre of mass and axis 3 .. 5.
CustomBody moved(const CustomBody& body, int axis, double by) {
  CustomBody out = body;
  if (axis < 3) {
    out.pose.position = out.pose.position + unitVector(axis) * by;
    out.center = out.center + unitVector(axis) * by;
    return out;
  }
  const Vec3d about = unitVector(axis - 3) * std::sin(by / 2);
  const Quat turn{static_cast<float>(std::cos(by / 2)), static_cast<float>(about.x), static_cast<float>(about.y),
                  static_cast<float>(about.z)};
  const Vec3d arm = body.pose.position - body.center;
  // In double: the turn of an arm, not of a float's quaternion.
  const Vec3d n = unitVector(axis - 3);
  const Vec3d turned = arm * std::cos(by) + crossd(n, arm) * std::sin(by) + n * (dot(n, arm) * (1 - std::cos(by)));
  out.pose.rotation = turn * body.pose.rotation;
  out.pose.position = body.center + turned;
  return out;
}

}  // namespace

void CustomFamily::remember(std::span<const CustomBody>, std::span<const float>, std::span<float>) const {}

void CustomRow::addPoint(int body, const CustomBody& at, Vec3d point, Vec3 direction) {
  const size_t i = static_cast<size_t>(body);
  linear[i] = linear[i] + direction;
  angular[i] = angular[i] + cross(toFloat(point - at.center), direction);
}

double jacobianError(const CustomFamily& family, std::span<const CustomBody> bodies, std::span<const float> constants,
                     std::span<const float> memory, double step) {
  const std::vector<CustomRow> here = rowsAt(family, bodies, constants, memory);
  double worst = 0;
  std::vector<CustomBody> at(bodies.begin(), bodies.end());
  for (size_t b = 0; b < bodies.size(); ++b)
    for (int axis = 0; axis < 6; ++axis) {
      at[b] = moved(bodies[b], axis, step);
      const std::vector<CustomRow> up = rowsAt(family, at, constants, memory);
      at[b] = moved(bodies[b], axis, -step);
      const std::vector<CustomRow> down = rowsAt(family, at, constants, memory);
      at[b] = bodies[b];
      for (size_t i = 0; i < here.size(); ++i) {
        const Vec3 j = axis < 3 ? here[i].linear[b] : here[i].angular[b];
        const double found = (up[i].C - down[i].C) / (2 * step);
        worst = std::max(worst, std::abs(found - component(toDouble(j), axis % 3)));
      }
    }
  return worst;
}

double reactionError(const CustomFamily& family, std::span<const CustomBody> bodies, std::span<const float> constants,
                     std::span<const float> memory) {
  double worst = 0;
  for (const CustomRow& row : rowsAt(family, bodies, constants, memory)) {
    Vec3d force, torque;
    for (size_t b = 0; b < bodies.size(); ++b) {
      force = force + toDouble(row.linear[b]);
      torque = torque + toDouble(row.angular[b]) + crossd(bodies[b].center, toDouble(row.linear[b]));
    }
    worst = std::max({worst, length(force), length(torque)});
  }
  return worst;
}

}  // namespace avbd
