// Stands in for the engines that are not installed.
#include "bench/bench.h"

namespace avbd::bench {
namespace {

[[noreturn, maybe_unused]] void refuse(const char* call, const char* name) {
  throw Error(call, "peer", name, "this program was built without it");
}

}  // namespace

#ifndef AVBD_HAS_BULLET
BenchRecord benchBullet(const scenes::Scene&) { refuse("benchBullet", "bullet"); }
BenchRecord benchBullet4(const scenes::Scene&) { refuse("benchBullet", "bullet4"); }
#endif
#ifndef AVBD_HAS_MUJOCO
BenchRecord benchMujoco(const scenes::Scene&) { refuse("benchMujoco", "mujoco"); }
#endif
#ifndef AVBD_HAS_ODE
BenchRecord benchOde(const scenes::Scene&) { refuse("benchOde", "ode"); }
#endif

}  // namespace avbd::bench
