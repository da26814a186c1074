// Bad files of the corpus are refused with what was expected; good ones survive being cut and damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "io/mesh_file.h"
#include "io/mjcf.h"

namespace avbd {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(__FILE__).parent_path() / "corpus";

std::string bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::vector<fs::path> filesOf(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

bool isMesh(const fs::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".obj" || kind == ".stl" || kind == ".msh";
}

// What the reader of this kind says; empty where it accepts.
std::string refusalOf(const fs::path& file) {
  try {
    if (isMesh(file)) {
      readMeshFile(file);
    } else {
      readMjcf(file);
    }
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(Corpus, BadFilesAreRefusedAsExpected) {
  std::ifstream list(kCorpus / "bad/expected.txt");
  std::map<std::string, std::vector<std::string>> expected;
  for (std::string line; std::getline(list, line);) {
    std::istringstream in(line);
    std::string name;
    std::getline(in, name, '\t');
    for (std::string part; std::getline(in, part, '\t');) expected[name].push_back(part);
  }
  size_t checked = 0;
  for (const fs::path& file : filesOf(kCorpus / "bad")) {
    if (!isMesh(file) && file.extension() != ".xml") continue;
    const std::string name = file.filename().string();
    ASSERT_TRUE(expected.contains(name)) << name << " is not in expected.txt";
    const std::string message = refusalOf(file);
    EXPECT_NE(message, "") << name << " is accepted";
    EXPECT_NE(message.find(name.substr(0, name.find('.'))), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : expected[name]) {
      EXPECT_NE(message.find(part), std::string::npos) << name << ": " << message << "\n  lacks: " << part;
    }
    ++checked;
  }
  EXPECT_EQ(checked, expected.size());
}

TEST(Corpus, GoodFilesAreRead) {
  for (const fs::path& file : filesOf(kCorpus / "good")) {
    if (file.extension() == ".bin" || file.filename() == "points.msh") continue;
    EXPECT_EQ(refusalOf(file), "");
  }
}

TEST(Corpus, EveryMujocoSampleIsReadWithNotes) {
  const fs::path folder = "/usr/share/mujoco/model";
  if (!fs::exists(folder)) GTEST_SKIP() << "libmujoco-samples is not installed";
  size_t read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    EXPECT_EQ(refusalOf(entry.path()), "");
    EXPECT_FALSE(readMjcf(entry.path()).notes.empty()) << entry.path();  // each has something that we leave out
    ++read;
  }
  EXPECT_EQ(read, 18u);
}

// Success or FileError, nothing else; true for success.
bool survives(const std::string& bytes, const fs::path& file) {
  try {
    if (isMesh(file)) {
      readMeshBytes(std::as_bytes(std::span(bytes)), file.extension().string().substr(1), "t");
    } else {
      readMjcfText(bytes, "t.xml");
    }
    return true;
  } catch (const FileError& error) {
    EXPECT_STRNE(error.what(), "");
  }
  return false;
}

TEST(Corpus, EveryPrefixIsReadOrRefused) {
  for (const fs::path& file : filesOf(kCorpus / "good")) {
    if (file.extension() == ".bin") continue;
    const std::string whole = bytesOf(file);
    size_t accepted = 0;
    for (size_t size = 0; size < whole.size(); ++size) accepted += survives(whole.substr(0, size), file) ? 1 : 0;
    // XML ends only once, binary meshes fit one size or have some bytes to lose.
    if (file.extension() == ".xml") {
      EXPECT_LE(accepted, 1u) << file;
    } else if (file.extension() == ".msh") {
      EXPECT_EQ(accepted, 0u) << file;
    }
  }
}

TEST(Corpus, DamagedFilesAreReadOrRefused) {
  constexpr const char* kWords[] = {"nan", "-1", "1e300", "0",  "",   "99999999999", "<",
                                    "'",   "/",  "-",     "f ", "\n", "vertex"};
  for (const fs::path& file : filesOf(kCorpus / "good")) {
    if (file.extension() == ".bin") continue;
    const std::string whole = bytesOf(file);
    std::mt19937 random(1);
    const auto below = [&](size_t n) { return static_cast<size_t>(random()) % n; };
    for (int round = 0; round < 2000; ++round) {
      std::string bytes = whole;
      for (size_t k = below(4); k != static_cast<size_t>(-1); --k) {
        const size_t at = below(bytes.size());
        switch (below(5)) {
          case 0:
            bytes[at] = static_cast<char>(random());
            break;
          case 1:
            bytes[at] ^= static_cast<char>(1 << below(8));
            break;
          case 2:
            bytes.insert(at, kWords[below(std::size(kWords))]);
            break;
          case 3:
            bytes.erase(at, below(9));
            break;
          default:
            bytes.insert(at, whole.substr(below(whole.size()), below(40)));
        }
        if (bytes.empty()) bytes = "x";
      }
      survives(bytes, file);
      if (HasFailure()) FAIL() << file << " round " << round;
    }
  }
}

// The custom format of height fields is read through a model.
TEST(Corpus, HeightFieldFilesCutShort) {
  const fs::path folder = fs::path(testing::TempDir()) / "avbd_hills";
  fs::create_directories(folder);
  const std::string whole = bytesOf(kCorpus / "good/hills.bin");
  const std::string model =
      "<mujoco><asset><hfield name='h' file='h.bin' size='1 1 1 1'/></asset><worldbody><geom type='hfield' hfield='h'/>"
      "</worldbody></mujoco>";
  std::ofstream(folder / "m.xml") << model;
  for (size_t size = 0; size <= whole.size(); ++size) {
    std::ofstream(folder / "h.bin", std::ios::binary) << whole.substr(0, size);
    EXPECT_EQ(refusalOf(folder / "m.xml").empty(), size == whole.size()) << size;
  }
  fs::remove_all(folder);
}

TEST(Corpus, LinksInACircleAreNotFollowed) {
  const fs::path folder = fs::path(testing::TempDir()) / "avbd_links";
  fs::remove_all(folder);
  fs::create_directories(folder);
  fs::create_symlink("b.obj", folder / "a.obj");
  fs::create_symlink("a.obj", folder / "b.obj");
  std::ofstream(folder / "m.xml") << "<mujoco><asset><mesh name='a' file='a.obj'/></asset><worldbody><geom type='mesh' "
                                     "mesh='a'/></worldbody></mujoco>";
  EXPECT_NE(refusalOf(folder / "m.xml").find("file = \"a.obj\": no such file"), std::string::npos);
  EXPECT_NE(refusalOf(folder / "a.obj").find("a.obj: no such file"), std::string::npos);
  fs::remove_all(folder);
}

TEST(Corpus, DeepNestingAndManyElements) {
  for (const char* name : {"body", "frame", "default"}) {
    std::string deep = "<mujoco><worldbody>";
    for (int i = 0; i < 100000; ++i) deep += "<" + std::string(name) + ">";
    survives(deep, "t.xml");
    for (int i = 0; i < 100000; ++i) deep += "</" + std::string(name) + ">";
    survives(deep + "</worldbody></mujoco>", "t.xml");
  }
}

}  // namespace
}  // namespace avbd
