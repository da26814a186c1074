// Pulleys, couplings and custom joints of a world: their definitions for the head, their residuals for a frame.
#include <algorithm>

#include "io/record/source.h"

namespace avbd {
namespace {

/// A coordinate's way beyond its limit; negative below.
double beyond(double q, const JointLimit& limit) {
  return std::max(0.0, q - static_cast<double>(limit.upper)) - std::max(0.0, static_cast<double>(limit.lower) - q);
}

double residualOf(const World& world, JointId id, const PulleyJoint& pulley) {
  const double missing = world.coordinate(id).position - static_cast<double>(pulley.length);
  return pulley.slack ? std::max(0.0, missing) : missing;
}

double residualOf(const World& world, JointId id, const Coupling& coupling) {
  const double sum = world.coordinate(id).position;
  return coupling.axis.motion == AxisMotion::Free ? beyond(sum, coupling.axis.limit)
                                                  : sum - coupling.rest.value_or(sum);
}

CustomBody bodyOf(const World& world, BodyId id) {
  return id ? CustomBody{world.pose(id), world.worldCenterOfMass(id)} : CustomBody{};
}

void addRows(const World& world, const CustomJoint& joint, std::vector<float>& out) {
  std::vector<CustomBody> bodies;
  for (int i = 0; i < joint.bodyCount; ++i) bodies.push_back(bodyOf(world, joint.bodies[static_cast<size_t>(i)]));
  std::vector<CustomRow> rows(static_cast<size_t>(joint.family->rowCount()));
  joint.family->evaluate(bodies, bodies, 0, joint.constants, joint.memory, rows);
  for (const CustomRow& row : rows) out.push_back(static_cast<float>(row.C));
}

}  // namespace

void describeLink(const World& world, JointId id, RecordedJoint& out) {
  if (world.type(id) == JointType::Pulley) {
    const PulleyJoint pulley = world.pulleyJoint(id);
    out.wheels = {pulley.wheelA, pulley.wheelB};
    out.ratio = pulley.ratio;
    out.residuals = 1;
  } else if (world.type(id) == JointType::Coupling) {
    const Coupling coupling = world.coupling(id);
    out.rest = coupling.rest.value_or(0);
    out.residuals = 1;
    if (coupling.axis.motion == AxisMotion::Locked) return;
    out.freeAxes = 1;
    out.limits[0] = {coupling.axis.limit.lower, coupling.axis.limit.upper};
  } else if (world.type(id) == JointType::Custom) {
    const CustomJoint custom = world.customJoint(id);
    out.family = custom.family->name();
    out.residuals = static_cast<uint8_t>(custom.family->rowCount());
  }
}

std::vector<RecordedTerm> termsOf(const Coupling& coupling, std::span<const JointId> recorded) {
  std::vector<RecordedTerm> out;
  for (const CouplingTerm& term : coupling.terms) {
    const auto at = std::lower_bound(recorded.begin(), recorded.end(), term.joint);
    const bool found = at != recorded.end() && *at == term.joint;
    out.push_back({found ? static_cast<uint32_t>(at - recorded.begin()) : kNotRecorded,
                   term.axis,
                   {term.factor, term.square, term.cube, term.fourth}});
  }
  return out;
}

void addResiduals(const World& world, JointId id, std::vector<float>& out) {
  if (world.type(id) == JointType::Pulley)
    out.push_back(static_cast<float>(residualOf(world, id, world.pulleyJoint(id))));
  else if (world.type(id) == JointType::Coupling)
    out.push_back(static_cast<float>(residualOf(world, id, world.coupling(id))));
  else if (world.type(id) == JointType::Custom)
    addRows(world, world.customJoint(id), out);
}

}  // namespace avbd
