// How a tree answers a force along one of its coordinates: the inverse mass that an acceleration drive feels, all that
// hangs on either side of its joint with it.
//
// With H = M / h^2 and the joints' hard rows alone, from root to leaf (the diagonal blocks of the inverse):
//   x_c = P r_c + T x_p,   P = Hc^-1 - U S^-1 U^T,   T = -U S^-1 Jp,   Z_c = P + T Z_p T^T
// in the names of tree.h. Loops, springs and contacts are left out.
#pragma once

#include "solve/tree.h"

namespace avbd {

struct TreeResponse {
  float z[6][6];  ///< block of the inverse
  float t[6][6];
};

/// Of all nodes of a forest at the start of the step; overwrites what its factor holds.
void findResponses(const BatchView& view, Forest& forest, std::vector<TreeResponse>& response);
/// Inverse mass along a row of the joint of `node`, by its J on the child and on the parent [h^2 / kg].
float inverseMassOf(const Forest& forest, const std::vector<TreeResponse>& response, size_t node,
                    const rows::Twist<float>& child, const rows::Twist<float>& parent);

}  // namespace avbd
