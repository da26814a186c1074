// Joints in the page's head; src/recording.js reads them.
#include <algorithm>

#include "viewer/head.h"

namespace avbd::page {
namespace {

constexpr uint8_t kNoType = 255;

bool isLink(const RecordedJoint& joint) { return joint.type && *joint.type >= JointType::Pulley; }

void writeForms(Head& head, const Recording& r) {
  std::vector<uint8_t> types, free;
  std::vector<float> rotations, limits, cones;
  for (const RecordedJoint& joint : r.joints) {
    types.push_back(joint.type ? static_cast<uint8_t>(*joint.type) : kNoType);  // src/joints.js: kTypes
    free.push_back(joint.freeAxes);
    append(rotations, joint.frameA.rotation);
    append(rotations, joint.frameB.rotation);
    for (const RecordedLimit& limit : joint.limits) limits.insert(limits.end(), {limit.lower, limit.upper});
    cones.insert(cones.end(), {joint.coneY, joint.coneZ});
  }
  head.numbers("jointTypes", types);
  head.numbers("jointFree", free);
  head.numbers("jointRotations", rotations);
  head.numbers("jointLimits", limits);
  head.numbers("jointCones", cones);
  head.list("jointNames", r.joints, [](std::ostream& out, const RecordedJoint& joint) { out << jsonText(joint.name); });
}

/// What only pulleys, couplings and custom joints have, of all joints: [joint, axis, factors ...] for each term.
void writeLinks(Head& head, const Recording& r) {
  std::vector<double> wheels, rests;
  std::vector<float> ratios;
  std::vector<uint32_t> more;
  for (const RecordedJoint& joint : r.joints) {
    for (const Vec3d wheel : joint.wheels) append(wheels, wheel);
    ratios.push_back(joint.ratio);
    rests.push_back(joint.rest);
    more.insert(more.end(), joint.moreBodies.begin(), joint.moreBodies.end());
  }
  head.numbers("jointWheels", wheels);
  head.numbers("jointRatios", ratios);
  head.numbers("jointRests", rests);
  head.numbers("jointMoreBodies", more);
  head.list("jointTerms", r.joints, [](std::ostream& out, const RecordedJoint& joint) {
    std::vector<double> terms;
    for (const RecordedTerm& term : joint.terms) {
      terms.insert(terms.end(), {static_cast<double>(term.joint), static_cast<double>(term.axis)});
      terms.insert(terms.end(), term.factors.begin(), term.factors.end());
    }
    out << '"' << base64Of(terms) << '"';
  });
  head.list("jointFamilies", r.joints,
            [](std::ostream& out, const RecordedJoint& joint) { out << jsonText(joint.family); });
}

}  // namespace

void writeJoints(Head& head, const Recording& r) {
  std::vector<uint32_t> bodies;
  std::vector<double> anchors;
  std::vector<uint8_t> residuals;
  bool types = false;
  for (const RecordedJoint& joint : r.joints) {
    bodies.insert(bodies.end(), {joint.bodyA, joint.bodyB});
    append(anchors, joint.frameA.position);
    append(anchors, joint.frameB.position);
    residuals.push_back(joint.residuals);
    types = types || joint.type.has_value();
  }
  head.numbers("jointBodies", bodies);
  head.numbers("jointAnchors", anchors);
  if (residualCount(r) > 0) head.numbers("jointResiduals", residuals);
  if (types) writeForms(head, r);
  if (std::any_of(r.joints.begin(), r.joints.end(), isLink)) writeLinks(head, r);
}

}  // namespace avbd::page
