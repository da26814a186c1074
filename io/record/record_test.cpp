// Recordings as files: what goes in comes out, and damage is seen and named.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/record/chunk.h"
#include "io/record/crc.h"
#include "io/record/reader.h"
#include "io/record/same.h"
#include "io/record/sample.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

std::span<const uint8_t> bytesOf(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

std::string writeSample(const Folder& folder, size_t frames, const RecordOptions& options, bool finish = true) {
  const std::filesystem::path path = folder.file("sample.avbd");
  const Recording head = sampleHead();
  RecordWriter writer(path, head, options);
  for (size_t i = 0; i < frames; ++i) writer.add(sampleFrame(head, i));
  writer.flush();
  const std::string open = Folder::read(path);
  writer.finish({{"hash", "12ab"}});
  return finish ? Folder::read(path) : open;
}

/// What a reader says of these bytes, or what it throws.
std::string complaintOf(const std::filesystem::path& path) {
  try {
    RecordReader reader(path);
    std::string all;
    for (const std::string& note : reader.info().notes) all += note + "\n";
    for (const std::string& line : reader.verify()) all += line + "\n";
    reader.readAll();
    return all;
  } catch (const FileError& e) {
    return e.what();
  }
}

TEST(RecordCrc, GivesThePublishedSums) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32c(bytesOf(digits)), 0xe3069283u);  // RFC 3720 and the catalogue of CRCs
  EXPECT_EQ(crc32(bytesOf(digits), Polynomial::Ieee), 0xcbf43926u);
  const auto first = bytesOf(digits).first(4), rest = bytesOf(digits).subspan(4);
  EXPECT_EQ(crc32(rest, Polynomial::Castagnoli, crc32c(first)), 0xe3069283u);
  const std::vector<uint8_t> zeros(32, 0);  // RFC 3720, B.4
  EXPECT_EQ(crc32c(zeros), 0x8a9136aau);
}

TEST(RecordFields, EveryEncodingKeepsEveryBit) {
  std::vector<double> doubles{0, -0.0, 1, -1, 1e300, -1e-300, NAN, INFINITY, -INFINITY, 5e-324};
  std::vector<float> floats{0, -0.0f, NAN, -INFINITY, 1e-45f, 3, 4, 5, 6};
  std::vector<uint8_t> small{1, 2, 255};
  for (const Encoding encoding : {Encoding::Plain, Encoding::Shuffled, Encoding::Delta, Encoding::Line}) {
    for (const uint32_t stride : {0u, 1u, 3u, 100u}) {
      FieldWriter out;
      out.list(7, doubles, encoding, stride);
      out.list(8, floats, encoding, stride);
      out.list(9, small, encoding, stride);
      out.list(10, std::vector<double>{}, encoding, stride);
      out.texts(20, {"", "ab", "ä"});
      const FieldReader in(out.bytes(), "test");
      EXPECT_TRUE(sameBits(in.list<double>(7), doubles));
      EXPECT_TRUE(sameBits(in.list<float>(8), floats));
      EXPECT_TRUE(sameBits(in.list<uint8_t>(9), small));
      EXPECT_TRUE(in.list<double>(10).empty());
      EXPECT_TRUE(in.list<double>(11).empty());
      EXPECT_EQ(in.texts(20), (std::vector<std::string>{"", "ab", "ä"}));
      EXPECT_THROW(in.list<float>(7), FileError);
    }
  }
}

TEST(Record, WhatGoesInComesOut) {
  for (const bool compress : {true, false}) {
    const Folder folder;
    const Recording head = sampleHead(9);
    const auto path = folder.file("a.avbd");
    {
      RecordWriter writer(path, head, {.compress = compress, .framesPerChunk = 4});
      // The file changes from frames with velocities to such without.
      for (size_t i = 0; i < 30; ++i) writer.add(sampleFrame(head, i, i < 13));
      writer.finish({{"label", "value"}, {"", "\n"}});
    }
    RecordReader reader(path);
    EXPECT_TRUE(reader.info().finished);
    EXPECT_TRUE(reader.info().notes.empty()) << reader.info().notes[0];
    EXPECT_EQ(reader.info().frames, 30u);
    EXPECT_EQ(reader.head().title, head.title);
    EXPECT_EQ(reader.head().engine, head.engine);
    EXPECT_EQ(reader.head().up, head.up);
    EXPECT_EQ(reader.head().dt, head.dt);
    ASSERT_EQ(reader.head().shapes.size(), 9u);
    for (size_t i = 0; i < 9; ++i) {
      EXPECT_EQ(reader.head().bodies[i].name, head.bodies[i].name);
      EXPECT_EQ(reader.head().bodies[i].type, head.bodies[i].type);
      EXPECT_EQ(reader.head().shapes[i].geometry.index(), head.shapes[i].geometry.index());
      EXPECT_EQ(reader.head().shapes[i].pose, head.shapes[i].pose);
      EXPECT_EQ(reader.head().shapes[i].trigger, head.shapes[i].trigger);
      EXPECT_EQ(reader.head().shapes[i].color, head.shapes[i].color);
    }
    EXPECT_EQ(std::get<Cone>(reader.head().shapes[5].geometry).rounding, 0.02f);
    EXPECT_EQ(std::get<Box>(reader.head().shapes[1].geometry).z, 0.3f);
    ASSERT_EQ(reader.head().joints.size(), 2u);
    for (size_t i = 0; i < 2; ++i) expectSameJoint(reader.head().joints[i], head.joints[i]);
    EXPECT_EQ(reader.head().report[1].second, "\n");
    for (const size_t i : {29, 0, 13, 12, 4, 3, 28, 15, 16}) expectSame(reader.frame(i), sampleFrame(head, i, i < 13));
    EXPECT_TRUE(reader.verify().empty());
    EXPECT_THROW(reader.frame(30), FileError);
    EXPECT_EQ(reader.readAll(7).frames.size(), 6u);  // 0 7 14 21 28 and the last
  }
}

TEST(Record, CutAnywhereKeepsTheCompleteFrames) {
  const Folder folder;
  const std::string whole = writeSample(folder, 6, {.framesPerChunk = 2});
  const Recording head = sampleHead();
  std::vector<uint64_t> ends;  // of the chunks of frames
  {
    const RecordReader reader(folder.write("whole.avbd", whole));
    const Index& index = reader.index();
    for (size_t i = 0; i < index.offsets.size(); ++i)
      if (index.types[i] == kFrames)
        ends.push_back(i + 1 < index.offsets.size() ? index.offsets[i + 1] : reader.contentEnd());
  }
  ASSERT_EQ(ends.size(), 3u);
  size_t refused = 0;
  for (size_t size = 0; size < whole.size(); ++size) {
    const auto path = folder.write("cut.avbd", whole.substr(0, size));
    size_t expected = 0;
    for (const uint64_t end : ends) expected += size >= end ? 2 : 0;
    try {
      RecordReader reader(path);
      ASSERT_EQ(reader.frameCount(), expected) << size;
      ASSERT_FALSE(reader.info().finished) << size;
      ASSERT_FALSE(reader.info().notes.empty()) << size;
      ASSERT_NE(reader.info().notes.back().find("the end is missing"), std::string::npos) << size;
      if (expected > 0) expectSame(reader.frame(expected - 1), sampleFrame(head, expected - 1));
    } catch (const FileError& e) {
      ++refused;
      ASSERT_LT(size, kFileHeadBytes) << e.what();
      ASSERT_NE(std::string(e.what()).find("cut.avbd"), std::string::npos);
    }
  }
  EXPECT_EQ(refused, kFileHeadBytes);
}

TEST(Record, EveryFlippedByteIsNoticed) {
  const Folder folder;
  for (const bool compress : {true, false}) {
    const std::string whole = writeSample(folder, 4, {.compress = compress, .framesPerChunk = 2});
    EXPECT_EQ(complaintOf(folder.write("whole.avbd", whole)), "");
    for (size_t at = 0; at < whole.size(); ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
      const std::string complaint = complaintOf(folder.write("flipped.avbd", bytes));
      ASSERT_NE(complaint, "") << "byte " << at << " of " << whole.size();
    }
  }
}

TEST(Record, DamageIsNamedWithItsPlace) {
  const Folder folder;
  std::string bytes = writeSample(folder, 6, {.framesPerChunk = 2});
  RecordReader sound(folder.write("sound.avbd", bytes));
  uint64_t offset = 0;
  for (size_t i = 0; i < sound.index().offsets.size(); ++i)
    if (sound.index().firsts[i] == 2) offset = sound.index().offsets[i];
  ASSERT_GT(offset, 0u);
  bytes[offset + kChunkHeadBytes + 5] ^= 1;
  const std::string place = "chunk FRAM at byte " + std::to_string(offset) + " is damaged: its checksum does not fit";
  {
    RecordReader reader(folder.write("flipped.avbd", bytes));
    EXPECT_EQ(reader.frameCount(), 6u);
    expectSame(reader.frame(5), sampleFrame(sampleHead(), 5));
    try {
      reader.frame(3);
      FAIL();
    } catch (const FileError& e) {
      EXPECT_NE(std::string(e.what()).find(place), std::string::npos) << e.what();
    }
  }
  // Without its end the file is searched: what is lost is said by number.
  const std::string complaint = complaintOf(folder.write("open.avbd", bytes.substr(0, bytes.size() - kFooterBytes)));
  EXPECT_NE(complaint.find(place), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("frames 2 to 3 are lost"), std::string::npos) << complaint;
  // A damaged head of a chunk: the search goes on behind it.
  bytes[offset + 2] ^= 1;
  RecordReader reader(folder.write("open.avbd", bytes.substr(0, bytes.size() - kFooterBytes)));
  EXPECT_EQ(reader.frameCount(), 4u);
  expectSame(reader.frame(3), sampleFrame(sampleHead(), 5));
}

TEST(Record, OtherVersions) {
  const Folder folder;
  const std::string whole = writeSample(folder, 2, {});
  const auto withVersion = [&](uint16_t major, uint16_t minor) {
    std::string bytes = whole;
    std::memcpy(&bytes[8], &major, 2);
    std::memcpy(&bytes[10], &minor, 2);
    const uint32_t sum = crc32c(bytesOf(bytes).first(12));
    std::memcpy(&bytes[12], &sum, 4);
    return folder.write("version.avbd", bytes);
  };
  EXPECT_NE(complaintOf(withVersion(2, 5)).find("is of version 2.5; this program reads version 1"), std::string::npos);
  EXPECT_EQ(complaintOf(withVersion(1, 9)), "");
  EXPECT_EQ(RecordReader(withVersion(1, 9)).info().versionMinor, 9);
  EXPECT_NE(complaintOf(folder.write("a.avbd", "<mujoco/>")).find("is no AVBD recording"), std::string::npos);
  EXPECT_NE(complaintOf(folder.write("a.avbd", "")).find("is empty"), std::string::npos);
  EXPECT_NE(complaintOf(folder.file("none.avbd")).find("No such file"), std::string::npos);
  EXPECT_NE(complaintOf(folder.file(".")).find("directory"), std::string::npos);
}

/// A file of an older version, of sampleHead(3) and five of its frames, unpacked.
RecordReader olderFile(uint16_t minor) {
  const std::string name = "corpus/version_1_" + std::to_string(minor) + ".avbd";
  RecordReader reader(std::filesystem::path(__FILE__).parent_path() / name);
  EXPECT_EQ(reader.info().versionMinor, minor);
  EXPECT_TRUE(reader.info().finished);
  EXPECT_TRUE(reader.info().notes.empty());
  EXPECT_TRUE(reader.verify().empty());
  EXPECT_EQ(reader.head().joints.size(), 2u);
  EXPECT_EQ(reader.frameCount(), 5u);
  return reader;
}

TEST(Record, AFileOfVersionOneTwoLacksOnlyWhatCameLater) {
  RecordReader reader = olderFile(2);
  const Recording head = sampleHead();
  EXPECT_TRUE(reader.head().softs.empty());
  for (size_t i = 0; i < 2; ++i) expectSameJoint(reader.head().joints[i], head.joints[i]);
  for (size_t i = 0; i < 5; ++i) expectSame(reader.frame(i), sampleFrame(head, i));
}

TEST(Record, AFileOfVersionOneOneLacksOnlyWhatCameLater) {
  RecordReader reader = olderFile(1);
  const Recording head = sampleHead();
  for (size_t i = 0; i < 2; ++i) expectSameJoint(reader.head().joints[i], head.joints[i]);
  for (size_t i = 0; i < 5; ++i) expectSame(reader.frame(i), sampleFrame(head, i));
}

TEST(Record, AFileOfVersionOneZeroLacksOnlyWhatCameLater) {
  RecordReader reader = olderFile(0);
  const Recording head = sampleHead();
  for (size_t i = 0; i < 2; ++i) {
    RecordedJoint expected;
    expected.bodyA = head.joints[i].bodyA;
    expected.bodyB = head.joints[i].bodyB;
    expected.frameA.position = head.joints[i].frameA.position;
    expected.frameB.position = head.joints[i].frameB.position;
    expectSameJoint(reader.head().joints[i], expected);
  }
  for (size_t i = 0; i < 5; ++i) {
    RecordedFrame expected = sampleFrame(head, i);
    expected.joints.clear();
    expected.limitExcessMax = expected.limitExcessAngleMax = NAN;
    std::erase_if(expected.events, [](const RecordedEvent& e) { return e.kind != RecordedEventKind::Hit; });
    expectSame(reader.frame(i), expected);
  }
}

TEST(Record, WhatANewerWriterAddsIsLeftOut) {
  const Folder folder;
  std::string bytes = writeSample(folder, 2, {}, false);
  FieldWriter unknown;
  unknown.text(999, "from the future");
  const Bytes chunk = chunkBytes(typeOf("NEWS"), unknown.bytes(), true);
  bytes.insert(bytes.end(), chunk.begin(), chunk.end());
  // A head with one field more than this version knows.
  FieldWriter meta;
  meta.text(1, "new title");
  meta.value(77, 3.5);
  const Bytes more = chunkBytes(kMeta, meta.bytes(), true);
  bytes.insert(bytes.end(), more.begin(), more.end());
  RecordReader reader(folder.write("new.avbd", bytes));
  EXPECT_EQ(reader.frameCount(), 2u);
  EXPECT_EQ(reader.head().title, "new title");
  EXPECT_NE(reader.info().notes[0].find("chunk NEWS is not known"), std::string::npos);
}

TEST(Record, GoesOnAfterACrashAndAfterTheEnd) {
  const Folder folder;
  const Recording head = sampleHead();
  const std::string open = writeSample(folder, 5, {.framesPerChunk = 2}, false);
  const std::string done = writeSample(folder, 5, {.framesPerChunk = 2});
  for (const std::string& bytes : {open, open.substr(0, open.size() - 3), done, done.substr(0, done.size() - 3)}) {
    const auto path = folder.write("a.avbd", bytes);
    const size_t before = RecordReader(path).frameCount();
    {
      RecordWriter writer = RecordWriter::reopen(path, {.framesPerChunk = 2});
      ASSERT_EQ(writer.frameCount(), before);
      for (size_t i = before; i < 9; ++i) writer.add(sampleFrame(head, i));
      EXPECT_THROW(writer.add(sampleFrame(head, 2)), std::invalid_argument);
      writer.finish();
    }
    RecordReader reader(path);
    EXPECT_TRUE(reader.info().finished);
    EXPECT_TRUE(reader.info().notes.empty());
    ASSERT_EQ(reader.frameCount(), 9u);
    for (size_t i = 0; i < 9; ++i) expectSame(reader.frame(i), sampleFrame(head, i));
  }
}

TEST(Record, ReadsAlongWhileItGrows) {
  const Folder folder;
  const Recording head = sampleHead();
  const auto path = folder.file("a.avbd");
  RecordWriter writer(path, head, {.framesPerChunk = 3});
  RecordReader reader(path);
  EXPECT_EQ(reader.frameCount(), 0u);
  size_t seen = 0;
  for (size_t i = 0; i < 10; ++i) {
    writer.add(sampleFrame(head, i));
    EXPECT_EQ(reader.refresh(), i % 3 == 2);
    for (; seen < reader.frameCount(); ++seen) expectSame(reader.frame(seen), sampleFrame(head, seen));
    EXPECT_EQ(seen, (i + 1) / 3 * 3);
  }
  EXPECT_FALSE(reader.info().finished);
  writer.finish();
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.frameCount(), 10u);
  EXPECT_TRUE(reader.info().finished);
  EXPECT_TRUE(reader.info().notes.empty());
  EXPECT_FALSE(reader.refresh());
}

TEST(Record, ABodyMoreOrATimeBackIsRefused) {
  const Folder folder;
  const auto path = folder.file("a.avbd");
  Recording head = sampleHead();
  RecordWriter writer(path, head);
  RecordedFrame frame = sampleFrame(head, 1);
  writer.add(frame);
  frame.time = NAN;
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame.time = 0;
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame = sampleFrame(head, 2);
  frame.poses.pop_back();
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  frame = sampleFrame(head, 2);
  frame.joints.pop_back();
  EXPECT_THROW(writer.add(frame), std::invalid_argument);
  head.joints[0].limits[2] = {1, 0};
  EXPECT_THROW(RecordWriter(folder.file("b.avbd"), head), std::invalid_argument);
  head = sampleHead();
  head.joints[1].coneZ = NAN;
  EXPECT_THROW(RecordWriter(folder.file("b.avbd"), head), std::invalid_argument);
  head = sampleHead();
  head.shapes[0].body = 3;
  EXPECT_THROW(RecordWriter(folder.file("b.avbd"), head), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.avbd")));
  EXPECT_THROW(RecordWriter("/dev/full", sampleHead()), FileError);
  EXPECT_THROW(RecordWriter(folder.file("no/such/a.avbd"), sampleHead()), FileError);
}

TEST(Record, AHundredThousandFramesAreFoundByTimeAndNumber) {
  const Folder folder;
  const auto path = folder.file("long.avbd");
  const Recording head = sampleHead(2);
  RecordedFrame frame = sampleFrame(head, 0, false);
  {
    RecordWriter writer(path, head, {.framesPerChunk = 256});
    for (int i = 0; i < 100'000; ++i) {
      frame.time = i / 240.0;
      frame.poses[1].position.x = i;
      writer.add(frame);
    }
  }
  RecordReader reader(path);
  EXPECT_EQ(reader.info().frames, 100'000u);
  for (const uint64_t i : {0ull, 99'999ull, 1ull, 255ull, 256ull, 54'321ull}) {
    EXPECT_EQ(reader.frame(i).poses[1].position.x, static_cast<double>(i));
    EXPECT_EQ(reader.frameAt(static_cast<double>(i) / 240.0), i);
    EXPECT_EQ(reader.frameAt((static_cast<double>(i) + 0.5) / 240.0), i);
  }
  EXPECT_EQ(reader.frameAt(-1), 0u);
  EXPECT_EQ(reader.frameAt(1e9), 99'999u);
}

}  // namespace
}  // namespace avbd::record
