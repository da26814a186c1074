// Fields of pulleys, couplings and custom joints (joint_links.h).
#include "io/record/joint_links.h"

namespace avbd::record {
namespace {

enum LinkField : uint16_t {
  kWheels = 13,
  kRatios = 14,
  kTermCounts = 15,
  kTermJoints = 16,
  kTermAxes = 17,
  kTermFactors = 18,
  kRests = 19,
  kMoreBodies = 20,
  kFamilies = 21,
  kResiduals = 23,
};

constexpr uint8_t kAxes = 6;

}  // namespace

LinkColumns::LinkColumns(const FieldReader& f, size_t count) {
  wheels_ = f.listOf<double>(kWheels, 6 * count);
  ratios_ = f.listOf<float>(kRatios, count);
  termCounts_ = f.listOf<uint32_t>(kTermCounts, count);
  countTerms();
  const size_t terms = firstTerm_.back();
  termJoints_ = f.listOf<uint32_t>(kTermJoints, terms);
  termAxes_ = f.listOf<uint8_t>(kTermAxes, terms);
  factors_ = f.listOf<float>(kTermFactors, 4 * terms);
  if (terms > 0 && (termJoints_.empty() || termAxes_.empty() || factors_.empty()))
    f.refuse(kTermCounts, "stands alone");
  rests_ = f.listOf<double>(kRests, count);
  moreBodies_ = f.listOf<uint32_t>(kMoreBodies, 2 * count);
  families_ = f.texts(kFamilies, count);
  if (!families_.empty() && families_.size() != count) f.refuse(kFamilies, "does not fit the joints");
  residuals_ = f.listOf<uint8_t>(kResiduals, count);
}

void LinkColumns::countTerms() {
  firstTerm_.assign(1, 0);
  for (const uint32_t terms : termCounts_) firstTerm_.push_back(firstTerm_.back() + terms);
}

void LinkColumns::add(const RecordedJoint& joint) {
  for (const Vec3d wheel : joint.wheels) wheels_.insert(wheels_.end(), {wheel.x, wheel.y, wheel.z});
  ratios_.push_back(joint.ratio);
  termCounts_.push_back(static_cast<uint32_t>(joint.terms.size()));
  for (const RecordedTerm& term : joint.terms) {
    termJoints_.push_back(term.joint);
    termAxes_.push_back(static_cast<uint8_t>(term.axis));
    factors_.insert(factors_.end(), term.factors.begin(), term.factors.end());
  }
  rests_.push_back(joint.rest);
  moreBodies_.insert(moreBodies_.end(), joint.moreBodies.begin(), joint.moreBodies.end());
  families_.push_back(joint.family);
  residuals_.push_back(joint.residuals);
  any_ = any_ || joint.residuals > 0 || (joint.type && *joint.type >= JointType::Pulley);
}

void LinkColumns::fill(size_t i, RecordedJoint& joint) const {
  // Also of types that are not known: the numbers of other joints stand behind theirs.
  if (!residuals_.empty()) joint.residuals = residuals_[i];
  for (size_t side = 0; side < 2 && !wheels_.empty(); ++side) {
    const double* p = &wheels_[6 * i + 3 * side];
    joint.wheels[side] = {p[0], p[1], p[2]};
  }
  if (!ratios_.empty()) joint.ratio = ratios_[i];
  for (size_t t = termCounts_.empty() ? 0 : firstTerm_[i]; !termCounts_.empty() && t < firstTerm_[i + 1]; ++t) {
    const float* k = &factors_[4 * t];
    joint.terms.push_back({termJoints_[t], static_cast<JointAxis>(termAxes_[t]), {k[0], k[1], k[2], k[3]}});
  }
  if (!rests_.empty()) joint.rest = rests_[i];
  if (!moreBodies_.empty()) joint.moreBodies = {moreBodies_[2 * i], moreBodies_[2 * i + 1]};
  if (!families_.empty()) joint.family = families_[i];
}

void LinkColumns::write(FieldWriter& out) const {
  if (!any_) return;
  out.list(kWheels, wheels_, Encoding::Shuffled);
  out.list(kRatios, ratios_, Encoding::Shuffled);
  out.list(kTermCounts, termCounts_, Encoding::Shuffled);
  out.list(kTermJoints, termJoints_, Encoding::Shuffled);
  out.list(kTermAxes, termAxes_);
  out.list(kTermFactors, factors_, Encoding::Shuffled);
  out.list(kRests, rests_, Encoding::Shuffled);
  out.list(kMoreBodies, moreBodies_, Encoding::Shuffled);
  out.texts(kFamilies, families_);
  out.list(kResiduals, residuals_);
}

void LinkColumns::check(const FieldReader& f, size_t bodies, size_t joints) const {
  for (const uint32_t joint : termJoints_)
    if (joint != kNotRecorded && joint >= joints) f.refuse(kTermJoints, "names a joint that there is not");
  for (const uint8_t axis : termAxes_)
    if (axis >= kAxes) f.refuse(kTermAxes, "names a coordinate that there is not");
  for (const uint32_t body : moreBodies_)
    if (body != kNotRecorded && body >= bodies) f.refuse(kMoreBodies, "names a body that there is not");
}

}  // namespace avbd::record
