// Writes a recording as one HTML file: the bundled viewer, a JSON head, and the frames in base64.
#include "viewer/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "io/record/content.h"
#include "io/record/softs.h"
#include "viewer/encode.h"
#include "viewer/head.h"
#include "viewer/surface.h"

namespace avbd {

/// dist/viewer.js as the build found it.
std::string_view viewerScript();

namespace {

using page::append;
using page::Bounds;
using page::Bytes;
using page::Head;
using page::isFinite;
using page::jsonText;
using page::Range;

/// A script element holds this much at most: browsers limit the length of one text.
constexpr size_t kChunkBytes = 6u << 20;

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& range) {
  throw std::invalid_argument("Recording." + field + " = " + value + ": " + range);
}

std::string element(const char* list, size_t index, const char* field) {
  return std::string(list) + "[" + std::to_string(index) + "]." + field;
}

void checkFrames(const Recording& r) {
  if (r.frames.empty()) refuse("frames", "0", "must hold at least one frame");
  double before = -std::numeric_limits<double>::infinity();
  const size_t residuals = residualCount(r);
  for (size_t i = 0; i < r.frames.size(); ++i) {
    const RecordedFrame& f = r.frames[i];
    if (!(f.time >= before) || !std::isfinite(f.time)) {
      refuse(element("frames", i, "time"), std::to_string(f.time), "must be finite and not before the last frame");
    }
    before = f.time;
    if (f.poses.size() != r.bodies.size()) {
      refuse(element("frames", i, "poses"), std::to_string(f.poses.size()),
             "must hold a pose for each of the " + std::to_string(r.bodies.size()) + " bodies");
    }
    if (!f.joints.empty() && f.joints.size() != r.joints.size()) {
      refuse(element("frames", i, "joints"), std::to_string(f.joints.size()),
             "must be one for each of the " + std::to_string(r.joints.size()) + " joints, or none");
    }
    if (!f.residuals.empty() && f.residuals.size() != residuals) {
      refuse(element("frames", i, "residuals"), std::to_string(f.residuals.size()),
             "must be the " + std::to_string(residuals) + " of all joints, or none");
    }
  }
}

void check(const Recording& r) {
  const float up = length(r.up);
  if (!(up > 0) || !std::isfinite(up)) refuse("up", "zero or not finite", "must be a direction");
  const std::string range = "must be below the number of bodies, " + std::to_string(r.bodies.size());
  for (size_t i = 0; i < r.shapes.size(); ++i) {
    const uint32_t body = r.shapes[i].body;
    if (body >= r.bodies.size()) refuse(element("shapes", i, "body"), std::to_string(body), range);
  }
  for (size_t i = 0; i < r.joints.size(); ++i) {
    const RecordedJoint& joint = r.joints[i];
    for (const uint32_t body : {joint.bodyA, joint.bodyB, joint.moreBodies[0], joint.moreBodies[1]}) {
      if (body != kNotRecorded && body >= r.bodies.size())
        refuse(element("joints", i, "body"), std::to_string(body), range);
    }
  }
  checkSofts(r);
  checkFrames(r);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The page computes in float about this point, the middle of the crowd; zero unless the scene lies far out.
Vec3d originOf(const Recording& r) {
  std::vector<double> x, y, z;
  for (size_t i = 0; i < r.bodies.size(); ++i) {
    const Vec3d p = r.frames[0].poses[i].position;
    if (r.bodies[i].type == BodyType::Static || !isFinite(p)) continue;
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  if (x.empty()) return {};
  const Vec3d middle{median(std::move(x)), median(std::move(y)), median(std::move(z))};
  return length(middle) < 1000 ? Vec3d{} : middle;
}

/// Bodies that move and are no points of soft bodies, and the range of each one's coordinates.
struct Tracks {
  std::vector<uint32_t> bodies;
  std::vector<std::array<Range, 3>> ranges;
  std::vector<int32_t> trackOfBody;  ///< -1: never moves
  std::vector<float> stillPoses;     ///< of those, about the origin
};

Tracks findTracks(const Recording& r, Vec3d origin) {
  Tracks t;
  t.trackOfBody.assign(solidBodies(r), -1);
  for (uint32_t body = 0; body < solidBodies(r); ++body) {
    const Pose& first = r.frames[0].poses[body];
    Bounds bounds;
    bool moves = false;
    for (const RecordedFrame& f : r.frames) {
      bounds.add(f.poses[body].position);
      moves = moves || !(f.poses[body] == first);
    }
    if (moves) {
      t.trackOfBody[body] = static_cast<int32_t>(t.bodies.size());
      t.bodies.push_back(body);
      t.ranges.push_back(bounds.ranges());
    } else {
      append(t.stillPoses, toFloat(isFinite(first.position) ? first.position - origin : Vec3d{}));
      append(t.stillPoses, first.rotation);
    }
  }
  return t;
}

/// The largest number of contacts a frame may keep so that all frames together keep at most `budget`.
size_t contactsPerFrame(const Recording& r, size_t budget) {
  size_t low = 0, high = 0;
  for (const RecordedFrame& f : r.frames) high = std::max(high, f.contacts.size());
  while (low < high) {
    const size_t middle = low + (high - low + 1) / 2;
    size_t kept = 0;
    for (const RecordedFrame& f : r.frames) kept += std::min(middle, f.contacts.size());
    (kept <= budget ? low : high) = kept <= budget ? middle : middle - 1;
  }
  return low;
}

std::vector<RecordedContact> strongest(const std::vector<RecordedContact>& all, size_t count) {
  if (all.size() <= count) return all;
  std::vector<std::pair<float, uint32_t>> order(all.size());
  for (uint32_t i = 0; i < all.size(); ++i) {
    const float force = length(all[i].force);
    order[i] = {std::isfinite(force) ? -force : 0, i};
  }
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<RecordedContact> kept;
  for (size_t i = 0; i < count; ++i) kept.push_back(all[order[i].second]);
  return kept;
}

void writeBodies(Head& head, const Recording& r, const Tracks& tracks) {
  std::vector<uint8_t> types;
  const auto bodies = std::span(r.bodies).first(solidBodies(r));
  for (const RecordedBody& body : bodies) types.push_back(static_cast<uint8_t>(body.type));
  head.list("names", bodies, [](std::ostream& out, const RecordedBody& body) { out << jsonText(body.name); });
  head.numbers("types", types);
  head.numbers("tracks", tracks.trackOfBody);
  head.numbers("still", tracks.stillPoses);
  std::vector<double> ranges;
  for (const auto& track : tracks.ranges) {
    for (const Range& axis : track) ranges.insert(ranges.end(), {axis.low, axis.step});
  }
  head.numbers("ranges", ranges);
}

using Size = std::array<float, 4>;
Size sizeOf(const Sphere& s) { return {s.radius}; }
Size sizeOf(const Capsule& s) { return {s.radius, s.halfHeight}; }
Size sizeOf(const Box& s) { return {s.x, s.y, s.z, s.rounding}; }
Size sizeOf(const HalfSpace&) { return {}; }
Size sizeOf(const Cylinder& s) { return {s.radius, s.halfHeight, 0, s.rounding}; }
Size sizeOf(const Cone& s) { return {s.radius, s.halfHeight, 0, s.rounding}; }
Size sizeOf(const Ellipsoid& s) { return {s.x, s.y, s.z}; }
Size sizeOf(const Hull& s) { return {s.scale.x, s.scale.y, s.scale.z, s.rounding}; }
Size sizeOf(const Mesh& s) { return {s.scale.x, s.scale.y, s.scale.z}; }
Size sizeOf(const HeightField& s) { return {s.scale.x, s.scale.y, s.scale.z}; }

void writeShapes(Head& head, const Recording& r) {
  std::vector<uint32_t> bodies;
  std::vector<uint8_t> kinds, triggers;
  std::vector<int32_t> numbers;
  std::vector<float> sizes, poses;
  std::vector<uint8_t> colors;
  bool anyColor = false;
  record::Surfaces surfaces;
  for (const RecordedShape& shape : std::span(r.shapes).first(solidShapes(r))) {
    const Size size = std::visit([](const auto& geometry) { return sizeOf(geometry); }, shape.geometry);
    bodies.push_back(shape.body);
    kinds.push_back(static_cast<uint8_t>(shape.geometry.index()));  // src/recording.js: kKinds
    triggers.push_back(shape.trigger ? 1 : 0);
    numbers.push_back(static_cast<int32_t>(surfaces.add(shape.geometry)));
    sizes.insert(sizes.end(), size.begin(), size.end());
    append(poses, toFloat(shape.pose.position));
    append(poses, shape.pose.rotation);
    const Color color = shape.color.value_or(Color{});
    colors.insert(colors.end(), {color.red, color.green, color.blue, static_cast<uint8_t>(shape.color ? 1 : 0)});
    anyColor = anyColor || shape.color;
  }
  if (anyColor) head.numbers("shapeColors", colors);
  head.numbers("shapeBodies", bodies);
  head.numbers("shapeKinds", kinds);
  head.numbers("shapeSizes", sizes);
  head.numbers("shapePoses", poses);
  head.numbers("shapeSurfaces", numbers);
  head.numbers("shapeTriggers", triggers);
  head.list("surfaces", surfaces.all(), [](std::ostream& out, const auto& data) { page::writeSurface(out, data); });
}

void writeFigures(Head& head, const Recording& r, size_t contactsKept) {
  std::vector<double> times;
  std::vector<float> energy, penetration, gap, excess, excessAngle;
  std::vector<uint32_t> kept, all;
  for (const RecordedFrame& f : r.frames) {
    times.push_back(f.time);
    energy.push_back(static_cast<float>(f.kineticEnergy));
    penetration.push_back(static_cast<float>(f.penetrationMax));
    gap.push_back(static_cast<float>(f.jointGapMax));
    excess.push_back(static_cast<float>(f.limitExcessMax));
    excessAngle.push_back(static_cast<float>(f.limitExcessAngleMax));
    all.push_back(static_cast<uint32_t>(f.contacts.size()) + f.contactsLeftOut);
    kept.push_back(static_cast<uint32_t>(std::min(f.contacts.size(), contactsKept)));
  }
  head.numbers("times", times);
  head.numbers("energy", energy);
  head.numbers("penetration", penetration);
  head.numbers("gap", gap);
  head.numbers("excess", excess);
  head.numbers("excessAngle", excessAngle);
  head.numbers("contactsAll", all);
  head.numbers("contactsKept", kept);
  head.list("report", r.report, [](std::ostream& out, const auto& line) {
    out << '[' << jsonText(line.first) << ',' << jsonText(line.second) << ']';
  });
}

std::array<Range, 3> contactRanges(const Recording& r) {
  Bounds bounds;
  for (const RecordedFrame& f : r.frames) {
    for (const RecordedContact& c : f.contacts) bounds.add(c.position);
  }
  return bounds.ranges();
}

/// Whether frames say what joints did.
bool hasJointStates(const Recording& r) {
  return std::any_of(r.frames.begin(), r.frames.end(), [](const RecordedFrame& f) { return !f.joints.empty(); });
}

// A frame that does not say shows no forces, and residuals that are no numbers.
void appendJoints(Bytes& bytes, const Recording& r, const RecordedFrame& f) {
  for (size_t i = 0; i < r.joints.size(); ++i) {
    const RecordedJointState state = f.joints.empty() ? RecordedJointState{} : f.joints[i];
    page::appendJoint(bytes, -state.reaction.force, state.enabled);
  }
  std::vector<float> residuals = f.residuals;
  residuals.resize(residualCount(r), NAN);
  for (const float residual : residuals) page::appendFloat(bytes, residual);
}

/// The frames' bytes in script elements of a few megabytes, each a whole number of frames.
void writeFrames(std::ostream& out, const Recording& r, const Tracks& tracks, size_t contactsKept) {
  const page::PlaceRanges places = page::placeRangesOf(r);
  std::vector<Vec3d> lastPlaces(pointCount(r));
  const std::array<Range, 3> contactRange = contactRanges(r);
  std::vector<Pose> last(tracks.bodies.size());  // a pose that is not finite shows as the one before
  const bool joints = hasJointStates(r);
  Bytes bytes;
  const auto flush = [&](size_t nextFrame) {
    out << "<script type=\"text/plain\" class=\"avbd-frames\" data-end=\"" << nextFrame << "\">" << page::base64(bytes)
        << "</script>\n";
    bytes.clear();
  };
  for (size_t i = 0; i < r.frames.size(); ++i) {
    const RecordedFrame& f = r.frames[i];
    for (size_t t = 0; t < tracks.bodies.size(); ++t) {
      const Pose& pose = f.poses[tracks.bodies[t]];
      if (isFinite(pose.position)) last[t] = pose;
      appendPose(bytes, tracks.ranges[t].data(), last[t]);
    }
    page::appendPlaces(bytes, r, f, places, lastPlaces);
    if (joints) appendJoints(bytes, r, f);
    for (const RecordedContact& c : strongest(f.contacts, contactsKept)) {
      appendContact(bytes, contactRange.data(), c.position, c.force);
    }
    if (bytes.size() >= kChunkBytes) flush(i + 1);
  }
  flush(r.frames.size());
}

void writePlace(Head& head, const Recording& r, Vec3d origin) {
  head.text("title", r.title);
  head.numbers("up", std::vector<float>{r.up.x, r.up.y, r.up.z});
  head.numbers("origin", std::vector<double>{origin.x, origin.y, origin.z});
}

void writeHead(std::ostream& out, const Recording& r, const Tracks& tracks, Vec3d origin, size_t contactsKept) {
  Head head(out);
  writePlace(head, r, origin);
  std::vector<double> contactRange;
  for (const Range& axis : contactRanges(r)) contactRange.insert(contactRange.end(), {axis.low, axis.step});
  head.numbers("contactRange", contactRange);
  writeBodies(head, r, tracks);
  writeShapes(head, r);
  page::writeSofts(head, r, page::placeRangesOf(r));
  page::writeJoints(head, r);
  head.numbers("jointStates", std::vector<uint8_t>{static_cast<uint8_t>(hasJointStates(r))});
  writeFigures(head, r, contactsKept);
}

/// All bodies that could move have a track.
Tracks liveTracks(const Recording& r, Vec3d origin) {
  Tracks t;
  for (uint32_t body = 0; body < solidBodies(r); ++body) {
    const bool moves = r.bodies[body].type != BodyType::Static;
    t.trackOfBody.push_back(moves ? static_cast<int32_t>(t.bodies.size()) : -1);
    if (moves) {
      t.bodies.push_back(body);
      continue;
    }
    const Pose& pose = r.frames[0].poses[body];
    append(t.stillPoses, toFloat(isFinite(pose.position) ? pose.position - origin : Vec3d{}));
    append(t.stillPoses, pose.rotation);
  }
  return t;
}

// The policy lets the page reach nothing but itself, and a live one the server that it came from.
constexpr char kTop[] = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="avbd">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:)";
constexpr char kTitle[] = R"(">
<title>)";
constexpr char kMiddle[] = R"(</title>
<style>html{background:#12161c;color:#d7dee8;font-family:system-ui,sans-serif}@media(prefers-color-scheme:light){html{background:#eef1f5;color:#1d2530}}</style>
</head>
<body>
<noscript>This page plays a recorded simulation and needs JavaScript.</noscript>
<script type="application/json" id="avbd-head">
)";

}  // namespace

void writePage(std::ostream& out, const Recording& recording, const PageOptions& options) {
  check(recording);
  const Vec3d origin = originOf(recording);
  const Tracks tracks = findTracks(recording, origin);
  const size_t contactsKept = contactsPerFrame(recording, options.contactsMax);
  out << kTop << kTitle << page::htmlText(recording.title.empty() ? "AVBD" : recording.title) << kMiddle;
  writeHead(out, recording, tracks, origin, contactsKept);
  out << "</script>\n";
  writeFrames(out, recording, tracks, contactsKept);
  out << "<script>" << viewerScript() << "</script>\n</body>\n</html>\n";
}

void writePage(const std::filesystem::path& file, const Recording& recording, const PageOptions& options) {
  check(recording);
  std::ofstream out(file, std::ios::binary);
  if (!out) throw std::runtime_error(file.string() + ": cannot be opened for writing");
  writePage(out, recording, options);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": could not be written");
}

void writeLivePage(std::ostream& out, uint16_t port) {
  out << kTop << "; connect-src 'self' ws://127.0.0.1:" << port << " ws://localhost:" << port << kTitle << "AVBD"
      << kMiddle << "{\"live\":true}</script>\n<script>" << viewerScript() << "</script>\n</body>\n</html>\n";
}

page::LiveHead page::liveHead(const Recording& recording) {
  check(recording);
  const Vec3d origin = originOf(recording);
  std::ostringstream out;
  {
    Head head(out);
    writePlace(head, recording, origin);
    head.numbers("contactRange", std::vector<double>{});
    writeBodies(head, recording, liveTracks(recording, origin));
    writeShapes(head, recording);
    page::writeSofts(head, recording, {});
    page::writeJoints(head, recording);
    Recording none;
    none.report = recording.report;
    writeFigures(head, none, 0);
  }
  return {out.str(), origin};
}

}  // namespace avbd
