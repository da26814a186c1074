// The classic house of cards: storey k has 5 - k tents of two leaning cards, and flat cards from tip to tip above them.
#include <utility>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trig.h"

namespace avbd::scenes {
namespace {

constexpr int kStoreys = 5;
constexpr double kLong = 1, kThick = 0.04;
// tan 22 degrees = 0.40: two thirds of the friction 0.6 that the feet and the flat cards can give.
constexpr double kLean = 22 * 3.14159265358979323846 / 180;
// A flat card reaches from tip to tip; a millimetre keeps neighbours apart.
constexpr double kPitch = kLong + 0.001;
constexpr Box kCard{0.02f, 0.5f, 0.3f};

struct Card {
  Vec3d at;
  double turn = 0;  // about z; 0 stands upright
};

std::vector<Card> plan() {
  std::vector<Card> cards;
  const double rise = kLong * cosine(kLean) + kThick * sine(kLean);
  // From the tip, where the two inner corners meet, to a leaning card's centre.
  const double out = (kLong * sine(kLean) + kThick * cosine(kLean)) / 2;
  for (int k = 0; k < kStoreys; ++k) {
    const int tents = kStoreys - k;
    const double floor = k * (rise + kThick);
    for (int i = 0; i < tents; ++i) {
      const double tip = (i - (tents - 1) / 2.0) * kPitch;
      cards.push_back({{tip - out, floor + rise / 2, 0}, -kLean});
      cards.push_back({{tip + out, floor + rise / 2, 0}, kLean});
      if (i + 1 < tents)
        cards.push_back({{tip + kPitch / 2, floor + rise + kThick / 2, 0}, 3.14159265358979323846 / 2});
    }
  }
  return cards;
}

}  // namespace

Model cardHouse(const Settings& settings, uint32_t seed) {
  std::vector<Card> cards = plan();
  Draws draws(seed);
  for (size_t i = cards.size(); i > 1 && seed != 0; --i)
    std::swap(cards[i - 1], cards[draws.below(static_cast<uint32_t>(i))]);
  Build build("card_house", settings);
  build.ground();
  for (size_t i = 0; i < cards.size(); ++i)
    build.box("card_" + std::to_string(i), kCard, cards[i].at, 1, {}, turned({0, 0, 1}, cards[i].turn));
  return build.take();
}

}  // namespace avbd::scenes
