// One move of a Mover: casts and planes.
#pragma once

#include <avbd/mover.h>
#include <avbd/world.h>

namespace avbd {

/// The capsule must stay on the front of it: normal . (center - point) >= 0.
struct MoverPlane {
  Vec3 normal;
  Vec3d point;
};

/// A Mover's capsule on its way through the world. `center` is the capsule's.
class Mover::Walk {
 public:
  Walk(const World& world, const Mover& mover, Vec3d center);

  Vec3d center() const { return center_; }
  /// Straight, until skin away from what is met.
  CastHit advance(Vec3 motion, const QueryFilter& filter);
  /// Towards center + motion as near as obstacles allow. level: not up what is too steep to stand on.
  void slide(Vec3 motion, bool level);
  /// The same with steps: over what is no higher than stepHeight.
  void stride(Vec3 motion);
  /// Down by no more than this, where there is ground to stand on; otherwise stays and returns false.
  bool settle(float depth);
  /// Out of what it overlaps, as far as other things let it.
  void recover();
  /// What is under the capsule within this distance, apart from what overlaps it.
  MoverGround findGround(float depth) const;

 private:
  /// What overlaps at the start counts only where the motion goes deeper into it.
  CastHit cast(Vec3 motion, const QueryFilter& filter) const;
  CastHit castOutOf(const std::vector<NearHit>& overlaps, Vec3 motion, const QueryFilter& filter) const;
  std::vector<NearHit> overlaps(const QueryFilter& filter) const;
  bool isGround(const CastHit& hit, Vec3& normal) const;
  void gatherPlanes(std::vector<MoverPlane>& planes, bool level) const;
  MoverPlane planeOf(Vec3 normal, float gap, bool level) const;
  float rise(Vec3d point) const { return static_cast<float>(dot(point - center_, toDouble(def_.up))) + foot_; }

  const World& world_;
  const MoverDef& def_;
  Capsule capsule_;
  Quat rotation_;
  Vec3d center_;
  float foot_;      ///< from the lowest point to the center
  float flattest_;  ///< up-component of the steepest ground's normal
};

/// The motion nearest to `wanted` that keeps `center` on the front of all planes.
Vec3 clipMotion(Vec3 wanted, Vec3d center, const std::vector<MoverPlane>& planes);

}  // namespace avbd
