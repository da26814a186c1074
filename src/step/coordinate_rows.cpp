// Rows of one coordinate (coordinate_rows.h).
#include "step/coordinate_rows.h"

#include <algorithm>
#include <cmath>

#include "step/joint_side.h"

namespace avbd {

namespace {

/// Of the depth at which a contact holds its load, a loaded joint gives way by this part.
constexpr float kLoadsPerFall = 64;
/// But no less than this part of the slop, where the rounding of C would be as large.
constexpr float kLeastDepth = 0.01f;

bool isLimited(const JointLimit& limit) { return limit.lower > -rows::kInfinity || limit.upper < rows::kInfinity; }

/// A hard stop: inside it is where it is, beyond it a part of the way back is asked for. What meets it fast enough
/// leaves it with a part of its speed.
void fillStops(const WorldData& world, const StepData& step, const CoordinateState& at, rows::D6Axis<float>& x) {
  const D6Axis& axis = at.definition;
  const JointLimit& limit = axis.limit;
  const float below = std::min(x.start - limit.lower, 0.0f), above = std::max(x.start - limit.upper, 0.0f);
  const float reach = axis.maxVelocity * step.h;
  x.lower = below < 0 ? x.start - corrected(step, below, at.correction) : limit.lower;
  x.upper = above > 0 ? x.start - corrected(step, above, at.correction) : limit.upper;
  const float next = x.start + at.speed * step.h;
  const float back = x.start - limit.restitution * at.speed * step.h;
  if (limit.restitution > 0 && std::fabs(at.speed) > world.def.restitutionThreshold) {
    if (at.speed > 0 && next > x.upper) x.upper = std::max(back, x.lower);
    if (at.speed < 0 && next < x.lower) x.lower = std::min(back, x.upper);
  }
  x.lower = std::clamp(x.lower, x.start - reach, x.start + reach);
  x.upper = std::clamp(x.upper, x.start - reach, x.start + reach);
}

void fillSoftStops(const StepData& step, const JointLimit& limit, rows::D6Axis<float>& x, float rho, bool inTree) {
  const float below = std::min(x.start - limit.lower, 0.0f), above = std::max(x.start - limit.upper, 0.0f);
  const bool beyond = below < 0 || above > 0;
  const float damping = beyond ? limit.damping / step.h : 0, whole = limit.stiffness + damping;
  const float share = limit.stiffness / whole;
  x.lower = below < 0 ? x.start - below * share : limit.lower;
  x.upper = above > 0 ? x.start - above * share : limit.upper;
  const ElasticRow e = elasticRow(whole, rho, inTree);
  x.k = e.k, x.s = e.s;
}

void fillLimit(const WorldData& world, const StepData& step, const CoordinateState& at, rows::D6Axes& axes,
               rows::D6Axis<float>& x) {
  const D6Axis& axis = at.definition;
  const JointMultipliers& lambda = at.lambda;
  const auto bit = static_cast<uint8_t>(1 << at.axis);
  if (axis.limit.stiffness > 0) {
    axes.limited |= bit;
    x.load = 0;
    fillSoftStops(step, axis.limit, x, x.k, at.inTree);
    return;
  }
  fillStops(world, step, at, x);
  // Two rows at one place would be one too many for a tree.
  if (x.upper - x.lower <= 1e-6f * (1 + std::fabs(x.start))) {
    axes.frozen |= bit;
    x.held = 0.5f * (x.lower + x.upper);
    x.lambda = lambda.lock + lambda.lower + lambda.upper;
    return;
  }
  axes.limited |= bit;
  if (lambda.lock < 0) x.lambdaLower += lambda.lock;
  if (lambda.lock > 0) x.lambdaUpper += lambda.lock;
}

void fillDrive(const StepData& step, const CoordinateState& at, float rho, rows::D6Axes& axes, rows::D6Axis<float>& x) {
  const D6Axis& axis = at.definition;
  const JointDrive& drive = axis.drive;
  if (!(drive.stiffness + drive.damping > 0)) {
    x.force += std::clamp(drive.force, -drive.maxForce, drive.maxForce);
    return;
  }
  axes.driven |= static_cast<uint8_t>(1 << at.axis);
  const float inertia = drive.acceleration && at.w > 0 ? 1 / at.w + axis.armature : 1;
  const ElasticRow e = elasticRow(fillDriveOf(step, drive, inertia, x), rho, at.inTree);
  x.kDrive = e.k, x.sDrive = e.s;
}

/// Spring, damper, and inertia: k = a / h^2 about where the coordinate would go unhindered.
void fillPassive(const StepData& step, const CoordinateState& at, float rho, rows::D6Axes& axes,
                 rows::D6Axis<float>& x) {
  const D6Axis& axis = at.definition;
  const JointSpring& spring = axis.spring;
  const float inertia = axis.armature / (step.h * step.h);
  const float whole = spring.stiffness + spring.damping / step.h + inertia;
  if (!(whole > 0)) return;
  axes.passive |= static_cast<uint8_t>(1 << at.axis);
  const ElasticRow e = elasticRow(whole, rho, at.inTree);
  x.kPassive = e.k, x.sPassive = e.s;
  x.rest = x.start + (spring.stiffness * (spring.position - x.start) + inertia * at.chordSpeed * step.h) / whole;
}

}  // namespace

ElasticRow elasticRow(float stiffness, float rho, bool inTree) {
  if (inTree || !(rho > 0)) return {stiffness, 0};
  return {stiffness * (rho / (stiffness + rho)), stiffness / (stiffness + rho)};
}

float stiffnessInUse(const StepData& step, float w) { return w > 0 ? kJointFactor / (w * step.h * step.h) : 0; }

float loadInUse(const StepData& step, float w, float massless) {
  if (!(w > 0) || !(massless > 0)) return 0;
  const float depth = std::max(step.loadDepth / kLoadsPerFall, kLeastDepth * step.slop);
  return 1 / (depth * std::sqrt(w / massless));
}

float fillDriveOf(const StepData& step, const JointDrive& drive, float inertia, rows::D6Axis<float>& x) {
  const float stiffness = drive.stiffness * inertia, damping = drive.damping * inertia;
  const float whole = stiffness + damping / step.h;
  x.driveMost = drive.maxForce;
  x.target = x.start + (stiffness * (drive.position - x.start) + damping * drive.velocity + drive.force) / whole;
  return whole;
}

void fillCoordinate(const WorldData& world, const StepData& step, const CoordinateState& at, rows::D6Axes& axes,
                    rows::D6Axis<float>& x) {
  const D6Axis& axis = at.definition;
  const JointMultipliers& lambda = at.lambda;
  const float rho = stiffnessInUse(step, at.w);
  const auto bit = static_cast<uint8_t>(1 << at.axis);
  x.lambda = lambda.lock, x.lambdaLower = lambda.lower, x.lambdaUpper = lambda.upper;
  x.lambdaDrive = lambda.drive, x.lambdaFriction = lambda.friction, x.lambdaPassive = lambda.passive;
  x.lambdaForce = 0;
  x.k = rho, x.s = 1;
  x.load = at.inTree ? 0 : loadInUse(step, at.w, at.massless);
  if (axis.motion == AxisMotion::Locked) {
    axes.locked |= bit;
    const float off = static_cast<float>(static_cast<double>(x.start) - at.lock);
    x.held = x.start - corrected(step, off, at.correction);
    return;
  }
  x.force = at.force;
  if (isLimited(axis.limit) || axis.maxVelocity < rows::kInfinity) fillLimit(world, step, at, axes, x);
  fillDrive(step, at, rho, axes, x);
  if (axis.friction > 0) {
    axes.rubbing |= bit;
    x.kFriction = rho, x.frictionMost = axis.friction;
  }
  fillPassive(step, at, rho, axes, x);
  if (x.force != 0) axes.forced |= bit;
}

JointMultipliers multipliersOf(const rows::D6Axis<float>& x) {
  return {x.lambda, x.lambdaLower, x.lambdaUpper, x.lambdaDrive, x.lambdaFriction, x.lambdaPassive};
}

}  // namespace avbd
