// Time of hulls beside qhull's, and of decompositions with their error: `hull_bench [MESH...]`, also of these mesh
// files.
#include <avbd/decompose.h>
#include <avbd/hull.h>
#include <benchmark/benchmark.h>

#include "io/mesh_file.h"
#include "src/geom/decompose_cases.h"
#include "src/geom/hull_cases.h"
#include "src/geom/hull_qhull.h"

namespace avbd {
namespace {

void makeOne(benchmark::State& state, Cloud kind, int maxVertices) {
  const std::vector<Vec3> points = cloud(kind, static_cast<size_t>(state.range(0)), 1);
  std::shared_ptr<const HullData> hull;
  for (auto _ : state) hull = makeHull({.points = points, .maxVertices = maxVertices});
  state.counters["vertices"] = static_cast<double>(hull->vertices().size());
  state.counters["faces"] = static_cast<double>(hull->faces().size());
  state.counters["error"] = hull->error();
}

void qhullOne(benchmark::State& state, Cloud kind) {
  const std::vector<Vec3> points = cloud(kind, static_cast<size_t>(state.range(0)), 1);
  QhullAnswer answer;
  for (auto _ : state) answer = askQhull(points);
  state.counters["vertices"] = static_cast<double>(answer.vertices.size());
}

void decomposeOne(benchmark::State& state, const TestMesh& mesh, bool seal) {
  Decomposition d;
  const DecomposeDef def{.vertices = mesh.vertices, .triangles = mesh.triangles, .seal = seal};
  for (auto _ : state) d = decompose(def);
  double volume = 0;
  for (const auto& hull : d.hulls) volume += hull->massProperties(1).mass;
  state.counters["hulls"] = static_cast<double>(d.hulls.size());
  state.counters["error"] = d.error;
  state.counters["found"] = d.errorFound;
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  state.counters["open"] = d.openEdges;
  state.counters["volumeRatio"] = volume / d.volume;
}

void addClouds() {
  const std::pair<const char*, Cloud> clouds[] = {{"sphere", Cloud::Sphere}, {"cube", Cloud::Cube}};
  for (const auto& [name, kind] : clouds) {
    for (int maxVertices : {64, 255}) {
      const std::string full = "hull/" + std::string(name) + "/" + std::to_string(maxVertices);
      benchmark::RegisterBenchmark(full.c_str(), makeOne, kind, maxVertices)
          ->RangeMultiplier(10)
          ->Range(100, 1000000)
          ->Unit(benchmark::kMicrosecond);
    }
    benchmark::RegisterBenchmark(("qhull/" + std::string(name)).c_str(), qhullOne, kind)
        ->RangeMultiplier(10)
        ->Range(100, 1000000)
        ->Unit(benchmark::kMicrosecond);
  }
}

void addDecomposition(const std::string& name, const TestMesh& mesh, bool seal) {
  benchmark::RegisterBenchmark(("decompose/" + name).c_str(), decomposeOne, mesh, seal)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

}  // namespace
}  // namespace avbd

int main(int argc, char** argv) {
  using namespace avbd;
  addClouds();
  addDecomposition("box", boxMesh({0.5f, 0.5f, 0.5f}), false);
  addDecomposition("l", lMesh(), false);
  addDecomposition("torus", torusMesh(1, 0.3f, 48, 24), false);
  addDecomposition("bowl", bowlMesh(), false);
  // Files follow the benchmark library's own arguments.
  benchmark::Initialize(&argc, argv);
  for (int i = 1; i < argc; ++i) {
    const MeshFile file = readMeshFile(argv[i]);
    addDecomposition(std::filesystem::path(argv[i]).filename().string(), {file.vertices, file.triangles}, true);
  }
  benchmark::RunSpecifiedBenchmarks();
}
