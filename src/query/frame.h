// Points and directions between the world and a shape's frame, in double.
#pragma once

#include <avbd/types.h>

namespace avbd {

constexpr Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3d crossOf(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3d unitOf(Vec3d a) { return a * (1 / length(a)); }

/// A pose as an exact rotation matrix: float quaternions are a rounding away from unit.
class Frame {
 public:
  explicit Frame(const Pose& pose) : p_(pose.position) {
    const double w = pose.rotation.w, x = pose.rotation.x, y = pose.rotation.y, z = pose.rotation.z;
    const double k = 1 / (w * w + x * x + y * y + z * z);
    x_ = Vec3d{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)} * k;
    y_ = Vec3d{2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)} * k;
    z_ = Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z} * k;
  }
  Vec3d origin() const { return p_; }
  Vec3d toWorld(Vec3d direction) const { return x_ * direction.x + y_ * direction.y + z_ * direction.z; }
  Vec3d toLocal(Vec3d direction) const { return {dot(x_, direction), dot(y_, direction), dot(z_, direction)}; }
  Vec3d pointToWorld(Vec3d point) const { return p_ + toWorld(point); }
  Vec3d pointToLocal(Vec3d point) const { return toLocal(point - p_); }

 private:
  Vec3d p_, x_, y_, z_;  ///< origin and axes
};

}  // namespace avbd
