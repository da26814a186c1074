// Frames as columns, and the columns as fields.
#include <algorithm>
#include <limits>

#include "io/file_error.h"
#include "io/record/content.h"
#include "io/record/limits.h"
#include "io/record/softs.h"

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
  kContactBallA = 28,
  kContactBallB = 29,
  kEventCounts = 30,
  kEventKind = 31,
  kEventA = 32,
  kEventB = 33,
  kEventPosition = 34,
  kEventNormal = 35,
  kEventSpeed = 36,
  kEventImpulse = 37,
  kEventBallA = 38,
  kEventBallB = 39,
  kJointCount = 40,
  kJointForce = 41,
  kJointTorque = 42,
  kJointEnabled = 43,
  kResiduals = 44,
  kPointCount = 50,
  kPointPlaces = 51,
};

constexpr size_t kFieldHeads = 48 * 12;  // of all fields

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
void checkShapes(const FieldReader& f, uint16_t id, const std::vector<uint32_t>& shapes, size_t count) {
  for (const uint32_t shape : shapes)
    if (shape != kNotRecorded && shape >= count) f.refuse(id, "names a shape that there is not");
}

/// A shape in two columns: one for those that are no balls of points, and one for balls.
void addShape(uint32_t shape, size_t solid, std::vector<uint32_t>& shapes, std::vector<uint32_t>& balls) {
  const bool ball = shape != kNotRecorded && shape >= solid;
  shapes.push_back(ball ? kNotRecorded : shape);
  balls.push_back(ball ? shape - static_cast<uint32_t>(solid) : kNotRecorded);
}
uint32_t shapeAt(const std::vector<uint32_t>& shapes, const std::vector<uint32_t>& balls, size_t i, size_t solid) {
  const uint32_t ball = at(balls, i, kNotRecorded);
  return ball == kNotRecorded ? at(shapes, i, kNotRecorded) : ball + static_cast<uint32_t>(solid);
}

void putBalls(FieldWriter& out, uint16_t id, const std::vector<uint32_t>& balls) {
  const bool any = std::any_of(balls.begin(), balls.end(), [](uint32_t ball) { return ball != kNotRecorded; });
  if (any) out.list(id, balls, Encoding::Shuffled);
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

void readBalls(const FieldReader& f, const Recording& head, size_t contacts, size_t events, FrameBlock& b) {
  const size_t solid = solidShapes(head), balls = head.shapes.size() - solid;
  checkShapes(f, kContactA, b.contactA, solid);
  checkShapes(f, kContactB, b.contactB, solid);
  checkShapes(f, kEventA, b.eventA, solid);
  checkShapes(f, kEventB, b.eventB, solid);
  const auto read = [&](uint16_t id, size_t count, std::vector<uint32_t>& list) {
    list = f.listOf<uint32_t>(id, count);
    checkShapes(f, id, list, balls);
  };
  read(kContactBallA, contacts, b.contactBallA);
  read(kContactBallB, contacts, b.contactBallB);
  read(kEventBallA, events, b.eventBallA);
  read(kEventBallB, events, b.eventBallB);
}

}  // namespace

size_t FrameBlock::bytes() const {
  return kFieldHeads + 8 * (positions.size() + 8 * times.size() + eventPosition.size()) +
         4 * (rotations.size() + 2 * linear.size() + 12 * contactA.size() + 8 * eventA.size()) +
         25 * jointEnabled.size() + 4 * residuals.size() + 8 * pointPlaces.size() +
         8 * (contactBallA.size() + eventBallA.size());
}

size_t FrameBlock::bytesOf(const RecordedFrame& f) {
  return 8 * 8 + 40 * f.poses.size() + 24 * f.velocities.size() + 48 * f.contacts.size() + 56 * f.events.size() +
         25 * f.joints.size() + 4 * f.residuals.size();
}

void FrameBlock::add(const RecordedFrame& f, const Recording& head) {
  const size_t solid = solidShapes(head);
  bodies = static_cast<uint32_t>(solidBodies(head));
  hasVelocities = !f.velocities.empty();
  times.push_back(f.time);
  for (const Pose& pose : std::span(f.poses).first(bodies)) {
    append(positions, pose.position);
    rotations.insert(rotations.end(), {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z});
  }
  for (const Velocity& velocity : std::span(f.velocities).first(hasVelocities ? bodies : 0)) {
    append(linear, velocity.linear);
    append(angular, velocity.angular);
  }
  kineticEnergy.push_back(f.kineticEnergy);
  penetration.push_back(f.penetrationMax);
  gap.push_back(f.jointGapMax);
  excess.push_back(f.limitExcessMax);
  excessAngle.push_back(f.limitExcessAngleMax);
  addJoints(f);
  addPoints(f, head);
  contactCounts.push_back(static_cast<uint32_t>(f.contacts.size()));
  contactsLeftOut.push_back(f.contactsLeftOut);
  for (const RecordedContact& c : f.contacts) {
    addShape(c.shapeA, solid, contactA, contactBallA);
    addShape(c.shapeB, solid, contactB, contactBallB);
    append(contactOffset, toFloat(c.position - baseOf(contactA.back(), contactB.back(), head, f.poses)));
    append(contactForce, c.force);
    append(contactNormal, c.normal);
    contactSeparation.push_back(c.separation);
  }
  eventCounts.push_back(static_cast<uint32_t>(f.events.size()));
  for (const RecordedEvent& e : f.events) {
    eventKind.push_back(static_cast<uint8_t>(e.kind));
    addShape(e.shapeA, solid, eventA, eventBallA);
    addShape(e.shapeB, solid, eventB, eventBallB);
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

void FrameBlock::addPoints(const RecordedFrame& f, const Recording& head) {
  points = static_cast<uint32_t>(pointCount(head));
  for (const RecordedSoft& soft : head.softs)
    for (size_t i = 0; i < soft.points.size(); ++i) {
      const Vec3d p = f.poses[soft.firstBody + i].position;
      for (const double x : {p.x, p.y, p.z}) pointPlaces.push_back(stepsOf(x, soft.step));
    }
}

void FrameBlock::placePoints(size_t i, const Recording& head, RecordedFrame& out) const {
  size_t from = 3 * i * points;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (const RecordedSoft& soft : head.softs)
    for (size_t k = 0; k < soft.points.size(); ++k, from += 3) {
      const auto place = [&](size_t axis) { return static_cast<double>(pointPlaces[from + axis]) * soft.step; };
      out.poses.push_back({{place(0), place(1), place(2)}, {}});
      if (hasVelocities) out.velocities.push_back({{kUnknown, kUnknown, kUnknown}, {kUnknown, kUnknown, kUnknown}});
    }
}

RecordedFrame FrameBlock::frame(size_t i, const Recording& head) const {
  RecordedFrame f;
  const size_t solid = solidShapes(head);
  f.time = times[i];
  f.poses.resize(bodies);
  for (size_t k = 0, from = i * bodies; k < bodies; ++k, ++from) {
    const float* q = &rotations[4 * from];
    f.poses[k] = {vectorAt(positions, from), {q[0], q[1], q[2], q[3]}};
    if (hasVelocities) f.velocities.push_back({vectorAt(linear, from), vectorAt(angular, from)});
  }
  placePoints(i, head, f);
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
                          vectorAt(contactNormal, from), at(contactSeparation, from),
                          shapeAt(contactA, contactBallA, from, solid), shapeAt(contactB, contactBallB, from, solid)});
  }
  for (size_t from = sum(eventCounts, i), left = at(eventCounts, i); left > 0; --left, ++from)
    f.events.push_back({static_cast<RecordedEventKind>(eventKind[from]), shapeAt(eventA, eventBallA, from, solid),
                        shapeAt(eventB, eventBallB, from, solid), vectorAt(eventPosition, from),
                        vectorAt(eventNormal, from), at(eventSpeed, from), at(eventImpulse, from)});
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
  if (b.points > 0) {
    out.value(kPointCount, b.points);
    out.list(kPointPlaces, secondDifferences(b.pointPlaces, size_t{3} * b.points), Encoding::Delta, 3);
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
  putBalls(out, kContactBallA, b.contactBallA);
  putBalls(out, kContactBallB, b.contactBallB);
  out.list(kContactOffset, b.contactOffset, Encoding::Shuffled);
  out.list(kContactForce, b.contactForce, Encoding::Shuffled);
  out.list(kContactNormal, b.contactNormal, Encoding::Shuffled);
  out.list(kContactSeparation, b.contactSeparation, Encoding::Shuffled);
  out.list(kEventCounts, b.eventCounts);
  out.list(kEventKind, b.eventKind);
  out.list(kEventA, b.eventA, Encoding::Shuffled);
  out.list(kEventB, b.eventB, Encoding::Shuffled);
  putBalls(out, kEventBallA, b.eventBallA);
  putBalls(out, kEventBallB, b.eventBallB);
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
  if (bodies != solidBodies(head)) f.refuse(kBodyCount, "does not fit the bodies");
  const size_t points = pointCount(head);
  if (points > 0 &&
      (f.value<uint32_t>(kPointCount, 0) != points || f.count(kPointPlaces) != 3 * points * f.count(kTimes)))
    f.refuse(kPointPlaces, "does not fit the soft bodies");
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
  b.points = static_cast<uint32_t>(pointCount(head));
  if (b.points > 0) b.pointPlaces = sumsOf(f.listOf<int64_t>(kPointPlaces, 3 * n * b.points), size_t{3} * b.points);
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
  readBalls(f, head, contacts, events, b);
  for (const uint8_t kind : b.eventKind)
    if (kind > static_cast<uint8_t>(RecordedEventKind::Hit)) f.refuse(kEventKind, "names a kind that there is not");
  return b;
}

}  // namespace avbd::record
