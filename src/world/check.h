// Refuses bad input: one Error that names the definition, the field, its value and the range; nothing has changed then.
#pragma once

#include <avbd/world.h>

#include <span>
#include <string>
#include <vector>

#include "base/format.h"
#include "world/world_data.h"

namespace avbd {

/// Where a value stands: "BodyDef" / "shapes"[2] / "radius". Becomes text only when something is refused. Refers to the
/// path it was made from, which must outlive it.
class Path {
 public:
  explicit constexpr Path(const char* definition) : name_(definition) {}
  constexpr Path operator/(const char* field) const { return Path(this, field, -1); }
  constexpr Path operator[](size_t index) const { return Path(this, "", static_cast<int64_t>(index)); }
  [[noreturn]] void refuse(std::string value, std::string range) const;

 private:
  constexpr Path(const Path* parent, const char* name, int64_t index) : parent_(parent), name_(name), index_(index) {}
  std::string field() const;
  const Path* parent_ = nullptr;
  const char* name_;
  int64_t index_ = -1;
};

/// Allowed interval. `open` leaves out the lower end.
struct Range {
  double low, high;
  bool open = false;
};
constexpr Range positive(double high) { return {0, high, true}; }
constexpr Range notNegative(double high) { return {0, high}; }
constexpr Range symmetric(double high) { return {-high, high}; }
std::string toText(Range range);  ///< "must be finite and > 0 and at most 1e+06"

// One value. All throw Error.
void check(const Path& path, float value, Range range);
void check(const Path& path, double value, Range range);
void check(const Path& path, int value, Range range);
void check(const Path& path, Vec3 value, Range eachComponent);
void check(const Path& path, Vec3d value, Range eachComponent);
Quat checkedRotation(const Path& path, Quat value);  ///< made exactly unit
Pose checkedPose(const Path& path, const Pose& value, double maxPosition);

// Definitions. `unit` is WorldDef::lengthUnit.
void checkWorld(const WorldDef& def);
void checkGeometry(const Path& path, const Geometry& geometry, float unit);
void checkGeometry(const Path& path, const Geometry& geometry, Range size);  ///< size: of each of its lengths
/// Unbounded and hollow shapes belong to static and kinematic bodies.
void checkMayMove(const Path& path, const Geometry& geometry, BodyType type);
void checkMaterial(const Path& path, const Material& material);
/// Of the triangles of a surface; none is right too.
void checkMaterials(const Path& path, std::span<const Material> materials, const Geometry& geometry);
/// Returns the shape with its rotation made exact.
ShapeDef checkedShape(const Path& path, const ShapeDef& def, BodyType type, float unit);
void checkLocks(const Path& path, uint8_t locks);
void checkVelocity(const Path& path, const Velocity& velocity, float unit);
void checkMassProperties(const Path& path, const MassProperties& properties, float unit);
/// Mass that shapes gave: in the range that the solver can work with.
void checkShapesMass(const Path& path, const MassProperties& properties);

/// What a BodyDef comes to.
struct BodyPlan {
  Pose pose;
  std::vector<ShapeDef> shapes;  ///< `shape` first
  MassProperties mass;           ///< of a dynamic body
};
BodyPlan checkedBody(const BodyDef& def, float unit);

/// Returns the soft body with its rotation made exact.
SoftDef checkedSoft(const WorldData& data, const SoftDef& def);

// Ids. `path` names the call and its parameter. Return the slot.
uint32_t slotOf(const WorldData& data, BodyId id, const Path& path);
uint32_t slotOf(const WorldData& data, ShapeId id, const Path& path);
uint32_t slotOf(const WorldData& data, JointId id, const Path& path);
uint32_t slotOf(const WorldData& data, SoftId id, const Path& path);
uint32_t movableSlotOf(const WorldData& data, BodyId id, const Path& path);  ///< not a static body's
uint32_t dynamicSlotOf(const WorldData& data, BodyId id, const Path& path);

// Joints, ready to be added.
JointData checkedJoint(const WorldData& data, const BallJoint& def);
JointData checkedJoint(const WorldData& data, const FixedJoint& def);
JointData checkedJoint(const WorldData& data, const TetVolume& def);

/// A hinge, slider or D6 joint, ready to be added.
struct D6Plan {
  JointData joint;
  D6Data d6;
};
D6Plan checkedJoint(const WorldData& data, const HingeJoint& def);
D6Plan checkedJoint(const WorldData& data, const SliderJoint& def);
D6Plan checkedJoint(const WorldData& data, const D6Joint& def);
/// A distance joint, pulley, coupling or custom joint, ready to be added.
struct LinkPlan {
  JointData joint;
  LinkData link;
};
LinkPlan checkedJoint(const WorldData& data, const DistanceJoint& def);
LinkPlan checkedJoint(const WorldData& data, const PulleyJoint& def);
LinkPlan checkedJoint(const WorldData& data, const Coupling& def);
LinkPlan checkedJoint(const WorldData& data, const CustomJoint& def);
/// swing: of one of two free swings; angular: of an angle.
void checkAxis(const Path& path, const D6Axis& axis, bool swing, bool angular, double unit);
void checkSpring(const Path& path, const JointSpring& spring, bool angular, double unit);
void checkSlerpDrive(const Path& path, const SlerpDrive& drive);
void checkBreak(const Path& path, const JointBreak& limits);
/// angular: of an angle. Returns nothing: limits and drives are kept as they are.
void checkLimit(const Path& path, const JointLimit& limit, bool swing, bool angular, double unit);
void checkDrive(const Path& path, const JointDrive& drive, bool angular, double unit);

}  // namespace avbd
