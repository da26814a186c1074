// Soft bodies of a recording: their points are its last bodies, the balls on their surfaces its last shapes.
#pragma once

#include "io/record/recording.h"

namespace avbd {

/// Adds a soft body with its bodies ("name_0" ...) and shapes. Sets firstBody and firstShape, and `step` where it is 0:
/// about a millionth of the body's size. Bodies and shapes that are no points' must be there before.
void appendSoft(Recording& recording, RecordedSoft soft);
/// Points that are corners of the surface, ascending: the ball on surfacePoints[i] is shape firstShape + i.
std::vector<uint32_t> surfacePoints(const RecordedSoft& soft);
/// Throws std::invalid_argument where `softs` does not fit itself, the bodies or the shapes.
void checkSofts(const Recording& recording);

/// How many bodies and shapes stand before those of soft bodies.
inline size_t solidBodies(const Recording& r) { return r.softs.empty() ? r.bodies.size() : r.softs[0].firstBody; }
inline size_t solidShapes(const Recording& r) { return r.softs.empty() ? r.shapes.size() : r.softs[0].firstShape; }
/// Points of all soft bodies.
inline size_t pointCount(const Recording& r) { return r.bodies.size() - solidBodies(r); }
/// The soft body of which this body is a point; null: none.
const RecordedSoft* softOf(const Recording& recording, uint32_t body);

namespace record {

/// A coordinate in steps, to the nearest; what is no number or beyond 2^62 steps as far as that goes.
int64_t stepsOf(double x, double step);

/// Each number of a frame less what the same number of the two frames before lets expect: its last change again. What a
/// field of points holds, coded against the point before: neighbours accelerate alike. `each` numbers a frame; wraps.
std::vector<int64_t> secondDifferences(const std::vector<int64_t>& places, size_t each);
std::vector<int64_t> sumsOf(std::vector<int64_t> differences, size_t each);  ///< back

}  // namespace record
}  // namespace avbd
