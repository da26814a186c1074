// Composites against MuJoCo 2.2: the bodies that it makes of them, by name, where they are and what they weigh.
#include <gtest/gtest.h>

#include <map>

#include "io/mjcf_build.h"
#include "io/mujoco_compare.h"

namespace avbd::mjcf {
namespace {

// Every named body of MuJoCo's is one of ours, at the same place, with the same mass; and all together weigh the same.
void expectSameBodies(const std::string& file, size_t named) {
  const Loaded theirs = load(file);
  ASSERT_TRUE(theirs.model) << theirs.error;
  const mjModel* m = theirs.model.get();
  const Description ours = parseFile(file);
  const std::vector<Posed> poses = worldPoses(ours, {});
  std::map<std::string, size_t> byName;
  double mass = 0, theirMass = 0;
  for (size_t i = 0; i < ours.bodies.size(); ++i) {
    if (!ours.bodies[i].name.empty()) byName[ours.bodies[i].name] = i;
    mass += ours.bodies[i].mass.mass;
  }
  EXPECT_EQ(ours.bodies.size(), static_cast<size_t>(m->nbody));
  size_t found = 0;
  for (int b = 1; b < m->nbody; ++b) {
    theirMass += m->body_mass[b];
    const char* name = mj_id2name(m, mjOBJ_BODY, b);
    if (!name || !*name) continue;
    ++found;
    ASSERT_TRUE(byName.contains(name)) << name;
    const size_t i = byName[name];
    expectNear(poses[i].position, theirs.data->xpos + 3 * b, 1e-9, name);
    EXPECT_NEAR(ours.bodies[i].mass.mass, m->body_mass[b], 1e-9) << name;
  }
  EXPECT_EQ(found, named);
  EXPECT_NEAR(mass, theirMass, 1e-7);
}

std::string model(const std::string& inside) { return write("<mujoco><worldbody>" + inside + "</worldbody></mujoco>"); }

TEST(MujocoComposite, Grids) {
  expectSameBodies(model("<composite type='grid' count='5 4 1' spacing='.1' offset='1 2 3' prefix='P'>"
                         "<pin coord='0 0'/><pin coord='4 0'/><geom size='.02'/></composite>"),
                   20);
  expectSameBodies(model("<body pos='1 0 0' quat='1 2 3 4'><geom size='.1'/><composite type='grid' count='7' "
                         "spacing='.1'><geom type='capsule' size='.02 .03' density='500'/></composite></body>"),
                   7);
}

TEST(MujocoComposite, Particles) {
  expectSameBodies(model("<composite type='particle' count='3 4 5' spacing='.1' offset='1 2 3'><geom size='.02'/>"
                         "</composite>"),
                   0);
}

TEST(MujocoComposite, Cloth) {
  expectSameBodies(model("<body name='B1_2' pos='1 2 3'><freejoint/><composite type='cloth' count='4 5 1' spacing='.1'>"
                         "<geom type='ellipsoid' size='.03 .01 .03'/></composite></body>"),
                   20);
}

// Of these all of it is compared: joints, geoms, inertias, the world that is made.
TEST(MujocoComposite, RopesAndLoops) {
  compare(
      model("<body name='PB2' pos='1 2 3'><freejoint/><composite type='rope' prefix='P' count='6 1 1' spacing='.1'>"
            "<joint kind='main' damping='.01'/><geom type='capsule' size='.01 .03'/></composite></body>"));
  compare(
      model("<body name='B0' pos='1 2 3' quat='1 2 3 4'><freejoint/><composite type='loop' count='9 1 1' "
            "spacing='.1'><geom type='ellipsoid' size='.01 .02 .03'/></composite></body>"));
}

}  // namespace
}  // namespace avbd::mjcf
