// Bodies as frames, shapes as primitives of their bodies' frames.
#include "io/record/mcap_messages.h"

#include <algorithm>
#include <optional>
#include <set>

#include "io/record/json.h"
#include "io/record/softs.h"

namespace avbd::record {
namespace {

constexpr std::string_view kSceneSchema =
    R"({"title":"foxglove.SceneUpdate","type":"object","properties":{"deletions":{"type":"array","items":{"type":"object","properties":{}}},"entities":{"type":"array","items":{"type":"object","properties":{"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},"frame_id":{"type":"string"},"id":{"type":"string"},"lifetime":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},"frame_locked":{"type":"boolean"},"metadata":{"type":"array","items":{"type":"object","properties":{}}},"arrows":{"type":"array","items":{"type":"object","properties":{}}},"cubes":{"type":"array","items":{"type":"object","properties":{}}},"spheres":{"type":"array","items":{"type":"object","properties":{}}},"cylinders":{"type":"array","items":{"type":"object","properties":{}}},"lines":{"type":"array","items":{"type":"object","properties":{}}},"triangles":{"type":"array","items":{"type":"object","properties":{}}},"texts":{"type":"array","items":{"type":"object","properties":{}}},"models":{"type":"array","items":{"type":"object","properties":{}}}}}}}})";
constexpr std::string_view kTransformsSchema =
    R"({"title":"foxglove.FrameTransforms","type":"object","properties":{"transforms":{"type":"array","items":{"type":"object","properties":{"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},"parent_frame_id":{"type":"string"},"child_frame_id":{"type":"string"},"translation":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"rotation":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}}})";
constexpr std::string_view kFiguresSchema =
    R"({"title":"avbd.Figures","type":"object","properties":{"kinetic_energy":{"type":"number"},"penetration_max":{"type":"number"},"joint_gap_max":{"type":"number"},"limit_excess_max":{"type":["number","null"]},"limit_excess_angle_max":{"type":["number","null"]},"contact_points":{"type":"integer"}}})";
constexpr std::string_view kContactsSchema =
    R"({"title":"avbd.Contacts","type":"object","properties":{"contacts":{"type":"array","items":{"type":"object","properties":{"position":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"force":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"normal":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},"separation":{"type":"number"},"body_a":{"type":"string"},"body_b":{"type":"string"}}}}}})";
constexpr std::string_view kEventsSchema =
    R"({"title":"avbd.Events","type":"object","properties":{"events":{"type":"array","items":{"type":"object","properties":{"kind":{"type":"string"},"body_a":{"type":"string"},"body_b":{"type":"string"},"speed":{"type":"number"},"impulse":{"type":"number"}}}}}})";

constexpr float kGroundHalf = 50;                       // [m] of the square that stands for a half-space
constexpr Quat kYToZ{0.70710678f, -0.70710678f, 0, 0};  // their cylinders stand along z, ours along y

std::string timeText(uint64_t nanoseconds) {
  constexpr uint64_t kSecond = 1'000'000'000;
  return "{\"sec\":" + std::to_string(nanoseconds / kSecond) + ",\"nsec\":" + std::to_string(nanoseconds % kSecond) +
         "}";
}

std::string poseText(const Pose& pose) {
  return "\"pose\":{\"position\":" + jsonObject(pose.position) + ",\"orientation\":" + jsonObject(pose.rotation) + "}";
}

std::string sizeText(Vec3 size) { return "\"size\":" + jsonObject(toDouble(size)); }

/// The primitives of one shape, in the lists of an entity.
class Primitives {
 public:
  Primitives(const Pose& pose, const std::string& color) : pose_(pose), color_(color) {}

  void operator()(const Sphere& s) { sphere(pose_, {2 * s.radius, 2 * s.radius, 2 * s.radius}); }
  void operator()(const Ellipsoid& s) { sphere(pose_, {2 * s.x, 2 * s.y, 2 * s.z}); }
  void operator()(const Capsule& s) {
    const float d = 2 * s.radius;
    cylinder({d, d, 2 * s.halfHeight}, 1);
    for (const double y : {-s.halfHeight, s.halfHeight}) sphere(pose_ * Pose{{0, y, 0}, {}}, {d, d, d});
  }
  void operator()(const Box& s) {
    const float r = s.rounding;
    cube(pose_, {2 * (s.x + r), 2 * (s.y + r), 2 * (s.z + r)});
  }
  void operator()(const Cylinder& s) {
    const float d = 2 * (s.radius + s.rounding);
    cylinder({d, d, 2 * (s.halfHeight + s.rounding)}, 1);
  }
  void operator()(const Cone& s) {
    const float d = 2 * (s.radius + s.rounding);
    cylinder({d, d, 2 * (s.halfHeight + s.rounding)}, s.rounding / (s.radius + s.rounding));
  }
  void operator()(const HalfSpace&) { cube(pose_ * Pose{{0, -0.05, 0}, {}}, {2 * kGroundHalf, 0.1f, 2 * kGroundHalf}); }
  void operator()(const Hull& s) {
    if (!s.data) return;
    std::vector<Vec3> corners;
    for (const HullData::Face& face : s.data->faces()) {
      const auto loop = s.data->loops().subspan(face.first, face.count);
      for (size_t i = 2; i < loop.size(); ++i)
        for (const uint8_t k : {loop[0], loop[i - 1], loop[i]}) corners.push_back(s.data->vertices()[k]);
    }
    triangles(corners, s.scale);
  }
  void operator()(const Mesh& s) { grid(s); }
  void operator()(const HeightField& s) { grid(s); }

  std::string text() const {
    return "\"cubes\":[" + cubes_ + "],\"spheres\":[" + spheres_ + "],\"cylinders\":[" + cylinders_ +
           "],\"triangles\":[" + triangles_ + "]";
  }

 private:
  static void add(std::string& list, const std::string& item) { list += (list.empty() ? "{" : ",{") + item + "}"; }

  void cube(const Pose& pose, Vec3 size) { add(cubes_, poseText(pose) + "," + sizeText(size) + "," + color_); }
  void sphere(const Pose& pose, Vec3 size) { add(spheres_, poseText(pose) + "," + sizeText(size) + "," + color_); }
  void cylinder(Vec3 size, float top) {
    add(cylinders_, poseText(pose_ * Pose{{}, kYToZ}) + "," + sizeText(size) +
                        ",\"bottom_scale\":1,\"top_scale\":" + jsonNumber(top) + "," + color_);
  }
  template <class Surface>
  void grid(const Surface& s) {
    if (!s.data) return;
    std::vector<Vec3> corners;
    for (uint32_t i = 0; i < s.data->triangleCount(); ++i)
      for (const Vec3& corner : s.data->triangle(i)) corners.push_back(corner);
    triangles(corners, s.scale);
  }
  void triangles(const std::vector<Vec3>& corners, Vec3 scale) {
    std::string points;
    for (const Vec3 c : corners)
      points.append(points.empty() ? "" : ",").append(jsonObject(Vec3d{c.x * scale.x, c.y * scale.y, c.z * scale.z}));
    add(triangles_, poseText(pose_) + ",\"points\":[" + points + "],\"colors\":[],\"indices\":[]," + color_);
  }

  Pose pose_;
  std::string color_, cubes_, spheres_, cylinders_, triangles_;
};

/// The file's own, opaque; else bodies differ by the golden ratio's steps around a simple colour wheel.
std::string colorText(const std::optional<Color>& given, uint32_t body, BodyType type, bool trigger) {
  const auto text = [&](double r, double g, double b) {
    return "\"color\":{\"r\":" + jsonNumber(r) + ",\"g\":" + jsonNumber(g) + ",\"b\":" + jsonNumber(b) +
           ",\"a\":" + (trigger ? "0.3" : "1") + "}";
  };
  if (given) return text(given->red / 255.0, given->green / 255.0, given->blue / 255.0);
  const double hue = type == BodyType::Static ? 0 : static_cast<double>(body * 618u % 1000u) / 1000;
  const auto channel = [&](double shift) {
    if (type == BodyType::Static) return 0.5;
    const double at = hue + shift, wrapped = at < 1 ? at : at - 1;
    const double wave = wrapped < 0.5 ? 2 * wrapped : 2 - 2 * wrapped;
    return 0.25 + 0.65 * wave;
  };
  return text(channel(0), channel(1.0 / 3), channel(2.0 / 3));
}

/// `frame` with its quotes.
std::string entityText(uint64_t nanoseconds, const std::string& frame, const std::string& id, bool locked,
                       const std::string& primitives) {
  return "{\"timestamp\":" + timeText(nanoseconds) + ",\"frame_id\":" + frame + ",\"id\":\"" + id +
         "\",\"lifetime\":{\"sec\":0,\"nsec\":0},\"frame_locked\":" + (locked ? "true" : "false") +
         ",\"metadata\":[],\"arrows\":[],\"lines\":[],\"texts\":[],\"models\":[]," + primitives + "}";
}

/// The triangles among a soft body's `corners`.
std::string indicesText(const RecordedSoft& soft, const std::vector<uint32_t>& corners) {
  std::string text = "\"indices\":[";
  for (const auto& face : soft.surface)
    for (const uint32_t point : face) {
      const auto at = std::lower_bound(corners.begin(), corners.end(), point) - corners.begin();
      text.append(text.back() == '[' ? "" : ",").append(std::to_string(at));
    }
  return text + "]";
}

}  // namespace

const std::array<McapTopic, 5>& mcapTopics() {
  static constexpr std::array<McapTopic, 5> kTopics{{
      {"/scene", "foxglove.SceneUpdate", kSceneSchema},
      {"/tf", "foxglove.FrameTransforms", kTransformsSchema},
      {"/figures", "avbd.Figures", kFiguresSchema},
      {"/contacts", "avbd.Contacts", kContactsSchema},
      {"/events", "avbd.Events", kEventsSchema},
  }};
  return kTopics;
}

McapMessages::McapMessages(const Recording& head) : head_(head) {
  std::set<std::string> taken{"world"};
  for (size_t i = 0; i < head.bodies.size(); ++i) {
    std::string name = head.bodies[i].name;
    if (name.empty()) name.append("body_").append(std::to_string(i));
    while (!taken.insert(name).second) name.append("#").append(std::to_string(i));
    frames_.push_back(jsonText(name));
  }
  for (const RecordedSoft& soft : head.softs) {
    corners_.push_back(surfacePoints(soft));
    triangles_.push_back(indicesText(soft, corners_.back()) + "," +
                         colorText(soft.color, soft.firstBody, BodyType::Dynamic, false));
  }
}

std::string McapMessages::scene(uint64_t nanoseconds) const {
  std::string out = "{\"deletions\":[],\"entities\":[";
  for (size_t i = 0; i < solidShapes(head_); ++i) {
    const RecordedShape& shape = head_.shapes[i];
    Primitives primitives(shape.pose, colorText(shape.color, shape.body, head_.bodies[shape.body].type, shape.trigger));
    std::visit(primitives, shape.geometry);
    out += std::string(i ? "," : "") +
           entityText(nanoseconds, frames_[shape.body], "shape_" + std::to_string(i), true, primitives.text());
  }
  return out + "]}";
}

std::string McapMessages::softs(const RecordedFrame& frame, uint64_t nanoseconds) const {
  std::string out = "{\"deletions\":[],\"entities\":[";
  for (size_t i = 0; i < head_.softs.size(); ++i) {
    const RecordedSoft& soft = head_.softs[i];
    const auto at = [&](size_t point) { return frame.poses[soft.firstBody + point].position; };
    const Vec3d origin = soft.points.empty() ? Vec3d{} : at(0);
    std::string points;
    for (const uint32_t point : corners_[i])
      points.append(points.empty() ? "" : ",").append(jsonObject(toDouble(toFloat(at(point) - origin))));
    const std::string surface = "\"cubes\":[],\"spheres\":[],\"cylinders\":[],\"triangles\":[{" +
                                poseText({origin, {}}) + ",\"points\":[" + points + "],\"colors\":[]," + triangles_[i] +
                                "}]";
    out +=
        std::string(i ? "," : "") + entityText(nanoseconds, "\"world\"", "soft_" + std::to_string(i), false, surface);
  }
  return out + "]}";
}

std::string McapMessages::transforms(const RecordedFrame& frame, uint64_t nanoseconds) const {
  std::string out = "{\"transforms\":[";
  const std::string head = "{\"timestamp\":" + timeText(nanoseconds) + ",\"parent_frame_id\":\"world\"";
  for (size_t i = 0; i < solidBodies(head_); ++i)
    out += std::string(i ? "," : "") + head + ",\"child_frame_id\":" + frames_[i] +
           ",\"translation\":" + jsonObject(frame.poses[i].position) +
           ",\"rotation\":" + jsonObject(frame.poses[i].rotation) + "}";
  return out + "]}";
}

std::string McapMessages::figures(const RecordedFrame& f) const {
  return "{\"kinetic_energy\":" + jsonNumber(f.kineticEnergy) + ",\"penetration_max\":" + jsonNumber(f.penetrationMax) +
         ",\"joint_gap_max\":" + jsonNumber(f.jointGapMax) + ",\"limit_excess_max\":" + jsonNumber(f.limitExcessMax) +
         ",\"limit_excess_angle_max\":" + jsonNumber(f.limitExcessAngleMax) +
         ",\"contact_points\":" + std::to_string(f.contacts.size() + f.contactsLeftOut) + "}";
}

std::string McapMessages::contacts(const RecordedFrame& f) const {
  const auto body = [&](uint32_t shape) {
    return shape < head_.shapes.size() ? frames_[head_.shapes[shape].body] : std::string("\"\"");
  };
  std::string out = "{\"contacts\":[";
  for (size_t i = 0; i < f.contacts.size(); ++i) {
    const RecordedContact& c = f.contacts[i];
    out += std::string(i ? "," : "") + "{\"position\":" + jsonObject(c.position) +
           ",\"force\":" + jsonObject(toDouble(c.force)) + ",\"normal\":" + jsonObject(toDouble(c.normal)) +
           ",\"separation\":" + jsonNumber(c.separation) + ",\"body_a\":" + body(c.shapeA) +
           ",\"body_b\":" + body(c.shapeB) + "}";
  }
  return out + "]}";
}

std::string McapMessages::events(const RecordedFrame& f) const {
  const auto body = [&](uint32_t shape) {
    return shape < head_.shapes.size() ? frames_[head_.shapes[shape].body] : std::string("\"\"");
  };
  std::string out = "{\"events\":[";
  for (size_t i = 0; i < f.events.size(); ++i) {
    const RecordedEvent& e = f.events[i];
    out += std::string(i ? "," : "") + "{\"kind\":\"" + std::string(eventName(e.kind)) +
           "\",\"body_a\":" + body(e.shapeA) + ",\"body_b\":" + body(e.shapeB) + ",\"speed\":" + jsonNumber(e.speed) +
           ",\"impulse\":" + jsonNumber(e.impulse) + "}";
  }
  return out + "]}";
}

}  // namespace avbd::record
