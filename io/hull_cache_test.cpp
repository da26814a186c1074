// Cached decompositions: the same result from the file, and files that are not believed.
#include "io/hull_cache.h"

#include <avbd/error.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "src/geom/decompose_cases.h"

namespace avbd {
namespace {

class HullCache : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / ("avbd_hull_cache_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  DecomposeDef def() const {
    return {.vertices = mesh.vertices, .triangles = mesh.triangles, .maxError = 0.3f, .resolution = 16};
  }

  static void expectSame(const Decomposition& a, const Decomposition& b) {
    ASSERT_EQ(a.hulls.size(), b.hulls.size());
    for (size_t i = 0; i < a.hulls.size(); ++i) EXPECT_EQ(a.hulls[i]->contentHash(), b.hulls[i]->contentHash());
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.errorFound, b.errorFound);
    EXPECT_EQ(a.volume, b.volume);
  }

  std::vector<char> fileBytes() const {
    std::ifstream in(cacheFile(def(), folder), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void writeBytes(const std::vector<char>& bytes) const {
    std::ofstream(cacheFile(def(), folder), std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
  }

  std::filesystem::path folder;
  TestMesh mesh = torusMesh(1, 0.4f, 12, 8);
};

TEST_F(HullCache, secondCallFindsTheSame) {
  const CachedDecomposition first = decomposeCached(def(), folder);
  EXPECT_FALSE(first.found);
  EXPECT_EQ(first.note, "");
  const CachedDecomposition second = decomposeCached(def(), folder);
  EXPECT_TRUE(second.found);
  expectSame(first.result, second.result);
  expectSame(first.result, decompose(def()));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << "no part files stay";
}

TEST_F(HullCache, otherMeshOrOptionsAreOtherFiles) {
  const auto file = cacheFile(def(), folder);
  DecomposeDef other = def();
  other.maxError = 0.4f;
  EXPECT_NE(cacheFile(other, folder), file);
  other = def();
  other.seal = true;
  EXPECT_NE(cacheFile(other, folder), file);
  TestMesh moved = mesh;
  moved.vertices[5].x += 1e-6f;
  other = def();
  other.vertices = moved.vertices;
  EXPECT_NE(cacheFile(other, folder), file);
}

TEST_F(HullCache, damagedFilesAreMadeAnew) {
  const Decomposition good = decomposeCached(def(), folder).result;
  const std::vector<char> bytes = fileBytes();
  std::vector<std::vector<char>> bad;
  for (size_t at : {size_t{0}, size_t{9}, size_t{20}, size_t{40}, bytes.size() / 2, bytes.size() - 1}) {
    bad.push_back(bytes);
    bad.back()[at] = static_cast<char>(bad.back()[at] ^ 4);
  }
  bad.push_back({});
  bad.push_back({bytes.begin(), bytes.end() - 7});
  bad.push_back(std::vector<char>(500, 'x'));
  for (const auto& content : bad) {
    writeBytes(content);
    const CachedDecomposition again = decomposeCached(def(), folder);
    EXPECT_FALSE(again.found);
    EXPECT_NE(again.note.find("made anew"), std::string::npos) << again.note;
    expectSame(good, again.result);
    EXPECT_EQ(fileBytes(), bytes) << "repaired";
  }
}

TEST_F(HullCache, folderThatCannotBeWritten) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "file") << "in the way";
  const CachedDecomposition made = decomposeCached(def(), folder / "file");
  EXPECT_FALSE(made.found);
  EXPECT_NE(made.note.find("cannot be written"), std::string::npos);
  EXPECT_FALSE(made.result.hulls.empty());
}

TEST_F(HullCache, badInputIsRefusedAsByDecompose) {
  mesh.triangles.pop_back();
  EXPECT_THROW(decomposeCached(def(), folder), Error);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

}  // namespace
}  // namespace avbd
