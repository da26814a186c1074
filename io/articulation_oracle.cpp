// Articulations against MuJoCo: mass matrix, bias, inverse dynamics and places of the same trees.
#include <avbd/articulation.h>
#include <avbd/world.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <sstream>

#include "io/mujoco_compare.h"

namespace avbd::mjcf {
namespace {

enum class Kind { Free, Hinge, Slide, Ball, Screwed };  // Screwed: along and about one axis

struct Part {
  int parent;  // -1: the world
  Kind kind;
};

/// The same tree as a file for MuJoCo and as a world. Hinges, slides and screws have their joint anywhere; a ball's
/// frame is turned as its body, and the root of a floating base has its centre in its origin, so that velocities
/// compare.
class Twin {
 public:
  Twin(const std::vector<Part>& parts, unsigned seed)
      : parts_(parts), random_(seed), world_({.gravity = {1, 2, -9.81f}}) {
    for (size_t i = 0; i < parts.size(); ++i) describe(i);
    for (size_t i = 0; i < parts.size(); ++i) build(i);
  }
  World& world() { return world_; }
  const std::vector<BodyId>& bodies() const { return bodies_; }
  const std::vector<JointId>& joints() const { return joints_; }
  std::string xml() const {
    std::string inside;
    for (size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i].parent < 0) inside += element(i);
    return "<mujoco><compiler angle='radian'/><option gravity='1 2 -9.81'><flag constraint='disable'/></option>"
           "<worldbody>" +
           inside + "</worldbody></mujoco>";
  }
  double number(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }

 private:
  struct Body {
    Pose pose, joint;  // in the parent's frame, and of the joint in the body's; its x is the axis
    Vec3 center;
    float mass, armature;
    SymMat3 inertia;
  };
  // Floats, so that both read the same numbers.
  float size() { return static_cast<float>(0.6 + number(0.4)); }
  Vec3d place() { return toDouble(Vec3{float(number(1)), float(number(1)), float(number(1))}); }
  Quat rotation() {
    const Vec3d v = place();
    const double s = 1 / std::sqrt(1 + dot(v, v));
    return {float(s), float(v.x * s), float(v.y * s), float(v.z * s)};
  }
  void describe(size_t i) {
    const Kind kind = parts_[i].kind;
    Body body{{place(), rotation()}, {place(), rotation()}, toFloat(place()), 2 * size(), 0, {}};
    if (kind == Kind::Free) body.center = {};
    if (kind == Kind::Ball) body.joint.rotation = {};
    if (kind == Kind::Hinge || kind == Kind::Slide) body.armature = size();
    const float a = size(), b = size(), c = size();
    body.inertia = {b + c, a + c, a + b, 0.05f * a, -0.04f * b, 0.03f * c};
    descriptions_.push_back(body);
  }
  void build(size_t i) {
    const Body& body = descriptions_[i];
    MassProperties mass{.mass = body.mass, .center = body.center, .inertia = body.inertia};
    bodies_.push_back(world_.create(BodyDef{.massProperties = mass}));
    const Part& part = parts_[i];
    const BodyId parent = part.parent < 0 ? BodyId{} : bodies_[static_cast<size_t>(part.parent)];
    const Pose onParent = body.pose * body.joint;
    const auto frames = [&](auto def) {
      def.bodyA = parent, def.bodyB = bodies_[i], def.frameA = onParent, def.frameB = body.joint;
      return def;
    };
    if (part.kind == Kind::Hinge) joints_.push_back(world_.create(frames(HingeJoint{.armature = body.armature})));
    if (part.kind == Kind::Slide) joints_.push_back(world_.create(frames(SliderJoint{.armature = body.armature})));
    if (part.kind == Kind::Ball) joints_.push_back(world_.create(frames(BallJoint{})));
    if (part.kind == Kind::Screwed) {
      D6Joint def;
      def.axes[0].motion = def.axes[3].motion = AxisMotion::Free;
      joints_.push_back(world_.create(frames(def)));
    }
  }
  std::string element(size_t i) const {
    const Body& b = descriptions_[i];
    std::ostringstream out;
    out.precision(17);
    const auto put = [&](Vec3d v) { out << v.x << ' ' << v.y << ' ' << v.z; };
    const Quat q = b.pose.rotation;
    out << "<body pos='";
    put(b.pose.position);
    out << "' quat='" << q.w << ' ' << q.x << ' ' << q.y << ' ' << q.z << "'><inertial mass='" << b.mass << "' pos='";
    put(toDouble(b.center));
    const SymMat3& m = b.inertia;
    out << "' fullinertia='" << m.xx << ' ' << m.yy << ' ' << m.zz << ' ' << m.xy << ' ' << m.xz << ' ' << m.yz
        << "'/>";
    const auto joint = [&](const char* type) {
      out << "<joint type='" << type << "' armature='" << b.armature << "' pos='";
      put(b.joint.position);
      out << "' axis='";
      put(rotate(b.joint.rotation, Vec3d{1, 0, 0}));
      out << "'/>";
    };
    const Kind kind = parts_[i].kind;
    if (kind == Kind::Free) out << "<freejoint/>";
    if (kind == Kind::Slide || kind == Kind::Screwed) joint("slide");
    if (kind == Kind::Hinge || kind == Kind::Screwed) joint("hinge");
    if (kind == Kind::Ball) joint("ball");
    for (size_t k = 0; k < parts_.size(); ++k)
      if (parts_[k].parent == static_cast<int>(i)) out << element(k);
    out << "</body>";
    return out.str();
  }

  std::vector<Part> parts_;
  std::mt19937 random_;
  World world_;
  std::vector<Body> descriptions_;
  std::vector<BodyId> bodies_;
  std::vector<JointId> joints_;
};

using Matrix = std::vector<double>;  // square, row by row

/// Velocities of MuJoCo from ours: another order, and those of balls and free bodies along the body's own axes.
Matrix velocityMap(const Articulation& tree, const Twin& twin, const mjModel* m, const mjData* d) {
  const size_t n = tree.dofCount();
  Matrix map(n * n);
  for (size_t i = 0; i < twin.bodies().size(); ++i) {
    const ArticulationLink& link = tree.links()[tree.linkOf(twin.bodies()[i])];
    const int body = static_cast<int>(i) + 1, joint = m->body_jntadr[body];
    const size_t row = static_cast<size_t>(m->jnt_dofadr[joint]), column = static_cast<size_t>(link.firstDof);
    const int type = m->jnt_type[joint];
    const auto count = static_cast<size_t>(link.dofCount);
    const size_t turns = type == mjJNT_FREE ? 3 : 0;
    for (size_t k = 0; k < count; ++k) map[(row + k) * n + column + k] = 1;
    if (type != mjJNT_FREE && type != mjJNT_BALL) continue;
    mjtNum turn[9];
    mju_quat2Mat(turn, d->qpos + m->jnt_qposadr[joint] + turns);
    for (size_t a = 0; a < 3; ++a)
      for (size_t b = 0; b < 3; ++b) map[(row + turns + a) * n + column + turns + b] = turn[b * 3 + a];
  }
  return map;
}

/// map^T v.
std::vector<double> pulled(const Matrix& map, const mjtNum* v, size_t n) {
  std::vector<double> out(n);
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < n; ++k) out[k] += map[i * n + k] * v[i];
  return out;
}

void push(const Matrix& map, const std::vector<double>& v, mjtNum* out) {
  const size_t n = v.size();
  for (size_t i = 0; i < n; ++i) {
    out[i] = 0;
    for (size_t k = 0; k < n; ++k) out[i] += map[i * n + k] * v[k];
  }
}

void setPositions(const Articulation& tree, const Twin& twin, const ArticulationState& state, const mjModel* m,
                  mjData* d) {
  for (size_t i = 0; i < twin.bodies().size(); ++i) {
    const ArticulationLink& link = tree.links()[tree.linkOf(twin.bodies()[i])];
    const int joint = m->body_jntadr[i + 1];
    mjtNum* to = d->qpos + m->jnt_qposadr[joint];
    if (m->jnt_type[joint] == mjJNT_FREE) {
      const Vec3d p = state.base.position;
      const Quat q = state.base.rotation;
      const double all[7] = {p.x, p.y, p.z, q.w, q.x, q.y, q.z};
      std::copy(all, all + 7, to);
      mju_normalize4(to + 3);
      continue;
    }
    const double* from = state.positions.data() + (link.firstDof - (tree.isFloating() ? 6 : 0));
    if (m->jnt_type[joint] == mjJNT_BALL) {
      mjtNum axis[3] = {from[0], from[1], from[2]};
      const mjtNum angle = mju_normalize3(axis);
      mju_axisAngle2Quat(to, axis, angle);
    } else {
      std::copy(from, from + link.dofCount, to);
    }
  }
}

void expectClose(const std::vector<double>& a, const std::vector<double>& b, const char* what) {
  double size = 0;
  for (const double x : b) size = std::max(size, std::abs(x));
  // Quaternions of frames are float; MuJoCo makes them unit in double.
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 2e-6 * size) << what << ' ' << i;
}

void compareAt(Twin& twin, const Articulation& tree, const Loaded& mj) {
  const mjModel* m = mj.model.get();
  mjData* d = mj.data.get();
  const size_t n = tree.dofCount();
  ASSERT_EQ(static_cast<size_t>(m->nv), n);
  ArticulationState state{{}, std::vector<double>(tree.positionCount()), std::vector<double>(n)};
  for (double& q : state.positions) q = twin.number(1);
  for (double& v : state.velocities) v = twin.number(2);
  state.base = {{1, 2, 3}, {0.5f, -0.5f, 0.5f, 0.5f}};
  setPositions(tree, twin, state, m, d);
  const Matrix map = velocityMap(tree, twin, m, d);
  push(map, state.velocities, d->qvel);
  mj_forward(m, d);
  const ArticulationDynamics dynamics = tree.dynamics(twin.world(), state);
  for (size_t i = 0; i < twin.bodies().size(); ++i) {
    const size_t link = tree.linkOf(twin.bodies()[i]);
    expectNear(dynamics.pose(link).position, d->xpos + 3 * (i + 1), 1e-6, "place");
  }
  Matrix full(n * n), mass(n * n);
  mj_fullM(m, full.data(), d->qM);
  for (size_t i = 0; i < n; ++i) {
    std::vector<double> column(n);
    for (size_t k = 0; k < n; ++k)
      for (size_t l = 0; l < n; ++l) column[k] += full[k * n + l] * map[l * n + i];
    const std::vector<double> ours = pulled(map, column.data(), n);
    for (size_t k = 0; k < n; ++k) mass[k * n + i] = ours[k];
  }
  expectClose(dynamics.massMatrix(), mass, "mass matrix");
  std::vector<double> bias = dynamics.biasForces();
  const std::vector<double> gravity = dynamics.gravityForces();
  for (size_t i = 0; i < n; ++i) bias[i] -= gravity[i];
  expectClose(bias, pulled(map, d->qfrc_bias, n), "bias and gravity");
  // A ball's acceleration turns with its velocity: no further term.
  std::vector<double> accelerations(n);
  for (double& a : accelerations) a = twin.number(3);
  push(map, accelerations, d->qacc);
  mj_inverse(m, d);
  expectClose(dynamics.inverseDynamics(accelerations), pulled(map, d->qfrc_inverse, n), "inverse dynamics");
}

void compareTree(const std::vector<Part>& parts) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Twin twin(parts, seed);
    const Loaded mj = load(write(twin.xml()));
    ASSERT_TRUE(mj.model) << mj.error;
    const Articulation tree(twin.world(), twin.joints());
    compareAt(twin, tree, mj);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ArticulationOracle, Chain) {
  compareTree({{-1, Kind::Hinge}, {0, Kind::Slide}, {1, Kind::Ball}, {2, Kind::Screwed}, {3, Kind::Hinge}});
}

TEST(ArticulationOracle, Branches) {
  compareTree({{-1, Kind::Ball},
               {0, Kind::Hinge},
               {1, Kind::Hinge},
               {0, Kind::Screwed},
               {3, Kind::Ball},
               {4, Kind::Slide},
               {3, Kind::Hinge}});
}

TEST(ArticulationOracle, FloatingBase) {
  compareTree(
      {{-1, Kind::Free}, {0, Kind::Ball}, {1, Kind::Hinge}, {0, Kind::Hinge}, {3, Kind::Slide}, {0, Kind::Screwed}});
}

}  // namespace
}  // namespace avbd::mjcf
