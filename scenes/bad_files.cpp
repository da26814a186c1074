// Broken scene and mesh files (bad_input.h).
#include "scenes/bad_input.h"

namespace avbd::scenes {
namespace {

std::string mjcf(const std::string& inside) { return "<mujoco><worldbody>" + inside + "</worldbody></mujoco>"; }
std::string urdf(const std::string& inside) { return "<robot name=\"r\">" + inside + "</robot>"; }

std::vector<BadFile> badMjcf() {
  return {{"mjcf", "", "bad.xml"},
          {"mjcf", "<mujoco", "bad.xml:1"},
          {"mjcf", "<robot/>", "robot"},
          {"mjcf", mjcf("<geom size='nan'/>"), "size"},
          {"mjcf", mjcf("<geom size='-1'/>"), "size"},
          {"mjcf", mjcf("<geom size='0.1,0.2'/>"), "size"},
          {"mjcf", mjcf("<geom type='blob' size='1'/>"), "type"},
          {"mjcf", mjcf("<geom type='mesh' mesh='nobody'/>"), "nobody"},
          {"mjcf", mjcf("<body pos='1 2'/>"), "pos"},
          {"mjcf", mjcf("<body quat='0 0 0 0'/>"), "quat"},
          {"mjcf", mjcf("<body name='a'/><body name='a'/>"), "a"},
          {"mjcf", mjcf("<body><freejoint/><geom size='1' mass='-3'/></body>"), "mass"},
          {"mjcf", mjcf("<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 9'/></body>"), "inertia"},
          {"mjcf", "<mujoco><include file='nowhere.xml'/></mujoco>", "include"}};
}

std::vector<BadFile> badUrdf() {
  const std::string link = "<link name=\"a\"/>";
  return {
      {"urdf", "", "bad.urdf"},
      {"urdf", "<mujoco/>", "mujoco"},
      {"urdf", "<robot name=\"r\"/>", "link"},
      {"urdf", urdf(link + link), "a"},
      {"urdf", urdf("<link/>"), "name"},
      {"urdf", urdf(link + "<link name=\"b\"/>"), "root"},
      {"urdf", urdf(link + "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"z\"/></joint>"), "z"},
      {"urdf", urdf(link + "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"a\"/></joint>"), "j"},
      {"urdf",
       urdf(link +
            "<link name=\"b\"/><joint name=\"j\" type=\"elastic\"><parent link=\"a\"/><child link=\"b\"/></joint>"),
       "elastic"},
      {"urdf", urdf("<link name=\"a\"><collision><geometry><sphere radius=\"nan\"/></geometry></collision></link>"),
       "radius"},
      {"urdf", urdf("<link name=\"a\"><collision><geometry><box size=\"1 1\"/></geometry></collision></link>"), "size"},
      {"urdf", urdf("<link name=\"a\"><collision><geometry><box size=\"1 0 1\"/></geometry></collision></link>"),
       "size"},
      {"urdf",
       urdf("<link name=\"a\"><inertial><mass value=\"NaN\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" "
            "ixz=\"0\" iyz=\"0\"/></inertial></link>"),
       "mass"}};
}

std::vector<BadFile> badMeshes() {
  return {{"obj", "", "empty"},
          {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "triangle"},
          {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "4"},
          {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "0"},
          {"obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "nan"},
          {"obj", "v 0 0\nf 1 1 1\n", "v"},
          {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "f"},
          {"stl", "", "bad.stl"},
          {"stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "bad.stl"},
          {"stl", std::string(84, '\0'), "triangle"},
          {"stl", std::string(80, 'b') + std::string("\xff\xff\xff\x7f", 4) + std::string(50, '\0'), "bad.stl"},
          {"msh", "", "bad.msh"},
          {"msh", std::string(8, '\x01'), "bad.msh"},
          {"msh", std::string(16, '\xff'), "bad.msh"}};
}

}  // namespace

std::vector<BadFile> badFiles() {
  std::vector<BadFile> all = badMjcf();
  for (const auto& more : {badUrdf(), badMeshes()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace avbd::scenes
