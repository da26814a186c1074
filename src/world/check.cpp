// Paths, numbers, rotations and ids (check.h).
#include "world/check.h"

#include <cmath>

#include "world/limits.h"

namespace avbd {

std::string Path::field() const {
  if (!parent_) return "";
  std::string text = parent_->field();
  if (index_ >= 0) return text + "[" + toText(index_) + "]";
  if (!text.empty()) text += ".";
  return text + name_;
}

void Path::refuse(std::string value, std::string range) const {
  const Path* root = this;
  while (root->parent_) root = root->parent_;
  throw Error(root->name_, field(), std::move(value), std::move(range));
}

std::string toText(Range range) {
  if (range.low == -range.high) return "must be finite and between " + toText(range.low) + " and " + toText(range.high);
  return std::string("must be finite and ") + (range.open ? "> " : ">= ") + toText(range.low) + " and at most " +
         toText(range.high);
}

namespace {

// The ends are compared in the value's own type, so that a float written as the end is inside. False for NaN.
template <class T>
bool isIn(T value, Range range) {
  const T low = static_cast<T>(range.low), high = static_cast<T>(range.high);
  return (range.open ? value > low : value >= low) && value <= high;
}

}  // namespace

void check(const Path& path, float value, Range range) {
  if (!isIn(value, range)) path.refuse(toText(value), toText(range));
}

void check(const Path& path, double value, Range range) {
  if (!isIn(value, range)) path.refuse(toText(value), toText(range));
}

void check(const Path& path, int value, Range range) {
  if (isIn(static_cast<double>(value), range)) return;
  path.refuse(toText(value), "must be " + toText(range.low) + " .. " + toText(range.high));
}

void check(const Path& path, Vec3 v, Range range) {
  if (!isIn(v.x, range) || !isIn(v.y, range) || !isIn(v.z, range)) path.refuse(toText(v), toText(range));
}

void check(const Path& path, Vec3d v, Range range) {
  if (!isIn(v.x, range) || !isIn(v.y, range) || !isIn(v.z, range)) path.refuse(toText(v), toText(range));
}

Quat checkedRotation(const Path& path, Quat q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  const double squared = w * w + x * x + y * y + z * z;
  const double size = std::sqrt(squared);
  if (!(std::abs(size - 1) <= kQuatTolerance)) path.refuse(toText(q), "must have a length within 0.001 of 1");
  // As exact as floats can be already: setting what was read changes no bit.
  if (std::abs(squared - 1) <= 2.5e-7) return q;
  return {static_cast<float>(w / size), static_cast<float>(x / size), static_cast<float>(y / size),
          static_cast<float>(z / size)};
}

Pose checkedPose(const Path& path, const Pose& value, double maxPosition) {
  check(path / "position", value.position, symmetric(maxPosition));
  return {value.position, checkedRotation(path / "rotation", value.rotation)};
}

namespace {

template <class Tag>
uint32_t livingSlot(const HandlePool<Tag>& pool, Id<Tag> id, const Path& path, const char* range) {
  if (!pool.isAlive(id)) path.refuse(toText(id), range);
  return pool.slot(id);
}

}  // namespace

uint32_t slotOf(const WorldData& data, BodyId id, const Path& path) {
  return livingSlot(data.bodyIds, id, path, "must name a living body of this world");
}

uint32_t slotOf(const WorldData& data, ShapeId id, const Path& path) {
  return livingSlot(data.shapeIds, id, path, "must name a living shape of this world");
}

uint32_t slotOf(const WorldData& data, JointId id, const Path& path) {
  return livingSlot(data.jointIds, id, path, "must name a living joint of this world");
}

uint32_t slotOf(const WorldData& data, SoftId id, const Path& path) {
  return livingSlot(data.softIds, id, path, "must name a living soft body of this world");
}

uint32_t movableSlotOf(const WorldData& data, BodyId id, const Path& path) {
  const uint32_t slot = slotOf(data, id, path);
  if (data.bodies[slot].type == BodyType::Static) path.refuse(toText(id), "must not name a static body");
  return slot;
}

uint32_t dynamicSlotOf(const WorldData& data, BodyId id, const Path& path) {
  const uint32_t slot = slotOf(data, id, path);
  if (data.bodies[slot].type != BodyType::Dynamic) path.refuse(toText(id), "must name a dynamic body");
  return slot;
}

}  // namespace avbd
