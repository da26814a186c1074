// Shared geometry for the sessions, made once.
#pragma once

#include <avbd/avbd.h>

namespace avbd::fuzz {

const std::shared_ptr<const HullData>& someHull();
const std::shared_ptr<const HullData>& roundHull();  ///< with many vertices
const std::shared_ptr<const MeshData>& someMesh();   ///< a bowl with a rim
const std::shared_ptr<const MeshData>& thinMesh();   ///< double-sided, two materials, a sliver
const std::shared_ptr<const HeightFieldData>& someField();

}  // namespace avbd::fuzz
