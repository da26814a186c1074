// Triangle meshes (mesh.h).
#include <avbd/error.h>
#include <avbd/mesh.h>

namespace avbd {

struct MeshData::Parts {};
MeshData::~MeshData() = default;
std::shared_ptr<const MeshData> makeMesh(const MeshDef&) { throw Error("MeshDef", "triangles", "0", "not built yet"); }

}  // namespace avbd
