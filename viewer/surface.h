// Hulls, meshes and height fields as the page takes them: vertices and triangles, or a grid of heights.
#pragma once

#include <ostream>

#include "io/record/content.h"

namespace avbd::page {

/// A JSON object: {"vertices", "triangles"}, or {"columns", "rows", "spacingX", "spacingZ", "heights", "open"}.
void writeSurface(std::ostream& out, const record::Surfaces::Data& data);

}  // namespace avbd::page
