// Scenes by name and files by path.
#include "app/load.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/commands.h"
#include "app/failure.h"
#include "app/number_text.h"
#include "app/soft_files.h"
#include "io/mjcf.h"
#include "io/soft_mesh_file.h"
#include "io/urdf.h"

namespace avbd::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestStep = 1;  // [s], of World::step
constexpr double kMostSteps = 1e8;

bool looksLikeFile(const std::string& name) {
  std::error_code ignored;
  const fs::path path(name);
  return path.has_extension() || name.find('/') != std::string::npos || fs::exists(path, ignored);
}

// By the root element, or by the extension where the text does not show one.
bool isUrdf(const std::string& file) {
  std::error_code ignored;
  const std::string kind = fs::path(file).extension().string();
  if (kind == ".urdf" || kind == ".xacro" || kind == ".URDF") return true;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::string head(65536, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(in.gcount()));
  for (size_t at = head.find('<'); at != std::string::npos; at = head.find('<', at + 1)) {
    if (head.compare(at, 4, "<!--") == 0) {
      at = head.find("-->", at);
    } else if (head.compare(at, 2, "<?") != 0 && head.compare(at, 2, "<!") != 0) {
      return head.compare(at, 6, "<robot") == 0;
    }
    if (at == std::string::npos) break;
  }
  return false;
}

void refuseUrdfOptions(const UrdfArguments& a, const std::string& scene) {
  const char* given = a.floating            ? "--floating"
                      : a.limp              ? "--limp"
                      : !a.selfCollision    ? "--no-self-collision"
                      : !a.packages.empty() ? "--package"
                      : a.skipBadMeshes     ? "--skip-bad-meshes"
                      : a.decompose         ? "--decompose"
                      : a.hullCache         ? "--hull-cache"
                      : a.collideVisuals    ? "--collide-visuals"
                                            : nullptr;
  if (given) throw BadInput(std::string(given) + ": " + scene + " is not a URDF file");
}

// Where programs of this user keep what they can make again (XDG base directories); empty where that is not known.
fs::path usualHullCache() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value ? fs::path(value) : fs::path();
  };
  if (const fs::path cache = folder("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "avbd" / "hulls";
  if (const fs::path home = folder("HOME"); home.is_absolute()) return home / ".cache" / "avbd" / "hulls";
  return {};
}

Model loadUrdf(const RunArguments& a) {
  if (a.urdf.hullCache && !a.urdf.decompose) throw BadInput("--hull-cache: only --decompose makes what it keeps");
  if (a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": a URDF file has no keyframes");
  UrdfOptions options;
  options.world = scenes::apply(a.settings);
  options.floating = a.urdf.floating;
  if (a.urdf.floating) options.ground = 0;
  options.limp = a.urdf.limp;
  options.selfCollision = a.urdf.selfCollision;
  options.badMesh = a.urdf.skipBadMeshes ? BadMesh::Note : BadMesh::Refuse;
  options.decompose = a.urdf.decompose;
  if (a.urdf.decompose) options.hullCache = a.urdf.hullCache ? fs::path(*a.urdf.hullCache) : usualHullCache();
  options.collideVisuals = a.urdf.collideVisuals;
  for (const std::string& package : a.urdf.packages) {
    const size_t equals = package.find('=');
    const std::string folder = equals == std::string::npos ? package : package.substr(equals + 1);
    std::error_code ignored;
    if (equals == 0 || !fs::is_directory(folder, ignored)) {
      throw BadInput("--package " + package + ": must be NAME=DIR or DIR, with an existing folder");
    }
    if (equals == std::string::npos) {
      options.packagePaths.emplace_back(folder);
    } else {
      options.packages[package.substr(0, equals)] = folder;
    }
  }
  return readUrdf(a.scene, options);
}

void refuseMaterial(const MaterialArguments& a, const std::string& scene) {
  const auto refuse = [&](const char* name, const std::string& value) {
    throw BadInput(std::string(name) + " " + value + ": " + scene +
                   " is not a soft mesh (--soft makes a closed surface one)");
  };
  if (a.young) refuse("--young", digits(*a.young, 9));
  if (a.poisson) refuse("--poisson", digits(*a.poisson, 9));
  if (a.density) refuse("--density", digits(*a.density, 9));
  if (!a.solid.empty()) refuse("--solid", a.solid);
}

/// Numbers beyond a float's are told by the world that refuses them.
SoftMaterial materialOf(const MaterialArguments& a) {
  SoftMaterial material;
  if (a.young) material.youngsModulus = static_cast<float>(*a.young);
  if (a.poisson) material.poissonRatio = static_cast<float>(*a.poisson);
  if (a.density) material.density = static_cast<float>(*a.density);
  if (a.solid == "corotational") material.model = SolidModel::Corotational;
  return material;
}

}  // namespace

Model loadModel(const RunArguments& a) {
  if (a.soft || isSoftMeshFile(a.scene)) {
    if (a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": a soft mesh has no keyframes");
    refuseUrdfOptions(a.urdf, a.scene);
    return dropped(readSoft(a.scene, a.soft), a.scene, materialOf(a.material), a.settings);
  }
  refuseMaterial(a.material, a.scene);
  if (const scenes::Scene* scene = scenes::find(a.scene)) {
    if (a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": scene " + a.scene + " has no keyframes");
    refuseUrdfOptions(a.urdf, "scene " + a.scene);
    Model model = scene->make(a.settings);
    model.before = scene->before;
    return model;
  }
  if (!looksLikeFile(a.scene)) sceneNamed(a.scene);
  if (isUrdf(a.scene)) return loadUrdf(a);
  refuseUrdfOptions(a.urdf, a.scene);
  MjcfOptions options;
  options.world = scenes::apply(a.settings);
  options.keyframe = a.keyframe.value_or("");
  return readMjcf(a.scene, options);
}

Plan planRun(const RunArguments& a, const Model& model) {
  Plan plan;
  plan.dt = a.dt.value_or(model.dt);
  // As the world takes it: a double may vanish as a float.
  if (const float dt = static_cast<float>(plan.dt); !(dt > 0 && plan.dt <= kLongestStep)) {
    const std::string name = a.dt ? "--dt" : a.scene + ": the file's step";
    throw BadInput(name + " = " + digits(plan.dt, 9) + ": must be > 0 and at most 1 s");
  }
  const double time = a.time.value_or(model.duration);
  if (!(time >= 0 && std::isfinite(time))) throw BadInput("--time = " + digits(time, 9) + ": must be finite and >= 0");
  const double steps = std::round(time / plan.dt);
  if (!(steps <= kMostSteps))
    throw BadInput("--time = " + digits(time, 9) + ": " + digits(steps, 4) + " steps of " + digits(plan.dt, 9) +
                   " s, must be at most 1e8");
  plan.steps = time > 0 ? std::max<int64_t>(1, static_cast<int64_t>(steps)) : 0;
  if (!(a.fps > 0 && a.fps <= 1e6)) throw BadInput("--fps = " + digits(a.fps, 9) + ": must be > 0 and at most 1e6");
  return plan;
}

}  // namespace avbd::cli
