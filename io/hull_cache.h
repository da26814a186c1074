// Convex decompositions kept on disk by content: the same mesh and options are decomposed once.
#pragma once

#include <avbd/decompose.h>

#include <filesystem>
#include <string>

namespace avbd {

struct CachedDecomposition {
  Decomposition result;
  bool found = false;  ///< read from the folder
  std::string note;    ///< why a file there was not used or none could be written; empty: nothing to say
};

/// decompose(def), or what an earlier call with the same mesh and options left in the folder (made if need be). A
/// file's name is the hash of mesh, options and version; it carries a hash of its content. One that is cut short,
/// changed or made by something else is not used and written anew. A folder that cannot be written costs the time of
/// the next call, nothing else. Throws what decompose() throws.
CachedDecomposition decomposeCached(const DecomposeDef& def, const std::filesystem::path& folder);

/// The file in the folder that this mesh and these options would use.
std::filesystem::path cacheFile(const DecomposeDef& def, const std::filesystem::path& folder);

}  // namespace avbd
