// The page's text and bytes: what stands in the file for a recording.
#include "viewer/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "io/record/softs.h"
#include "viewer/encode.h"

namespace avbd {
namespace {

using page::Range;

std::string text64(std::string_view text) {
  return page::base64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

Recording twoBodies() {
  Recording r;
  r.title = "two";
  r.bodies = {{"ground", BodyType::Static}, {"ball", BodyType::Dynamic}};
  r.shapes = {{0, HalfSpace{}, {}}, {1, Sphere{0.5f}, {}}};
  for (int i = 0; i < 3; ++i) {
    RecordedFrame f;
    f.time = 0.1 * i;
    f.poses = {{}, {{0, 1 - 0.1 * i, 0}, {}}};
    r.frames.push_back(f);
  }
  return r;
}

std::string pageOf(const Recording& r, const PageOptions& options = {}) {
  std::ostringstream out;
  writePage(out, r, options);
  return out.str();
}

TEST(Page, ColorsOfTheFileAreInTheHeadWhereThereAreAny) {
  Recording r = twoBodies();
  std::ostringstream without, with;
  writePage(without, r);
  EXPECT_EQ(without.str().find("\"shapeColors\":"), std::string::npos);
  r.shapes[1].color = Color{255, 128, 0, 20};
  writePage(with, r);
  const std::string expected = text64(std::string("\0\0\0\0\xff\x80\0\x01", 8));
  EXPECT_NE(with.str().find("\"shapeColors\":\"" + expected + '"'), std::string::npos);
}

size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Base64 characters in the elements that hold the frames.
size_t frameCharacters(const std::string& text) {
  size_t count = 0;
  for (size_t at = text.find("\"avbd-frames\""); at != std::string::npos; at = text.find("\"avbd-frames\"", at + 1)) {
    const size_t begin = text.find('>', at) + 1;
    count += text.find('<', begin) - begin;
  }
  return count;
}

std::string messageOf(const Recording& r) {
  try {
    pageOf(r);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Page, SoftBodiesAreSurfacesAndPlaces) {
  Recording r = twoBodies();
  const std::string before = pageOf(r);
  EXPECT_EQ(before.find("\"softs\":"), std::string::npos);
  RecordedSoft soft{"<i>flag</i>", true};
  soft.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  soft.surface = {{0, 2, 1}};
  soft.elements = 1;
  appendSoft(r, soft);
  for (RecordedFrame& f : r.frames)
    for (const Vec3 p : soft.points) f.poses.push_back({{double{p.x}, f.time, double{p.z}}, {}});
  r.frames[1].poses[3].position.x = std::numeric_limits<double>::quiet_NaN();
  const std::string page = pageOf(r);
  EXPECT_NE(page.find("\"softs\":[{\"name\":\"\\u003ci\\u003eflag"), std::string::npos);
  EXPECT_EQ(page.find("flag\\u003c/i\\u003e_0"), std::string::npos) << "points need no names";
  // Three points in three frames, nine bytes each.
  EXPECT_EQ(frameCharacters(page) - frameCharacters(before), size_t{3 * 3 * 9 * 4 / 3});
  r.softs[0].surface[0][0] = 3;
  EXPECT_NE(messageOf(r).find("softs[0].surface = 3"), std::string::npos);
}

/// The reader's side of packRotation, as in src/recording.js.
Quat unpackRotation(uint64_t packed) {
  const int largest = static_cast<int>(packed >> 45);
  float c[4] = {}, squared = 0;
  for (int i = 3, shift = 0; i >= 0; --i) {
    if (i == largest) continue;
    c[i] = (static_cast<float>(packed >> shift & 0x7fff) / 16383 - 1) * 0.70710678f;
    squared += c[i] * c[i];
    shift += 15;
  }
  c[largest] = std::sqrt(std::max(0.0f, 1 - squared));
  return {c[0], c[1], c[2], c[3]};
}

TEST(PageEncoding, Base64MatchesTheStandardsExamples) {
  EXPECT_EQ(text64(""), "");
  EXPECT_EQ(text64("f"), "Zg==");
  EXPECT_EQ(text64("fo"), "Zm8=");
  EXPECT_EQ(text64("foo"), "Zm9v");
  EXPECT_EQ(text64("foob"), "Zm9vYg==");
  EXPECT_EQ(text64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(text64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(text64("\xff\xfe\xfd"), "//79");
}

TEST(PageEncoding, TextCannotLeaveItsPlace) {
  EXPECT_EQ(page::jsonText("a\"b\\c"), "\"a\\u0022b\\u005cc\"");
  EXPECT_EQ(page::jsonText("</script>"), "\"\\u003c/script\\u003e\"");
  EXPECT_EQ(page::jsonText(std::string_view("\0\n", 2)), "\"\\u0000\\u000a\"");
  EXPECT_EQ(page::jsonText("größe"), "\"größe\"");
  EXPECT_EQ(page::htmlText("<b a='\"'>&\n"), "&lt;b a=&#39;&quot;&#39;&gt;&amp; ");
}

TEST(PageEncoding, PositionsAreExactToAStepOfTheirRange) {
  const Range range = page::rangeOf(-3, 50);
  for (const double value : {-3.0, -1.2345678, 0.0, 17.7, 50.0}) {
    EXPECT_NEAR(range.low + page::quantise(range, value) * range.step, value, 53.0 / page::kRangeSteps);
  }
  EXPECT_EQ(page::quantise(range, -1e300), 0u);
  EXPECT_EQ(page::quantise(range, 1e300), page::kRangeSteps);
  EXPECT_EQ(page::quantise(range, NAN), 0u);
  EXPECT_EQ(page::quantise(page::rangeOf(INFINITY, -INFINITY), 4), 0u);
  EXPECT_EQ(page::rangeOf(7, 7).low, 7);
}

TEST(PageEncoding, RotationsComeBack) {
  for (int i = 0; i < 2000; ++i) {
    const auto part = static_cast<float>(i);
    Quat q{std::sin(part), std::cos(2.3f * part), std::sin(5.1f * part + 1), std::cos(0.7f * part + 2)};
    const float size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q = {q.w / size, q.x / size, q.y / size, q.z / size};
    const Quat back = unpackRotation(page::packRotation(q));
    const float sign = q.w * back.w + q.x * back.x + q.y * back.y + q.z * back.z < 0 ? -1.0f : 1.0f;
    EXPECT_NEAR(q.w, sign * back.w, 1e-4f) << i;
    EXPECT_NEAR(q.x, sign * back.x, 1e-4f) << i;
    EXPECT_NEAR(q.y, sign * back.y, 1e-4f) << i;
    EXPECT_NEAR(q.z, sign * back.z, 1e-4f) << i;
  }
  EXPECT_EQ(unpackRotation(page::packRotation({1, 0, 0, 0})), (Quat{1, 0, 0, 0}));
  EXPECT_EQ(unpackRotation(page::packRotation({0, 0, 0, 0})), (Quat{1, 0, 0, 0}));
  EXPECT_EQ(unpackRotation(page::packRotation({NAN, 0, 0, 1})), (Quat{1, 0, 0, 0}));
}

TEST(PageEncoding, ForcesKeepTheirSizeToAThousandth) {
  EXPECT_EQ(page::packMagnitude(0), 0);
  EXPECT_EQ(page::packMagnitude(-1), 0);
  EXPECT_EQ(page::packMagnitude(NAN), 0);
  for (const float force : {1e-4f, 1.0f, 9810.0f, 3e7f}) {
    EXPECT_NEAR(std::exp2((page::packMagnitude(force) - 1) / 1024.0f - 20) / force, 1, 1e-3);
  }
  EXPECT_LE(page::packMagnitude(INFINITY), 65535);
}

TEST(Page, HoldsTheRecordingAndTheViewer) {
  const std::string text = pageOf(twoBodies());
  EXPECT_EQ(text.rfind("<!doctype html>", 0), 0u);
  EXPECT_NE(text.find("<title>two</title>"), std::string::npos);
  EXPECT_NE(text.find("\"names\":[\"ground\",\"ball\"]"), std::string::npos);
  EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
  EXPECT_GT(text.size(), 400'000u) << "the viewer is missing";
  EXPECT_EQ(text.substr(text.size() - 8), "</html>\n");
}

TEST(Page, OnlyWhatMovesIsStoredForEachFrame) {
  // One body of 15 bytes in three frames: 45 bytes.
  EXPECT_EQ(frameCharacters(pageOf(twoBodies())), 60u);
}

TEST(Page, NamesCannotAddElements) {
  Recording r = twoBodies();
  const std::string plain = pageOf(r);
  r.title = r.bodies[1].name = "</script></title><script>alert(1)</script><!--";
  r.report = {{r.title, r.title}};
  const std::string text = pageOf(r);
  EXPECT_EQ(countOf(text, "<script"), countOf(plain, "<script"));
  EXPECT_EQ(countOf(text, "</script"), countOf(plain, "</script"));
  EXPECT_EQ(countOf(text, "</title"), countOf(plain, "</title"));
}

TEST(Page, TwoThousandBodiesAndThreeHundredFramesFitIn15Megabytes) {
  Recording r;
  for (int i = 0; i < 2000; ++i) {
    r.bodies.push_back({"body_" + std::to_string(i), BodyType::Dynamic});
    r.shapes.push_back({static_cast<uint32_t>(i), Box{}, {}});
  }
  for (int i = 0; i < 300; ++i) {
    RecordedFrame f;
    f.time = i;
    for (int k = 0; k < 2000; ++k) f.poses.push_back({{k * 1.0, i * 0.01, 0}, {}});
    r.frames.push_back(std::move(f));
  }
  EXPECT_LT(pageOf(r).size(), 15'000'000u);
}

TEST(Page, TooManyContactsKeepTheStrongest) {
  Recording r = twoBodies();
  for (RecordedFrame& f : r.frames) {
    for (int i = 0; i < 100; ++i) f.contacts.push_back({{0, 0, 0}, {0, static_cast<float>(i), 0}});
  }
  const size_t all = frameCharacters(pageOf(r)), some = frameCharacters(pageOf(r, {.contactsMax = 30}));
  EXPECT_EQ(all, (3 * (15 + 100 * page::kContactBytes) + 2) / 3 * 4);
  EXPECT_EQ(some, (3 * (15 + 10 * page::kContactBytes) + 2) / 3 * 4);
  EXPECT_EQ(frameCharacters(pageOf(r, {.contactsMax = 0})), 60u);
}

TEST(Page, WhatJointsDidIsStoredWhereItIsKnown) {
  Recording r = twoBodies();
  r.joints = {{0, 1, {}, {}}};
  const std::string bare = pageOf(r);
  EXPECT_EQ(frameCharacters(bare), 60u);
  EXPECT_EQ(bare.find("\"jointTypes\":"), std::string::npos);
  r.joints[0].type = JointType::Hinge;
  r.joints[0].name = "</script>";
  r.joints[0].limits[3] = {-1, 2};
  r.frames[1].joints = {{{{1, 2, 3}, {}}, false}};
  const std::string text = pageOf(r);
  EXPECT_EQ(frameCharacters(text), (3 * (15 + page::kJointBytes) + 2) / 3 * 4);
  EXPECT_NE(text.find("\"jointTypes\":\"" + text64("\x03") + '"'), std::string::npos);
  EXPECT_NE(text.find("\"jointNames\":[\"\\u003c/script\\u003e\"]"), std::string::npos);
}

TEST(Page, ResidualsStandBehindForces) {
  Recording r = twoBodies();
  r.joints = {{0, 1, {}, {}, JointType::Pulley}, {1, kNotRecorded, {}, {}, JointType::Custom}};
  r.joints[0].residuals = 1;
  r.joints[1].residuals = 2;
  r.joints[1].family = "</script>";
  r.frames[1].joints.resize(2);
  r.frames[1].residuals = {1, 2, 3};
  const std::string text = pageOf(r);
  EXPECT_EQ(frameCharacters(text), (3 * (15 + 2 * page::kJointBytes + 3 * 4) + 2) / 3 * 4);
  EXPECT_NE(text.find("\"jointResiduals\":\"" + text64("\x01\x02") + '"'), std::string::npos);
  EXPECT_NE(text.find("\"jointFamilies\":[\"\",\"\\u003c/script\\u003e\"]"), std::string::npos);
  r.frames[1].residuals.pop_back();
  EXPECT_EQ(messageOf(r), "Recording.frames[1].residuals = 2: must be the 3 of all joints, or none");
  r.frames[1].residuals.clear();
  r.joints[1].moreBodies[0] = 2;
  EXPECT_NE(messageOf(r).find("Recording.joints[1].body = 2"), std::string::npos);
}

TEST(PageEncoding, AJointThatIsOffIsToldFromOneWithoutForce) {
  page::Bytes bytes;
  page::appendJoint(bytes, {}, true);
  page::appendJoint(bytes, {0, 1, 0}, false);
  EXPECT_EQ(bytes, (page::Bytes{0, 0, 0, 0, 0, 0, 0xff, 0xff}));
  page::appendJoint(bytes, {0, 1e30f, 0}, true);
  EXPECT_NE(bytes[10] | bytes[11] << 8, page::kJointOff);
}

TEST(Page, RefusesWhatDoesNotFitTogether) {
  Recording r = twoBodies();
  r.frames[1].poses.pop_back();
  EXPECT_EQ(messageOf(r), "Recording.frames[1].poses = 1: must hold a pose for each of the 2 bodies");
  r = twoBodies();
  r.frames.clear();
  EXPECT_EQ(messageOf(r), "Recording.frames = 0: must hold at least one frame");
  r = twoBodies();
  r.frames[2].time = 0;
  EXPECT_NE(messageOf(r).find("Recording.frames[2].time"), std::string::npos);
  r.frames[2].time = NAN;
  EXPECT_NE(messageOf(r).find("Recording.frames[2].time"), std::string::npos);
  r = twoBodies();
  r.shapes[1].body = 2;
  EXPECT_NE(messageOf(r).find("Recording.shapes[1].body = 2"), std::string::npos);
  r = twoBodies();
  r.joints = {{1, 9, {}, {}}};
  EXPECT_NE(messageOf(r).find("Recording.joints[0].body = 9"), std::string::npos);
  r.joints[0].bodyB = 0;
  r.frames[1].joints.resize(2);
  EXPECT_NE(messageOf(r).find("Recording.frames[1].joints = 2"), std::string::npos);
  r = twoBodies();
  r.up = {};
  EXPECT_NE(messageOf(r).find("Recording.up"), std::string::npos);
}

TEST(Page, FiguresThatAreNotFiniteAreWritten) {
  Recording r = twoBodies();
  r.frames[1].poses[1] = {{NAN, INFINITY, 0}, {NAN, 0, 0, 0}};
  r.frames[1].kineticEnergy = NAN;
  r.frames[1].contacts = {{{NAN, 0, 0}, {INFINITY, 0, 0}}};
  EXPECT_EQ(frameCharacters(pageOf(r)), (45 + page::kContactBytes + 2) / 3 * 4);
}

TEST(Page, RefusedRecordingLeavesTheFileAlone) {
  const auto file = std::filesystem::temp_directory_path() / "avbd_page_test.html";
  std::ofstream(file) << "before";
  Recording r = twoBodies();
  r.frames.clear();
  EXPECT_THROW(writePage(file, r), std::invalid_argument);
  std::string kept;
  std::ifstream(file) >> kept;
  EXPECT_EQ(kept, "before");
  writePage(file, twoBodies());
  EXPECT_GT(std::filesystem::file_size(file), 400'000u);
  std::filesystem::remove(file);
  EXPECT_THROW(writePage("/nonexistent/folder/page.html", twoBodies()), std::runtime_error);
}

}  // namespace
}  // namespace avbd
