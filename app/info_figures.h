// What `avbd info` says about a model or a mesh file.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/figures.h"
#include "io/mesh_file.h"

namespace avbd::cli {

inline constexpr size_t kShapeKinds = std::variant_size_v<Geometry>;
inline constexpr size_t kJointKinds = 10;
/// As in Geometry and JointType.
const char* shapeKindName(size_t kind);
const char* jointKindName(size_t kind);

struct Bounds {
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  bool empty() const { return lower.x > upper.x; }
};

/// A coordinate of a joint, in the file's terms.
struct CoordinateInfo {
  std::string name, joint;  ///< joint: its kind
  bool isAngle = false;     ///< else a length
  double position = 0;
  double lower = 0, upper = 0;  ///< infinite: no limit
  double maxVelocity = 0;       ///< infinite: no limit
};

struct ProbeInfo {
  std::string name, kind, unit;  ///< kind: the sensor's element in MJCF
  int dimension = 1;
};

struct ModelInfo {
  std::string name;
  size_t dynamic = 0, kinematic = 0, fixed = 0;
  std::array<size_t, kShapeKinds> shapes{};
  size_t coloredShapes = 0;                                       ///< those that the file gives a colour
  size_t hullVertices = 0, meshTriangles = 0, heightSamples = 0;  ///< of all shapes; shared ones once for each
  std::array<size_t, kJointKinds> joints{};
  std::vector<SoftFigures> softs;
  size_t softBodies = 0, particles = 0, tetrahedra = 0, triangles = 0;  ///< triangles: of cloth
  double mass = 0;                                                      ///< [kg] of all dynamic bodies
  Bounds bounds;  ///< of all shapes but half-spaces, at the start [m]
  double dt = 0;
  Vec3 gravity, up;
  std::vector<std::string> keyframes, notes;
  std::vector<CoordinateInfo> coordinates;
  std::vector<Actuator> actuators;
  std::vector<ProbeInfo> probes;
  std::vector<std::string> moved;  ///< by actuator: the name of the coordinate; empty where it has none
};

ModelInfo infoOf(const Model& model);
ReportLines reportLines(const ModelInfo& info);

struct MeshInfo {
  std::string name;
  size_t vertices = 0, triangles = 0;  ///< of the file
  Bounds bounds;
  MeshReport report;
  bool closed = false;          ///< every edge has two triangles that agree about the front
  double area = 0, volume = 0;  ///< [m^2], [m^3]; the volume means something where it is closed
  std::optional<size_t> hullVertices;
  double hullVolume = 0, hullError = 0;
  std::string hullRefused;  ///< why there is no hull
  std::vector<std::string> notes;
};

/// Throws Error for a mesh that the library refuses.
MeshInfo infoOf(const MeshFile& mesh, const std::string& name);
ReportLines reportLines(const MeshInfo& info);

}  // namespace avbd::cli
