// What pulleys, couplings and custom joints have besides frames, as fields of the chunk of joints.
#pragma once

#include "io/record/fields.h"
#include "io/record/recording.h"

namespace avbd::record {

/// A list for each field; empty where no joint has it. Terms are those of all couplings, one after the other.
class LinkColumns {
 public:
  LinkColumns() = default;
  /// Of a chunk with `count` joints. Throws FileError for lists that do not fit.
  LinkColumns(const FieldReader& f, size_t count);
  void add(const RecordedJoint& joint);
  /// Joint i of the chunk.
  void fill(size_t i, RecordedJoint& joint) const;
  void write(FieldWriter& out) const;
  /// Throws FileError where they name bodies, joints or coordinates that there are not.
  void check(const FieldReader& f, size_t bodies, size_t joints) const;

 private:
  void countTerms();
  std::vector<double> wheels_, rests_;
  std::vector<float> ratios_, factors_;
  std::vector<uint32_t> termCounts_, termJoints_, moreBodies_;
  std::vector<size_t> firstTerm_;
  std::vector<uint8_t> termAxes_, residuals_;
  std::vector<std::string> families_;
  bool any_ = false;  ///< joint that has some of it
};

}  // namespace avbd::record
