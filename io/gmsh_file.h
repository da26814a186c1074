// Reads triangles or tetrahedra from GMSH files (.msh) of the text formats 2.2 and 4.1.
#pragma once

#include <avbd/types.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_error.h"

namespace avbd {

struct GmshFile {
  int dim = 0;                                    ///< 3 where there are tetrahedra, else 2; 0: not read
  std::vector<Vec3> points;                       ///< in the order of the file
  std::vector<std::array<uint32_t, 4>> elements;  ///< indices of points; the fourth is 0 of triangles
  std::string leftOut;                            ///< why the file is not read: binary, or another version
};

/// Other kinds of elements are passed over. Throws FileError: broken syntax, a node that there is not, numbers that are
/// not finite, no triangle and no tetrahedron.
GmshFile readGmsh(std::string_view text, const std::string& nameForMessages);

}  // namespace avbd
