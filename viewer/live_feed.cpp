// Frames of a recording as floats about one origin.
#include "viewer/live_feed.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "io/record/json.h"
#include "io/record/softs.h"
#include "viewer/page.h"

namespace avbd::live {
namespace {

using record::Bytes;
using record::put;

/// Frames looked at in one update, so that a long recording does not keep the others waiting.
constexpr uint64_t kMostNew = 500;

void putVector(Bytes& out, Vec3 v) {
  for (const float x : {v.x, v.y, v.z}) put(out, std::isfinite(x) ? x : 0.0f);
}

template <class T>
void putPart(Bytes& out, const std::vector<T>& list, size_t first) {
  for (size_t i = first; i < list.size(); ++i) put(out, list[i]);
}

Message messageOf(Bytes&& bytes) { return std::make_shared<const Bytes>(std::move(bytes)); }

}  // namespace

void Feed::forget() {
  generation_ = reader_.generation();
  head_ = nullptr;
  times_.clear();
  for (auto* list : {&energy_, &penetration_, &gap_, &excess_, &excessAngle_}) list->clear();
  contactsAll_.clear();
  contactsKept_.clear();
}

bool Feed::update() {
  try {
    reader_.refresh();
  } catch (const FileError&) {
    // Begun anew, and not far enough yet to be read: what was sent is void all the same.
    if (reader_.generation() == generation_) throw;
  }
  if (reader_.generation() != generation_) {
    forget();
    return false;
  }
  const uint64_t end = std::min<uint64_t>(reader_.frameCount(), known() + kMostNew);
  for (uint64_t i = known(); i < end; ++i) {
    RecordedFrame f;
    try {
      f = reader_.frame(i);
    } catch (const FileError&) {
      f.kineticEnergy = NAN;  // its place in the plots stays empty
    }
    const auto count = static_cast<uint32_t>(f.contacts.size());
    times_.push_back(reader_.times()[i]);
    energy_.push_back(static_cast<float>(f.kineticEnergy));
    penetration_.push_back(static_cast<float>(f.penetrationMax));
    gap_.push_back(static_cast<float>(f.jointGapMax));
    excess_.push_back(static_cast<float>(f.limitExcessMax));
    excessAngle_.push_back(static_cast<float>(f.limitExcessAngleMax));
    contactsAll_.push_back(count + f.contactsLeftOut);
    contactsKept_.push_back(count);
  }
  return true;
}

Message Feed::head() {
  if (head_ || known() == 0) return head_;
  Recording first = reader_.head();
  try {
    first.frames = {reader_.frame(0)};
  } catch (const FileError&) {
    RecordedFrame none;
    none.time = times_[0];
    none.poses.resize(first.bodies.size());
    first.frames = {none};
  }
  const page::LiveHead live = page::liveHead(first);
  origin_ = live.origin;
  Bytes bytes;
  put(bytes, static_cast<uint32_t>(MessageKind::Head));
  bytes.insert(bytes.end(), live.json.begin(), live.json.end());
  head_ = messageOf(std::move(bytes));
  return head_;
}

Message Feed::figures(uint32_t first) const {
  Bytes bytes;
  put(bytes, static_cast<uint32_t>(MessageKind::Figures));
  put(bytes, first);
  put(bytes, known() - first);
  put(bytes, static_cast<uint32_t>(finished()));
  putPart(bytes, times_, first);
  putPart(bytes, energy_, first);
  putPart(bytes, penetration_, first);
  putPart(bytes, gap_, first);
  putPart(bytes, excess_, first);
  putPart(bytes, excessAngle_, first);
  putPart(bytes, contactsAll_, first);
  putPart(bytes, contactsKept_, first);
  return messageOf(std::move(bytes));
}

Message Feed::report() const {
  std::string json = "[";
  for (const auto& [label, value] : reader_.head().report)
    json += (json.size() > 1 ? ",[" : "[") + record::jsonText(label) + "," + record::jsonText(value) + "]";
  json += "]";
  Bytes bytes;
  put(bytes, static_cast<uint32_t>(MessageKind::Report));
  bytes.insert(bytes.end(), json.begin(), json.end());
  return messageOf(std::move(bytes));
}

Message Feed::frame(uint32_t number) {
  RecordedFrame f;
  try {
    f = reader_.frame(number);
  } catch (const FileError&) {
  }
  Bytes bytes;
  const size_t solid = std::min(f.poses.size(), solidBodies(reader_.head()));
  const auto points = std::span(f.poses).subspan(solid);
  bytes.reserve(28 + 28 * solid + 12 * points.size() + 24 * f.contacts.size() + 12 * f.joints.size() +
                4 * f.residuals.size());
  put(bytes, static_cast<uint32_t>(MessageKind::Frame));
  put(bytes, number);
  put(bytes, static_cast<uint32_t>(solid));
  put(bytes, static_cast<uint32_t>(f.contacts.size()));
  put(bytes, static_cast<uint32_t>(f.joints.size()));
  put(bytes, static_cast<uint32_t>(f.residuals.size()));
  put(bytes, static_cast<uint32_t>(points.size()));
  for (const Pose& pose : std::span(f.poses).first(solid)) {
    putVector(bytes, toFloat(pose.position - origin_));
    const Quat q = pose.rotation;
    const float size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    const bool sound = size > 1e-6f && std::isfinite(size);
    putVector(bytes, sound ? Vec3{q.x / size, q.y / size, q.z / size} : Vec3{});
    put(bytes, sound ? q.w / size : 1.0f);
  }
  for (const Pose& pose : points) putVector(bytes, toFloat(pose.position - origin_));
  for (const RecordedContact& c : f.contacts) putVector(bytes, toFloat(c.position - origin_));
  for (const RecordedContact& c : f.contacts) putVector(bytes, c.force);
  for (const RecordedJointState& joint : f.joints) {
    if (joint.enabled)
      putVector(bytes, -joint.reaction.force);
    else
      for (int i = 0; i < 3; ++i) put(bytes, NAN);
  }
  for (const float residual : f.residuals) put(bytes, residual);
  return messageOf(std::move(bytes));
}

}  // namespace avbd::live
