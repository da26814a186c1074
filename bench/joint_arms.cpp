// Where joint rows take their arms, measured: energy, gap and momentum of mechanisms for each choice. Prints a table.
#include <avbd/avbd.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace avbd;

struct Mechanism {
  World world;
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;
};

struct Result {
  double energy = 0;  ///< change over the run, relative to the largest potential energy at stake (or to the kinetic)
  double gap = 0;     ///< largest [m]
  double linear = 0;  ///< momentum drift relative to the initial sum of magnitudes
  double angular = 0;
  bool finite = true;
};

Mechanism make(float blend, Vec3 gravity) {
  WorldDef def;
  def.jointArmBlend = blend;
  def.gravity = gravity;
  def.sleep = false;
  return {World(def), {}, {}};
}

void hang(Mechanism& m, BodyId a, BodyId b, Vec3d at) {
  const auto local = [&](BodyId id) {
    return id ? Pose{(inverse(m.world.pose(id)) * Pose{at, {}}).position, {}} : Pose{at, {}};
  };
  m.joints.push_back(m.world.create(BallJoint{.bodyA = a, .bodyB = b, .frameA = local(a), .frameB = local(b)}));
}

/// Rods along x, jointed end to end from the origin; the last one may carry a heavy ball.
Mechanism chain(float blend, Vec3 gravity, int links, double ball, bool anchored) {
  Mechanism m = make(blend, gravity);
  BodyId last;
  for (int i = 0; i < links; ++i) {
    const BodyId link = m.world.create(BodyDef{
        .position = {0.25 + 0.5 * i, 0, 0}, .shape = Box{0.25f, 0.05f, 0.05f}, .mass = 1, .filter = {.mask = 0}});
    m.bodies.push_back(link);
    if (anchored || last) hang(m, last, link, {0.5 * i, 0, 0});
    last = link;
  }
  if (ball > 0) {
    m.bodies.push_back(m.world.create(BodyDef{.position = {0.5 * links + 1, 0, 0},
                                              .shape = Sphere{1},
                                              .mass = static_cast<float>(ball),
                                              .filter = {.mask = 0}}));
    hang(m, last, m.bodies.back(), {0.5 * links, 0, 0});
  }
  return m;
}

double energy(const Mechanism& m) {
  const double g = m.world.definition().gravity.y;
  double sum = 0;
  for (const BodyId id : m.bodies) {
    // Velocities are those of the middle of a step: move them on by half a step of gravity.
    const Velocity v = m.world.velocity(id);
    const Vec3 now = v.linear + Vec3{0, static_cast<float>(g / 120), 0};
    sum += m.world.kineticEnergy(id) + 0.5 * m.world.mass(id) * (dot(now, now) - dot(v.linear, v.linear));
    sum -= m.world.mass(id) * g * m.world.worldCenterOfMass(id).y;
  }
  return sum;
}

Result run(Mechanism m, double scale) {
  Result r;
  m.world.step(1.0f / 60);  // the velocities now fit the joints
  const double start = energy(m);
  if (scale == 0) scale = start;
  const Vec3d p0 = m.world.momentum(), l0 = m.world.angularMomentum();
  double sizes = 0, spins = 0;
  for (const BodyId id : m.bodies) {
    const double p = m.world.mass(id) * length(m.world.velocity(id).linear);
    sizes += p;
    spins += p * length(m.world.worldCenterOfMass(id)) + length(m.world.velocity(id).angular) * m.world.inertia(id).yy;
  }
  for (int i = 0; i < 600 && r.finite; ++i) {
    try {
      m.world.step(1.0f / 60);
    } catch (const NonFiniteError&) {
      r.finite = false;
    }
    for (const JointId id : m.joints) r.gap = std::fmax(r.gap, m.world.gap(id));
  }
  r.energy = (energy(m) - start) / scale;
  if (sizes > 0) r.linear = length(m.world.momentum() - p0) / sizes;
  if (spins > 0) r.angular = length(m.world.angularMomentum() - l0) / spins;
  return r;
}

void print(const char* choice, const Result& pendulum, const Result& heavy, const Result& free) {
  const auto pair = [](const Result& r) {
    char text[64];
    if (!r.finite || r.gap > 1) return std::string("explodes");
    std::snprintf(text, sizeof text, "%+.2f %%, %.3f mm", 100 * r.energy, 1e3 * r.gap);
    return std::string(text);
  };
  std::printf("| %s | %s | %s | %s, %.1e, %.1e |\n", choice, pair(pendulum).c_str(), pair(heavy).c_str(),
              pair(free).c_str(), free.linear, free.angular);
}

Mechanism tumbling(float blend) {
  Mechanism m = chain(blend, {}, 10, 0, false);
  for (size_t i = 0; i < m.bodies.size(); ++i)
    m.world.setVelocity(m.bodies[i],
                        {{0, i % 2 ? 0.4f : -0.3f, i % 3 ? 0.2f : -0.5f}, {0.5f, 0, i % 4 ? 1.5f : -2.0f}});
  return m;
}

}  // namespace

int main() {
  const Vec3 gravity{0, -9.81f, 0};
  std::printf(
      "| arms in J | double pendulum: energy, gap | 1000 kg on 50 links: energy, gap | "
      "ten links tumbling free: energy, gap, linear and angular momentum drift |\n|---|---|---|---|\n");
  const struct {
    const char* name;
    float blend;
  } choices[] = {{"start (SHAKE)", 0}, {"middle", 0.5f}, {"end", 1}, {"chosen per joint", -1}};
  for (const auto& c : choices) {
    print(c.name, run(chain(c.blend, gravity, 2, 0, true), 2 * 9.81),
          run(chain(c.blend, gravity, 50, 1000, true), 1000 * 9.81 * 26), run(tumbling(c.blend), 0));
  }
}
