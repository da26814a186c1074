// Loops in the exact solution: rows between bodies that no tree joins, as blocks of the factor beside the tree.
//
// Nodes are eliminated from the last to the first. With V_a = Hc^-1 H_ca for each node a that c is coupled to when its
// turn comes (its front: the other ends of its loops, what earlier eliminations left, and its parent p), and
// R_a = [a = p] Jp - Jc V_a:
//   down  H_ab += R_a^T S^-1 R_b - H_ca^T V_b,   ra -= V_a^T rc + R_a^T S^-1 (Jc Hc^-1 rc - b)
//   up    mu = S^-1 (Jc Hc^-1 rc - b + sum R_a xa),   xc = Hc^-1 (rc - Jc^T mu) - sum V_a xa
// which is tree.h where the front is the parent alone and H_cp = 0.
#pragma once

#include "solve/tree.h"

namespace avbd {

/// Reads the blocks of H that loops and linked joints make into the fronts.
void stampFill(const BatchView& view, Forest& forest, const uint8_t* active);
void eliminateFilled(Forest& forest, TreeNode& node);
void descendFilled(Forest& forest, TreeNode& node, bool violated);
/// The node's y becomes its part of the solution.
void ascendFilled(Forest& forest, TreeNode& node);

}  // namespace avbd
