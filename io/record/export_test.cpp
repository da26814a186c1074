// Exports: CSV and JSON by their own rules, MCAP by a reader that was written from its specification alone.
#include "io/record/export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/record/chunk.h"
#include "io/record/json.h"
#include "io/record/sample.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

using Json = nlohmann::json;

std::filesystem::path sampleFile(const Folder& folder, size_t frames) {
  const auto path = folder.file("sample.avbd");
  const Recording head = sampleHead(8);
  RecordWriter writer(path, head);
  for (size_t i = 0; i < frames; ++i) writer.add(sampleFrame(head, i, i % 2 == 0));
  writer.finish({{"hash", "12"}});
  return path;
}

TEST(RecordJson, TextIsValidWhateverTheBytes) {
  EXPECT_EQ(jsonText("a\"\\\n"), "\"a\\\"\\\\\\u000a\"");
  EXPECT_EQ(jsonText("ä\xf0\x9f\x99\x82"), "\"ä\xf0\x9f\x99\x82\"");
  EXPECT_EQ(jsonText("\xff\xc0\x80\xed\xa0\x80"), "\"\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\"");
  EXPECT_EQ(jsonText("\xe2\x82"), "\"\\ufffd\\ufffd\"");
  EXPECT_EQ(jsonNumber(0.1), "0.1");
  EXPECT_EQ(jsonNumber(0.1f), "0.1");
  EXPECT_EQ(jsonNumber(std::numeric_limits<double>::infinity()), "null");
}

TEST(RecordExport, CsvRowsReadBackAsTheSameBits) {
  const Folder folder;
  RecordReader reader(sampleFile(folder, 5));
  std::stringstream out;
  exportCsv(reader, out);
  std::string line;
  std::getline(out, line);
  EXPECT_EQ(line, "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
  size_t rows = 0;
  for (; std::getline(out, line); ++rows) {
    const RecordedFrame f = reader.frame(rows / 8);
    const Pose& pose = f.poses[rows % 8];
    const size_t quote = line.rfind('"');
    std::string rest = quote == std::string::npos ? line.substr(line.find(',') + 2) : line.substr(quote + 2);
    EXPECT_EQ(std::stod(line), f.time);
    EXPECT_EQ(std::stod(rest), pose.position.x) << line;
    EXPECT_EQ(std::count(rest.begin(), rest.end(), ','), 12);
    EXPECT_EQ(rest.ends_with(",,,,,"), f.velocities.empty());
  }
  EXPECT_EQ(rows, 40u);
}

TEST(RecordExport, JsonHoldsEverything) {
  const Folder folder;
  RecordReader reader(sampleFile(folder, 6));
  std::stringstream out;
  exportJson(reader, out);
  const Json json = Json::parse(out.str());
  EXPECT_EQ(json["title"], reader.head().title);
  ASSERT_EQ(json["shapes"].size(), 8u);
  EXPECT_EQ(json["shapes"][5]["kind"], "cone");
  EXPECT_EQ(json["shapes"][5]["rounding"].get<float>(), 0.02f);
  EXPECT_EQ(json["joints"][1]["bodyA"], nullptr);
  EXPECT_EQ(json["joints"][1].count("type"), 0u);
  EXPECT_EQ(json["joints"][0]["type"], "d6");
  EXPECT_EQ(json["joints"][0]["name"], "hip, \"x\"");
  EXPECT_EQ(json["joints"][0]["free"], (Json{"linear_x", "twist", "swing_y", "swing_z"}));
  EXPECT_EQ(json["joints"][0]["limits"][0], (Json{-0.25, 0.5}));
  EXPECT_EQ(json["joints"][0]["limits"][3], (Json{nullptr, 7}));
  EXPECT_EQ(json["joints"][0]["rotationA"][2].get<float>(), 0.8f);
  ASSERT_EQ(json["frames"].size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    const RecordedFrame f = reader.frame(i);
    const Json& frame = json["frames"][i];
    EXPECT_EQ(frame["time"].get<double>(), f.time);
    EXPECT_EQ(frame["positions"][7][2].get<double>(), f.poses[7].position.z);
    EXPECT_EQ(frame["rotations"][3][1].get<float>(), f.poses[3].rotation.x);
    EXPECT_EQ(frame["linear"].size(), f.velocities.size());
    EXPECT_EQ(frame["contacts"].size(), f.contacts.size());
    EXPECT_EQ(frame["events"].size(), f.events.size());
    EXPECT_EQ(frame["limitExcessMax"].get<double>(), f.limitExcessMax);
    ASSERT_EQ(frame["joints"].size(), 2u);
    EXPECT_EQ(frame["joints"][1]["force"][0].get<float>(), f.joints[1].reaction.force.x);
    EXPECT_EQ(frame["joints"][1]["enabled"], f.joints[1].enabled);
  }
}

/// What mcap_check.py prints; its complaint if it objects.
std::string checked(const std::filesystem::path& file, const std::string& more = {}) {
  const std::filesystem::path script = std::filesystem::path(__FILE__).parent_path() / "mcap_check.py";
  const std::string command = "python3 '" + script.string() + "' '" + file.string() + "' " + more + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  char part[4096];
  while (size_t got = std::fread(part, 1, sizeof part, pipe)) text.append(part, got);
  return pclose(pipe) == 0 ? text : "refused: " + text;
}

TEST(RecordExport, JsonHoldsPulleysCouplingsAndCustomJoints) {
  const Folder folder;
  Recording head = sampleHead();
  for (const RecordedJoint& joint : sampleLinks()) head.joints.push_back(joint);
  {
    RecordWriter writer(folder.file("a.avbd"), head);
    writer.add(sampleFrame(head, 1));
  }
  RecordReader reader(folder.file("a.avbd"));
  std::stringstream out;
  exportJson(reader, out);
  const Json json = Json::parse(out.str()), joints = json["joints"];
  EXPECT_EQ(joints[2]["type"], "pulley");
  EXPECT_EQ(joints[2]["wheels"], (Json{{1e6, 2, 3}, {1e6, 5, 6}}));
  EXPECT_EQ(joints[2]["ratio"], 2.5);
  EXPECT_EQ(joints[2]["limits"][0], (Json{0, 7}));
  EXPECT_EQ(joints[3]["terms"][0], (Json{{"joint", 0}, {"axis", "swing_z"}, {"factors", {1, 0.5, 0, -2}}}));
  EXPECT_EQ(joints[3]["terms"][1]["joint"], nullptr);
  EXPECT_EQ(joints[3]["rest"], 0.1);
  EXPECT_EQ(joints[4]["family"], "screw, \"left\"");
  EXPECT_EQ(joints[4]["bodyC"], 2);
  EXPECT_EQ(joints[4]["bodyD"], nullptr);
  EXPECT_EQ(joints[4]["residuals"], 2);
  EXPECT_EQ(joints[0].count("residuals") + joints[0].count("terms") + joints[0].count("wheels"), 0u);
  EXPECT_EQ(json["frames"][0]["residuals"].size(), 4u);
}

TEST(RecordExport, McapIsWhatTheSpecificationSays) {
  const Folder folder;
  RecordReader reader(sampleFile(folder, 600));
  std::ostringstream out;
  exportMcap(reader, out, {.compress = false});
  const std::string bytes = out.str();
  EXPECT_GT(bytes.size(), 1u << 20) << "more than one chunk";
  const auto file = folder.write("a.mcap", bytes);
  EXPECT_EQ(checked(file),
            "/scene foxglove.SceneUpdate 1\n/tf foxglove.FrameTransforms 600\n/figures avbd.Figures 600\n"
            "/contacts avbd.Contacts 599\n/events avbd.Events 300\n");
  const std::string text = checked(file, "/tf 7");
  const Json tf = Json::parse(text.substr(text.find('{')));
  const RecordedFrame f = reader.frame(7);
  EXPECT_EQ(tf["transforms"][2]["translation"]["y"].get<double>(), f.poses[2].position.y);
  EXPECT_EQ(tf["transforms"][2]["rotation"]["w"].get<float>(), f.poses[2].rotation.w);
  EXPECT_EQ(tf["transforms"][0]["child_frame_id"], "body_0");
  EXPECT_EQ(tf["transforms"][2]["timestamp"]["nsec"].get<int64_t>(), 116'666'667);
  // The reader can object: one byte of a message, of the summary, of an index.
  for (const size_t at : {size_t{300}, bytes.size() - 60, bytes.size() - 15}) {
    std::string damaged = bytes;
    damaged[at] ^= 4;
    EXPECT_TRUE(checked(folder.write("b.mcap", damaged)).starts_with("refused")) << at;
  }
}

TEST(RecordExport, PackedMcapHoldsTheSame) {
  if (!hasZstd()) GTEST_SKIP() << "this build packs nothing";
  const Folder folder;
  RecordReader reader(sampleFile(folder, 60));
  std::ostringstream plain, packed;
  exportMcap(reader, plain, {.compress = false});
  exportMcap(reader, packed);
  EXPECT_LT(packed.str().size(), plain.str().size() / 2);
  const auto a = folder.write("a.mcap", plain.str()), b = folder.write("b.mcap", packed.str());
  for (const char* more : {"", "/scene 0", "/tf 59", "/contacts 30", "/events 7"}) {
    EXPECT_EQ(checked(a, more), checked(b, more));
    EXPECT_FALSE(checked(b, more).starts_with("refused")) << checked(b, more);
  }
}

TEST(RecordExport, ContactsThatEndedAreTakenOff) {
  const Folder folder;
  RecordReader reader(sampleFile(folder, 9));
  std::ostringstream out;
  exportMcap(reader, out, {.compress = false});
  const auto file = folder.write("a.mcap", out.str());
  // Of frames 0 to 8 every third one has none; before the first there is nothing to take off.
  EXPECT_NE(checked(file).find("/contacts avbd.Contacts 8\n"), std::string::npos) << checked(file);
  const std::string third = checked(file, "/contacts 2");
  EXPECT_EQ(Json::parse(third.substr(third.find('{')))["contacts"].size(), 0u);
}

TEST(RecordExport, ADamagedChunkCostsItsFramesOnly) {
  const Folder folder;
  const auto path = sampleFile(folder, 200);
  std::string bytes = Folder::read(path);
  const RecordReader sound(path);
  for (size_t i = 0; i < sound.index().offsets.size(); ++i)
    if (sound.index().firsts[i] == 64) bytes[sound.index().offsets[i] + 200] ^= 1;
  RecordReader reader(folder.write("damaged.avbd", bytes));
  ASSERT_TRUE(reader.info().finished);
  // The block ends where velocities change: each sample frame is a chunk of its own.
  const size_t lost = 1;
  std::ostringstream csv, json, mcap;
  const auto notes = exportCsv(reader, csv);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("frames 64 to 64 are left out"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("chunk FRAM at byte"), std::string::npos) << notes[0];
  const std::string rows = csv.str();
  EXPECT_EQ(static_cast<size_t>(std::count(rows.begin(), rows.end(), '\n')), 1 + 8 * (200 - lost));
  EXPECT_EQ(exportJson(reader, json), notes);
  EXPECT_EQ(Json::parse(json.str())["frames"].size(), 200 - lost);
  EXPECT_EQ(exportMcap(reader, mcap), notes);
  EXPECT_NE(checked(folder.write("a.mcap", mcap.str())).find("/tf foxglove.FrameTransforms 199"), std::string::npos);
  std::vector<std::string> leftOut;
  EXPECT_EQ(reader.readAll(1, &leftOut).frames.size(), 200 - lost);
  EXPECT_EQ(leftOut.size(), 1u);
}

TEST(RecordExport, McapOfNoFramesIsStillAFile) {
  const Folder folder;
  RecordReader reader(sampleFile(folder, 0));
  std::ostringstream out;
  exportMcap(reader, out, {.compress = false});
  EXPECT_EQ(checked(folder.write("a.mcap", out.str())), "");
}

}  // namespace
}  // namespace avbd::record
