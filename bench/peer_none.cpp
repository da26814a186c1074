// Stands in for Bullet where it is not installed.
#include "bench/bench.h"

namespace avbd::bench {

bool hasBullet() { return false; }

BenchRecord benchBullet(const scenes::Scene&) {
  throw Error("benchBullet", "peer", "bullet", "this program was built without Bullet");
}

}  // namespace avbd::bench
