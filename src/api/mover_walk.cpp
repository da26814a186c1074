// One move of a Mover (mover_walk.h).
#include "api/mover_walk.h"

#include <algorithm>

#include "api/mover_push.h"

namespace avbd {
namespace {

constexpr int kSlides = 8;      // pieces of one motion
constexpr int kClips = 32;      // rounds over the planes
constexpr int kRecoveries = 8;  // rounds of leaving overlaps

// Least part of a motion that counts as against what it meets: a gap is kept along the way, not across it.
constexpr float kSlant = 0.1f;
// Of a unit motion against a normal: less is along the surface, but for rounding.
constexpr float kDeeper = 1e-3f;
// Of skin: what is no farther counts as an overlap where a cast starts.
constexpr float kTouch = 0.01f;

Vec3 unitOf(Vec3 v) { return v * (1 / length(v)); }
Vec3 across(Vec3 v, Vec3 up) { return v - up * dot(v, up); }

}  // namespace

Vec3 clipMotion(Vec3 wanted, Vec3d center, const std::vector<MoverPlane>& planes) {
  // Each plane's push is kept and may be taken back (Gauss-Seidel on the nearest point of the planes' common front).
  std::vector<float> push(planes.size(), 0.0f);
  Vec3 motion = wanted;
  for (int round = 0; round < kClips; ++round) {
    float change = 0;
    for (size_t i = 0; i < planes.size(); ++i) {
      const float gap = static_cast<float>(dot(center - planes[i].point, toDouble(planes[i].normal)));
      const float next = std::max(0.0f, push[i] - (gap + dot(motion, planes[i].normal)));
      motion = motion + planes[i].normal * (next - push[i]);
      change = std::max(change, std::abs(next - push[i]));
      push[i] = next;
    }
    if (change <= 1e-7f * (1 + length(wanted))) break;
  }
  return motion;
}

Mover::Walk::Walk(const World& world, const Mover& mover, Vec3d center)
    : world_(world),
      def_(mover.def_),
      capsule_{mover.def_.radius, mover.halfHeight_},
      rotation_(mover.rotation_),
      center_(center),
      foot_(0.5f * mover.def_.height),
      flattest_(1 / std::sqrt(1 + mover.def_.maxSlope * mover.def_.maxSlope) - 1e-4f) {}

CastHit Mover::Walk::cast(Vec3 motion, const QueryFilter& filter) const {
  if (!(dot(motion, motion) > 0)) return {};
  const CastHit hit = world_.castClosest(capsule_, {center_, rotation_}, motion, filter);
  if (!hit || hit.distance > 0) return hit;
  const std::vector<NearHit> around = overlaps(filter);
  const Vec3 direction = unitOf(motion);
  for (const NearHit& near : around)
    if (dot(near.normal, direction) < -kDeeper)
      return {near.shape, near.body, near.element, 0, near.onShape, near.normal};
  return castOutOf(around, motion, filter);
}

std::vector<NearHit> Mover::Walk::overlaps(const QueryFilter& filter) const {
  return world_.nearest(capsule_, {center_, rotation_}, kTouch * def_.skin, filter);
}

CastHit Mover::Walk::castOutOf(const std::vector<NearHit>& overlaps, Vec3 motion, const QueryFilter& filter) const {
  const auto isAmong = [&](ShapeId shape) {
    return std::any_of(overlaps.begin(), overlaps.end(), [&](const NearHit& near) { return near.shape == shape; });
  };
  const auto accepts = [&](ShapeId shape) { return !filter.accept || filter.accept(shape); };
  QueryFilter seen = filter;
  seen.accept = [&](ShapeId shape) { return !isAmong(shape) && accepts(shape); };
  CastHit first = world_.castClosest(capsule_, {center_, rotation_}, motion, seen);
  const float way = length(motion);
  // A convex shape is not met again on the way out. Of a surface only a part is overlapped: the rest is met by a
  // capsule that is thinner by the depth, if that is not all of it.
  for (const NearHit& near : overlaps) {
    const float thinner = kTouch * def_.skin - std::min(near.distance, 0.0f);
    if (near.element == kNoElement || thinner > 0.9f * def_.radius) continue;
    seen.accept = [&](ShapeId shape) { return shape == near.shape; };
    const Capsule thin{capsule_.radius - thinner, capsule_.halfHeight};
    // It meets things later, the more so the more slantingly; slants are counted as in advance().
    CastHit hit = world_.castClosest(thin, {center_, rotation_}, motion * (1 + thinner / (kSlant * way)), seen);
    if (!hit) continue;
    hit.distance -= thinner / std::max(-dot(hit.normal, motion) / way, kSlant);
    if (hit.distance > way) continue;
    hit.distance = std::max(hit.distance, 0.0f);
    if (!first || hit.distance < first.distance) first = hit;
  }
  return first;
}

CastHit Mover::Walk::advance(Vec3 motion, const QueryFilter& filter) {
  const float wanted = length(motion);
  if (!(wanted > 0)) return {};
  const Vec3 direction = motion * (1 / wanted);
  // Looks a skin farther, so that it stops a skin before.
  const CastHit hit = cast(direction * (wanted + 2 * def_.skin), filter);
  float way = wanted;
  if (hit) {
    const float against = std::max(-dot(hit.normal, direction), kSlant);
    way = std::clamp(hit.distance - def_.skin / against, 0.0f, wanted);
  }
  center_ = center_ + toDouble(direction) * static_cast<double>(way);
  return way < wanted ? hit : CastHit{};
}

MoverPlane Mover::Walk::planeOf(Vec3 normal, float gap, bool level) const {
  const float up = dot(normal, def_.up);
  const Vec3 flat = across(normal, def_.up);
  const bool wall = level && up < flattest_ && up > -flattest_ && dot(flat, flat) > 1e-6f;
  const Vec3 n = wall ? unitOf(flat) : normal;
  return {n, center_ - toDouble(n) * static_cast<double>(gap - def_.skin)};
}

void Mover::Walk::gatherPlanes(std::vector<MoverPlane>& planes, bool level) const {
  for (const NearHit& hit : world_.nearest(capsule_, {center_, rotation_}, 2 * def_.skin, def_.filter)) {
    // What is a little too near is left as it is: pushing it away would make it tremble.
    // What it could not leave must only not be entered deeper.
    const bool kept = hit.distance > 0.25f * def_.skin || hit.distance <= 0;
    const float gap = kept ? std::max(hit.distance, def_.skin) : hit.distance;
    planes.push_back(planeOf(hit.normal, gap, level && hit.distance > 0));
  }
}

void Mover::Walk::slide(Vec3 motion, bool level) {
  const Vec3d target = center_ + motion;
  std::vector<MoverPlane> met;
  for (int i = 0; i < kSlides; ++i) {
    std::vector<MoverPlane> planes = met;
    gatherPlanes(planes, level);
    const Vec3 wanted = clipMotion(toFloat(target - center_), center_, planes);
    if (length(wanted) <= 1e-4f * def_.skin) return;
    const Vec3d before = center_;
    const CastHit hit = advance(wanted, def_.filter);
    if (!hit) return;
    met.push_back(planeOf(hit.normal, def_.skin, level));
    // Blocked at once by something that the planes do not tell of: going on would not help.
    if (center_ == before && i > 3) return;
  }
}

void Mover::Walk::recover() {
  for (int i = 0; i < kRecoveries; ++i) {
    std::vector<MoverPlane> planes;
    bool overlaps = false;
    for (const NearHit& hit : world_.nearest(capsule_, {center_, rotation_}, def_.skin, def_.filter)) {
      planes.push_back({hit.normal, center_ - toDouble(hit.normal) * static_cast<double>(hit.distance - def_.skin)});
      overlaps = overlaps || hit.distance <= 0.25f * def_.skin;
    }
    if (!overlaps) return;
    const Vec3d before = center_;
    // Cast like everything: what moved into it may have come a longer way than a wall behind it is thick.
    advance(clipMotion({}, center_, planes), def_.filter);
    if (length(center_ - before) <= 1e-4 * static_cast<double>(def_.skin)) return;
  }
}

bool Mover::Walk::isGround(const CastHit& hit, Vec3& normal) const {
  normal = hit.normal;
  if (dot(normal, def_.up) >= flattest_) return true;
  // An edge: what counts is the face behind it, seen from above.
  const Vec3 flat = across(normal, def_.up);
  if (!(dot(flat, flat) > 1e-6f) || dot(normal, def_.up) < 0) return false;
  const Vec3 inwards = unitOf(flat) * -(0.5f * def_.skin);
  const Ray down{hit.position + inwards + def_.up * (2 * def_.skin), -def_.up, 4 * def_.skin};
  const CastHit face = world_.rayClosest(down, def_.filter);
  if (!face || !(face.distance > 0) || dot(face.normal, def_.up) < flattest_) return false;
  if (rise(hit.position) > def_.stepHeight + def_.skin) return false;
  normal = face.normal;
  return true;
}

bool Mover::Walk::settle(float depth) {
  const CastHit hit = cast(def_.up * -(depth + 2 * def_.skin), def_.filter);
  if (!hit || !(hit.distance > 0)) return false;
  Walk landed = *this;
  const float way = std::clamp(hit.distance - def_.skin, 0.0f, depth);
  landed.center_ = center_ - toDouble(def_.up) * static_cast<double>(way);
  Vec3 normal;
  if (!landed.isGround(hit, normal)) return false;
  center_ = landed.center_;
  return true;
}

void Mover::Walk::stride(Vec3 motion) {
  const float wanted = length(motion);
  if (!(wanted > 0)) return;
  const Vec3 direction = motion * (1 / wanted);
  const Vec3d start = center_;
  const auto progress = [&](Vec3d at) { return static_cast<float>(dot(at - start, toDouble(direction))); };
  slide(motion, true);
  const float plain = progress(center_);
  if (plain >= 0.99f * wanted || !(def_.stepHeight > 0)) return;
  Walk over = *this;
  over.center_ = start;
  over.advance(def_.up * def_.stepHeight, def_.filter);
  const float lifted = static_cast<float>(dot(over.center_ - start, toDouble(def_.up)));
  // Far enough for the round end to come over the edge, also where it walks slowly.
  const Vec3 forward = across(motion, def_.up);
  const float pace = length(forward);
  if (!(pace > 0)) return;
  over.slide(forward * (std::max(pace, 1.5f * def_.skin) / pace), true);
  if (progress(over.center_) <= plain + 1e-3f * wanted) return;
  const CastHit top = over.cast(def_.up * -(lifted + 2 * def_.skin), def_.filter);
  // The ground is a skin below the foot.
  const double height = dot(top.position - start, toDouble(def_.up)) + static_cast<double>(foot_ + def_.skin);
  if (!top || height > static_cast<double>(def_.stepHeight + 0.1f * def_.skin)) return;
  if (!over.settle(lifted)) return;
  const bool climbed = dot(over.center_ - start, toDouble(def_.up)) > 0.1 * static_cast<double>(def_.skin);
  if (climbed || progress(over.center_) <= 1.01f * wanted) center_ = over.center_;
}

MoverGround Mover::Walk::findGround(float depth) const {
  const Vec3 down = def_.up * -depth;
  CastHit hit = cast(down, def_.filter);
  // Something that overlaps and lies lower holds it up no more than a wall does; what is under it may still do so.
  if (hit && !(hit.distance > 0)) hit = castOutOf(overlaps(def_.filter), down, def_.filter);
  if (!hit || !(hit.distance > 0)) return {};
  MoverGround ground;
  ground.onGround = isGround(hit, ground.normal);
  ground.shape = hit.shape;
  ground.body = hit.body;
  ground.point = hit.position;
  ground.velocity = pointVelocity(world_, hit.body, hit.position);
  return ground;
}

}  // namespace avbd
