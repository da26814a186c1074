// Queries of a crowded world: what Bullet finds too.
#include "bench/query_peer.h"

#include <gtest/gtest.h>

namespace avbd::bench {
namespace {

TEST(QueryPeer, agreesWithBullet) {
  for (const bool dense : {false, true}) {
    for (const QueryRow& row : compareQueries(500, dense, 300)) {
      SCOPED_TRACE(row.query);
      EXPECT_EQ(row.asked, 300u);
      EXPECT_GT(row.hits, 20u);
      if (row.peerNanoseconds == 0) GTEST_SKIP() << "without Bullet";
      // Bullet's rays and sweeps stop beside shapes that they graze, its boxes and hulls end where its margin does.
      EXPECT_LE(row.differ, 9u);
      // Of overlaps the numbers are compared.
      EXPECT_LT(row.medianDifference, row.query == "box overlap" ? 0.5 : 2e-3);
      // A few of its rays leave out what they graze and meet what lies behind, so the largest says nothing.
      EXPECT_LT(row.highDifference, row.query == "box overlap" ? 0.5 : row.query == "ray closest" ? 0.03 : 3e-3);
    }
  }
}

}  // namespace
}  // namespace avbd::bench
