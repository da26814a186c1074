// The reader against MuJoCo itself: bodies, masses, poses and geoms of the same files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "io/mjcf.h"
#include "io/mujoco_compare.h"

namespace avbd {
namespace {

using namespace mjcf;

class Samples : public testing::TestWithParam<const char*> {};

TEST_P(Samples, GiveTheSameBodies) {
  const std::string file = std::string("/usr/share/mujoco/model/") + GetParam();
  if (!std::ifstream(file)) GTEST_SKIP() << "libmujoco-samples is not installed";
  compare(file);
}

// Those without composite elements.
INSTANTIATE_TEST_SUITE_P(Mujoco, Samples,
                         testing::Values("humanoid/humanoid.xml", "slider_crank/slider_crank.xml",
                                         "tendon_arm/arm26.xml", "humanoid100/humanoid100.xml",
                                         "humanoid/22_humanoids.xml"));

// Its mesh weighs by density.
TEST(Oracle, Mug) {
  const std::string file = "/usr/share/mujoco/model/mug/mug.xml";
  if (!std::ifstream(file)) GTEST_SKIP() << "libmujoco-samples is not installed";
  compare(file, MeshWeight::BoxOfInertia);
}

TEST(Oracle, Showcase) { compare(std::string(AVBD_SCENES) + "/showcase.xml"); }

class Snippets : public testing::TestWithParam<const char*> {};

TEST_P(Snippets, GiveTheSameBodies) { compare(write(std::string("<mujoco>") + GetParam() + "</mujoco>")); }

INSTANTIATE_TEST_SUITE_P(
    Mjcf, Snippets,
    testing::Values(
        // long shapes from point to point, in all their kinds
        R"(<worldbody><body><freejoint/>
          <geom type="capsule" size=".1" fromto="0 0 0 1 2 3"/><geom type="box" size=".1" fromto="1 0 0 1 2 -3"/>
          <geom type="cylinder" size=".2" fromto="0 0 0 0 0 -1"/><geom type="ellipsoid" size=".3" fromto="0 0 1 0 2 1"/>
          <geom type="box" size=".1" fromto="0 0 1 0 0 0"/></body></worldbody>)",
        // every way to say an orientation
        R"(<compiler angle="radian"/><worldbody>
          <body euler=".1 .2 .3"><freejoint/><geom size="1"/></body>
          <body axisangle="1 2 3 .7"><freejoint/><geom type="box" size="1 2 3" quat="2 1 0 1"/></body>
          <body xyaxes="1 1 0 0 1 1"><freejoint/><geom type="box" size="1 2 3" zaxis="1 -1 2"/></body>
          <body zaxis="0 0 -2"><freejoint/><geom type="box" size="1 2 3" zaxis="0 0 5"/></body></worldbody>)",
        R"(<compiler eulerseq="zYx"/><worldbody>
          <body euler="10 20 30"><freejoint/><geom size="1"/></body></worldbody>)",
        R"(<compiler eulerseq="XYZ"/><worldbody>
          <body euler="10 20 30"><freejoint/><geom size="1"/></body></worldbody>)",
        // classes: nested, inherited, by childclass, overridden by a body below, by the element
        R"(<default><geom size=".2" density="500"/><default class="a"><geom type="box" size=".1 .2 .3" group="2"/>
             <default class="b"><geom mass="3" contype="4"/><joint type="ball" pos=".1 0 0"/></default></default>
             <default class="c"><geom type="capsule" size=".1 .4" friction=".3"/></default></default>
           <worldbody><body childclass="a"><freejoint/><geom/><geom class="b"/><geom class="main"/>
             <body childclass="b"><joint/><geom/><body><joint type="hinge"/><geom/><geom class="c" mass="1"/></body></body>
             <body><geom/><joint class="b" pos="0 1 0"/></body></body></worldbody>)",
        // a class of the top has a name, or several, and then "main" is any other's
        R"(<default class="robot"><geom size=".2"/><default class="b"><geom type="box" size=".1 .2 .3"/></default></default>
           <worldbody><body childclass="robot"><freejoint/><geom/><geom class="b"/></body><body><freejoint/><geom/></body>
           <body childclass="b"><freejoint/><geom/><geom class="robot"/></body></worldbody>)",
        R"(<default class="robot"><geom size=".2"/><default class="main"><geom size=".5"/></default></default>
           <worldbody><body><freejoint/><geom/><geom class="main"/><geom class="robot"/></body></worldbody>)",
        R"(<default><geom size=".2" density="500"/></default><default class="robot"><geom type="box" size=".1 .2 .3"/></default>
           <worldbody><body><freejoint/><geom/><geom class="robot"/></body></worldbody>)",
        R"(<default class="a"><geom size=".2"/></default><default class="b"><geom density="500"/></default>
           <worldbody><body><freejoint/><geom/><geom class="b"/></body></worldbody>)",
        // a class gives one orientation, the element another
        R"(<default><geom euler="10 20 30" type="box" size="1 2 3"/><default class="q"><geom quat="1 1 0 0"/></default>
           </default><worldbody><body><freejoint/><geom zaxis="1 0 0"/><geom class="q"/><geom axisangle="1 0 0 30"/></body>
           </worldbody>)",
        // inertial elements
        R"(<worldbody><body><freejoint/><inertial pos="1 2 3" mass="2" diaginertia="3 4 5" euler="10 20 30"/><geom size="1"/></body>
           <body><freejoint/><inertial pos="0 0 1" mass="2" fullinertia="3 4 5 .1 .2 .3"/></body></worldbody>)",
        R"(<compiler inertiafromgeom="true"/><worldbody><body><freejoint/>
           <inertial pos="1 2 3" mass="2" diaginertia="3 4 5"/><geom size="1"/></body>
           <body><freejoint/><inertial pos="1 2 3" mass="2" diaginertia="3 4 5"/></body></worldbody>)",
        R"(<compiler inertiagrouprange="1 2"/><worldbody><body><freejoint/><geom size="1" group="0"/><geom size="2" group="1"/>
           <geom type="box" pos="1 2 3" size="1 1 1" group="2" euler="1 2 3"/><geom size="1" group="3"/></body></worldbody>)",
        R"(<compiler balanceinertia="true" boundmass=".5" boundinertia=".01"/><worldbody><body><freejoint/>
           <inertial pos="0 0 0" mass=".1" diaginertia="1 1 4"/></body><body><freejoint/><geom size=".01"/></body>
           <body><freejoint/><geom type="box" size=".01 .2 .3" euler="10 20 30" density="100"/></body></worldbody>)",
        R"(<compiler settotalmass="7"/><worldbody><geom type="box" size="1 1 1"/><body><geom size="1"/></body>
           <body><freejoint/><geom size=".1" mass="2"/><body><joint/><geom size=".3"/></body></body></worldbody>)",
        R"(<compiler settotalmass="7" boundmass="3"/><worldbody><body/>
           <body><freejoint/><geom size=".1" mass="2"/></body></worldbody>)",
        // bodies within bodies without joints, and joints after children
        R"(<worldbody><body pos="1 0 0" euler="0 0 30"><geom size=".1"/><body name="t" pos="0 1 0"><geom size=".2"/>
             <body pos="1 1 1" euler="10 0 0"><joint type="ball" pos="0 .1 0"/><geom size=".1"/>
               <body pos="0 0 1"><geom type="capsule" size=".1 .2" euler="90 0 0"/></body></body></body></body></worldbody>)",
        R"(<worldbody><body><geom size=".1"/><body pos="0 0 1"><joint type="ball"/><geom size=".1"/></body><freejoint/></body>
           </worldbody><keyframe><key qpos="1 2 3 1 0 1 0 .5 .5 .5 .5"/></keyframe>)",
        // keyframes through all kinds of joints, with references and off-centre anchors
        R"(<worldbody><body pos="0 0 1" euler="0 30 0"><joint type="slide" axis="1 1 0" ref=".2"/><joint pos="0 .1 .2" axis="0 1 1" ref="20"/>
             <geom size=".1"/><body pos="0 1 0"><joint type="ball" pos=".1 .2 .3"/><geom size=".1"/>
               <body pos="0 1 0"><joint axis="1 0 0"/><joint type="ball" pos=".1 0 0"/><geom size=".1"/></body></body></body>
             <body pos="5 5 5"><freejoint/><geom size=".1"/></body></worldbody>
           <keyframe><key name="k" qpos=".3 .4 1 2 3 4 .7 .5 .5 -.5 .5 1 2 3 0 0 0 2"/>
             <key qpos="-.3 1 1 0 0 0 .5 .5 -.5 .5 0 1 2 3 0 0 1 0"/></keyframe>)",
        R"(<worldbody><body><freejoint/><geom size="1" condim="1" friction=".7 .1" priority="2" contype="6" conaffinity="0"/>
           <geom size="1" mass="0"/><geom size="1" density="0" condim="6"/></body></worldbody>)"));

TEST(Oracle, DefaultsOfMeshesHoldNoData) {
  for (const char* data : {"vertex='0 0 0 1 0 0 0 1 0 0 0 1'", "face='0 2 1 0 1 3 0 3 2 1 2 3'", "file='a.obj'",
                           "refpos='1 0 0'", "refquat='0 1 0 0'", "normal='0 0 1'", "texcoord='0 0'",
                           "smoothnormal='true'", "content_type='model/obj'", "scale='2 3 4'"}) {
    const std::string file = write("<mujoco><default><mesh " + std::string(data) + R"(/></default><asset>
      <mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody><geom type="mesh" mesh="m"/></worldbody></mujoco>)");
    bool isRead = true;
    try {
      readMjcf(file);
    } catch (const FileError& error) {
      isRead = false;
      EXPECT_NE(std::string(error.what()).find("not allowed in a default"), std::string::npos) << error.what();
    }
    EXPECT_EQ(isRead, load(file).model != nullptr) << data;
  }
}

TEST(Oracle, KeyframeVelocities) {
  const std::string file = write(R"(<mujoco><worldbody>
    <body name="a" euler="10 20 30"><freejoint/><geom size=".1" pos=".3 .2 .1"/>
      <body pos="0 1 0"><body name="b" pos="1 0 0"><joint type="ball" pos="0 .5 0"/><geom size=".2" pos="0 0 .4"/></body></body>
    </body>
    <body name="c" pos="0 0 9"><joint type="ball" pos="0 .5 .2"/><geom type="box" size="1 2 3" pos="1 0 0"/></body>
    </worldbody><keyframe><key qpos="1 2 3 1 2 0 0 1 1 0 1 1 0 2 1" qvel="1 2 3 .4 .5 .6 .7 -.8 .9 1 -2 3"/></keyframe></mujoco>)");
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << mj.error;
  mj_resetDataKeyframe(mj.model.get(), mj.data.get(), 0);
  mj_forward(mj.model.get(), mj.data.get());
  const Model model = readMjcf(file);
  for (const NamedBody& body : model.bodies) {
    mjtNum v[6];
    mj_objectVelocity(mj.model.get(), mj.data.get(), mjOBJ_BODY,
                      mj_name2id(mj.model.get(), mjOBJ_BODY, body.name.c_str()), v, 0);
    const Velocity ours = model.world.velocity(body.id);
    expectNear(toDouble(ours.angular), v, 1e-5, body.name);
    expectNear(toDouble(ours.linear), v + 3, 1e-5, body.name);
  }
  EXPECT_EQ(model.bodies.size(), 3u);
}

// Which bodies touch: bit masks, parents and children, the world, excludes, pairs.
std::set<std::pair<std::string, std::string>> touching(const std::string& file) {
  std::set<std::pair<std::string, std::string>> out;
  Model model = readMjcf(file);
  model.world.step(1e-4f);
  const auto name = [&](BodyId id) {
    return std::find_if(model.bodies.begin(), model.bodies.end(), [&](const NamedBody& b) { return b.id == id; })->name;
  };
  for (const Contact& contact : model.world.contacts()) {
    const auto [a, b] = std::minmax(name(contact.bodyA), name(contact.bodyB));
    out.emplace(a, b);
  }
  return out;
}

TEST(Oracle, TheSameBodiesTouch) {
  for (const char* head : {"", "<option><flag filterparent='disable'/></option>", "<option collision='predefined'/>",
                           "<option collision='dynamic'/>", "<option><flag contact='disable'/></option>"}) {
    const std::string file = write(std::string("<mujoco><size nconmax='1000' njmax='5000'/>") + head + R"(<worldbody>
      <geom type="plane" size="1 1 1"/>
      <body name="a"><freejoint/><geom size="1" contype="1" conaffinity="2"/>
        <body name="a1" pos="0 .1 0"><joint type="ball"/><geom size="1"/>
          <body name="a2" pos=".1 0 0"><joint type="ball"/><geom type="capsule" size="1 1" conaffinity="4"/></body></body></body>
      <body name="b"><freejoint/><geom type="box" size="1 1 1" pos="0 0 .2" contype="2" conaffinity="0"/></body>
      <body name="c"><freejoint/><geom size="1" contype="4" conaffinity="0" pos=".3 0 0"/></body>
      <body name="d"><freejoint/><geom size="1" contype="0" conaffinity="0" pos="0 .3 0"/></body>
      <body name="e"><joint type="ball"/><geom size="1" pos=".1 .2 .3"/></body>
      <body name="f"><freejoint/><geom name="f" size="1" contype="4" conaffinity="8" pos=".4 0 0"/></body>
      <body name="g"><freejoint/><geom name="g" size="1" contype="16" conaffinity="16" pos=".4 0 .2"/></body>
      </worldbody><contact><exclude body1="a" body2="e"/><exclude body1="world" body2="c"/><pair geom1="f" geom2="g"/></contact>
      </mujoco>)");
    const Loaded mj = load(file);
    ASSERT_TRUE(mj.model) << mj.error;
    mj_forward(mj.model.get(), mj.data.get());
    std::set<std::pair<std::string, std::string>> theirs;
    for (int i = 0; i < mj.data->ncon; ++i) {
      const mjModel* m = mj.model.get();
      const auto name = [&](int geom) { return std::string(mj_id2name(m, mjOBJ_BODY, m->geom_bodyid[geom])); };
      const auto [a, b] = std::minmax(name(mj.data->contact[i].geom1), name(mj.data->contact[i].geom2));
      theirs.emplace(a, b);
    }
    EXPECT_EQ(touching(file), theirs) << head;
    if (*head == '\0') {
      EXPECT_EQ(theirs.size(), 10u);  // not two empty sets
    }
  }
}

// Random trees with random shapes and orientations.
std::string randomModel(uint32_t seed) {
  std::mt19937 random(seed);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); };
  const auto number = [&] { return std::to_string((static_cast<int>(random() % 2001) - 1000) / 500.0 + 0.0007); };
  const auto positive = [&] { return std::to_string(0.05 + (random() % 1000) / 1000.0); };
  const auto list = [&](int n) {
    std::string out;
    for (int i = 0; i < n; ++i) out += number() + " ";
    return out;
  };
  const auto turn = [&]() -> std::string {
    switch (pick(6)) {
      case 0:
        return " quat='" + list(4) + "'";
      case 1:
        return " euler='" + list(3) + "'";
      case 2:
        return " axisangle='" + list(4) + "'";
      case 3:
        return " xyaxes='" + list(6) + "'";
      case 4:
        return " zaxis='" + list(3) + "'";
      default:
        return "";
    }
  };
  const auto geom = [&]() -> std::string {
    const char* kinds[] = {"sphere", "capsule", "ellipsoid", "cylinder", "box"};
    const std::string kind = kinds[pick(5)];
    const std::string weight = pick(3) == 0 ? " mass='" + positive() + "'"
                               : pick(2)    ? " density='" + positive() + "'"
                                            : "";
    if (kind != "sphere" && pick(3) == 0) {
      return "<geom type='" + kind + "' size='" + positive() + "' fromto='" + list(6) + "'" + weight + "/>";
    }
    return "<geom type='" + kind + "' size='" + positive() + " " + positive() + " " + positive() + "' pos='" + list(3) +
           "'" + turn() + weight + "/>";
  };
  std::string out = pick(2) ? "<compiler angle='radian' eulerseq='yXz'/>" : "";
  out += "<worldbody>";
  int open = 0;
  for (int i = 0; i < 12; ++i) {
    out += "<body pos='" + list(3) + "'" + turn() + ">";
    const char* joints[] = {"<joint type='ball' pos='1 2 3'/>", "", "<joint axis='1 2 3'/>", "<joint type='slide'/>"};
    out += open == 0 && pick(2) ? "<freejoint/>" : joints[pick(4)];
    for (int k = pick(3); k >= 0; --k) out += geom();
    ++open;
    while (open > 0 && pick(2)) {
      out += "</body>";
      --open;
    }
  }
  while (open-- > 0) out += "</body>";
  return "<mujoco>" + out + "</worldbody></mujoco>";
}

TEST(Oracle, RandomModels) {
  for (uint32_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
    const std::string xml = randomModel(seed);
    SCOPED_TRACE(xml);
    compare(write(xml));
  }
}

}  // namespace
}  // namespace avbd
