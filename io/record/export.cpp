// CSV and JSON.
#include "io/record/export.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "io/record/json.h"

namespace avbd {

using namespace record;

namespace {

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

template <class T>
void appendNumber(std::string& to, T value) {
  char text[32];
  to += ',';
  to.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string quatList(Quat q) {
  std::string out = "[";
  for (const float x : {q.w, q.x, q.y, q.z}) out.append(out.size() > 1 ? "," : "").append(jsonNumber(x));
  return out.append("]");
}

std::string indexText(uint32_t index) { return index == kNotRecorded ? "null" : std::to_string(index); }

/// Prints elements with commas between them.
template <class List, class Print>
void printList(std::ostream& out, const char* name, const List& list, Print print) {
  out << '"' << name << "\":[";
  const char* comma = "";
  for (const auto& item : list) {
    out << comma;
    print(item);
    comma = ",";
  }
  out << ']';
}

void printSize(std::ostream& out, const Geometry& geometry) {
  const auto one = [&](const char* name, float value) { out << ",\"" << name << "\":" << jsonNumber(value); };
  std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.radius; }) one("radius", s.radius);
        if constexpr (requires { s.halfHeight; }) one("halfHeight", s.halfHeight);
        if constexpr (requires { s.x; }) out << ",\"half\":" << jsonList(Vec3{s.x, s.y, s.z});
        if constexpr (requires { s.scale; }) out << ",\"scale\":" << jsonList(s.scale);
        if constexpr (requires { s.rounding; }) one("rounding", s.rounding);
      },
      geometry);
}

void printSurface(std::ostream& out, const Surfaces::Data& data) {
  const auto print = [&](const auto& v) { out << v; };
  if (const auto* hull = std::get_if<0>(&data)) {
    printList(out << '{', "vertices", (*hull)->vertices(), [&](Vec3 v) { out << jsonList(v); });
    printList(out << ',', "faces", (*hull)->faces(), [&](const HullData::Face& face) {
      const char* comma = "[";
      for (const uint8_t i : (*hull)->loops().subspan(face.first, face.count)) {
        out << comma << static_cast<int>(i);
        comma = ",";
      }
      out << ']';
    });
  } else if (const auto* mesh = std::get_if<1>(&data)) {
    out << "{\"triangles\":[";
    for (uint32_t i = 0; i < (*mesh)->triangleCount(); ++i) {
      const auto corners = (*mesh)->triangle(i);
      out << (i ? "," : "") << '[' << jsonList(corners[0]) << ',' << jsonList(corners[1]) << ',' << jsonList(corners[2])
          << ']';
    }
    out << ']';
  } else {
    const HeightFieldData& field = *std::get<2>(data);
    std::vector<std::string> heights;
    for (int row = 0; row < field.rows(); ++row)
      for (int column = 0; column < field.columns(); ++column) heights.push_back(jsonNumber(field.height(column, row)));
    out << "{\"columns\":" << field.columns() << ",\"rows\":" << field.rows() << ",\"spacing\":["
        << jsonNumber(field.spacingX()) << ',' << jsonNumber(field.spacingZ()) << "],";
    printList(out, "heights", heights, print);
  }
  out << '}';
}

constexpr const char* kAxes[] = {"linear_x", "linear_y", "linear_z", "twist", "swing_y", "swing_z"};

/// What only pulleys, couplings and custom joints have.
void printLink(std::ostream& out, const RecordedJoint& joint) {
  if (joint.type == JointType::Pulley)
    out << ",\"wheels\":[" << jsonList(joint.wheels[0]) << ',' << jsonList(joint.wheels[1])
        << "],\"ratio\":" << jsonNumber(joint.ratio);
  if (joint.type == JointType::Coupling) {
    printList(out << ',', "terms", joint.terms, [&](const RecordedTerm& term) {
      out << "{\"joint\":" << indexText(term.joint) << ",\"axis\":\"" << kAxes[static_cast<size_t>(term.axis)] << "\",";
      printList(out, "factors", term.factors, [&](float factor) { out << jsonNumber(factor); });
      out << '}';
    });
    out << ",\"rest\":" << jsonNumber(joint.rest);
  }
  if (joint.type == JointType::Custom)
    out << ",\"family\":" << jsonText(joint.family) << ",\"bodyC\":" << indexText(joint.moreBodies[0])
        << ",\"bodyD\":" << indexText(joint.moreBodies[1]);
  if (joint.residuals > 0) out << ",\"residuals\":" << +joint.residuals;
}

void printSoft(std::ostream& out, const RecordedSoft& soft) {
  out << "{\"name\":" << jsonText(soft.name) << ",\"cloth\":" << (soft.cloth ? "true" : "false")
      << ",\"firstBody\":" << soft.firstBody << ",\"elements\":" << soft.elements << ',';
  printList(out, "points", soft.points, [&](Vec3 point) { out << jsonList(point); });
  printList(out << ',', "surface", soft.surface,
            [&](const auto& face) { out << '[' << face[0] << ',' << face[1] << ',' << face[2] << ']'; });
  out << '}';
}

/// What is known of a joint beyond its anchors; null is a limit that there is not.
void printJointForm(std::ostream& out, const RecordedJoint& joint) {
  out << ",\"type\":\"" << jointTypeName(*joint.type) << "\",\"name\":" << jsonText(joint.name)
      << ",\"rotationA\":" << quatList(joint.frameA.rotation) << ",\"rotationB\":" << quatList(joint.frameB.rotation)
      << ",\"free\":[";
  const char* comma = "";
  for (size_t i = 0; i < 6; ++i) {
    if (!(joint.freeAxes >> i & 1)) continue;
    out << comma << '"' << kAxes[i] << '"';
    comma = ",";
  }
  out << ']';
  printList(out << ',', "limits", joint.limits, [&](const RecordedLimit& limit) {
    out << '[' << jsonNumber(limit.lower) << ',' << jsonNumber(limit.upper) << ']';
  });
  out << ",\"cone\":[" << jsonNumber(joint.coneY) << ',' << jsonNumber(joint.coneZ) << ']';
  printLink(out, joint);
}

void printHead(std::ostream& out, const Recording& head) {
  out << "{\"title\":" << jsonText(head.title) << ",\"engine\":" << jsonText(head.engine)
      << ",\"up\":" << jsonList(head.up) << ",\"dt\":" << jsonNumber(head.dt);
  printList(out << ",\n", "bodies", head.bodies, [&](const RecordedBody& body) {
    out << "{\"name\":" << jsonText(body.name) << ",\"type\":\"" << bodyTypeName(body.type) << "\"}";
  });
  Surfaces surfaces;
  printList(out << ",\n", "shapes", head.shapes, [&](const RecordedShape& shape) {
    out << "{\"body\":" << shape.body << ",\"kind\":\"" << geometryName(shape.geometry) << '"';
    printSize(out, shape.geometry);
    if (const uint32_t number = surfaces.add(shape.geometry); number != kNotRecorded) out << ",\"surface\":" << number;
    out << ",\"position\":" << jsonList(shape.pose.position) << ",\"rotation\":" << quatList(shape.pose.rotation)
        << (shape.trigger ? ",\"trigger\":true" : "");
    if (const auto& c = shape.color)
      out << ",\"color\":[" << +c->red << ',' << +c->green << ',' << +c->blue << ',' << +c->alpha << ']';
    out << '}';
  });
  printList(out << ",\n", "surfaces", surfaces.all(), [&](const Surfaces::Data& data) { printSurface(out, data); });
  printList(out << ",\n", "joints", head.joints, [&](const RecordedJoint& joint) {
    out << "{\"bodyA\":" << indexText(joint.bodyA) << ",\"bodyB\":" << indexText(joint.bodyB)
        << ",\"anchorA\":" << jsonList(joint.frameA.position) << ",\"anchorB\":" << jsonList(joint.frameB.position);
    if (joint.type) printJointForm(out, joint);
    out << '}';
  });
  printList(out << ",\n", "softs", head.softs, [&](const RecordedSoft& soft) { printSoft(out, soft); });
  printList(out << ",\n", "report", head.report,
            [&](const auto& line) { out << '[' << jsonText(line.first) << ',' << jsonText(line.second) << ']'; });
}

void printFrame(std::ostream& out, const RecordedFrame& f) {
  out << "{\"time\":" << jsonNumber(f.time) << ",\"kineticEnergy\":" << jsonNumber(f.kineticEnergy)
      << ",\"penetrationMax\":" << jsonNumber(f.penetrationMax) << ",\"jointGapMax\":" << jsonNumber(f.jointGapMax)
      << ",\"limitExcessMax\":" << jsonNumber(f.limitExcessMax)
      << ",\"limitExcessAngleMax\":" << jsonNumber(f.limitExcessAngleMax);
  printList(out << ',', "positions", f.poses, [&](const Pose& pose) { out << jsonList(pose.position); });
  printList(out << ',', "rotations", f.poses, [&](const Pose& pose) { out << quatList(pose.rotation); });
  printList(out << ',', "linear", f.velocities, [&](const Velocity& v) { out << jsonList(v.linear); });
  printList(out << ',', "angular", f.velocities, [&](const Velocity& v) { out << jsonList(v.angular); });
  printList(out << ',', "joints", f.joints, [&](const RecordedJointState& joint) {
    out << "{\"force\":" << jsonList(joint.reaction.force) << ",\"torque\":" << jsonList(joint.reaction.torque)
        << ",\"enabled\":" << (joint.enabled ? "true" : "false") << '}';
  });
  printList(out << ',', "residuals", f.residuals, [&](float value) { out << jsonNumber(value); });
  printList(out << ',', "contacts", f.contacts, [&](const RecordedContact& c) {
    out << "{\"position\":" << jsonList(c.position) << ",\"force\":" << jsonList(c.force)
        << ",\"normal\":" << jsonList(c.normal) << ",\"separation\":" << jsonNumber(c.separation)
        << ",\"shapeA\":" << indexText(c.shapeA) << ",\"shapeB\":" << indexText(c.shapeB) << '}';
  });
  printList(out << ',', "events", f.events, [&](const RecordedEvent& e) {
    out << "{\"kind\":\"" << eventName(e.kind) << "\",\"shapeA\":" << indexText(e.shapeA)
        << ",\"shapeB\":" << indexText(e.shapeB);
    if (!(e.normal == Vec3{}))
      out << ",\"position\":" << jsonList(e.position) << ",\"normal\":" << jsonList(e.normal)
          << ",\"impulse\":" << jsonNumber(e.impulse);
    if (e.kind == RecordedEventKind::Hit) out << ",\"speed\":" << jsonNumber(e.speed);
    out << '}';
  });
  out << '}';
}

}  // namespace

std::vector<std::string> eachFrame(RecordReader& reader, const std::function<bool(const RecordedFrame&)>& use) {
  std::vector<std::string> leftOut;
  std::string why;
  uint64_t first = 0;
  const auto say = [&](uint64_t end) {
    if (!why.empty())
      leftOut.push_back("frames " + std::to_string(first) + " to " + std::to_string(end - 1) + " are left out: " + why);
    why.clear();
  };
  const uint64_t count = reader.frameCount();
  for (uint64_t i = 0; i < count; ++i) {
    std::optional<RecordedFrame> frame;
    try {
      frame = reader.frame(i);
    } catch (const FileError& e) {
      if (why == e.what()) continue;
      say(i);
      why = e.what();
      first = i;
    }
    if (!frame) continue;
    say(i);
    if (!use(*frame)) return leftOut;
  }
  say(count);
  return leftOut;
}

std::vector<std::string> exportCsv(RecordReader& reader, std::ostream& out) {
  std::vector<std::string> names;
  for (const RecordedBody& body : reader.head().bodies) names.push_back(csvField(body.name));
  out << "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  std::string rows;
  return eachFrame(reader, [&](const RecordedFrame& f) {
    rows.clear();
    for (size_t i = 0; i < names.size(); ++i) {
      const auto& [p, q] = f.poses[i];
      std::string time;
      appendNumber(time, f.time);
      rows += time.substr(1) + "," + names[i];
      for (const double v : {p.x, p.y, p.z}) appendNumber(rows, v);
      for (const float v : {q.w, q.x, q.y, q.z}) appendNumber(rows, v);
      if (f.velocities.empty() || std::isnan(f.velocities[i].linear.x)) {
        rows += ",,,,,,\n";
        continue;
      }
      const auto& [l, w] = f.velocities[i];
      for (const float v : {l.x, l.y, l.z, w.x, w.y, w.z}) appendNumber(rows, v);
      rows += '\n';
    }
    return static_cast<bool>(out << rows);
  });
}

std::vector<std::string> exportJson(RecordReader& reader, std::ostream& out) {
  printHead(out, reader.head());
  out << ",\n\"frames\":[";
  const char* comma = "\n";
  std::vector<std::string> leftOut = eachFrame(reader, [&](const RecordedFrame& f) {
    printFrame(out << comma, f);
    comma = ",\n";
    return static_cast<bool>(out);
  });
  out << "]}\n";
  return leftOut;
}

}  // namespace avbd
