// Acceptance, rigid bodies at rest: towers, pyramids, piles, heavy on light, the card house.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

struct Settled {
  Evidence evidence;
  double speed = 0;  ///< of the fastest body after the last step [m/s]
};

Settled settle(Model model, int steps) {
  const Layout layout = layoutOf(model.world);
  Watch watch;
  watch.penetration = true;
  Settled result;
  result.evidence = observeRun(*avbdEngine(model, layout), layout, watch, {0, steps, model.dt});
  result.speed = speedMax(model.world);
  return result;
}

std::vector<Figure> rest(const Settings& settings) {
  Build build("rest", settings);
  build.ground();
  build.box("box", {1, 1, 1}, {0, 1, 0}, 80);
  const Settled s = settle(build.take(), 1200);
  return {atMost("penetration", s.evidence.penetrationLate, 0.003, "m"),
          atMost("drift", s.evidence.displacement.horizontal, 0.0001, "m"), atMost("speed", s.speed, 1e-4, "m/s"),
          holds("finite", s.evidence.finite)};
}

std::vector<Figure> tower(const Settings& settings) {
  const Settled s = settle(tower10(settings), 600);
  return {atMost("penetration", s.evidence.penetrationLate, 0.004, "m"),
          atMost("horizontal", s.evidence.displacement.horizontal, 0.003, "m"), atMost("speed", s.speed, 1e-3, "m/s"),
          holds("finite", s.evidence.finite)};
}

std::vector<Figure> pyramid(const Settings& settings) {
  const Settled s = settle(pyramid10(settings), 600);
  return {atMost("penetration", s.evidence.penetrationLate, 0.004, "m"),
          atMost("horizontal", s.evidence.displacement.horizontal, 0.010, "m"), holds("finite", s.evidence.finite)};
}

std::vector<Figure> cardHouses(const Settings& settings) {
  constexpr uint32_t kOrders = 10;
  constexpr double kFallen = 0.1;  // less than any way in which a card can lie down
  int stand = 0;
  for (uint32_t seed = 1; seed <= kOrders; ++seed) {
    Model model = cardHouse(settings, seed);
    const Layout layout = layoutOf(model.world);
    const Evidence e = observeRun(*avbdEngine(model, layout), layout, {}, {0, 600, model.dt});
    if (e.finite && e.displacement.total < kFallen) ++stand;
  }
  return {{"stand", "orders=10", static_cast<double>(stand), kOrders, kOrders, "houses"}};
}

// A line that is a scene's own check.
Line ofScene(std::string list, std::string name, std::vector<std::pair<std::string, std::string>> scenes) {
  return {std::move(list), std::move(name),
          [scenes](const Settings& settings) {
            std::vector<Figure> figures;
            for (const auto& [scene, params] : scenes) {
              const Scene& s = *find(scene);
              for (Figure& f : s.check(run(s, settings))) {
                f.params = params;
                figures.push_back(std::move(f));
              }
            }
            return figures;
          },
          ""};
}

}  // namespace

std::vector<Line> restLines() {
  return {
      {"R", "rest", rest, ""},
      {"R", "tower10", tower, ""},
      {"R", "pyramid10", pyramid, ""},
      ofScene("R", "pyramid30", {{"pyramid30", ""}}),
      ofScene("R", "bricks", {{"bricks", ""}}),
      ofScene("R", "pile", {{"pile", ""}}),
      ofScene("R", "heavy_on_light", {{"heavy_on_light", "load=1000"}, {"heavy_on_light_10t", "load=10000"}}),
      ofScene("R", "doubling", {{"doubling", ""}}),
      ofScene("R", "tonnes", {{"tonnes", ""}}),
      {"R", "card_house", cardHouses, ""},
      ofScene("J", "chain", {{"chain", "load=1000"}, {"chain_50t", "load=50000"}}),
      ofScene("J", "net", {{"net", ""}}),
      ofScene("J", "chainmail", {{"chainmail", ""}}),
      ofScene("J", "hanging", {{"hanging", ""}}),
  };
}

}  // namespace avbd::scenes
