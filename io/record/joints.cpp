// Joints: what they join and where, what they leave free and how far that may go.
#include "io/record/chunk.h"
#include "io/record/content.h"
#include "io/record/joint_links.h"

namespace avbd::record {
namespace {

enum JointField : uint16_t {
  kBodyA = 1,
  kBodyB = 2,
  kAnchorA = 3,
  kAnchorB = 4,
  kRotationA = 5,
  kRotationB = 6,
  kTypes = 7,
  kNames = 8,
  kFree = 10,
  kLimits = 11,
  kCones = 12,
};

constexpr uint8_t kNoType = 255;
static_assert(static_cast<int>(JointType::Custom) == 9, "files name types by these numbers");

/// A list for each field.
struct Columns {
  std::vector<uint32_t> a, b;
  std::vector<double> anchorA, anchorB;
  std::vector<float> rotationA, rotationB, limits, cones;
  std::vector<uint8_t> types, free;
  std::vector<std::string> names;
  bool anyType = false;
  LinkColumns links;

  void add(const RecordedJoint& joint);
  RecordedJoint joint(size_t i) const;
};

void append(std::vector<double>& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }
void append(std::vector<float>& out, Quat q) { out.insert(out.end(), {q.w, q.x, q.y, q.z}); }

Pose poseAt(const std::vector<double>& places, const std::vector<float>& rotations, size_t i) {
  const double* p = &places[3 * i];
  Pose pose{{p[0], p[1], p[2]}, {}};
  if (!rotations.empty())
    pose.rotation = {rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2], rotations[4 * i + 3]};
  return pose;
}

void Columns::add(const RecordedJoint& joint) {
  a.push_back(joint.bodyA);
  b.push_back(joint.bodyB);
  append(anchorA, joint.frameA.position);
  append(anchorB, joint.frameB.position);
  append(rotationA, joint.frameA.rotation);
  append(rotationB, joint.frameB.rotation);
  types.push_back(joint.type ? static_cast<uint8_t>(*joint.type) : kNoType);
  names.push_back(joint.name);
  free.push_back(joint.freeAxes);
  for (const RecordedLimit& limit : joint.limits) limits.insert(limits.end(), {limit.lower, limit.upper});
  cones.insert(cones.end(), {joint.coneY, joint.coneZ});
  anyType = anyType || joint.type;
  links.add(joint);
}

RecordedJoint Columns::joint(size_t i) const {
  RecordedJoint joint{a[i], b[i], poseAt(anchorA, rotationA, i), poseAt(anchorB, rotationB, i)};
  links.fill(i, joint);
  if (types.empty() || types[i] > static_cast<uint8_t>(JointType::Custom)) return joint;
  joint.type = static_cast<JointType>(types[i]);
  if (!names.empty()) joint.name = names[i];
  if (!free.empty()) joint.freeAxes = free[i];
  for (size_t axis = 0; axis < 6 && !limits.empty(); ++axis)
    joint.limits[axis] = {limits[12 * i + 2 * axis], limits[12 * i + 2 * axis + 1]};
  if (!cones.empty()) joint.coneY = cones[2 * i], joint.coneZ = cones[2 * i + 1];
  return joint;
}

Columns columnsOf(const FieldReader& f) {
  Columns c;
  c.a = f.list<uint32_t>(kBodyA);
  const size_t n = c.a.size();
  c.b = f.listOf<uint32_t>(kBodyB, n);
  c.anchorA = f.listOf<double>(kAnchorA, 3 * n);
  c.anchorB = f.listOf<double>(kAnchorB, 3 * n);
  if (n > 0 && (c.b.empty() || c.anchorA.empty() || c.anchorB.empty())) f.refuse(kBodyA, "stands alone");
  c.rotationA = f.listOf<float>(kRotationA, 4 * n);
  c.rotationB = f.listOf<float>(kRotationB, 4 * n);
  c.types = f.listOf<uint8_t>(kTypes, n);
  c.names = f.texts(kNames, n);
  if (!c.names.empty() && c.names.size() != n) f.refuse(kNames, "does not fit the joints");
  c.free = f.listOf<uint8_t>(kFree, n);
  c.limits = f.listOf<float>(kLimits, 12 * n);
  c.cones = f.listOf<float>(kCones, 2 * n);
  c.links = LinkColumns(f, n);
  return c;
}

void checkLimits(const FieldReader& f, const Columns& c) {
  for (size_t i = 0; i < c.limits.size(); i += 2)
    if (!(c.limits[i] <= c.limits[i + 1])) f.refuse(kLimits, "holds what is no range");
  for (const float limit : c.cones)
    if (!(limit > 0)) f.refuse(kCones, "holds what is no cone");
}

}  // namespace

Bytes jointsContent(const Recording& r) {
  Columns c;
  for (const RecordedJoint& joint : r.joints) c.add(joint);
  FieldWriter out;
  out.list(kBodyA, c.a);
  out.list(kBodyB, c.b);
  out.list(kAnchorA, c.anchorA, Encoding::Shuffled);
  out.list(kAnchorB, c.anchorB, Encoding::Shuffled);
  if (!c.anyType) return out.bytes();
  out.list(kRotationA, c.rotationA, Encoding::Shuffled);
  out.list(kRotationB, c.rotationB, Encoding::Shuffled);
  out.list(kTypes, c.types);
  out.texts(kNames, c.names);
  out.list(kFree, c.free);
  out.list(kLimits, c.limits, Encoding::Shuffled);
  out.list(kCones, c.cones, Encoding::Shuffled);
  c.links.write(out);
  return out.bytes();
}

void HeadReader::takeJoints(const FieldReader& f) {
  refuseMore(f, kBodyA, recording.joints.size());
  const Columns c = columnsOf(f);
  const auto fits = [&](uint32_t body) { return body == kNotRecorded || body < recording.bodies.size(); };
  for (size_t i = 0; i < c.a.size(); ++i)
    if (!fits(c.a[i]) || !fits(c.b[i])) f.refuse(kBodyA, "names a body that there is not");
  checkLimits(f, c);
  c.links.check(f, recording.bodies.size(), recording.joints.size() + c.a.size());
  bool unknown = false;
  for (size_t i = 0; i < c.a.size(); ++i) {
    recording.joints.push_back(c.joint(i));
    unknown = unknown || (!c.types.empty() && c.types[i] != kNoType && !recording.joints.back().type);
  }
  if (unknown) notes.emplace_back("joints of types that are not known to this version show as points alone");
}

}  // namespace avbd::record
