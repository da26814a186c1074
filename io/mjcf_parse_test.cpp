// What an MJCF file means, checked by hand-computed figures (mujoco_oracle.cpp compares with MuJoCo itself).
#include "io/mjcf_parse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "io/mjcf_mass.h"

namespace avbd::mjcf {
namespace {

using std::numbers::pi;

Description parse(const std::string& inside) { return parseText("<mujoco>" + inside + "</mujoco>", "t.xml"); }

bool hasNote(const Description& d, const std::string& part) {
  return std::any_of(d.notes.begin(), d.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

void expectVector(Vec3d a, Vec3d b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(MjcfParse, AnEmptyModelHasMujocosDefaults) {
  const Description d = parse("");
  EXPECT_EQ(d.dt, 0.002);
  expectVector(d.gravity, {0, 0, -9.81});
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_EQ(d.bodies[0].name, "world");
  EXPECT_TRUE(d.notes.empty());
}

TEST(MjcfParse, LaterOptionsWin) {
  const Description d = parse("<option timestep='.1' gravity='0 -1 0'/><option timestep='.2'/>");
  EXPECT_EQ(d.dt, 0.2);
  expectVector(d.gravity, {0, -1, 0});
}

TEST(MjcfParse, NumbersInEveryNotation) {
  const Description d = parse("<worldbody><geom size='+.5' pos='1. -2e0\t\n 3E+0'/></worldbody>");
  EXPECT_EQ(d.bodies[0].geoms[0].size.x, 0.5);
  expectVector(d.bodies[0].geoms[0].pose.position, {1, -2, 3});
}

TEST(MjcfParse, MassesOfSolids) {
  const Description d = parse(
      "<worldbody><body><freejoint/><geom size='.5'/></body><body><freejoint/><geom type='box' size='1 2 3' "
      "mass='6'/></body>"
      "<body><freejoint/><geom type='capsule' size='1 2' density='3'/></body></worldbody>");
  EXPECT_NEAR(d.bodies[1].mass.mass, 1000 * 4 / 3.0 * pi * 0.125, 1e-9);
  EXPECT_NEAR(d.bodies[1].mass.inertia.xx, 0.4 * d.bodies[1].mass.mass * 0.25, 1e-9);
  EXPECT_NEAR(d.bodies[2].mass.inertia.xx, 6 * (4 + 9) / 3.0, 1e-12);
  EXPECT_NEAR(d.bodies[2].mass.inertia.zz, 6 * (1 + 4) / 3.0, 1e-12);
  EXPECT_NEAR(d.bodies[3].mass.mass, 3 * (pi * 4 + 4 * pi / 3), 1e-9);
}

TEST(MjcfParse, AClassReachesThroughChildclassUntilAnotherIsNamed) {
  const Description d = parse(
      "<default><geom size='1'/><default class='a'><geom size='2'/></default></default>"
      "<worldbody><geom/><body childclass='a'><geom/><geom class='main'/><body><geom/><geom "
      "size='3'/></body></body></worldbody>");
  EXPECT_EQ(d.bodies[0].geoms[0].size.x, 1);
  EXPECT_EQ(d.bodies[1].geoms[0].size.x, 2);
  EXPECT_EQ(d.bodies[1].geoms[1].size.x, 1);
  EXPECT_EQ(d.bodies[2].geoms[0].size.x, 2);
  EXPECT_EQ(d.bodies[2].geoms[1].size.x, 3);
}

TEST(MjcfParse, AClassInheritsWhatItsParentSaysBelow) {
  const Description d = parse(
      "<worldbody><geom class='a'/></worldbody>"
      "<default><default class='a'><geom mass='2'/></default><geom size='7'/></default>");
  EXPECT_EQ(d.bodies[0].geoms[0].size.x, 7);
  EXPECT_EQ(d.bodies[0].geoms[0].mass, 2);
}

TEST(MjcfParse, AFrameMovesWhatStandsInIt) {
  const Description d = parse(
      "<worldbody><frame pos='1 0 0' euler='0 0 90'><geom size='1' pos='1 0 0'/>"
      "<frame pos='1 0 0'><body pos='0 1 0'><joint pos='0 0 1'/><geom size='1'/></body></frame></frame></worldbody>");
  expectVector(d.bodies[0].geoms[0].pose.position, {1, 1, 0});
  expectVector(d.bodies[1].pose.position, {0, 1, 0});
  EXPECT_TRUE(d.bodies[1].moves);
}

TEST(MjcfParse, AnglesOfReferencesFollowTheCompiler) {
  const char* body =
      "<worldbody><body><joint ref='90'/><joint type='slide' ref='90'/><geom size='1'/></body></worldbody>";
  EXPECT_NEAR(parse(body).bodies[1].joints[0].ref, pi / 2, 1e-12);
  EXPECT_EQ(parse(body).bodies[1].joints[1].ref, 90);
  EXPECT_EQ(parse("<compiler angle='radian'/>" + std::string(body)).bodies[1].joints[0].ref, 90);
}

TEST(MjcfParse, NotesSayWhatIsNotUsedOnceForAll) {
  const Description d = parse(
      "<option iterations='50' wind='0 0 0' viscosity='1'/><sensor/><actuator/><tendon/><nonsense/>"
      "<worldbody><geom size='1' colour='red' solref='1 1' margin='0'/><geom size='1' colour='red' margin='.1'/>"
      "<body><replicate/><freejoint/><wheel/><geom type='cylinder' size='1 1'/><geom size='1' "
      "condim='4'/></body></worldbody>");
  EXPECT_TRUE(hasNote(d, "t.xml:1: option: attribute iterations is not used"));
  EXPECT_TRUE(hasNote(d, "attribute viscosity is not used"));
  EXPECT_FALSE(hasNote(d, "wind"));
  EXPECT_TRUE(hasNote(d, "nonsense: unknown element"));
  EXPECT_TRUE(hasNote(d, "unknown attribute \"colour\" (and 1 more)"));
  EXPECT_TRUE(hasNote(d, "attribute solref is not used"));
  EXPECT_TRUE(hasNote(d, "attribute margin is not used"));
  EXPECT_FALSE(hasNote(d, "margin is not used (and"));
  EXPECT_TRUE(hasNote(d, "replicate: left out"));
  EXPECT_TRUE(hasNote(d, "wheel: unknown element"));
  EXPECT_FALSE(hasNote(d, "cylinder"));
  EXPECT_FALSE(hasNote(d, "condim"));
}

TEST(MjcfParse, DrawingIsNotedAtMostOnce) {
  const Description d = parse(
      "<size njmax='1'/><visual><map znear='1'/></visual><statistic extent='2'/><custom><numeric name='a' "
      "data='1'/></custom>"
      "<asset><texture name='t' builtin='flat'/><texture name='u' builtin='flat'/><material name='m' "
      "texture='t'/></asset>"
      "<worldbody><light/><camera/><site/><geom size='1' rgba='1 0 0 1' material='m' group='1' user='1 2 "
      "3'/></worldbody>");
  // One note for each kind of asset.
  ASSERT_EQ(d.notes.size(), 1u) << d.notes[1];
  EXPECT_EQ(d.notes[0], "t.xml:1: texture \"t\": not used: only for drawing (and 1 more)");
}

TEST(MjcfParse, ColorsAreTheGeomsOrTheMaterials) {
  const Description d = parse(
      "<default><geom rgba='0 0 1 1'/><default class='q'><material rgba='0 1 0 .5'/><geom rgba='.5 .5 .5 1'/></default>"
      "</default><asset><texture name='t' builtin='flat'/><material name='red' rgba='1 0 0 1'/><material name='white'/>"
      "<material name='q' class='q'/><material name='wood' texture='t'/></asset><worldbody><geom size='1'/>"
      "<geom size='1' material='red'/><geom size='1' rgba='0 .2 3 -1'/><geom size='1' class='q'/>"
      "<geom size='1' class='q' material='red'/><geom size='1' class='q' material='white'/>"
      "<geom size='1' class='q' material='q'/><geom size='1' class='q' material='wood'/></worldbody>");
  const std::optional<Color> expected[] = {Color{0, 0, 255},      Color{0, 0, 255}, Color{0, 51, 255, 0},
                                           Color{128, 128, 128},  Color{255, 0, 0}, Color{255, 255, 255},
                                           Color{0, 255, 0, 128}, std::nullopt};
  const std::vector<Geom>& geoms = d.bodies.at(0).geoms;
  ASSERT_EQ(geoms.size(), std::size(expected));
  for (size_t i = 0; i < geoms.size(); ++i) EXPECT_EQ(geoms[i].color, expected[i]) << i;
}

TEST(MjcfParse, KeyframesAreNotUsedWherePartsAreLeftOut) {
  const Description d = parse("<worldbody><replicate/></worldbody><keyframe><key qpos='1 2 3'/></keyframe>");
  ASSERT_EQ(d.keys.size(), 1u);
  EXPECT_TRUE(d.keys[0].qpos.empty());
  EXPECT_TRUE(hasNote(d, "keyframes are not used"));
}

TEST(MjcfParse, DisabledEqualitiesAreLeftOutInactiveOnesAreNot) {
  const std::string bodies = "<worldbody><body name='a'/></worldbody>";
  const std::string weld = "<equality><weld body1='a'/><weld body1='a' active='false'/></equality>";
  const Description d = parse(bodies + weld);
  ASSERT_EQ(d.equalities.size(), 2u);
  EXPECT_TRUE(d.equalities[0].active);
  EXPECT_FALSE(d.equalities[1].active);
  EXPECT_EQ(parse(bodies + weld + "<option><flag equality='disable'/></option>").equalities.size(), 0u);
  EXPECT_FALSE(parse("<default><equality active='false'/></default>" + bodies + weld).equalities[0].active);
}

TEST(MjcfParse, DeeperThanTheCStack) {
  const int depth = 200000;
  std::string xml = "<worldbody>";
  for (int i = 0; i < depth; ++i) xml += "<body pos='0 0 1'>";
  for (int i = 0; i < depth; ++i) xml += "</body>";
  const Description d = parse(xml + "</worldbody>");
  EXPECT_EQ(d.bodies.size(), depth + 1u);
  EXPECT_EQ(worldPoses(d, {}).back().position.z, depth);

  std::string classes;
  for (int i = 0; i < 20000; ++i) classes += "<default class='c" + std::to_string(i) + "'>";
  for (int i = 0; i < 20000; ++i) classes += "</default>";
  EXPECT_THROW(parse("<default>" + classes + "</default>"), FileError);

  std::string frames = "<worldbody>";
  for (int i = 0; i < depth; ++i) frames += "<frame>";
  for (int i = 0; i < depth; ++i) frames += "</frame>";
  EXPECT_EQ(parse(frames + "</worldbody>").bodies.size(), 1u);
  std::string unknown;
  for (int i = 0; i < depth; ++i) unknown += "<x>";
  for (int i = 0; i < depth; ++i) unknown += "</x>";
  EXPECT_EQ(parse(unknown).notes.size(), 1u);
}

TEST(MjcfParse, ATenMegabyteLine) {
  const auto start = std::chrono::steady_clock::now();
  const std::string digits(10 << 20, '1');
  EXPECT_THROW(parse("<option timestep='" + digits + "'/>"), FileError);
  std::string many;
  while (many.size() < (10u << 20)) many += "1 ";
  EXPECT_THROW(parse("<option gravity='" + many + "'/>"), FileError);
  EXPECT_THROW(parse("<keyframe><key qpos='" + many + "'/></keyframe>"), FileError);
  EXPECT_THROW(parse("<worldbody><geom name='" + digits + "'/></worldbody>"), FileError);
  std::string geoms = "<worldbody>";
  while (geoms.size() < (10u << 20)) geoms += "<geom size='1' bogus" + std::to_string(geoms.size()) + "='1'/>";
  const Description d = parse(geoms + "</worldbody>");
  EXPECT_GT(d.bodies[0].geoms.size(), 100000u);
  EXPECT_LE(d.notes.size(), 1001u);
  std::string attributes = "<worldbody ";
  while (attributes.size() < (10u << 20)) attributes += "a" + std::to_string(attributes.size()) + "='' ";
  EXPECT_THROW(parse(attributes + "/>"), FileError);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(MjcfParse, EntitiesDoNotGrow) {
  EXPECT_THROW(
      parseText("<!DOCTYPE m [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><mujoco><option timestep='&b;'/></mujoco>",
                "t.xml"),
      FileError);
}

// Whatever bytes come: a description or a FileError.
TEST(MjcfParse, BrokenBytes) {
  const std::string good =
      "<mujoco model='m'><compiler angle='radian' eulerseq='xyz'/><option timestep='.01' gravity='0 0 -9'/>"
      "<default><geom size='.1' friction='.5'/><default class='c'><joint type='ball'/></default></default>"
      "<worldbody><geom type='plane' size='1 1 1'/><body name='a' pos='0 0 1' euler='1 2 3'><freejoint/><geom/>"
      "<body name='b' childclass='c'><joint pos='1 2 3'/><geom type='capsule' size='.1' fromto='0 0 0 1 1 1'/>"
      "<inertial pos='0 0 0' mass='1' fullinertia='1 1 1 0 0 0'/></body></body></worldbody>"
      "<contact><exclude body1='a' body2='b'/></contact><equality><connect body1='a' body2='b' anchor='0 0 "
      "0'/></equality>"
      "<keyframe><key qpos='1 2 3 1 0 0 0 1 0 0 0'/></keyframe></mujoco>";
  ASSERT_EQ(parseText(good, "t.xml").bodies.size(), 3u);
  std::mt19937 random(7);
  const std::string_view alphabet = "<>/='\" &;!-[]0123456789.e-abxyz\x80\xff\n";
  int accepted = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bad = good;
    for (uint32_t k = random() % 3; k != ~0u; --k) {
      const size_t at = random() % bad.size();
      switch (random() % 4) {
        case 0:
          bad[at] = alphabet[random() % alphabet.size()];
          break;
        case 1:
          bad.erase(at, random() % 20);
          break;
        case 2:
          bad.insert(at, 1, alphabet[random() % alphabet.size()]);
          break;
        default:
          bad.insert(at, bad.substr(random() % bad.size(), random() % 60));
          break;
      }
    }
    try {
      worldPoses(parseText(bad, "t.xml"), {});
      ++accepted;
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("t.xml:", 0), 0u) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace avbd::mjcf
