// Pulleys, couplings and custom joints in files: what goes in comes out, and what names nothing is refused.
#include <gtest/gtest.h>

#include <stdexcept>

#include "io/record/reader.h"
#include "io/record/same.h"
#include "io/record/sample.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

TEST(Record, PulleysCouplingsAndCustomJointsComeBack) {
  const Folder folder;
  Recording head = sampleHead();
  for (const RecordedJoint& joint : sampleLinks()) head.joints.push_back(joint);
  ASSERT_EQ(residualCount(head), 4u);
  {
    RecordWriter writer(folder.file("a.avbd"), head, {.framesPerChunk = 8});
    for (size_t i = 0; i < 40; ++i) {
      RecordedFrame frame = sampleFrame(head, i);
      if (i % 8 == 3) frame.residuals.clear();
      writer.add(frame);
    }
    writer.finish();
  }
  RecordReader reader(folder.file("a.avbd"));
  EXPECT_TRUE(reader.info().notes.empty());
  EXPECT_TRUE(reader.verify().empty());
  ASSERT_EQ(reader.head().joints.size(), 5u);
  for (size_t i = 0; i < 5; ++i) expectSameJoint(reader.head().joints[i], head.joints[i]);
  ASSERT_EQ(reader.frameCount(), 40u);
  for (size_t i = 0; i < 40; ++i) {
    RecordedFrame expected = sampleFrame(head, i);
    if (i % 8 == 3) expected.residuals.clear();
    expectSame(reader.frame(i), expected);
  }
}

TEST(Record, RefusesLinksThatNameNothing) {
  const Folder folder;
  const auto refusal = [&](auto change) {
    Recording head = sampleHead();
    for (const RecordedJoint& joint : sampleLinks()) head.joints.push_back(joint);
    RecordedFrame frame = sampleFrame(head, 1);
    change(head, frame);
    try {
      RecordWriter writer(folder.file("a.avbd"), head);
      writer.add(frame);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto expect = [](const std::string& found, const std::string& start) {
    EXPECT_EQ(found.rfind(start, 0), 0u) << found;
  };
  expect(refusal([](Recording& r, RecordedFrame&) { r.joints[3].terms[0].joint = 5; }),
         "Recording.joints[3].terms[].joint = 5: must be below the number of joints, 5");
  expect(refusal([](Recording& r, RecordedFrame&) { r.joints[3].terms[0].axis = static_cast<JointAxis>(6); }),
         "Recording.joints[3].terms[].axis = 6");
  expect(refusal([](Recording& r, RecordedFrame&) { r.joints[4].moreBodies[1] = 3; }),
         "Recording.joints[4].body = 3: must be below the number of bodies, 3");
  expect(refusal([](Recording&, RecordedFrame& f) { f.residuals.pop_back(); }),
         "Recording.frames[0].residuals = 3: must be as many as the joints have, 4");
  expect(refusal([](Recording&, RecordedFrame& f) { f.joints.clear(); }), "Recording.frames[0].residuals = 4");
}

}  // namespace
}  // namespace avbd::record
