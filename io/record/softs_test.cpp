// Soft bodies in recordings: what comes back, what it costs, what is refused.
#include "io/record/softs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/record/export.h"
#include "io/record/mcap_messages.h"
#include "io/record/reader.h"
#include "io/record/same.h"
#include "io/record/sample.h"
#include "io/record/source.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

RecordedSoft sheet(const std::string& name, bool cloth) {
  RecordedSoft soft{name, cloth};
  // The last point is not of the surface.
  soft.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0.5f, 0.1f, 0.5f}};
  soft.surface = {{0, 2, 1}, {1, 2, 3}};
  soft.elements = 7;
  soft.radius = 0.02f;
  return soft;
}

Recording softHead() {
  Recording head = sampleHead(3);
  RecordedSoft flag = sheet("flag", true);
  flag.color = Color{1, 2, 3};
  appendSoft(head, flag);
  appendSoft(head, sheet("cube \"ä\"", false));
  head.joints[1].bodyB = 4;  // a point
  return head;
}

/// With a contact and an event of a point and of what is no point.
RecordedFrame softFrame(const Recording& head, size_t number) {
  RecordedFrame f = sampleFrame(head, number);
  const uint32_t ball = head.softs[1].firstShape + 1;
  f.contacts.push_back({f.poses[head.shapes[ball].body].position, {0, 3, 0}, {0, 1, 0}, -0.001f, ball, 1});
  f.contacts.push_back({f.poses[1].position, {0, 3, 0}, {0, 1, 0}, -0.001f, 1, kNotRecorded});
  f.events.push_back({RecordedEventKind::TouchBegin, 1, ball, {1, 2, 3}, {0, 1, 0}, 0, 0.5f});
  return f;
}

void expectSameSoft(const RecordedSoft& a, const RecordedSoft& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.cloth, b.cloth);
  EXPECT_EQ(a.firstBody, b.firstBody);
  EXPECT_EQ(a.firstShape, b.firstShape);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.color, b.color);
}

std::string complaintOf(const Recording& head) {
  const Folder folder;
  try {
    RecordWriter(folder.file("a.avbd"), head);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(RecordSofts, ComeBackWithTheirPointsToAMillionthOfTheirSize) {
  const Folder folder;
  const Recording head = softHead();
  ASSERT_EQ(head.softs[0].step, std::ldexp(1.0, -20));
  RecordWriter writer(folder.file("a.avbd"), head, {.framesPerChunk = 4});
  for (size_t i = 0; i < 9; ++i) writer.add(softFrame(head, i));
  writer.finish();
  RecordReader reader(folder.file("a.avbd"));
  EXPECT_TRUE(reader.info().notes.empty());
  EXPECT_TRUE(reader.verify().empty());
  ASSERT_EQ(reader.head().softs.size(), 2u);
  for (size_t i = 0; i < 2; ++i) expectSameSoft(reader.head().softs[i], head.softs[i]);
  ASSERT_EQ(reader.head().bodies.size(), 13u);
  EXPECT_EQ(reader.head().bodies[12].name, "cube \"ä\"_4");
  EXPECT_EQ(reader.head().shapes.size(), 11u);
  expectSameJoint(reader.head().joints[1], head.joints[1]);
  for (size_t i = 0; i < 9; ++i) {
    RecordedFrame expected = softFrame(head, i), found = reader.frame(i);
    for (size_t k = 3; k < 13; ++k) {
      const Vec3d off = found.poses[k].position - expected.poses[k].position;
      EXPECT_LE(std::max({std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)}), head.softs[0].step / 2 + 1e-9);
      EXPECT_EQ(found.poses[k].rotation, Quat{});
      EXPECT_TRUE(std::isnan(found.velocities[k].linear.x)) << "nobody wrote it";
    }
    for (auto* frame : {&expected, &found}) frame->poses.resize(3), frame->velocities.resize(3);
    expectSame(found, expected);
    const uint32_t ball = head.softs[1].firstShape + 1;
    EXPECT_EQ(found.contacts.back().shapeA, 1u);
    EXPECT_EQ(found.contacts.back().shapeB, kNotRecorded);
    EXPECT_EQ(found.contacts[found.contacts.size() - 2].shapeA, ball);
    EXPECT_EQ(found.events.back().shapeB, ball);
  }
}

TEST(RecordSofts, AreFoundByTheirPoints) {
  const Recording head = softHead();
  EXPECT_EQ(softOf(head, 2), nullptr);
  EXPECT_EQ(softOf(head, 3), &head.softs[0]);
  EXPECT_EQ(softOf(head, 8), &head.softs[1]);
  EXPECT_EQ(softOf(head, 13), nullptr);
  EXPECT_EQ(pointCount(head), 10u);
  EXPECT_EQ(surfacePoints(head.softs[0]), (std::vector<uint32_t>{0, 1, 2, 3}));
}

TEST(RecordSofts, DifferencesOfDifferencesKeepEveryBit) {
  Chance chance;
  constexpr int64_t kLeast = std::numeric_limits<int64_t>::min(), kMost = std::numeric_limits<int64_t>::max();
  std::vector<int64_t> places{0, kLeast, kMost, kMost, kMost, kLeast, 5, kMost, kLeast};
  for (int i = 0; i < 60; ++i) places.push_back(static_cast<int64_t>(chance.next() * 1e9));
  EXPECT_EQ(sumsOf(secondDifferences(places, 3), 3), places);
  EXPECT_EQ(secondDifferences({1, 10, 4, 13, 7, 16}, 2), (std::vector<int64_t>{1, 10, 3, 3, 0, 0}));
  EXPECT_EQ(stepsOf(1e300, 1e-6), int64_t{1} << 62);
  EXPECT_EQ(stepsOf(-INFINITY, 1e-6), -(int64_t{1} << 62));
  EXPECT_EQ(stepsOf(NAN, 1e-6), 0);
}

TEST(RecordSofts, AWriterRefusesWhatDoesNotFit) {
  const auto refused = [](const std::string& word, auto change) {
    Recording head = softHead();
    change(head);
    const std::string complaint = complaintOf(head);
    EXPECT_NE(complaint.find(word), std::string::npos) << complaint;
  };
  EXPECT_EQ(complaintOf(softHead()), "");
  refused("softs[0].surface = 5", [](Recording& r) { r.softs[0].surface[0][1] = 5; });
  refused("softs[1].firstBody = 7", [](Recording& r) { r.softs[1].firstBody = 7; });
  refused("softs[1].firstShape = 9", [](Recording& r) { r.softs[1].firstShape = 9; });
  refused("softs[0].step", [](Recording& r) { r.softs[0].step = 0; });
  refused("softs[0].radius", [](Recording& r) { r.softs[0].radius = NAN; });
  refused("softs[1].points", [](Recording& r) { r.bodies.push_back({"behind", BodyType::Dynamic}); });
}

TEST(RecordSofts, AReaderRefusesWhatDoesNotFit) {
  const Folder folder;
  const auto complaint = [&](const Bytes& softs) {
    Bytes file = fileHead();
    for (const Bytes& chunk :
         {chunkBytes(kBodies, bodiesContent(sampleHead(3)), true), chunkBytes(kSofts, softs, true)})
      file.insert(file.end(), chunk.begin(), chunk.end());
    try {
      const RecordReader reader(folder.write("a.avbd", {file.begin(), file.end()}));
      return std::string();
    } catch (const FileError& e) {
      return std::string(e.what());
    }
  };
  const auto contentOf = [](auto change) {
    Recording head = softHead();
    change(head);
    return softsContent(head);
  };
  EXPECT_EQ(complaint(contentOf([](Recording&) {})), "");
  EXPECT_NE(complaint(contentOf([](Recording& r) { r.softs[1].surface[0][1] = 5; })).find("a point that there is not"),
            std::string::npos);
  EXPECT_NE(complaint(contentOf([](Recording& r) { r.softs[1].step = -1; })).find("no step"), std::string::npos);
  EXPECT_NE(complaint(contentOf([](Recording& r) { r.softs[1].radius = INFINITY; })).find("no radius"),
            std::string::npos);
  FieldWriter alone;
  alone.texts(1, {"a"});
  EXPECT_NE(complaint(alone.bytes()).find("stands alone"), std::string::npos);
}

TEST(RecordSofts, FramesWithoutTheirPointsAreLeftOut) {
  const Folder folder;
  const Recording head = softHead();
  Recording few = head;
  few.softs.pop_back();
  few.bodies.resize(8);
  few.shapes.resize(7);
  FrameBlock block;
  block.add(softFrame(head, 0), head);
  FrameBlock other;
  RecordedFrame frame = softFrame(head, 0);
  frame.contacts.clear(), frame.events.clear(), frame.poses.resize(8), frame.velocities.resize(8);
  other.add(frame, few);
  for (const bool fits : {true, false}) {
    RecordWriter(folder.file("a.avbd"), head).addChunk(kFrames, framesContent(fits ? block : other));
    std::string bytes = Folder::read(folder.file("a.avbd"));
    RecordReader reader(folder.write("b.avbd", bytes.substr(0, bytes.size() - kFooterBytes)));
    EXPECT_EQ(reader.frameCount(), fits ? 1u : 0u);
  }
}

TEST(RecordSofts, McapDrawsTheirSurfacesAndNotTheirBalls) {
  using Json = nlohmann::json;
  const Recording head = softHead();
  const McapMessages messages(head);
  const RecordedFrame frame = softFrame(head, 1);
  EXPECT_EQ(Json::parse(messages.scene(0))["entities"].size(), 3u);
  EXPECT_EQ(Json::parse(messages.transforms(frame, 0))["transforms"].size(), 3u);
  const Json softs = Json::parse(messages.softs(frame, 1'500'000'000))["entities"];
  ASSERT_EQ(softs.size(), 2u);
  EXPECT_EQ(softs[1]["id"], "soft_1");
  EXPECT_EQ(softs[1]["frame_id"], "world");
  EXPECT_EQ(softs[1]["timestamp"]["sec"], 1);
  const Json& surface = softs[1]["triangles"][0];
  EXPECT_EQ(surface["indices"], Json::parse("[0, 2, 1, 1, 2, 3]"));
  ASSERT_EQ(surface["points"].size(), 4u);
  const Vec3d at = frame.poses[8 + 3].position;
  const double found = surface["pose"]["position"]["x"].get<double>() + surface["points"][3]["x"].get<double>();
  EXPECT_NEAR(found, at.x, 1e-6);
  EXPECT_NEAR(softs[0]["triangles"][0]["color"]["b"].get<double>(), 3 / 255.0, 1e-6);
}

TEST(RecordSofts, CsvLeavesOpenWhatNobodyWroteAndJsonHasTheirSurfaces) {
  const Folder folder;
  const Recording head = softHead();
  RecordWriter writer(folder.file("a.avbd"), head);
  writer.add(softFrame(head, 0));
  writer.finish();
  RecordReader reader(folder.file("a.avbd"));
  std::ostringstream csv, json;
  exportCsv(reader, csv);
  EXPECT_NE(csv.str().find("flag_4,"), std::string::npos);
  EXPECT_NE(csv.str().find(",1,0,0,0,,,,,,\n"), std::string::npos) << csv.str();
  EXPECT_EQ(csv.str().find("nan"), std::string::npos);
  exportJson(reader, json);
  const auto all = nlohmann::json::parse(json.str());
  EXPECT_EQ(all["softs"][0]["name"], "flag");
  EXPECT_EQ(all["softs"][0]["surface"].size(), 2u);
  EXPECT_EQ(all["frames"][0]["positions"].size(), 13u);
}

TEST(RecordSofts, AWorldsSoftBodiesStandBehindItsOtherBodies) {
  Model model;
  const SoftId cloth = model.world.create(SoftDef{.mesh = makeClothGrid(0.5f, 0.5f, 4, 4), .pose = {{0, 0.3, 0}, {}}});
  const SoftId cube = model.world.create(
      SoftDef{.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2), .pose = {{0, 1, 0}, {}}, .radius = 0.02f});
  model.softs = {{cloth, "flag"}};
  const BodyId ground =
      model.world.create(BodyDef{.type = BodyType::Static, .position = {0, -1, 0}, .shape = Box{9, 1, 9}});
  for (const BodyId particle : model.world.particles(cloth)) model.bodies.push_back({particle, "any"});
  model.bodies.push_back({ground, "ground"});
  RecordSource source(model);
  const Recording& head = source.head();
  EXPECT_NO_THROW(checkSofts(head));
  EXPECT_EQ(head.bodies[0].name, "ground");
  ASSERT_EQ(head.softs.size(), 2u);
  EXPECT_EQ(head.softs[0].name, "flag");
  EXPECT_EQ(head.softs[1].name, "soft_1");
  EXPECT_TRUE(head.softs[0].cloth);
  EXPECT_EQ(head.softs[1].elements, 40u);
  EXPECT_EQ(head.shapes.size(), 1u + 25u + 26u) << "a cube's middle point has no ball";
  EXPECT_EQ(source.slotOf(ground), 0u);
  EXPECT_EQ(source.slotOf(model.world.particles(cube)[3]), head.softs[1].firstBody + 3);
  for (int i = 0; i < 60; ++i) {
    model.world.step(1.0f / 60);
    source.watch(model.world);
  }
  const RecordedFrame frame = source.frame(model, 1);
  EXPECT_EQ(frame.poses[head.softs[1].firstBody + 3], model.world.pose(model.world.particles(cube)[3]));
  ASSERT_FALSE(frame.contacts.empty());
  for (const RecordedContact& c : frame.contacts) {
    const uint32_t ball = c.shapeA == 0 ? c.shapeB : c.shapeA;
    ASSERT_LT(ball, head.shapes.size());
    // A face touches anywhere between its points.
    const bool isPoint = c.shapeA == 0 || c.shapeB == 0;
    EXPECT_LT(length(frame.poses[head.shapes[ball].body].position - c.position), isPoint ? 0.05 : 0.25);
  }
  EXPECT_FALSE(frame.events.empty());
}

}  // namespace
}  // namespace avbd::record
