// Acceptance, articulations: an arm's joints report the forces and torques that inverse dynamics asks of them.
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kMass = 2, kThick = 0.05;
constexpr Box kLink{0.5f, static_cast<float>(kThick), static_cast<float>(kThick)};  // a metre from joint to joint
constexpr JointDrive kStiff{.stiffness = 1e5f, .damping = 1e3f};

/// Links in a row along x, on driven hinges about z.
struct Row {
  Model model;
  std::vector<JointId> joints;
};

Row rowOf(const Settings& settings, size_t links) {
  Build build("inverse_dynamics", settings);
  build.filter(kGhost);
  Row row;
  BodyId previous;
  for (size_t i = 0; i < links; ++i) {
    const double x = static_cast<double>(i);
    const BodyId link = build.box("link", kLink, {x + 0.5, 0, 0}, static_cast<float>(kMass));
    row.joints.push_back(build.join(HingeJoint{.drive = kStiff}, previous, link, {{x, 0, 0}, along({0, 0, 1})}));
    previous = link;
  }
  row.model = build.take();
  return row;
}

/// What a joint does to the link beyond it: force in the x-y plane and torque about z, at the joint.
struct Effort {
  double x = 0, y = 0, torque = 0;
};

/// A link's angle from the x axis.
struct Turning {
  double angle = 0, speed = 0, acceleration = 0;
};

/// Newton and Euler from the tip to the base. With e the direction of a link, its far end is accelerated by
/// alpha e' - w^2 e against its near end.
std::vector<Effort> effortsOf(const std::vector<Turning>& links) {
  const double inertia = kMass * (1 + 4 * kThick * kThick) / 12;
  double ax = 0, ay = kGravity;  // of the near end; gravity as an acceleration upwards
  std::vector<Effort> own(links.size());
  for (size_t i = 0; i < links.size(); ++i) {
    const double c = std::cos(links[i].angle), s = std::sin(links[i].angle);
    const double w2 = links[i].speed * links[i].speed, alpha = links[i].acceleration;
    const double ex = -alpha * s - w2 * c, ey = alpha * c - w2 * s;
    own[i] = {kMass * (ax + 0.5 * ex), kMass * (ay + 0.5 * ey), 0};
    own[i].torque = inertia * alpha + 0.5 * (c * own[i].y - s * own[i].x);
    ax += ex, ay += ey;
  }
  for (size_t i = links.size() - 1; i-- > 0;) {
    const Effort& beyond = own[i + 1];
    const double c = std::cos(links[i].angle), s = std::sin(links[i].angle);
    own[i].torque += beyond.torque + c * beyond.y - s * beyond.x;
    own[i].x += beyond.x, own[i].y += beyond.y;
  }
  return own;
}

/// Largest differences and largest values of one joint.
struct Compared {
  double force = 0, torque = 0, forcePeak = 0, torquePeak = 0;
  void see(const JointReaction& r, const Effort& e) {  // a reaction is on the nearer body
    force = std::max(force, length(toDouble(r.force) + Vec3d{e.x, e.y, 0}));
    torque = std::max(torque, length(toDouble(r.torque) + Vec3d{0, 0, e.torque}));
    forcePeak = std::max(forcePeak, std::hypot(e.x, e.y));
    torquePeak = std::max(torquePeak, std::abs(e.torque));
  }
  void tell(std::vector<Figure>& figures, const std::string& params) const {
    figures.push_back(atMost("force_error", force / forcePeak, 0.01, "of the largest", params));
    figures.push_back(atMost("torque_error", torque / torquePeak, 0.01, "of the largest", params));
  }
};

// Three links held bent, where their drives have let them sag to.
void atRest(std::vector<Figure>& figures, const Settings& settings) {
  Row row = rowOf(settings, 3);
  const float angles[3] = {0.4f, -0.9f, 0.7f};
  for (int i = 0; i < stepsFor(4, kDt); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      JointDrive drive = kStiff;
      drive.position = angles[k] * std::min(1.0f, static_cast<float>(i) / 60);
      row.model.world.setDrive(row.joints[k], drive);
    }
    row.model.world.step(static_cast<float>(kDt));
  }
  std::vector<Turning> links;
  for (const NamedBody& body : row.model.bodies) {
    const Vec3d e = rotate(row.model.world.pose(body.id).rotation, Vec3d{1, 0, 0});
    links.push_back({std::atan2(e.y, e.x), 0, 0});
  }
  const std::vector<Effort> efforts = effortsOf(links);
  for (size_t k = 0; k < 3; ++k) {
    Compared compared;
    compared.see(row.model.world.reaction(row.joints[k]), efforts[k]);
    compared.tell(figures, "at_rest links=3 joint=" + std::to_string(k));
  }
}

// One link, and two, along q = reach (1 - cos w t), dt 1/240. A step's forces are those of its start: it goes from
// there to where the path is at its end.
void onPath(std::vector<Figure>& figures, const Settings& settings, size_t links) {
  constexpr double kStep = 1.0 / 240;
  const double reach[2] = {0.6, -0.8}, rate[2] = {2.0, 3.0};
  Row row = rowOf(settings, links);
  std::vector<Compared> compared(links);
  for (int i = 0; i < stepsFor(5, kStep); ++i) {
    const double now = i * kStep, end = now + kStep;
    std::vector<Turning> turning(links);
    Turning sum;
    for (size_t k = 0; k < links; ++k) {
      const double a = reach[k], w = rate[k];
      JointDrive drive = kStiff;
      drive.position = static_cast<float>(a * (1 - std::cos(w * end)));
      drive.velocity = static_cast<float>(a * w * std::sin(w * end));
      row.model.world.setDrive(row.joints[k], drive);
      sum.angle += a * (1 - std::cos(w * now));
      sum.speed += a * w * std::sin(w * now);
      sum.acceleration += a * w * w * std::cos(w * now);
      turning[k] = sum;
    }
    row.model.world.step(static_cast<float>(kStep));
    if (i < stepsFor(0.5, kStep)) continue;  // it has been set in motion by then
    const std::vector<Effort> efforts = effortsOf(turning);
    for (size_t k = 0; k < links; ++k) compared[k].see(row.model.world.reaction(row.joints[k]), efforts[k]);
  }
  for (size_t k = 0; k < links; ++k)
    compared[k].tell(figures, "on_path links=" + std::to_string(links) + " joint=" + std::to_string(k) + " rate=240");
}

std::vector<Figure> inverseDynamics(const Settings& settings) {
  std::vector<Figure> figures;
  atRest(figures, settings);
  onPath(figures, settings, 1);
  onPath(figures, settings, 2);
  return figures;
}

}  // namespace

std::vector<Line> inverseDynamicsLines() { return {{"A", "inverse_dynamics", inverseDynamics, ""}}; }

}  // namespace avbd::scenes
