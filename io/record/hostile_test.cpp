// Recordings that were made to harm, begun anew under a reader, or whose writer ran out of room.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>

#include "io/record/chunk.h"
#include "io/record/crc.h"
#include "io/record/limits.h"
#include "io/record/reader.h"
#include "io/record/sample.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }
std::string chunkText(uint32_t type, const FieldWriter& fields, bool compress = true) {
  return textOf(chunkBytes(type, fields.bytes(), compress));
}

std::string bodiesText(uint32_t count) {
  FieldWriter out;
  out.list(1, std::vector<uint32_t>(count, 0));
  out.text(2, "");
  return chunkText(kBodies, out);
}

/// A run of frames without anything but times and bodies.
FieldWriter timesOnly(size_t frames, uint32_t bodies) {
  FieldWriter out;
  out.list(2, std::vector<double>(frames, 0.0), Encoding::Delta, 1);
  out.value(3, bodies);
  return out;
}

std::string notesOf(const RecordReader& reader) {
  std::string all;
  for (const std::string& note : reader.info().notes) all += note + "\n";
  return all;
}

std::filesystem::path writeFrames(const std::filesystem::path& path, size_t frames, size_t firstFrame = 0) {
  const Recording head = sampleHead();
  RecordWriter writer(path, head, {.framesPerChunk = 2});
  for (size_t i = 0; i < frames; ++i) writer.add(sampleFrame(head, firstFrame + i));
  writer.finish({{"hash", "12ab"}});
  return path;
}

/// The same content with another index.
std::string withIndex(const std::string& bytes, uint64_t contentEnd, const Index& index) {
  return bytes.substr(0, contentEnd) + textOf(chunkBytes(kIndex, indexContent(index), true)) +
         textOf(footerBytes({contentEnd, index.times.size()}));
}

TEST(RecordBombs, AFewPackedBytesMakeNoGigabytes) {
  if (!hasZstd()) GTEST_SKIP() << "without zstd a bomb is as large as what it unpacks to";
  const Folder folder;
  const std::string head = textOf(fileHead());
  const std::string many = head + bodiesText((1u << 18) + (1u << 16));
  ASSERT_LT(many.size(), 10'000u);
  try {
    RecordReader reader(folder.write("bodies.avbd", many));
    FAIL();
  } catch (const FileError& e) {
    EXPECT_NE(std::string(e.what()).find("more elements than a file of this size"), std::string::npos) << e.what();
  }
  // Each chunk is within its limit, but not all of them together.
  FieldWriter title;
  title.text(1, std::string(1u << 20, 'a'));
  std::string titles = head;
  for (int i = 0; i < 20; ++i) titles += chunkText(kMeta, title);
  ASSERT_LT(titles.size(), 10'000u);
  EXPECT_NE(notesOf(RecordReader(folder.write("titles.avbd", titles))).find("unpacks to more than a file of this size"),
            std::string::npos);
  // Frames of no bodies hold nothing but times.
  const std::string times = head + chunkText(kFrames, timesOnly((1u << 22) + (1u << 18), 0));
  ASSERT_LT(times.size(), 100'000u);
  const RecordReader empty(folder.write("times.avbd", times));
  EXPECT_EQ(empty.frameCount(), 0u);
  EXPECT_NE(notesOf(empty).find("more frames than a file of this size"), std::string::npos) << notesOf(empty);
  const RecordReader bare(folder.write("poses.avbd", head + bodiesText(1) + chunkText(kFrames, timesOnly(1000, 1))));
  EXPECT_EQ(bare.frameCount(), 0u);
  EXPECT_NE(notesOf(bare).find("does not fit the poses"), std::string::npos) << notesOf(bare);
  FieldWriter events = timesOnly(1, 0);
  events.list(30, std::vector<uint32_t>{kEventsMost + 1});
  events.list(31, std::vector<uint8_t>(kEventsMost + 1, 0));
  RecordReader busy(folder.write("events.avbd", head + chunkText(kFrames, events)));
  EXPECT_THROW(busy.frame(0), FileError);
}

TEST(RecordHostile, FramesNameWhatThereIs) {
  const Folder folder;
  const auto refused = [&](auto change) {
    FieldWriter out = timesOnly(1, 0);
    change(out);
    RecordReader reader(folder.write("a.avbd", textOf(fileHead()) + chunkText(kFrames, out)));
    EXPECT_EQ(reader.frameCount(), 1u);
    EXPECT_THROW(reader.frame(0), FileError);
    EXPECT_FALSE(reader.verify().empty());
  };
  refused([](FieldWriter& out) {  // a contact of a shape that there is not
    out.list(20, std::vector<uint32_t>{1});
    out.list(22, std::vector<uint32_t>{0});
    out.list(24, std::vector<float>{0, 0, 0});
    out.list(25, std::vector<float>{0, 0, 0});
  });
  refused([](FieldWriter& out) {  // an event of a kind that there is not
    out.list(30, std::vector<uint32_t>{1});
    out.list(31, std::vector<uint8_t>{5});
  });
  refused([](FieldWriter& out) {
    out.list(30, std::vector<uint32_t>{1});
    out.list(31, std::vector<uint8_t>{0});
    out.list(33, std::vector<uint32_t>{7});
  });
  FieldWriter surface, shape;
  surface.value(1, uint8_t{9});
  shape.list(1, std::vector<uint32_t>{0});
  shape.list(2, std::vector<uint8_t>{7});
  shape.list(3, std::vector<float>{1, 1, 1, 0});
  shape.list(4, std::vector<uint32_t>{0});
  shape.list(5, std::vector<double>{0, 0, 0});
  shape.list(6, std::vector<float>{1, 0, 0, 0});
  EXPECT_THROW(RecordReader(folder.write("a.avbd", textOf(fileHead()) + bodiesText(1) + chunkText(kSurfaces, surface) +
                                                       chunkText(kShapes, shape))),
               FileError);
}

/// One joint between the world and itself, and what else `change` writes of it.
std::string jointText(const std::function<void(FieldWriter&)>& change) {
  FieldWriter out;
  out.list(1, std::vector<uint32_t>{kNotRecorded});
  out.list(2, std::vector<uint32_t>{kNotRecorded});
  out.list(3, std::vector<double>(3, 0.0));
  out.list(4, std::vector<double>(3, 0.0));
  change(out);
  return chunkText(kJoints, out);
}

TEST(RecordHostile, JointsThatAreNoneAreSaidAndLeftOut) {
  const Folder folder;
  const auto notes = [&](auto change, size_t joints) {
    const RecordReader reader(folder.write("a.avbd", textOf(fileHead()) + jointText(change)));
    EXPECT_EQ(reader.head().joints.size(), joints);
    return notesOf(reader);
  };
  std::vector<float> limits(12, 0.0f);
  limits[7] = -1;
  const auto expectNote = [](const std::string& all, const char* part) {
    EXPECT_NE(all.find(part), std::string::npos) << all;
  };
  expectNote(notes([&](FieldWriter& out) { out.list(11, limits); }, 0), "field 11 holds what is no range");
  limits[7] = NAN;
  expectNote(notes([&](FieldWriter& out) { out.list(11, limits); }, 0), "field 11 holds what is no range");
  expectNote(notes(
                 [](FieldWriter& out) {
                   out.list(12, std::vector<float>{1, 0});
                 },
                 0),
             "field 12 holds what is no cone");
  expectNote(notes([](FieldWriter& out) { out.list(6, std::vector<float>{1, 0, 0}); }, 0), "field 6 has 3 elements");
  expectNote(notes([](FieldWriter& out) { out.texts(8, {"a", "b"}); }, 0), "field 8 has 2 elements");
  // A type of the future keeps its anchors.
  expectNote(notes([](FieldWriter& out) { out.value(7, uint8_t{77}); }, 1), "types that are not known");
}

TEST(RecordHostile, LinksThatNameNothingAreSaidAndLeftOut) {
  const Folder folder;
  const auto expectNote = [&](const char* part, auto change) {
    const RecordReader reader(folder.write("a.avbd", textOf(fileHead()) + jointText(change)));
    EXPECT_TRUE(reader.head().joints.empty());
    EXPECT_NE(notesOf(reader).find(part), std::string::npos) << notesOf(reader);
  };
  const auto term = [](FieldWriter& out, uint32_t count, uint32_t joint, uint8_t axis) {
    out.list(15, std::vector<uint32_t>{count});
    out.list(16, std::vector<uint32_t>{joint});
    out.list(17, std::vector<uint8_t>{axis});
    out.list(18, std::vector<float>{1, 0, 0, 0});
  };
  expectNote("field 16 names a joint", [&](FieldWriter& out) { term(out, 1, 1, 0); });
  expectNote("field 17 names a coordinate", [&](FieldWriter& out) { term(out, 1, 0, 6); });
  expectNote("field 16 has 1 elements", [&](FieldWriter& out) { term(out, 0xffffffffu, 0, 0); });
  expectNote("field 15 stands alone", [](FieldWriter& out) { out.list(15, std::vector<uint32_t>{0xffffffffu}); });
  expectNote("field 13 has 5 elements", [](FieldWriter& out) { out.list(13, std::vector<double>(5)); });
  expectNote("field 20 names a body", [](FieldWriter& out) { out.list(20, std::vector<uint32_t>{kNotRecorded, 0}); });
  expectNote("field 21", [](FieldWriter& out) { out.texts(21, {"a", "b"}); });
  expectNote("field 23 has 2 elements", [](FieldWriter& out) { out.list(23, std::vector<uint8_t>{1, 1}); });
}

TEST(RecordHostile, ResidualsFitTheJoints) {
  const Folder folder;
  const auto frameOf = [&](std::vector<float> residuals, uint8_t each) {
    FieldWriter out = timesOnly(1, 0);
    out.value(40, 1u);
    out.list(41, std::vector<float>(3));
    out.list(44, residuals);
    // Of a type of the future, which may have more of them.
    const std::string joint = jointText([&](FieldWriter& fields) {
      fields.value(7, uint8_t{77});
      fields.value(23, each);
    });
    return RecordReader(folder.write("a.avbd", textOf(fileHead()) + joint + chunkText(kFrames, out))).frame(0);
  };
  EXPECT_EQ(frameOf({1, 2, 3}, 3).residuals, (std::vector<float>{1, 2, 3}));
  EXPECT_TRUE(frameOf({}, 0).residuals.empty());
  EXPECT_THROW(frameOf({1, 2}, 3), FileError);
  EXPECT_THROW(frameOf({1}, 0), FileError);
  EXPECT_THROW(frameOf({}, 255), FileError);
}

TEST(RecordHostile, WhatJointsDidFitsTheFrames) {
  const Folder folder;
  const auto frameOf = [&](auto change, size_t joints) {
    FieldWriter out = timesOnly(1, 0);
    change(out);
    std::string bytes = textOf(fileHead());
    for (size_t i = 0; i < joints; ++i) bytes += jointText([](FieldWriter&) {});
    return RecordReader(folder.write("a.avbd", bytes + chunkText(kFrames, out))).frame(0);
  };
  const auto two = [](FieldWriter& out) {
    out.value(40, 2u);
    out.list(41, std::vector<float>{1, 2, 3, 4, 5, 6});
  };
  const RecordedFrame frame = frameOf(two, 2);
  ASSERT_EQ(frame.joints.size(), 2u);
  EXPECT_EQ(frame.joints[1].reaction.force, (Vec3{4, 5, 6}));
  EXPECT_EQ(frame.joints[1].reaction.torque, Vec3{});
  EXPECT_TRUE(frame.joints[1].enabled);
  EXPECT_TRUE(frameOf(two, 1).joints.empty()) << "joints that were lost";
  EXPECT_THROW(frameOf([](FieldWriter& out) { out.value(40, 2u); }, 2), FileError);
  EXPECT_THROW(frameOf([](FieldWriter& out) { out.value(40, 0xffffffffu); }, 2), FileError);
  EXPECT_THROW(frameOf(
                   [&](FieldWriter& out) {
                     two(out);
                     out.list(43, std::vector<uint8_t>{1});
                   },
                   2),
               FileError);
}

TEST(RecordHostile, TimesOfTheIndexAreThoseOfTheChunks) {
  const Folder folder;
  const auto path = writeFrames(folder.file("a.avbd"), 6);
  const std::string bytes = Folder::read(path);
  const RecordReader sound(path);
  const Index index = sound.index();
  const uint64_t end = sound.contentEnd();

  Index other = index;
  other.times[3] = NAN;
  const RecordReader searched(folder.write("nan.avbd", withIndex(bytes, end, other)));
  EXPECT_EQ(searched.times(), sound.times());
  EXPECT_NE(notesOf(searched).find("not opened by its index"), std::string::npos);

  other = index;
  other.times[3] = 0.5 * (index.times[2] + index.times[4]) + 1e-4;
  RecordReader shifted(folder.write("shifted.avbd", withIndex(bytes, end, other)));
  EXPECT_NO_THROW(shifted.frame(0));
  EXPECT_THROW(shifted.frame(3), FileError);
  EXPECT_FALSE(shifted.verify().empty());

  // Times that no chunk of frames stands for.
  other = index;
  other.counts[0] = 1;
  other.times.push_back(index.times.back() + 1);
  RecordReader more(folder.write("more.avbd", withIndex(bytes, end, other)));
  EXPECT_EQ(more.frameCount(), 6u);
  EXPECT_NO_THROW(more.frame(5));
  // A chunk of frames with a time that is none.
  FieldWriter out;
  out.list(2, std::vector<double>{0, NAN, 1});
  out.value(3, 0u);
  EXPECT_EQ(RecordReader(folder.write("b.avbd", textOf(fileHead()) + chunkText(kFrames, out))).frameCount(), 0u);
}

TEST(RecordHostile, WhatNobodyNeedsIsNoReasonToRefuse) {
  const Folder folder;
  const std::string bytes = Folder::read(writeFrames(folder.file("a.avbd"), 4));
  const RecordReader sound(folder.file("a.avbd"));
  ASSERT_EQ(sound.head().joints.size(), 2u);
  std::string damaged = bytes;
  for (size_t i = 0; i < sound.index().offsets.size(); ++i)
    if (sound.index().types[i] == kJoints) damaged[sound.index().offsets[i] + kChunkHeadBytes + 3] ^= 1;
  RecordReader reader(folder.write("b.avbd", damaged));
  EXPECT_EQ(reader.frameCount(), 4u);
  EXPECT_NO_THROW(reader.frame(3));
  EXPECT_TRUE(reader.head().joints.empty());
  EXPECT_NE(notesOf(reader).find("chunk JOIN"), std::string::npos) << notesOf(reader);
  // Packed by a method of the future, and longer than anything.
  Bytes news = chunkBytes(typeOf("NEWS"), FieldWriter().bytes(), false);
  news[8] = 77;
  const uint32_t raw = 0xffffffffu;
  std::memcpy(&news[16], &raw, 4);
  const uint32_t sum = crc32c(std::span(news).first(24));
  std::memcpy(&news[24], &sum, 4);
  RecordReader newer(folder.write("c.avbd", bytes.substr(0, sound.contentEnd()) + textOf(news)));
  EXPECT_EQ(newer.frameCount(), 4u);
  EXPECT_NE(notesOf(newer).find("chunk NEWS is not known"), std::string::npos);
  EXPECT_TRUE(newer.verify().empty());
}

TEST(RecordAnew, AFileThatIsBegunAnewIsAnotherOne) {
  const Folder folder;
  const auto path = writeFrames(folder.file("a.avbd"), 4);
  RecordReader reader(path);
  reader.frame(3);
  EXPECT_FALSE(reader.refresh());
  EXPECT_EQ(reader.generation(), 0u);
  writeFrames(path, 30, 7);  // longer: its size alone tells nothing
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.generation(), 1u);
  ASSERT_EQ(reader.frameCount(), 30u);
  EXPECT_EQ(reader.frame(3).poses, sampleFrame(sampleHead(), 10).poses);
  EXPECT_TRUE(reader.info().notes.empty()) << notesOf(reader);
  // Replaced by another of its name.
  std::filesystem::rename(writeFrames(folder.file("b.avbd"), 30, 9), path);
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.generation(), 2u);
  EXPECT_EQ(reader.frame(3).poses, sampleFrame(sampleHead(), 12).poses);
  // Nothing yet, then something.
  folder.write("a.avbd", "");
  EXPECT_THROW(reader.refresh(), FileError);
  EXPECT_EQ(reader.generation(), 3u);
  EXPECT_EQ(reader.frameCount(), 0u);
  EXPECT_EQ(reader.info().frames, 0u);
  EXPECT_THROW(reader.refresh(), FileError);
  writeFrames(path, 5);
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.generation(), 3u);
  EXPECT_EQ(reader.frameCount(), 5u);
  // Appended to: the same file.
  const Recording head = sampleHead();
  {
    RecordWriter writer = RecordWriter::reopen(path);
    writer.add(sampleFrame(head, 5));
    writer.finish();
  }
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.generation(), 3u);
  EXPECT_EQ(reader.frameCount(), 6u);
}

TEST(RecordRoom, WhatWasWrittenInPartIsTakenBack) {
  const Folder folder;
  const auto path = folder.file("a.avbd");
  const Recording head = sampleHead();
  RecordWriter writer(path, head, {.framesPerChunk = 2});
  for (size_t i = 0; i < 4; ++i) writer.add(sampleFrame(head, i));
  const auto size = std::filesystem::file_size(path);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{size + 50, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  writer.add(sampleFrame(head, 4));
  EXPECT_THROW(writer.add(sampleFrame(head, 5)), FileError);
  EXPECT_EQ(std::filesystem::file_size(path), size);
  EXPECT_THROW(writer.finish(), FileError);
  EXPECT_EQ(std::filesystem::file_size(path), size);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, ignored);
  writer.add(sampleFrame(head, 6));
  writer.finish();
  RecordReader reader(path);
  EXPECT_TRUE(reader.info().notes.empty()) << notesOf(reader);
  EXPECT_TRUE(reader.verify().empty());
  ASSERT_EQ(reader.frameCount(), 7u);
  for (size_t i = 0; i < 7; ++i) EXPECT_EQ(reader.frame(i).poses, sampleFrame(head, i).poses);
}

TEST(RecordRoom, WhatStandsBehindAPartOfAChunkIsFound) {
  const Folder folder;
  const std::string bytes = Folder::read(writeFrames(folder.file("a.avbd"), 8));
  const RecordReader sound(folder.file("a.avbd"));
  const Index& index = sound.index();
  for (size_t i = 0; i < index.offsets.size(); ++i) {
    if (index.types[i] != kFrames) continue;
    const uint64_t at = index.offsets[i];
    // As if its first bytes had been written, and then the whole of it behind them: at the end too.
    for (const uint64_t part : {uint64_t{40}, uint64_t{200}}) {
      RecordReader reader(folder.write("b.avbd", bytes.substr(0, at + part) + bytes.substr(at)));
      EXPECT_EQ(reader.frameCount(), 8u) << i << " " << part << " " << notesOf(reader);
      EXPECT_NE(notesOf(reader).find("damaged"), std::string::npos);
    }
  }
}

TEST(RecordRoom, AWriterMakesNothingThatAReaderRefuses) {
  const Folder folder;
  const auto path = folder.file("a.avbd");
  Recording head = sampleHead();
  head.title.assign(kChunkMost, 'a');
  EXPECT_THROW(RecordWriter(path, head), std::invalid_argument);
  head = sampleHead();
  head.report.resize(kReportMost + 1);
  EXPECT_THROW(RecordWriter(path, head), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
  // Bodies that pack as well as a bomb's.
  head = {};
  head.bodies.resize((1u << 18) + (1u << 16));
  RecordWriter(path, head).finish();
  EXPECT_EQ(RecordReader(path).head().bodies.size(), head.bodies.size());

  head = sampleHead();
  RecordWriter writer(path, head);
  RecordedFrame frame = sampleFrame(head, 1);
  frame.contacts = {{{}, {}, {}, 0, 3, 0}};
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame.contacts.clear();
  frame.events = {{static_cast<RecordedEventKind>(5)}};
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame.events.assign(kEventsMost + 1, {});
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame.events.clear();
  writer.add(frame);
  writer.finish();
  EXPECT_EQ(RecordReader(path).frameCount(), 1u);
}

}  // namespace
}  // namespace avbd::record
