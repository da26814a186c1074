// Broken MJCF: each is refused with file, line, element, attribute, value and what is allowed.
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {
namespace {

struct Refused {
  const char* xml;
  std::initializer_list<const char*> parts;  // all in the message
};

std::string messageOf(std::string_view xml) {
  try {
    parseText(xml, "t.xml");
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

void expectRefused(const std::string& xml, std::initializer_list<const char*> parts) {
  const std::string message = messageOf(xml);
  EXPECT_NE(message, "") << "accepted: " << xml;
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks: " << part;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// As whole files.
const Refused kFiles[] = {
    {"", {"t.xml:1:", "No document element found"}},
    {"  \n\n ", {"t.xml:", "No document element found"}},
    {"hello", {"t.xml:1:"}},
    {"<!-- only a comment -->", {"t.xml:1:"}},
    {"<mujoco>", {"t.xml:1:", "Start-end tags mismatch"}},
    {"<mujoco>\n<worldbody>\n</mujoco>", {"t.xml:3:", "Start-end tags mismatch"}},
    {"<mujoco>\n\n<worldbody", {"t.xml:3:"}},
    {"<mujoco>\n<option timestep=1/></mujoco>", {"t.xml:2:", "attribute"}},
    {"<mujoco>\n<option timestep='1/></mujoco>", {"t.xml:2:", "attribute"}},
    {"<mujoco><!-- </mujoco>", {"t.xml:1:", "comment"}},
    {"<mujoco/><mujoco/>", {"t.xml:1:", "a second root element <mujoco>"}},
    {"<robot name='r'/>", {"t.xml:1: robot", "root element must be <mujoco>", "URDF"}},
    {"<html><body/></html>", {"t.xml:1: html", "root element must be <mujoco>"}},
    {"\xff\xfe<\0m", {"t.xml:1:", "not text in UTF-8"}},
    {"<mujoco model='a\xc3('/>", {"t.xml:1:", "not text in UTF-8"}},
    {"<mujoco model='\xc0\xaf'/>", {"t.xml:1:", "not text in UTF-8"}},
    {"<mujoco model='\xed\xa0\x80'/>", {"t.xml:1:", "not text in UTF-8"}},
    {"<mujoco><include/></mujoco>", {"t.xml:1: include", "file is missing"}},
    {"<mujoco><include file='x.xml'/></mujoco>", {"t.xml:1: include", "file = \"x.xml\"", "not a file"}},
};

TEST(Refused, Files) {
  for (const Refused& r : kFiles) expectRefused(r.xml, r.parts);
}

TEST(Refused, ZeroByte) {
  EXPECT_NE(messageOf(std::string_view("<mujoco>\n<a\0b/></mujoco>", 24)).find("t.xml:2: not text in UTF-8"),
            std::string::npos);
}

// Inside <mujoco>.
const Refused kSections[] = {
    {"<compiler angle='degrees'/>", {"compiler: angle = \"degrees\"", "must be one of radian, degree"}},
    {"<compiler coordinate='global'/>", {"compiler: coordinate = \"global\"", "only local"}},
    {"<compiler coordinate='both'/>", {"coordinate = \"both\"", "must be one of local, global"}},
    {"<compiler eulerseq='xy'/>", {"eulerseq = \"xy\"", "three letters"}},
    {"<compiler eulerseq='abc'/>", {"eulerseq = \"abc\"", "three letters"}},
    {"<compiler inertiafromgeom='yes'/>", {"inertiafromgeom = \"yes\"", "false, true, auto"}},
    {"<compiler inertiagrouprange='0'/>", {"inertiagrouprange = \"0\"", "must be 2 numbers"}},
    {"<compiler inertiagrouprange='0 x'/>", {"inertiagrouprange = \"0 x\"", "\"x\" is not a number"}},
    {"<compiler boundmass='-1'/>", {"boundmass = \"-1\"", "must be finite and >= 0"}},
    {"<compiler boundinertia='-1e-9'/>", {"boundinertia = \"-1e-9\"", "must be finite and >= 0"}},
    {"<compiler balanceinertia='1'/>", {"balanceinertia = \"1\"", "must be one of false, true"}},
    {"<compiler settotalmass='heavy'/>", {"settotalmass = \"heavy\"", "is not a number"}},
    {"<compiler angle='degree' angle='radian'/>", {"compiler: angle = \"radian\"", "given twice"}},
    {"<option timestep='0'/>", {"option: timestep = \"0\"", "must be > 0 and <= 1"}},
    {"<option timestep='-0.01'/>", {"timestep = \"-0.01\"", "must be > 0 and <= 1"}},
    {"<option timestep='2'/>", {"timestep = \"2\"", "must be > 0 and <= 1"}},
    {"<option timestep='nan'/>", {"timestep = \"nan\"", "must be finite"}},
    {"<option timestep=''/>", {"timestep = \"\"", "must be 1 number"}},
    {"<option timestep='0.01 0.02'/>", {"timestep = \"0.01 0.02\"", "must be 1 number"}},
    {"<option timestep='0,01'/>", {"timestep = \"0,01\"", "is not a number"}},
    {"<option gravity='0 -9.81'/>", {"gravity = \"0 -9.81\"", "must be 3 numbers"}},
    {"<option gravity='0 0 inf'/>", {"gravity = \"0 0 inf\"", "must be finite"}},
    {"<option gravity='0 0 -1e9'/>", {"gravity = \"0 0 -1e9\"", "at most 1e6"}},
    {"<option collision='none'/>", {"collision = \"none\"", "all, predefined, dynamic"}},
    {"<option iterations='many'/>", {"iterations = \"many\"", "is not a number"}},
    {"<option><flag contact='off'/></option>", {"option > flag: contact = \"off\"", "disable, enable"}},
    {"<default class='a'><default class='a'/></default>", {"class = \"a\"", "exists"}},
    {"<default><default class='a'/></default><default class='a'/>", {"class = \"a\"", "exists"}},
    {"<default><mesh vertex='0 0 0'/></default>", {"vertex = \"0 0 0\"", "not allowed in a default"}},
    {"<default><mesh face='0 1 2'/></default>", {"face = \"0 1 2\"", "not allowed in a default"}},
    {"<default><mesh file='a.obj'/></default>", {"file = \"a.obj\"", "not allowed in a default"}},
    {"<default><mesh refpos='1 0 0'/></default>", {"refpos = \"1 0 0\"", "not allowed in a default"}},
    {"<default><mesh refquat='1 0 0 0'/></default>", {"refquat = \"1 0 0 0\"", "not allowed in a default"}},
    {"<default><default/></default>", {"default", "class is missing"}},
    {"<default><default class='a'/><default class='a'/></default>", {"class = \"a\"", "exists"}},
    {"<default><default class='main'/></default>", {"class = \"main\"", "exists"}},
    {"<default><geom size='1 2 3 4'/></default>", {"default > geom: size = \"1 2 3 4\"", "1 to 3 numbers"}},
    {"<default><geom friction='a'/></default>", {"friction = \"a\"", "is not a number"}},
    {"<default><geom name='a'/></default>", {"name = \"a\"", "not allowed in a default"}},
    {"<asset><material name='a'/><material name='a'/></asset>", {"material \"a\"", "another material has this name"}},
    {"<keyframe><key qpos='1'/></keyframe>", {"keyframe > key: qpos holds 1 numbers", "must be 0"}},
    {"<keyframe><key name='a'/><key name='a'/></keyframe>", {"key \"a\": name = \"a\"", "has this name"}},
    {"<keyframe><key qvel='nan'/></keyframe>", {"qvel = \"nan\""}},
    {"<contact><exclude body1='a' body2='world'/></contact>", {"exclude: body1 = \"a\"", "no body has this name"}},
    {"<contact><exclude body2='world'/></contact>", {"exclude: body1 is missing"}},
    {"<contact><pair geom1='a' geom2='b'/></contact>", {"pair: geom1 = \"a\"", "no geom has this name"}},
    {"<contact><pair/></contact>", {"pair: geom1 is missing"}},
    {"<equality><connect anchor='0 0 0' body1='a'/></equality>", {"connect: body1 = \"a\"", "no body has this name"}},
    {"<equality><weld/></equality>", {"weld: body1 is missing"}},
    {"<equality><weld body1='world'/></equality>", {"weld: body1 = \"world\"", "two different bodies"}},
};

TEST(Refused, Sections) {
  for (const Refused& r : kSections) {
    expectRefused("<mujoco>\n" + std::string(r.xml) + "\n</mujoco>", r.parts);
    expectRefused("<mujoco>\n" + std::string(r.xml) + "\n</mujoco>", {"t.xml:2: "});
  }
}

// Inside <worldbody>.
const Refused kWorld[] = {
    {"<geom/>", {"geom: size is missing", "must be finite and > 0"}},
    {"<geom size=''/>", {"geom: size = \"\"", "1 to 3 numbers"}},
    {"<geom name='a' type='box' size='0 1 1'/>", {"geom \"a\": size = \"0 1 1\": each must be finite and > 0"}},
    {"<geom type='box' size='1 1'/>", {"size = \"1 1\": must be 3 numbers, each finite and > 0"}},
    {"<geom type='box' size='1 1 -1'/>", {"size = \"1 1 -1\"", "each must be finite and > 0"}},
    {"<geom type='capsule' size='1'/>", {"size = \"1\": must be 2 numbers, each finite and > 0"}},
    {"<geom type='capsule' size='1 nan'/>", {"size = \"1 nan\"", "\"nan\" must be finite"}},
    {"<geom type='cylinder' size='1 0'/>", {"size = \"1 0\"", "> 0"}},
    {"<geom type='ellipsoid' size='1 2'/>", {"size = \"1 2\"", "3 numbers"}},
    {"<geom size='-1'/>", {"size = \"-1\": must be finite and > 0"}},
    {"<geom size='1e999'/>", {"size = \"1e999\"", "must be finite"}},
    {"<geom size='1e16'/>", {"size = \"1e16\"", "at most 1e15"}},
    {"<geom size='1x'/>", {"size = \"1x\"", "\"1x\" is not a number"}},
    {"<geom size='0x10'/>", {"size = \"0x10\"", "is not a number"}},
    {"<geom size='+-1'/>", {"size = \"+-1\"", "is not a number"}},
    {"<geom size='&lol;'/>", {"size = \"&lol;\"", "is not a number"}},
    {"<geom size='1' type='ball'/>", {"type = \"ball\"", "must be one of plane, hfield, sphere"}},
    {"<geom size='1' pos='0 0'/>", {"pos = \"0 0\"", "must be 3 numbers"}},
    {"<geom size='1' pos='0 0 0 0'/>", {"pos = \"0 0 0 0\"", "must be 3 numbers"}},
    {"<geom size='1' pos='a b c'/>", {"pos = \"a b c\"", "\"a\" is not a number"}},
    {"<geom size='1' quat='0 0 0 0'/>", {"quat = \"0 0 0 0\"", "must not be zero"}},
    {"<geom size='1' quat='1 0 0'/>", {"quat = \"1 0 0\"", "must be 4 numbers"}},
    {"<geom size='1' axisangle='0 0 0 1'/>", {"axisangle = \"0 0 0 1\"", "must not be zero"}},
    {"<geom size='1' euler='1 2'/>", {"euler = \"1 2\"", "must be 3 numbers"}},
    {"<geom size='1' xyaxes='0 0 0 0 1 0'/>", {"xyaxes", "x axis must not be zero"}},
    {"<geom size='1' xyaxes='1 0 0 2 0 0'/>", {"xyaxes", "along the x axis"}},
    {"<geom size='1' zaxis='0 0 0'/>", {"zaxis = \"0 0 0\"", "must not be zero"}},
    {"<geom size='1' quat='1 0 0 0' euler='0 0 0'/>", {"more than one of quat"}},
    {"<geom size='1' mass='-1'/>", {"mass = \"-1\"", "must be finite and >= 0"}},
    {"<geom size='1' mass='nan'/>", {"mass = \"nan\"", "must be finite"}},
    {"<geom size='1' density='-5'/>", {"density = \"-5\"", "must be finite and >= 0"}},
    {"<geom size='1' friction='-0.1'/>", {"friction = \"-0.1\"", "each must be finite and >= 0"}},
    {"<geom size='1' friction='1 1 1 1'/>", {"friction = \"1 1 1 1\"", "1 to 3 numbers"}},
    {"<geom size='1' condim='2'/>", {"condim = \"2\"", "1, 3, 4 or 6"}},
    {"<geom size='1' condim='3.5'/>", {"condim = \"3.5\"", "whole number"}},
    {"<geom size='1' priority='1e10'/>", {"priority = \"1e10\"", "whole number of 32 bits"}},
    {"<geom size='1' contype='x'/>", {"contype = \"x\"", "is not a number"}},
    {"<geom size='1' margin='x'/>", {"margin = \"x\"", "is not a number"}},
    {"<geom size='1' rgba='red'/>", {"rgba = \"red\"", "is not a number"}},
    {"<geom size='1' class='none'/>", {"class = \"none\"", "no default class has this name"}},
    {"<geom size='1' material='none'/>", {"material = \"none\"", "no material of this name"}},
    {"<geom type='mesh'/>", {"mesh is missing"}},
    {"<geom type='mesh' mesh='none'/>", {"mesh = \"none\"", "no mesh of this name"}},
    {"<geom type='hfield' hfield='none'/>", {"hfield = \"none\"", "no hfield of this name"}},
    {"<geom size='1' fromto='0 0 0 0 0 1'/>", {"fromto", "only allowed for a capsule"}},
    {"<geom type='plane' size='1 1 1' fromto='0 0 0 0 0 1'/>", {"fromto", "not allowed for a plane"}},
    {"<geom type='capsule' size='1' fromto='0 0 0 0 0'/>", {"fromto = \"0 0 0 0 0\"", "must be 6 numbers"}},
    {"<geom type='capsule' size='1' fromto='1 2 3 1 2 3'/>", {"fromto", "must not be equal"}},
    {"<geom name='a' size='1'/><geom name='a' size='1'/>", {"geom \"a\": name = \"a\"", "another geom"}},
    {"<geom size='1' size='2'/>", {"size = \"2\"", "given twice"}},
    {"<body name='a'/><body name='a'/>", {"body \"a\": name = \"a\"", "another body"}},
    {"<body name='world'/>", {"name = \"world\"", "another body"}},
    {"<body childclass='none'/>", {"childclass = \"none\"", "no default class"}},
    {"<body pos='0 0 nan'/>", {"worldbody > body: pos = \"0 0 nan\""}},
    {"<body mocap='yes'/>", {"mocap = \"yes\"", "false, true"}},
    {"<body><body mocap='true'/></body>", {"mocap = \"true\"", "only children of worldbody"}},
    {"<body mocap='true'><freejoint/></body>", {"a mocap body cannot have joints"}},
    {"<joint/>", {"the world cannot have a joint"}},
    {"<inertial pos='0 0 0' mass='1'/>", {"the world cannot have an inertial"}},
    {"<body><body name='c'><freejoint/></body></body>", {"body \"c\" > freejoint", "child of worldbody"}},
    {"<body><freejoint/><joint/></body>", {"only joint of its body"}},
    {"<body><joint/><joint type='free'/></body>", {"only joint of its body"}},
    {"<body><joint type='ball'/><joint type='hinge'/></body>", {"may follow a ball joint"}},
    {"<body><joint type='ball'/><joint type='ball'/></body>", {"may follow a ball joint"}},
    {"<body name='b'><joint type='rev'/></body>", {"body \"b\" > joint: type = \"rev\"", "free, ball, slide, hinge"}},
    {"<body><joint axis='0 0 0'/></body>", {"axis = \"0 0 0\"", "must not be zero"}},
    {"<body><joint pos='0'/></body>", {"pos = \"0\"", "3 numbers"}},
    {"<body><joint axis='0 nan 0'/></body>", {"axis = \"0 nan 0\"", "must be finite"}},
    {"<body><joint range='2 1'/></body>", {"range = \"2 1\"", "less than the second"}},
    {"<body><joint type='slide' range='1 1'/></body>", {"range = \"1 1\"", "less than the second"}},
    {"<body><joint limited='true'/></body>", {"range is missing", "limited is true"}},
    {"<body><joint type='ball' range='-1 1'/></body>", {"range = \"-1 1\"", "0 and the largest turn > 0"}},
    {"<body><joint stiffness='-1'/></body>", {"stiffness = \"-1\"", "finite and >= 0"}},
    {"<body><joint damping='-1'/></body>", {"damping = \"-1\"", "finite and >= 0"}},
    {"<body><joint armature='-1'/></body>", {"armature = \"-1\"", "finite and >= 0"}},
    {"<body><joint frictionloss='-1'/></body>", {"frictionloss = \"-1\"", "finite and >= 0"}},
    {"<body><joint springref='x'/></body>", {"springref = \"x\"", "is not a number"}},
    {"<body><joint actuatorfrcrange='1 0'/></body>", {"actuatorfrcrange = \"1 0\"", "less than the second"}},
    {"<site name='p'/><site name='p'/>", {"site \"p\": name = \"p\"", "has this name"}},
    {"<site fromto='0 0 0 0 0 0'/>", {"fromto", "must not be equal"}},
    {"<body><joint range='0'/></body>", {"range = \"0\"", "2 numbers"}},
    {"<body><joint type='ball' limited='maybe'/></body>", {"limited = \"maybe\"", "false, true, auto"}},
    {"<body><joint name='j'/></body><body><freejoint name='j'/></body>", {"name = \"j\"", "has this name"}},
    {"<body><freejoint/><geom type='plane' size='1 1 1'/></body>", {"planes are only allowed in bodies that do not"}},
    {"<body><joint/><body><geom type='plane' size='1 1 1'/></body></body>", {"planes are only allowed"}},
    {"<body><inertial mass='1'/></body>", {"inertial: pos is missing"}},
    {"<body><inertial pos='0 0 0'/></body>", {"inertial: mass is missing"}},
    {"<body><inertial pos='0 0 0' mass='-1'/></body>", {"mass = \"-1\"", ">= 0"}},
    {"<body><inertial pos='0 0 0' mass='inf'/></body>", {"mass = \"inf\"", "must be finite"}},
    {"<body><inertial pos='0 0 0' mass='1' diaginertia='1 1'/></body>", {"diaginertia = \"1 1\"", "3 numbers"}},
    {"<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 -1'/></body>", {"diaginertia", ">= 0"}},
    {"<body name='b'><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/></body>", {"inertial: inertia", "A + B >= C"}},
    {"<body><inertial pos='0 0 0' mass='1' fullinertia='1 1 1 2 0 0'/></body>", {"fullinertia", "positive definite"}},
    {"<body><inertial pos='0 0 0' mass='1' fullinertia='1 1 1'/></body>", {"fullinertia = \"1 1 1\"", "6 numbers"}},
    {"<body><inertial pos='0 0 0' mass='1' quat='1 0 0 0' fullinertia='1 1 1 0 0 0'/></body>", {"quat", "fullinertia"}},
    {"<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1' fullinertia='1 1 1 0 0 0'/></body>", {"both"}},
    {"<body><inertial pos='0 0 0' mass='1'/><inertial pos='0 0 0' mass='1'/></body>", {"one inertial only"}},
    {"<frame pos='0'><geom size='1'/></frame>", {"frame: pos = \"0\"", "3 numbers"}},
    {"<frame childclass='x'/>", {"childclass = \"x\"", "no default class"}},
};

TEST(Refused, InWorldbody) {
  for (const Refused& r : kWorld) {
    const std::string xml = "<mujoco>\n<worldbody>\n\n" + std::string(r.xml) + "</worldbody></mujoco>";
    expectRefused(xml, r.parts);
    expectRefused(xml, {"t.xml:4: "});
  }
}

// Links between two free bodies a and b with geoms of the same names.
const Refused kLinks[] = {
    {"<contact><pair geom1='a' geom2='b' condim='5'/></contact>", {"condim = \"5\"", "1, 3, 4 or 6"}},
    {"<contact><pair geom1='a' geom2='b' friction='-1'/></contact>", {"friction = \"-1\"", ">= 0"}},
    {"<contact><pair geom1='a' geom2='c'/></contact>", {"geom2 = \"c\"", "no geom"}},
    {"<contact><exclude body1='a' body2='c'/></contact>", {"body2 = \"c\"", "no body"}},
    {"<equality><connect body1='a' body2='b'/></equality>", {"anchor is missing", "3 numbers"}},
    {"<equality><connect body1='a' body2='a' anchor='0 0 0'/></equality>", {"body2 = \"a\"", "two different bodies"}},
    {"<equality><connect body1='a' body2='b' anchor='0 0'/></equality>", {"anchor = \"0 0\"", "3 numbers"}},
    {"<equality><weld body1='a' body2='b' relpose='0 0 0'/></equality>", {"relpose = \"0 0 0\"", "7 numbers"}},
    {"<equality><weld body1='a' active='on'/></equality>", {"active = \"on\"", "false, true"}},
    {"<equality><weld name='w' body1='a'/><weld name='w' body1='b'/></equality>", {"weld \"w\"", "has this name"}},
    {"<keyframe><key qpos='0 0 0 1 0 0 0'/></keyframe>", {"qpos holds 7 numbers", "must be 14"}},
    {"<keyframe><key qvel='0 0 0 0 0 0 0'/></keyframe>", {"qvel holds 7 numbers", "must be 12"}},
};

TEST(Refused, Links) {
  for (const Refused& r : kLinks) {
    expectRefused(
        "<mujoco><worldbody><body name='a'><freejoint/><geom name='a' size='1'/></body>"
        "<body name='b'><freejoint/><geom name='b' size='1'/></body></worldbody>" +
            std::string(r.xml) + "</mujoco>",
        r.parts);
  }
}

// Beside a body with a hinge h, a slide s and a ball b, sites p and q, tendon t over h.
const Refused kMoved[] = {
    {"<actuator><motor joint='x'/></actuator>", {"motor: joint = \"x\"", "no joint has this name"}},
    {"<actuator><motor/></actuator>", {"motor: must name exactly one of joint"}},
    {"<actuator><motor joint='h' tendon='t'/></actuator>", {"must name exactly one of joint"}},
    {"<actuator><motor tendon='x'/></actuator>", {"tendon = \"x\"", "no tendon has this name"}},
    {"<actuator><motor site='x'/></actuator>", {"site = \"x\"", "no site has this name"}},
    {"<actuator><motor cranksite='p' slidersite='x'/></actuator>", {"slidersite = \"x\"", "no site"}},
    {"<actuator><adhesion body='x'/></actuator>", {"body = \"x\"", "no body has this name"}},
    {"<actuator><motor joint='h' gear='nan'/></actuator>", {"gear = \"nan\"", "must be finite"}},
    {"<actuator><motor joint='h' gear='1 2 3 4 5 6 7'/></actuator>", {"gear", "1 to 6 numbers"}},
    {"<actuator><motor joint='h' ctrlrange='1 -1'/></actuator>", {"ctrlrange = \"1 -1\"", "less than the second"}},
    {"<actuator><motor joint='h' ctrllimited='true'/></actuator>", {"ctrlrange is missing", "ctrllimited is true"}},
    {"<actuator><motor joint='h' forcerange='1'/></actuator>", {"forcerange = \"1\"", "2 numbers"}},
    {"<actuator><motor joint='h' forcerange='2 2'/></actuator>", {"forcerange = \"2 2\"", "less than the second"}},
    {"<actuator><position joint='h' kp='-1'/></actuator>", {"kp = \"-1\"", "finite and >= 0"}},
    {"<actuator><velocity joint='h' kv='-1'/></actuator>", {"kv = \"-1\"", "finite and >= 0"}},
    {"<actuator><position joint='h' inheritrange='1'/></actuator>", {"inheritrange = \"1\"", "joint with a range"}},
    {"<actuator><general joint='h' dyntype='x'/></actuator>", {"dyntype = \"x\"", "none, integrator"}},
    {"<actuator><general joint='h' gainprm='a'/></actuator>", {"gainprm = \"a\"", "is not a number"}},
    {"<actuator><motor name='m' joint='h'/><motor name='m' joint='h'/></actuator>", {"name = \"m\"", "has this name"}},
    {"<tendon><fixed/></tendon>", {"fixed: a fixed tendon must have a joint"}},
    {"<tendon><fixed><joint joint='h'/></fixed></tendon>", {"coef is missing"}},
    {"<tendon><fixed><joint joint='x' coef='1'/></fixed></tendon>", {"joint = \"x\"", "no joint has this name"}},
    {"<tendon><fixed><joint joint='b' coef='1'/></fixed></tendon>", {"joint = \"b\"", "hinge or slide"}},
    {"<tendon><fixed range='2 1'><joint joint='h' coef='1'/></fixed></tendon>", {"range = \"2 1\"", "less than"}},
    {"<tendon><fixed stiffness='-1'><joint joint='h' coef='1'/></fixed></tendon>", {"stiffness = \"-1\"", ">= 0"}},
    {"<tendon><fixed springlength='2 1'><joint joint='h' coef='1'/></fixed></tendon>", {"springlength", "above"}},
    {"<tendon><fixed name='t'><joint joint='h' coef='1'/></fixed></tendon>", {"name = \"t\"", "has this name"}},
    {"<tendon><spatial><site site='p'/></spatial></tendon>", {"spatial", "two sites or more"}},
    {"<tendon><spatial><site site='p'/><site site='x'/></spatial></tendon>", {"site = \"x\"", "no site"}},
    {"<tendon><spatial><site site='p'/><geom geom='x'/><site site='q'/></spatial></tendon>", {"geom = \"x\""}},
    {"<tendon><spatial><site site='p'/><pulley divisor='0'/><site site='q'/></spatial></tendon>", {"divisor", "> 0"}},
    {"<equality><joint joint1='x'/></equality>", {"joint1 = \"x\"", "no joint has this name"}},
    {"<equality><joint/></equality>", {"joint1 is missing"}},
    {"<equality><joint joint1='h' joint2='h'/></equality>", {"joint2 = \"h\"", "must be another one"}},
    {"<equality><joint joint1='h' joint2='b'/></equality>", {"joint2 = \"b\"", "hinge or slide"}},
    {"<equality><joint joint1='h' polycoef='1 2 3 4 5 6'/></equality>", {"polycoef", "1 to 5 numbers"}},
    {"<equality><tendon tendon1='x'/></equality>", {"tendon1 = \"x\"", "no tendon has this name"}},
    {"<equality><distance geom1='g' geom2='x'/></equality>", {"geom2 = \"x\"", "no geom"}},
    {"<equality><distance geom1='g' geom2='k' distance='-1'/></equality>", {"distance = \"-1\"", ">= 0"}},
    {"<equality><weld site1='p' site2='x'/></equality>", {"site2 = \"x\"", "no site"}},
    {"<equality><connect site1='p' site2='p'/></equality>", {"site2 = \"p\"", "another body"}},
    {"<keyframe><key qpos='1 2 3'/></keyframe>", {"qpos holds 3 numbers", "must be 6", "as the joints"}},
    {"<keyframe><key ctrl='1 2'/></keyframe>", {"ctrl holds 2 numbers", "must be 0", "as the actuators"}},
};

TEST(Refused, WhatMoves) {
  for (const Refused& r : kMoved) {
    expectRefused(
        "<mujoco><worldbody><site name='q'/><geom name='k' size='1'/><body name='a'><joint name='h'/>"
        "<joint name='s' type='slide'/><geom name='g' size='1'/><site name='p'/><body><joint name='b' type='ball'/>"
        "<geom size='1'/></body></body></worldbody><tendon><fixed name='t'><joint joint='h' "
        "coef='1'/></fixed></tendon>" +
            std::string(r.xml) + "</mujoco>",
        r.parts);
  }
}

// A value from a default class is refused where the class says it.
TEST(Refused, NamesThePlaceInTheDefaultClass) {
  expectRefused("<mujoco>\n<default>\n<geom type='box' size='1'/></default>\n<worldbody><geom/></worldbody></mujoco>",
                {"t.xml:3: default > geom: size = \"1\"", "must be 3 numbers"});
}

TEST(Refused, LongValuesAreCutInMessages) {
  const std::string message = messageOf("<mujoco><option timestep='" + std::string(100000, 'x') + "'/></mujoco>");
  EXPECT_LT(message.size(), 400u);
  EXPECT_NE(message.find("..."), std::string::npos);
}

}  // namespace
}  // namespace avbd::mjcf
