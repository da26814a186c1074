// Frames as columns, and the columns as fields.
#include <limits>

#include "io/file_error.h"
#include "io/record/content.h"
#include "io/record/limits.h"

namespace avbd::record {
namespace {

enum FrameField : uint16_t {
  kFirst = 1,
  kTimes = 2,
  kBodyCount = 3,
  kPositions = 4,
  kRotations = 5,
  kLinear = 6,
  kAngular = 7,
  kKineticEnergy = 8,
  kPenetration = 9,
  kGap = 10,
  kExcess = 11,
  kExcessAngle = 12,
  kContactCounts = 20,
  kContactsLeftOut = 21,
  kContactA = 22,
  kContactB = 23,
  kContactOffset = 24,
  kContactForce = 25,
  kContactNormal = 26,
  kContactSeparation = 27,
  kEventCounts = 30,
  kEventKind = 31,
  kEventA = 32,
  kEventB = 33,
  kEventPosition = 34,
  kEventNormal = 35,
  kEventSpeed = 36,
  kEventImpulse = 37,
  kJointCount = 40,
  kJointForce = 41,
  kJointTorque = 42,
  kJointEnabled = 43,
  kResiduals = 44,
};

constexpr size_t kFieldHeads = 40 * 12;  // of all fields

void append(std::vector<float>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }
void append(std::vector<double>& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }
Vec3 vectorAt(const std::vector<float>& list, size_t i) {
  return list.empty() ? Vec3{} : Vec3{list[3 * i], list[3 * i + 1], list[3 * i + 2]};
}
Vec3d vectorAt(const std::vector<double>& list, size_t i) {
  return list.empty() ? Vec3d{} : Vec3d{list[3 * i], list[3 * i + 1], list[3 * i + 2]};
}
template <class T>
T at(const std::vector<T>& list, size_t i, T otherwise = {}) {
  return list.empty() ? otherwise : list[i];
}

/// What a contact's position is relative to: its first recorded body, so that a float is enough.
Vec3d baseOf(uint32_t shapeA, uint32_t shapeB, const Recording& head, const std::vector<Pose>& poses) {
  const uint32_t shape = shapeA < head.shapes.size() ? shapeA : shapeB;
  if (shape >= head.shapes.size()) return {};
  return poses[head.shapes[shape].body].position;
}

size_t sum(const std::vector<uint32_t>& counts, size_t end) {
  if (counts.empty()) return 0;  // the field is not there
  size_t total = 0;
  for (size_t i = 0; i < end; ++i) total += counts[i];
  return total;
}

/// Shapes are named or unknown.
void checkShapes(const FieldReader& f, uint16_t id, const std::vector<uint32_t>& shapes, const Recording& head) {
  for (const uint32_t shape : shapes)
    if (shape != kNotRecorded && shape >= head.shapes.size()) f.refuse(id, "names a shape that there is not");
}

void readJoints(const FieldReader& f, const Recording& head, FrameBlock& b) {
  b.joints = f.value<uint32_t>(kJointCount, 0);
  const size_t all = b.size() * b.joints;
  b.jointForce = f.listOf<float>(kJointForce, 3 * all);
  b.jointTorque = f.listOf<float>(kJointTorque, 3 * all);
  b.jointEnabled = f.listOf<uint8_t>(kJointEnabled, all);
  if (all > 0 && b.jointForce.empty()) f.refuse(kJointForce, "is missing");
  // Where the chunk of joints was damaged, nobody knows whose these are.
  if (b.joints != head.joints.size()) b.joints = 0;
  if (b.joints == 0 || !f.has(kResiduals)) return;
  b.residualsEach = residualCount(head);
  b.residuals = f.listOf<float>(kResiduals, b.size() * b.residualsEach);
}

}  // namespace

size_t FrameBlock::bytes() const {
  return kFieldHeads + 8 * (positions.size() + 8 * times.size() + eventPosition.size()) +
         4 * (rotations.size() + 2 * linear.size() + 12 * contactA.size() + 8 * eventA.size()) +
         25 * jointEnabled.size() + 4 * residuals.size();
}

size_t FrameBlock::bytesOf(const RecordedFrame& f) {
  return 8 * 8 + 40 * f.poses.size() + 24 * f.velocities.size() + 48 * f.contacts.size() + 56 * f.events.size() +
         25 * f.joints.size() + 4 * f.residuals.size();
}

void FrameBlock::add(const RecordedFrame& f, const Recording& head) {
  bodies = static_cast<uint32_t>(f.poses.size());
  hasVelocities = !f.velocities.empty();
  times.push_back(f.time);
  for (const Pose& pose : f.poses) {
    append(positions, pose.position);
    rotations.insert(rotations.end(), {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z});
  }
  for (const Velocity& velocity : f.velocities) {
    append(linear, velocity.linear);
    append(angular, velocity.angular);
  }
  kineticEnergy.push_back(f.kineticEnergy);
  penetration.push_back(f.penetrationMax);
  gap.push_back(f.jointGapMax);
  excess.push_back(f.limitExcessMax);
  excessAngle.push_back(f.limitExcessAngleMax);
  addJoints(f);
  contactCounts.push_back(static_cast<uint32_t>(f.contacts.size()));
  contactsLeftOut.push_back(f.contactsLeftOut);
  for (const RecordedContact& c : f.contacts) {
    contactA.push_back(c.shapeA);
    contactB.push_back(c.shapeB);
    append(contactOffset, toFloat(c.position - baseOf(c.shapeA, c.shapeB, head, f.poses)));
    append(contactForce, c.force);
    append(contactNormal, c.normal);
    contactSeparation.push_back(c.separation);
  }
  eventCounts.push_back(static_cast<uint32_t>(f.events.size()));
  for (const RecordedEvent& e : f.events) {
    eventKind.push_back(static_cast<uint8_t>(e.kind));
    eventA.push_back(e.shapeA);
    eventB.push_back(e.shapeB);
    append(eventPosition, e.position);
    append(eventNormal, e.normal);
    eventSpeed.push_back(e.speed);
    eventImpulse.push_back(e.impulse);
  }
}

void FrameBlock::addJoints(const RecordedFrame& f) {
  joints = static_cast<uint32_t>(f.joints.size());
  for (const RecordedJointState& joint : f.joints) {
    append(jointForce, joint.reaction.force);
    append(jointTorque, joint.reaction.torque);
    jointEnabled.push_back(joint.enabled ? 1 : 0);
  }
  residualsEach = f.residuals.size();
  residuals.insert(residuals.end(), f.residuals.begin(), f.residuals.end());
}

RecordedFrame FrameBlock::frame(size_t i, const Recording& head) const {
  RecordedFrame f;
  f.time = times[i];
  f.poses.resize(bodies);
  for (size_t k = 0, from = i * bodies; k < bodies; ++k, ++from) {
    const float* q = &rotations[4 * from];
    f.poses[k] = {vectorAt(positions, from), {q[0], q[1], q[2], q[3]}};
    if (hasVelocities) f.velocities.push_back({vectorAt(linear, from), vectorAt(angular, from)});
  }
  f.kineticEnergy = at(kineticEnergy, i);
  f.penetrationMax = at(penetration, i);
  f.jointGapMax = at(gap, i);
  f.limitExcessMax = at(excess, i, std::numeric_limits<double>::quiet_NaN());
  f.limitExcessAngleMax = at(excessAngle, i, std::numeric_limits<double>::quiet_NaN());
  for (size_t k = 0, from = i * joints; k < joints; ++k, ++from)
    f.joints.push_back(
        {{vectorAt(jointForce, from), vectorAt(jointTorque, from)}, at<uint8_t>(jointEnabled, from, 1) != 0});
  const auto own = std::span(residuals).subspan(i * residualsEach, residualsEach);
  f.residuals.assign(own.begin(), own.end());
  f.contactsLeftOut = at(contactsLeftOut, i);
  for (size_t from = sum(contactCounts, i), left = at(contactCounts, i); left > 0; --left, ++from) {
    const uint32_t a = at(contactA, from, kNotRecorded), b = at(contactB, from, kNotRecorded);
    f.contacts.push_back({baseOf(a, b, head, f.poses) + vectorAt(contactOffset, from), vectorAt(contactForce, from),
                          vectorAt(contactNormal, from), at(contactSeparation, from), a, b});
  }
  for (size_t from = sum(eventCounts, i), left = at(eventCounts, i); left > 0; --left, ++from)
    f.events.push_back({static_cast<RecordedEventKind>(eventKind[from]), at(eventA, from, kNotRecorded),
                        at(eventB, from, kNotRecorded), vectorAt(eventPosition, from), vectorAt(eventNormal, from),
                        at(eventSpeed, from), at(eventImpulse, from)});
  return f;
}

Bytes framesContent(const FrameBlock& b) {
  FieldWriter out;
  out.value(kFirst, b.first);
  out.list(kTimes, b.times, Encoding::Line, 1);
  out.value(kBodyCount, b.bodies);
  out.list(kPositions, b.positions, Encoding::Delta, 3 * b.bodies);
  out.list(kRotations, b.rotations, Encoding::Delta, 4 * b.bodies);
  if (b.hasVelocities) {
    out.list(kLinear, b.linear, Encoding::Delta, 3 * b.bodies);
    out.list(kAngular, b.angular, Encoding::Delta, 3 * b.bodies);
  }
  out.list(kKineticEnergy, b.kineticEnergy, Encoding::Shuffled);
  out.list(kPenetration, b.penetration, Encoding::Shuffled);
  out.list(kGap, b.gap, Encoding::Shuffled);
  out.list(kExcess, b.excess, Encoding::Shuffled);
  out.list(kExcessAngle, b.excessAngle, Encoding::Shuffled);
  out.list(kContactCounts, b.contactCounts);
  out.list(kContactsLeftOut, b.contactsLeftOut);
  out.list(kContactA, b.contactA, Encoding::Shuffled);
  out.list(kContactB, b.contactB, Encoding::Shuffled);
  out.list(kContactOffset, b.contactOffset, Encoding::Shuffled);
  out.list(kContactForce, b.contactForce, Encoding::Shuffled);
  out.list(kContactNormal, b.contactNormal, Encoding::Shuffled);
  out.list(kContactSeparation, b.contactSeparation, Encoding::Shuffled);
  out.list(kEventCounts, b.eventCounts);
  out.list(kEventKind, b.eventKind);
  out.list(kEventA, b.eventA, Encoding::Shuffled);
  out.list(kEventB, b.eventB, Encoding::Shuffled);
  out.list(kEventPosition, b.eventPosition, Encoding::Shuffled);
  out.list(kEventNormal, b.eventNormal, Encoding::Shuffled);
  out.list(kEventSpeed, b.eventSpeed, Encoding::Shuffled);
  out.list(kEventImpulse, b.eventImpulse, Encoding::Shuffled);
  if (b.joints == 0) return out.bytes();
  out.value(kJointCount, b.joints);
  out.list(kJointForce, b.jointForce, Encoding::Delta, 3 * b.joints);
  out.list(kJointTorque, b.jointTorque, Encoding::Delta, 3 * b.joints);
  out.list(kJointEnabled, b.jointEnabled);
  if (b.residualsEach > 0) out.list(kResiduals, b.residuals, Encoding::Delta, static_cast<uint32_t>(b.residualsEach));
  return out.bytes();
}

std::pair<uint64_t, std::vector<double>> timesOf(const FieldReader& f, const Recording& head) {
  const size_t bodies = f.value<uint32_t>(kBodyCount, 0), all = f.count(kTimes) * bodies;
  if (bodies != head.bodies.size()) f.refuse(kBodyCount, "does not fit the bodies");
  if (f.count(kPositions) != 3 * all || f.count(kRotations) != 4 * all) f.refuse(kTimes, "does not fit the poses");
  return {f.value<uint64_t>(kFirst, 0), f.list<double>(kTimes)};
}

FrameBlock framesOf(const FieldReader& f, const Recording& head) {
  FrameBlock b;
  std::tie(b.first, b.times) = timesOf(f, head);
  const size_t n = b.size();
  b.bodies = f.value<uint32_t>(kBodyCount, 0);
  const size_t all = n * b.bodies;
  b.positions = f.listOf<double>(kPositions, 3 * all);
  b.rotations = f.listOf<float>(kRotations, 4 * all);
  b.linear = f.listOf<float>(kLinear, 3 * all);
  b.angular = f.listOf<float>(kAngular, 3 * all);
  b.hasVelocities = f.has(kLinear);
  b.kineticEnergy = f.listOf<double>(kKineticEnergy, n);
  b.penetration = f.listOf<double>(kPenetration, n);
  b.gap = f.listOf<double>(kGap, n);
  b.excess = f.listOf<double>(kExcess, n);
  b.excessAngle = f.listOf<double>(kExcessAngle, n);
  readJoints(f, head, b);
  b.contactCounts = f.listOf<uint32_t>(kContactCounts, n);
  b.contactsLeftOut = f.listOf<uint32_t>(kContactsLeftOut, n);
  const size_t contacts = sum(b.contactCounts, b.contactCounts.size());
  b.contactA = f.listOf<uint32_t>(kContactA, contacts);
  b.contactB = f.listOf<uint32_t>(kContactB, contacts);
  b.contactOffset = f.listOf<float>(kContactOffset, 3 * contacts);
  b.contactForce = f.listOf<float>(kContactForce, 3 * contacts);
  b.contactNormal = f.listOf<float>(kContactNormal, 3 * contacts);
  b.contactSeparation = f.listOf<float>(kContactSeparation, contacts);
  if (contacts > 0 && (b.contactOffset.empty() || b.contactForce.empty())) f.refuse(kContactOffset, "is missing");
  b.eventCounts = f.listOf<uint32_t>(kEventCounts, n);
  const size_t events = sum(b.eventCounts, b.eventCounts.size());
  if (events > kEventsMost) f.refuse(kEventCounts, "names more events than a chunk may hold");
  b.eventKind = f.listOf<uint8_t>(kEventKind, events);
  if (events > 0 && b.eventKind.empty()) f.refuse(kEventKind, "is missing");
  b.eventA = f.listOf<uint32_t>(kEventA, events);
  b.eventB = f.listOf<uint32_t>(kEventB, events);
  b.eventPosition = f.listOf<double>(kEventPosition, 3 * events);
  b.eventNormal = f.listOf<float>(kEventNormal, 3 * events);
  b.eventSpeed = f.listOf<float>(kEventSpeed, events);
  b.eventImpulse = f.listOf<float>(kEventImpulse, events);
  checkShapes(f, kContactA, b.contactA, head);
  checkShapes(f, kContactB, b.contactB, head);
  checkShapes(f, kEventA, b.eventA, head);
  checkShapes(f, kEventB, b.eventB, head);
  for (const uint8_t kind : b.eventKind)
    if (kind > static_cast<uint8_t>(RecordedEventKind::Hit)) f.refuse(kEventKind, "names a kind that there is not");
  return b;
}

}  // namespace avbd::record
