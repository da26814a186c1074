// Queries of a large world, answered by AVBD and by Bullet.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace avbd::bench {

/// One kind of query in one world.
struct QueryRow {
  std::string query;
  size_t asked = 0, hits = 0;
  double nanoseconds = 0;        ///< a query, AVBD
  double peerNanoseconds = 0;    ///< Bullet; 0 where it is not there
  size_t differ = 0;             ///< queries of which one found something and the other did not
  double largestDifference = 0;  ///< of distances [m], where both found something
  double medianDifference = 0;
  double highDifference = 0;  ///< 95 in 100 are no larger
};

/// A world of this many boxes, balls, capsules and hulls, a quarter each. Dense: they touch each other, as in a pile;
/// otherwise they fill a hundredth of the room.
std::vector<QueryRow> compareQueries(int shapes, bool dense, int asked);

}  // namespace avbd::bench
