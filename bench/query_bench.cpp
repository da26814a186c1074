// Time per query in a world of 10,000 shapes, beside Bullet's. Arguments: shapes, queries of each kind.
#include <cstdio>
#include <cstdlib>

#include "bench/query_peer.h"

int main(int count, char** words) {
  const int shapes = count > 1 ? std::atoi(words[1]) : 10000, asked = count > 2 ? std::atoi(words[2]) : 10000;
  if (shapes < 1 || asked < 1) {
    std::fprintf(stderr, "usage: query_bench [shapes] [queries]\n");
    return 1;
  }
  std::printf("%d shapes, %d queries of each kind; best of three rounds\n", shapes, asked);
  std::printf("%-8s %-12s %9s %9s %7s %8s %8s %10s %10s %10s\n", "world", "query", "ns", "Bullet ns", "ratio", "hits",
              "differ", "median", "95 %", "max diff");
  for (const bool dense : {false, true}) {
    for (const avbd::bench::QueryRow& row : avbd::bench::compareQueries(shapes, dense, asked)) {
      std::printf("%-8s %-12s %9.0f %9.0f %7.2f %8zu %8zu %10.2g %10.2g %10.2g\n", dense ? "dense" : "spread",
                  row.query.c_str(), row.nanoseconds, row.peerNanoseconds, row.peerNanoseconds / row.nanoseconds,
                  row.hits, row.differ, row.medianDifference, row.highDifference, row.largestDifference);
    }
  }
  return 0;
}
