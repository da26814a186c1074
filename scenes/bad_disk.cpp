// Broken files that need others beside them, and torn recordings (bad_input.h).
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "io/record/writer.h"
#include "scenes/bad_input.h"

namespace avbd::scenes {
namespace {

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

/// A height field's file: rows, columns, heights.
std::string heights(int32_t rows, int32_t columns, const std::string& values) {
  return raw<int32_t>({rows, columns}) + values;
}

std::vector<BadFile> badMjcf() {
  const std::string mesh =
      "<mujoco><asset><mesh name='m' file='m.obj'/></asset><worldbody>"
      "<geom type='mesh' mesh='m'/></worldbody></mujoco>";
  const std::string field =
      "<mujoco><asset><hfield name='h' file='h.bin' size='1 1 1 1'/></asset><worldbody>"
      "<geom type='hfield' hfield='h'/></worldbody></mujoco>";
  const std::string four = raw<float>({0, 1, 0, 1});
  const std::string nan = raw<float>({0, 1, std::numeric_limits<float>::quiet_NaN(), 1});
  const std::string include = "<mujoco><include file='bad.xml'/></mujoco>";
  const std::string bomb =
      "<!DOCTYPE mujoco [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
      "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;\">]>\n<mujoco><option timestep=\"&c;\"/></mujoco>";
  return {{"mjcf", mesh, {"mesh \"m\"", "file = \"m.obj\"", "no such file"}, {}, true},
          {"mjcf", mesh, {"mesh \"m\"", "m.obj:2", "v.x = \"nan\""}, {{"m.obj", "v 0 0 0\nv nan 0 0\n"}}},
          {"mjcf", mesh, {"mesh \"m\"", "without faces", "points = 2 points"}, {{"m.obj", "v 0 0 0\nv 1 0 0\n"}}},
          {"mjcf", field, {"file = \"h.bin\"", "no such file"}, {}, true},
          {"mjcf", field, {"h.bin", "size = 3", "8 bytes"}, {{"h.bin", "abc"}}},
          {"mjcf", field, {"h.bin", "size = 20", "24 bytes"}, {{"h.bin", heights(2, 2, four.substr(0, 12))}}},
          {"mjcf", field, {"h.bin", "rows = 1", "2 .. 32768"}, {{"h.bin", heights(1, 4, four)}}},
          {"mjcf", field, {"h.bin", "rows = 4294967295", "2 .. 32768"}, {{"h.bin", heights(-1, -4, four)}}},
          {"mjcf", field, {"h.bin", "height 2 = nan", "finite"}, {{"h.bin", heights(2, 2, nan)}}},
          {"mjcf", include, {"bad.xml:1", "includes itself"}, {}, true},
          {"mjcf",
           "<mujoco><include file='b.xml'/></mujoco>",
           {"b.xml:1", "main file cannot be included"},
           {{"b.xml", include}}},
          {"mjcf", bomb, {"bad.xml:2", "timestep = \"&c;\"", "not a number"}, {}, true}};
}

std::vector<BadFile> badUrdf() {
  const auto mesh = [](const std::string& name) {
    return "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"" + name +
           "\"/></geometry></collision></link></robot>";
  };
  const std::pair<std::string, std::string> package{"hand/package.xml", "<package><name>hand</name></package>"};
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::pair<std::string, std::string> secret{"secret.obj", good};
  const std::string stay = "must stay in the folder of its package";
  return {
      {"urdf", mesh("none.stl"), {"filename = \"none.stl\"", "no such file"}, {}, true},
      {"urdf", mesh("package://hand/none.stl"), {"filename = \"package://hand/none.stl\""}, {package}},
      {"urdf", mesh("package://foot/a.stl"), {"filename = \"package://foot/a.stl\"", "package"}, {package}},
      {"urdf", mesh("package://hand/../secret.obj"), {"package://hand/../secret.obj", stay}, {package, secret}},
      {"urdf", mesh("package://../secret.obj"), {"package://../secret.obj", stay}, {package, secret}},
      {"urdf", mesh("package:///secret.obj"), {"package:///secret.obj", stay}, {package, secret}},
      {"urdf",
       mesh("m.stl"),
       {"filename = \"m.stl\"", "ends within a facet"},
       {{"m.stl", "solid x\nfacet normal 0 0 1\n"}}},
      {"urdf", mesh("m.obj"), {"m.obj", "f = \"9\"", "1 .. 3"}, {{"m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"}}}};
}

}  // namespace

std::vector<BadFile> badModelsOnDisk() {
  std::vector<BadFile> all = badMjcf();
  const std::vector<BadFile> more = badUrdf();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string wholeRecording(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "whole.avbd";
  Recording head;
  head.bodies = {{"ball", BodyType::Dynamic}};
  head.shapes = {{0, Sphere{0.5f}, {}, false}};
  {
    RecordWriter writer(file, head, {.framesPerChunk = 1});
    for (int i = 0; i < 3; ++i) {
      RecordedFrame frame;
      frame.time = 0.1 * i;
      frame.poses = {Pose{{0, 1.0 - 0.1 * i, 0}, {}}};
      writer.add(frame);
    }
    writer.finish();
  }
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<BadFile> badRecordings(const std::string& whole) {
  std::string damaged = whole, later = whole, body = whole;
  damaged[10] = static_cast<char>(damaged[10] ^ 1);
  const size_t at = body.find("BODY");
  if (at != std::string::npos) body[at + 32] = static_cast<char>(body[at + 32] ^ 1);
  return {{"recording", "", {"is empty", "no AVBD recording"}, {}, true},
          {"recording", "just a text, but a long one", {"is no AVBD recording"}, {}, true},
          {"recording", whole.substr(1), {"is no AVBD recording"}, {}, true},
          {"recording", whole.substr(0, 12), {"cut off within its first 16 bytes"}, {}, true},
          {"recording", damaged, {"head is damaged", "checksum"}, {}, true},
          {"recording", body, {"BODY", "damaged", "checksum"}, {}, true}};
}

}  // namespace avbd::scenes
