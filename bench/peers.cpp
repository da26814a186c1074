// The engines to compare with, and how each is observed.
#include <algorithm>
#include <array>

#include "bench/bench.h"

namespace avbd::bench {
namespace {

#ifdef AVBD_HAS_BULLET
constexpr bool kBullet = true;
#else
constexpr bool kBullet = false;
#endif
#ifdef AVBD_HAS_MUJOCO
constexpr bool kMujoco = true;
#else
constexpr bool kMujoco = false;
#endif
#ifdef AVBD_HAS_ODE
constexpr bool kOde = true;
#else
constexpr bool kOde = false;
#endif

const std::array<Peer, 4> kPeers{{
    {"bullet", kBullet, "boxes and hulls with margins, friction as a pyramid, 10 iterations, single precision",
     benchBullet},
    {"bullet4", kBullet, "as bullet, with four steps a frame, as its own examples of soft bodies have", benchBullet4},
    {"mujoco", kMujoco,
     "soft contacts, trees of joints in joint coordinates, CG for more than 300 freedoms, double precision",
     benchMujoco},
    {"ode", kOde, "quick step with 20 iterations, friction as a pyramid scaled by the normal force, double precision",
     benchOde},
}};

}  // namespace

std::span<const Peer> peers() { return kPeers; }

const Peer* findPeer(std::string_view name) {
  const auto found = std::find_if(kPeers.begin(), kPeers.end(), [&](const Peer& p) { return name == p.name; });
  return found == kPeers.end() ? nullptr : &*found;
}

BenchRecord observePeer(
    const scenes::Scene& scene, const char* name,
    const std::function<std::unique_ptr<scenes::Engine>(const World&, const scenes::Layout&)>& make) {
  if (scene.before) throw Error(name, "scene", scene.name, "must not change by itself as it runs");
  const Model model = scene.make({});
  const scenes::Layout layout = scenes::layoutOf(model.world);
  const std::unique_ptr<scenes::Engine> engine = make(model.world, layout);
  BenchRecord record =
      toRecord(scene, name, 1, scenes::observeRun(*engine, layout, scene.watch, {scene.warmup, scene.steps, model.dt}));
  record.bodies = static_cast<size_t>(std::count(layout.dynamic.begin(), layout.dynamic.end(), 1));
  return record;
}

}  // namespace avbd::bench
