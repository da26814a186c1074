// Files of our own making with the mistakes that real ones have: what becomes of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "io/urdf.h"

namespace avbd {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(__FILE__).parent_path() / "corpus" / "urdf";

UrdfOptions floating() {
  UrdfOptions options;
  options.floating = true;
  options.packagePaths = {kCorpus};
  return options;
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> filesIn(const char* folder) {
  std::set<std::string> out;
  for (const auto& entry : fs::directory_iterator(kCorpus / folder)) out.insert(entry.path().stem().string());
  return out;
}

struct Repaired {
  const char* file;
  size_t bodies, shapes;
  std::vector<std::string> notes;  // parts of all notes together
};

const Repaired kRepaired[] = {
    {"arm", 4, 5, {"> safety_controller: <safety_controller>: not used"}},
    {"bom", 1, 0, {}},
    {"empty_collision", 1, 0, {"no geometry: left out (and 1 more)", "> plane: a shape that is not part of URDF"}},
    {"fixed_without_mass", 1, 1, {"4: link \"plate\": no mass of its own: the link that it is fixed to has one"}},
    {"floating", 3, 1, {"link \"world\": nothing but a frame", "ball joint"}},
    {"gazebo", 2, 2, {"\"nobody\": refers to nothing", "<plugin>: not used", "<include>: not used", "<ros2_control>"}},
    {"huge_inertia", 1, 1, {"inertia is larger than its mass can have within its collisions"}},
    {"impossible_inertia", 1, 1, {"3: link \"base\" > inertial: no body can have this inertia", "nearest possible"}},
    {"latin1", 1, 0, {"iso-8859-1"}},
    {"limit_missing", 3, 0, {"without <limit>: taken as unlimited", "neither lower nor upper", "normalised"}},
    {"limits_swapped", 2, 0, {"8: joint \"a\" > limit: lower is greater than upper: swapped"}},
    {"mesh_backslashes", 1, 1, {"backslashes taken for slashes"}},
    {"mesh_dae",
     1,
     1,
     {"wedge.dae\": \"wedge.obj\" beside it is read instead", "lonely.dae\": only .stl, .obj and .msh"}},
    {"mesh_hook", 1, 2, {}},
    {"mesh_millimetres", 1, 2, {}},
    {"mesh_two_slashes", 1, 1, {}},
    {"mesh_wrong_case", 1, 1, {"upper.stl\": found as \"Upper.STL\""}},
    {"mimic_loop", 3, 0, {"joint \"a\": mimics itself, perhaps through others"}},
    {"mimic_missing", 2, 0, {"8: joint \"a\" > mimic: no joint is named \"finger\": mimic left out"}},
    {"missing_inertial", 2, 1, {"link \"arm\": moves but has no mass: that of its collisions at 1000 kg/m^3"}},
    {"no_inertia", 1, 0, {"no <inertia>: taken from the link's collisions"}},
    {"one_number_scale", 1, 1, {"scale is one number: taken for all three axes"}},
    {"rpy_degrees", 1, 0, {"8: joint \"a\" > origin: rpy turns by more than a full turn"}},
    {"solidworks", 1, 0, {"visuals are not used"}},
    {"unnamed", 1, 0, {"the robot has no name", "a joint without name"}},
    {"utf16", 1, 0, {"UTF-16"}},
    {"world_holds_foot",
     2,
     0,
     {"11: joint \"attach_foot_to_ground\": no link is named \"world\": holds the robot there"}},
    {"world_unsaid", 1, 0, {"4: joint \"hold\": no link is named \"world\": taken for an empty one"}},
    {"wrong_sign_products", 1, 1, {"no body can have this inertia"}},
    {"zero_inertia", 1, 1, {"an inertia of 0: taken from the link's collisions"}},
    {"zero_mass", 1, 1, {"a mass of 0", "1000 kg/m^3"}},
    {"zero_outside_limits", 2, 0, {"position 0 is outside the bounds: starts at the nearest one"}},
    {"zero_size_box", 1, 0, {"a shape without size: left out (and 1 more)"}},
};

TEST(UrdfCorpus, MistakesWithOneMeaningAreRepairedAndNoted) {
  std::set<std::string> seen;
  for (const Repaired& r : kRepaired) {
    seen.insert(r.file);
    const fs::path file = kCorpus / "good" / (std::string(r.file) + ".urdf");
    try {
      const Model model = readUrdf(file, floating());
      EXPECT_EQ(model.bodies.size(), r.bodies) << r.file;
      EXPECT_EQ(model.world.shapeCount(), r.shapes) << r.file;
      std::string all;
      for (const std::string& note : model.notes) all += note + "\n";
      for (const std::string& part : r.notes) EXPECT_NE(all.find(part), std::string::npos) << r.file << ":\n" << all;
      EXPECT_EQ(r.notes.empty() && all.find("left out") != std::string::npos, false) << r.file << ":\n" << all;
      readUrdf(file, {.packagePaths = {kCorpus}});  // fixed
    } catch (const std::exception& error) {
      ADD_FAILURE() << r.file << ": " << error.what();
    }
  }
  EXPECT_EQ(seen, filesIn("good"));
}

struct Refused {
  const char* file;
  int line;
  std::vector<std::string> parts;
};

const Refused kRefused[] = {
    {"decimal_commas", 3, {"link \"a\" > inertial > mass: value = \"1,5\"", "is not a number"}},
    {"duplicate_joint", 11, {"name = \"x\": another joint has this name"}},
    {"duplicate_link", 4, {"name = \"a\": another link has this name"}},
    {"empty", 0, {"the file is empty"}},
    {"flat_box", 3, {"collision > geometry > box: size = \"1 1 0\"", "each must be finite and > 0"}},
    {"friction", 4, {"gazebo \"a\" > mu1", "\"slippery\"", "must be a finite number >= 0"}},
    {"gzipped", 0, {"compressed by gzip"}},
    {"html", 2, {"<html>", "root element <robot>"}},
    {"infinite_origin", 3, {"link \"a\" > collision > origin: xyz = \"0 inf 0\"", "must be finite"}},
    {"joint_type", 5, {"joint \"x\": type = \"revolut\"", "fixed, revolute, continuous"}},
    {"joint_without_child", 4, {"joint \"x\": <child> is missing"}},
    {"loop", 3, {"joints make a loop (\"b\" > \"a\")", "tree"}},
    {"loop_beside_root", 6, {"joints make a loop (\"a\" > \"b\" > \"c\")", "root \"root\""}},
    {"mass_without_value", 3, {"mass: value is missing"}},
    {"mesh_flat", 3, {"flat.obj\": its hull: "}},
    {"mesh_missing",
     3,
     {"filename = \"package://parts/meshes/nowhere.stl\": no such file; tried ", "parts_description"}},
    {"mesh_no_name", 3, {"filename = \"\": must not be empty"}},
    {"mesh_package_unknown", 3, {"no folder of this package was found", "--package NAME=DIR"}},
    {"mesh_torn", 3, {"torn.stl\": ", "parts_description/meshes/torn.stl"}},
    {"mesh_web", 3, {"\"http://example.org/a.stl\": must be package://, model://, file:// or a path"}},
    {"mesh_zero_scale", 3, {"mesh: scale = \"1 1 0\": each must be finite and not 0"}},
    {"mjcf", 1, {"this is MJCF"}},
    {"nan_mass", 3, {"mass: value = \"nan\"", "must be finite"}},
    {"negative_mass", 3, {"mass: value = \"-1\": must be finite and >= 0"}},
    {"negative_moment", 3, {"inertia: ixx = \"-0.01\": must be finite and >= 0"}},
    {"negative_radius", 3, {"sphere: radius = \"-1\": must be finite and > 0"}},
    {"no_links", 2, {"robot \"r\": a robot needs at least one link"}},
    {"package_escapes_by_dots", 3, {"leaves by \"..\"", "must stay in the folder of its package"}},
    {"package_escapes_by_root", 3, {"an absolute path", "must stay in the folder of its package"}},
    {"package_is_dots", 3, {"package \"..\"", "must stay in the folder of its package"}},
    {"quaternion", 3, {"origin: quat_xyzw = \"0 0 0 1\": not part of URDF"}},
    {"sdf", 1, {"this is SDF"}},
    {"self_joint", 4, {"joint \"x\": joins link \"a\" to itself"}},
    {"torn", 2, {}},
    {"two_inertials", 3, {"inertial: the element is given twice"}},
    {"two_numbers", 3, {"origin: xyz = \"0 1\": must be 3 numbers"}},
    {"two_parents", 11, {"link \"c\" has a parent already, by joint \"x\""}},
    {"two_roots", 2, {"2 links have no parent (\"a\", \"b\")"}},
    {"two_shapes", 3, {"geometry: holds 2 shapes: must be one"}},
    {"unknown_link", 7, {"joint \"x\" > child: link = \"bee\": no link has this name"}},
    {"unnamed_link", 3, {"link: name is missing"}},
    {"xacro_expression", 3, {"radius = \"${r}\": xacro is not expanded here"}},
    {"xacro_find", 3, {"filename = \"$(find parts)/meshes/wedge.obj\": xacro is not expanded here"}},
    {"xacro_macro", 2, {"xacro is not expanded here: run `xacro FILE > robot.urdf` first"}},
    {"xacro_old", 2, {"xacro is not expanded here"}},
    {"zero_axis", 8, {"joint \"x\" > axis: xyz = \"0 0 0\": must not be zero"}},
};

TEST(UrdfCorpus, MistakesThatWouldNeedAGuessAreRefusedInTheirPlace) {
  std::set<std::string> seen;
  for (const Refused& r : kRefused) {
    seen.insert(r.file);
    const fs::path file = kCorpus / "bad" / (std::string(r.file) + ".urdf");
    try {
      readUrdf(file, floating());
      ADD_FAILURE() << r.file << " was read";
    } catch (const FileError& error) {
      const std::string what = error.what();
      const std::string place = file.string() + (r.line > 0 ? ":" + std::to_string(r.line) : "") + ": ";
      EXPECT_EQ(what.rfind(place, 0), 0u) << what;
      EXPECT_EQ(error.line(), r.line) << what;
      EXPECT_EQ(error.file(), file.string());
      for (const std::string& part : r.parts) EXPECT_NE(what.find(part), std::string::npos) << what;
    }
  }
  EXPECT_EQ(seen, filesIn("bad"));
}

TEST(UrdfCorpus, BadMeshesAreLeftOutWhereAsked) {
  UrdfOptions options = floating();
  options.floating = false;
  options.badMesh = BadMesh::Note;
  for (const char* name : {"mesh_missing", "mesh_package_unknown", "mesh_web", "mesh_flat", "mesh_torn"}) {
    const Model model = readUrdf(kCorpus / "bad" / (std::string(name) + ".urdf"), options);
    EXPECT_EQ(model.world.shapeCount(), 0u) << name;
    ASSERT_FALSE(model.notes.empty()) << name;
    EXPECT_NE(model.notes[0].find("left out"), std::string::npos) << model.notes[0];
  }
  // Not what tries to leave its package.
  EXPECT_THROW(readUrdf(kCorpus / "bad/package_escapes_by_dots.urdf", options), FileError);
}

// The wedge is 0.2 x 0.1 x 0.1 m with half of its box filled, however it is written.
TEST(UrdfCorpus, MeshesHaveTheSizeOfTheirScale) {
  for (const char* name : {"mesh_dae", "mesh_millimetres", "mesh_two_slashes", "mesh_wrong_case", "mesh_backslashes"}) {
    const Model model = readUrdf(kCorpus / "good" / (std::string(name) + ".urdf"), floating());
    for (const ShapeId shape : model.world.shapes(model.bodies.at(0).id)) {
      const auto hull = std::get<Hull>(model.world.geometry(shape)).data;
      EXPECT_EQ(hull->vertices().size(), 6u) << name;
      EXPECT_NEAR(hull->massProperties(1000).mass, 1, 1e-4) << name;
    }
  }
  // Mirrored by its negative scale.
  const Model model = readUrdf(kCorpus / "good/mesh_millimetres.urdf", floating());
  const auto hull = std::get<Hull>(model.world.geometry(model.world.shapes(model.bodies.at(0).id).at(1))).data;
  EXPECT_FLOAT_EQ(hull->lower().x, -0.2f);
  EXPECT_NEAR(hull->upper().x, 0, 1e-6);
}

// An L of two 0.1 x 0.1 bars, 0.3 long each way: one hull fills its corner, several leave it open.
TEST(UrdfCorpus, ADecomposedMeshKeepsItsHollows) {
  UrdfOptions options = floating();
  const fs::path file = kCorpus / "good/mesh_hook.urdf";
  const Model one = readUrdf(file, options);
  EXPECT_EQ(one.world.shapeCount(), 2u);
  options.decompose = true;
  const Model many = readUrdf(file, options);
  EXPECT_GT(many.world.shapeCount(), 2u);
  // No mass is given: two hooks of 0.1 x 0.05 m^2, one of them mirrored, against the filled triangle of their hulls.
  const double solid = 1000 * 0.05 * 0.1, filled = solid + 1000 * 0.02 * 0.1;
  EXPECT_NEAR(one.world.mass(one.bodies.at(0).id), 2 * filled, 0.01 * filled);
  EXPECT_NEAR(many.world.mass(many.bodies.at(0).id), 2 * solid, 0.1 * solid);
}

class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "avbd_urdf_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path put(const fs::path& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Made once, read the second time, and what the files say is what stands.
TEST(UrdfCorpus, DecomposedMeshesAreKeptOnDisk) {
  const Folder folder;
  UrdfOptions options = floating();
  options.decompose = true;
  options.hullCache = folder.path() / "hulls";
  const fs::path file = kCorpus / "good/mesh_hook.urdf";
  const Model first = readUrdf(file, options);
  std::vector<fs::path> kept;
  for (const auto& entry : fs::directory_iterator(options.hullCache)) kept.push_back(entry.path());
  ASSERT_EQ(kept.size(), 2u) << "one of the hook and one of its mirror image";
  const auto written = fs::last_write_time(kept[0]);
  const Model second = readUrdf(file, options);
  EXPECT_EQ(fs::last_write_time(kept[0]), written);
  EXPECT_EQ(second.world.hash(), first.world.hash());
  EXPECT_EQ(second.world.shapeCount(), first.world.shapeCount());
  EXPECT_EQ(second.notes, first.notes);
  std::ofstream(kept[0]) << "broken";
  EXPECT_GT(readUrdf(file, options).notes.size(), first.notes.size()) << "a broken file there is told of";
}

std::string robotWith(const std::string& mesh) {
  return "<robot name='r'><link name='a'><collision><geometry><mesh filename='" + mesh +
         "'/></geometry></collision></link></robot>";
}

TEST(UrdfMeshes, ALinkOutOfThePackageIsRefused) {
  const Folder folder;
  const std::string wedge = textOf(kCorpus / "parts_description/meshes/wedge.obj");
  folder.put("secret.obj", wedge);
  folder.put("pack/inner.obj", wedge);
  fs::create_symlink(folder.path() / "secret.obj", folder.path() / "pack/out.obj");
  fs::create_symlink(folder.path() / "pack/inner.obj", folder.path() / "pack/in.obj");
  fs::create_directory_symlink(folder.path(), folder.path() / "pack/up");
  const auto read = [&](const std::string& mesh) { return readUrdf(folder.put("r.urdf", robotWith(mesh))); };
  EXPECT_EQ(read("package://pack/in.obj").world.shapeCount(), 1u);
  for (const char* mesh : {"package://pack/out.obj", "package://pack/up/secret.obj", "model://pack/out.obj"}) {
    try {
      read(mesh);
      ADD_FAILURE() << mesh;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("leaves by a symbolic link"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(mesh), std::string::npos) << error.what();
    }
  }
}

// As colcon build --symlink-install lays them out.
TEST(UrdfMeshes, ALinkToThePackagesSourcesOrToANamedFolderIsFollowed) {
  const Folder folder;
  const std::string wedge = textOf(kCorpus / "parts_description/meshes/wedge.obj");
  const fs::path source = folder.put("ws/src/repository/arm/meshes/a.obj", wedge);
  const fs::path share = "ws/install/arm/share/arm";
  const fs::path file = folder.put(share / "urdf/r.urdf", robotWith("package://arm/meshes/a.obj"));
  fs::create_directory(folder.path() / share / "meshes");
  fs::create_symlink(source, folder.path() / share / "meshes/a.obj");
  try {
    readUrdf(file);
    ADD_FAILURE() << "nothing says that the link leads to the package's sources";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("symbolic link to " + source.string()), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--package DIR"), std::string::npos) << error.what();
  }
  EXPECT_THROW(readUrdf(file, {.packagePaths = {folder.path() / "ws/install"}}), FileError);
  EXPECT_EQ(readUrdf(file, {.packagePaths = {folder.path() / "ws/src/"}}).world.shapeCount(), 1u);
  EXPECT_EQ(readUrdf(file, {.packages = {{"other", folder.path() / "ws/src"}}}).world.shapeCount(), 1u);
  folder.put("ws/src/repository/arm/package.xml", "<package><name>leg</name></package>");
  EXPECT_THROW(readUrdf(file), FileError);
  folder.put("ws/src/repository/arm/package.xml", "<package><name>arm</name></package>");
  EXPECT_EQ(readUrdf(file).world.shapeCount(), 1u);
}

TEST(UrdfMeshes, PackagesAreFoundByNameByPathAndUpwards) {
  const Folder folder;
  const std::string wedge = textOf(kCorpus / "parts_description/meshes/wedge.obj");
  folder.put("ws/arm/meshes/a.obj", wedge);
  folder.put("ws/other_name/package.xml", "<?xml version='1.0'?><package format='2'><name>hand</name></package>");
  folder.put("ws/other_name/a.obj", wedge);
  folder.put("elsewhere/b.obj", wedge);
  const auto shapes = [&](const std::string& mesh, const std::string& where, const UrdfOptions& options = {}) {
    return readUrdf(folder.put(where, robotWith(mesh)), options).world.shapeCount();
  };
  EXPECT_EQ(shapes("package://arm/meshes/a.obj", "ws/arm/urdf/deep/r.urdf"), 1u);  // the folder it stands in
  EXPECT_EQ(shapes("package://arm/meshes/a.obj", "ws/other_name/r.urdf"), 1u);     // beside it
  EXPECT_EQ(shapes("package://hand/a.obj", "ws/other_name/urdf/r.urdf"), 1u);      // by package.xml
  EXPECT_EQ(shapes("../a.obj", "ws/other_name/urdf/r.urdf"), 1u);                  // relative to the file
  EXPECT_EQ(shapes("file://" + (folder.path() / "elsewhere/b.obj").string(), "ws/r.urdf"), 1u);
  EXPECT_EQ(shapes("package://x/b.obj", "r.urdf", {.packages = {{"x", folder.path() / "elsewhere"}}}), 1u);
  EXPECT_EQ(shapes("package://hand/a.obj", "r.urdf", {.packagePaths = {folder.path() / "ws"}}), 1u);
  EXPECT_EQ(shapes("package://arm/meshes/a.obj", "r.urdf", {.packagePaths = {folder.path() / "ws/arm/"}}), 1u);
  EXPECT_THROW(shapes("package://hand/a.obj", "r.urdf"), FileError);
}

// Whatever the bytes: a model or a FileError.
bool isRead(const std::string& text, const UrdfOptions& options, const std::string& what) {
  try {
    readUrdfText(text, "t.urdf", options);
    return true;
  } catch (const FileError&) {
  } catch (const std::exception& error) {
    ADD_FAILURE() << what << ": " << error.what() << "\n" << text;
  }
  return false;
}

std::string mutated(std::string text, std::mt19937& random) {
  static const char* const kWords[] = {"nan", "-1",    "0",   "1e308",    "1e-320",   "1e15",        "",
                                       "<",   "/>",    "\"",  "base",     "--><!--",  "<collision>", "</link>",
                                       "1e7", "-1e14", "../", "revolute", "floating", "1e-20"};
  const auto below = [&](size_t n) { return n == 0 ? 0 : random() % n; };
  for (size_t k = 1 + below(3); k > 0; --k) {
    const size_t at = below(text.size()), count = std::min(below(30), text.size() - at);
    switch (below(12)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, count);
        break;
      case 2:
        text.insert(below(text.size()), text.substr(at, count));
        break;
      case 3:
        text.insert(at, kWords[below(std::size(kWords))]);
        break;
      default: {
        // a whole value
        const size_t open = text.find("=\"", at), close = open == std::string::npos ? open : text.find('"', open + 2);
        if (close != std::string::npos) text.replace(open + 2, close - open - 2, kWords[below(std::size(kWords))]);
      }
    }
  }
  return text;
}

TEST(UrdfCorpus, TruncationsAndMutationsEndInAModelOrAFileError) {
  UrdfOptions options = floating();
  options.badMesh = BadMesh::Note;
  options.ground = 0;
  size_t read = 0, all = 0;
  for (const char* folder : {"good", "bad"}) {
    for (const std::string& name : filesIn(folder)) {
      const std::string text = textOf(kCorpus / folder / (name + ".urdf"));
      for (size_t n = 0; n < text.size(); n += 1 + text.size() / 100) isRead(text.substr(0, n), options, name);
      std::mt19937 random(1);
      for (int i = 0; i < 2000; ++i, ++all) {
        read += isRead(mutated(text, random), options, name + " " + std::to_string(i)) ? 1 : 0;
      }
    }
  }
  // Else the mutations test only the first check that they meet.
  EXPECT_GT(read, all / 20);
  RecordProperty("read", static_cast<int>(read));
  RecordProperty("all", static_cast<int>(all));
}

}  // namespace
}  // namespace avbd
