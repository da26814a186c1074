// The joints of one MJCF body as joints of ours (mjcf_stages.h).
#include "io/mjcf_stages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace avbd::mjcf {

namespace {

constexpr double kStraight = 1e-5;                           // sine below which axes count as parallel, or as square
constexpr double kMostSwing = 150 * std::numbers::pi / 180;  // well below half a turn, where a swing ends
constexpr double kShare = 0.005;                             // of the child's mass and least moment of inertia
constexpr double kLeastShare = 0.0002;                       // of its largest moment

/// A right-handed frame that axes are put into one by one.
class Axes {
 public:
  /// The axis that lies along `direction`, and with which sign; nothing if it is not square to those before.
  std::optional<std::pair<size_t, double>> place(Vec3d direction) {
    for (size_t i = 0; i < set_; ++i) {
      const double along = dot(axis_[i], direction);
      if (std::abs(along) > 1 - kStraight * kStraight) return std::pair{i, along < 0 ? -1.0 : 1.0};
      if (std::abs(along) > kStraight) return {};
    }
    for (size_t i = 0; i < set_; ++i) direction = direction - axis_[i] * dot(axis_[i], direction);
    direction = direction * (1 / length(direction));
    double sign = 1;
    if (set_ == 2) {
      const Vec3d third = cross(axis_[0], axis_[1]);
      sign = dot(third, direction) < 0 ? -1 : 1;
      direction = third;
    }
    axis_[set_] = direction;
    return std::pair{set_++, sign};
  }

  Quatd rotation() {
    if (set_ == 0) return {};
    if (set_ == 1) {
      const Vec3d x = axis_[0];
      place(std::abs(x.x) < 0.5 ? perpendicular(x, {1, 0, 0}) : perpendicular(x, {0, 1, 0}));
    }
    return fromAxes(axis_[0], axis_[1], cross(axis_[0], axis_[1]));
  }

 private:
  static Vec3d perpendicular(Vec3d x, Vec3d near) {
    const Vec3d v = near - x * dot(x, near);
    return v * (1 / length(v));
  }

  std::array<Vec3d, 3> axis_;
  size_t set_ = 0;
};

bool swings(const Joint& hinge) {
  return hinge.limited && std::abs(hinge.lower - hinge.ref) <= kMostSwing &&
         std::abs(hinge.upper - hinge.ref) <= kMostSwing;
}

/// Puts the slides into the frame; false if they do not fit, or two share an axis.
bool placeSlides(const Body& body, size_t slides, Axes& axes, Stage& stage) {
  constexpr JointAxis kLinear[] = {JointAxis::LinearX, JointAxis::LinearY, JointAxis::LinearZ};
  for (size_t i = 0; i < slides; ++i) {
    const auto placed = axes.place(body.joints[stage.first + i].axis);
    if (!placed) return false;
    const JointAxis axis = kLinear[placed->first];
    if (std::find(stage.axes.begin(), stage.axes.end(), axis) != stage.axes.end()) return false;
    stage.axes.push_back(axis);
    stage.signs.push_back(placed->second);
  }
  return true;
}

/// Where the axes of two hinges at right angles meet.
std::optional<Vec3d> meeting(const Joint& a, const Joint& b) {
  const Vec3d apart = b.pos - a.pos;
  if (std::abs(dot(a.axis, b.axis)) > kStraight) return {};
  if (std::abs(dot(apart, cross(a.axis, b.axis))) > 1e-9 * (1 + length(apart))) return {};
  return a.pos + a.axis * dot(apart, a.axis);
}

/// A stage of `slides` slides and then `turns` joints that turn, if one joint of ours can be that.
std::optional<Stage> asStage(const Body& body, size_t first, size_t slides, size_t turns) {
  Stage stage;
  stage.first = first;
  stage.count = slides + turns;
  const Joint* next = body.joints.data() + first + slides;
  stage.frame.position = turns > 0 ? next[0].pos : body.joints[first].pos;
  Axes axes;
  if (turns == 2) {
    const std::optional<Vec3d> anchor = meeting(next[0], next[1]);
    stage.turned = !swings(next[0]);
    if (!anchor || (stage.turned && (slides > 0 || !swings(next[1])))) return {};
    stage.frame.position = *anchor;
    axes.place(next[stage.turned ? 0 : 1].axis);
    axes.place(next[stage.turned ? 1 : 0].axis);
  } else if (turns == 1 && next[0].kind == JointKind::Hinge) {
    axes.place(next[0].axis);
  }
  if (!placeSlides(body, slides, axes, stage)) return {};
  if (turns == 2) stage.axes.push_back(stage.turned ? JointAxis::Twist : JointAxis::SwingY);
  if (turns > 0) stage.axes.push_back(stage.turned ? JointAxis::SwingY : JointAxis::Twist);
  stage.signs.resize(stage.count, stage.turned ? -1 : 1);
  stage.frame.rotation = axes.rotation();
  return stage;
}

}  // namespace

std::vector<Stage> stagesOf(const Body& body) {
  std::vector<Stage> out;
  const std::vector<Joint>& joints = body.joints;
  for (size_t first = 0; first < joints.size(); first += out.back().count) {
    std::optional<Stage> best;
    // The longest that fits; one joint alone always does.
    for (size_t slides = 0; slides <= 3 && first + slides <= joints.size(); ++slides) {
      if (slides > 0 && joints[first + slides - 1].kind != JointKind::Slide) break;
      for (size_t turns = 0; turns <= 2 && first + slides + turns <= joints.size(); ++turns) {
        if (turns > 0 && joints[first + slides + turns - 1].kind == JointKind::Slide) break;
        if (turns == 2 && joints[first + slides + 1].kind != JointKind::Hinge) break;
        if (slides + turns <= (best ? best->count : 0)) continue;
        if (std::optional<Stage> stage = asStage(body, first, slides, turns)) best = std::move(stage);
      }
    }
    out.push_back(std::move(*best));
  }
  return out;
}

Mass splitOff(Mass& child, Vec3d anchor) {
  const auto sorted = [](const Sym3d& m) {
    std::array<double, 3> moments = principal(m).values;
    std::sort(moments.begin(), moments.end());
    return moments;
  };
  const std::array<double, 3> before = sorted(child.inertia);
  // The same about all axes, and small beside the child's least: it never turns with the child.
  const double moment = std::max(kShare * before[0], kLeastShare * before[2]);
  const Mass part{child.mass * kShare, anchor, Sym3d{1, 1, 1} * moment};
  const double left = child.mass - part.mass;
  const Vec3d arm = child.center - anchor;
  child.center = anchor + arm * (child.mass / left);
  // The point mass leaves the inertia about the anchor as it was; about the new centre that is less.
  const Sym3d rest = child.inertia + pointInertia(child.mass, arm) + pointInertia(-left, child.center - anchor) +
                     Sym3d{1, 1, 1} * -moment;
  const std::array<double, 3> after = sorted(rest);
  const bool possible = after[0] > 0.5 * before[0] && after[0] + after[1] >= after[2];
  child.mass = left;
  if (possible) child.inertia = rest;
  return part;
}

}  // namespace avbd::mjcf
