// Broken scene and mesh files (bad_input.h).
#include "scenes/bad_input.h"

namespace avbd::scenes {
namespace {

std::string mjcf(const std::string& inside) { return "<mujoco><worldbody>" + inside + "</worldbody></mujoco>"; }
std::string urdf(const std::string& inside) { return "<robot name=\"r\">" + inside + "</robot>"; }

std::vector<BadFile> badMjcf() {
  return {{"mjcf", "", {"bad.xml", "No document element"}},
          {"mjcf", "<mujoco", {"bad.xml:1", "start element"}},
          {"mjcf", "<robot/>", {"bad.xml:1: robot", "<mujoco>"}},
          {"mjcf", mjcf("<geom size='nan'/>"), {"size = \"nan\"", "finite"}},
          {"mjcf", mjcf("<geom size='-1'/>"), {"size = \"-1\"", "> 0"}},
          {"mjcf", mjcf("<geom size='0.1,0.2'/>"), {"size = \"0.1,0.2\"", "number"}},
          {"mjcf", mjcf("<geom type='blob' size='1'/>"), {"type = \"blob\"", "sphere"}},
          {"mjcf", mjcf("<geom type='mesh' mesh='nobody'/>"), {"mesh = \"nobody\"", "no mesh"}},
          {"mjcf", mjcf("<body pos='1 2'/>"), {"pos = \"1 2\"", "3 numbers"}},
          {"mjcf", mjcf("<body quat='0 0 0 0'/>"), {"quat = \"0 0 0 0\"", "zero"}},
          {"mjcf", mjcf("<body name='a'/><body name='a'/>"), {"name = \"a\"", "another body"}},
          {"mjcf", mjcf("<body><freejoint/><geom size='1' mass='-3'/></body>"), {"mass = \"-3\"", ">= 0"}},
          {"mjcf",
           mjcf("<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 9'/></body>"),
           {"inertial: inertia", "A + B >= C"}},
          {"mjcf", "<mujoco><include file='nowhere.xml'/></mujoco>", {"include", "file = \"nowhere.xml\""}}};
}

std::vector<BadFile> badUrdf() {
  const std::string link = "<link name=\"a\"/>";
  const auto joint = [](const char* type, const char* parent, const char* child) {
    return std::string("<joint name=\"j\" type=\"") + type + "\"><parent link=\"" + parent + "\"/><child link=\"" +
           child + "\"/></joint>";
  };
  const auto collision = [](const char* shape) {
    return urdf(std::string("<link name=\"a\"><collision><geometry>") + shape + "</geometry></collision></link>");
  };
  return {{"urdf", "", {"bad.urdf", "the file is empty"}},
          {"urdf", "<mujoco/>", {"bad.urdf", "<mujoco>"}},
          {"urdf", "<robot name=\"r\"/>", {"robot", "link"}},
          {"urdf", urdf(link + link), {"name = \"a\"", "another link"}},
          {"urdf", urdf("<link/>"), {"link", "name is missing"}},
          {"urdf", urdf(link + "<link name=\"b\"/>"), {"\"a\"", "\"b\"", "root"}},
          {"urdf", urdf(link + joint("fixed", "a", "z")), {"link = \"z\"", "no link"}},
          {"urdf", urdf(link + joint("fixed", "a", "a")), {"joint \"j\"", "joins link \"a\" to itself"}},
          {"urdf", urdf(link + "<link name=\"b\"/>" + joint("elastic", "a", "b")), {"type = \"elastic\""}},
          {"urdf", collision("<sphere radius=\"nan\"/>"), {"radius = \"nan\"", "finite"}},
          {"urdf", collision("<box size=\"1 1\"/>"), {"size = \"1 1\"", "3 numbers"}},
          {"urdf", collision("<box size=\"1 0 1\"/>"), {"size = \"1 0 1\"", "> 0"}},
          {"urdf",
           urdf("<link name=\"a\"><inertial><mass value=\"NaN\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" "
                "ixz=\"0\" iyz=\"0\"/></inertial></link>"),
           {"mass", "value = \"NaN\""}}};
}

std::vector<BadFile> badMeshes() {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string manyTriangles("\xff\xff\xff\x7f", 4);
  return {{"obj", "", {"the file is empty"}},
          {"obj", three, {"triangles = 0", "at least 1"}},
          {"obj", three + "f 1 2 4\n", {"bad.obj:4", "f = \"4\"", "1 .. 3"}},
          {"obj", three + "f 1 2 0\n", {"bad.obj:4", "f = \"0\"", "1 .. 3"}},
          {"obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", {"bad.obj:2", "v.x = \"nan\"", "finite"}},
          {"obj", "v 0 0\nf 1 1 1\n", {"bad.obj:1", "v.z is missing"}},
          {"obj", three + "f 1 2 99999999999999999999\n", {"bad.obj:4", "f = \"99999999999999999999\""}},
          {"obj", three + "f 1 2\n", {"bad.obj:4", "f has 2 vertices"}},
          {"stl", "", {"the file is empty"}},
          {"stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", {"bad.stl:", "ends within a facet"}},
          {"stl",
           "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
           {"bad.stl:4", "vertex.y = \"inf\""}},
          {"stl", std::string(84, '\0'), {"triangles = 0"}},
          {"stl", std::string(80, 'b') + manyTriangles + std::string(50, '\0'), {"number of triangles = 2147483647"}},
          {"msh", "", {"the file is empty"}},
          {"msh", std::string(8, '\x01'), {"size = 8", "16 bytes"}},
          {"msh", std::string(16, '\xff'), {"4294967295 vertices"}}};
}

}  // namespace

std::vector<BadFile> badFiles() {
  std::vector<BadFile> all = badMjcf();
  for (const auto& more : {badUrdf(), badMeshes()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace avbd::scenes
