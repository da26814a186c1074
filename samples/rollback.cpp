// Rollback as network code does it: two players, each on a machine of its own that simulates at once with the inputs it
// has, guesses those that are still on their way, and when they come goes back and simulates again.
//
//   rollback [FRAMES]        frames to play, 300 where nobody says
#include <avbd/avbd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>
using namespace avbd;

constexpr int kDelay = 8;  // frames that an input is on its way
constexpr float kDt = 1.0f / 60;

struct Input {
  float push = 0;  // [N] along x
  bool jump = false;
  friend bool operator==(const Input&, const Input&) = default;
};

// What a player does in a frame: here a script, on a real machine a gamepad.
Input played(int player, int frame) {
  const int beat = (frame + 17 * player) / 23;
  return {beat % 3 == 0 ? 60.0f : beat % 3 == 1 ? -60.0f : 0.0f, (frame + 31 * player) % 90 == 0};
}

// Two balls among boxes.
struct Game {
  World world;
  std::array<BodyId, 2> ball;

  Game() {
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    for (int side = -1; side <= 1; side += 2)
      world.create(BodyDef{.type = BodyType::Static, .position = {6.0 * side, 1, 0}, .shape = Box{0.5f, 1, 6}});
    for (int i = 0; i < 60; ++i)
      world.create(BodyDef{.position = {i % 6 - 2.5, 0.3 + 0.6 * (i / 12), 0.7 * (i / 6 % 2) - 0.35},
                           .shape = Box{0.3f, 0.3f, 0.3f},
                           .density = 50});
    for (int player = 0; player < 2; ++player)
      ball[static_cast<size_t>(player)] =
          world.create(BodyDef{.position = {4.0 - 8 * player, 0.5, 0}, .shape = Sphere{0.5f}, .density = 20});
  }

  void step(const std::array<Input, 2>& inputs) {
    for (size_t player = 0; player < 2; ++player) {
      world.addForce(ball[player], {inputs[player].push, 0, 0});
      if (inputs[player].jump) world.addImpulse(ball[player], {0, 4 * world.mass(ball[player]), 0});
    }
    world.step(kDt);
  }
};

// [ms] spent, and how often.
struct Cost {
  double sum = 0, most = 0;
  int count = 0;
  template <class F>
  void of(F&& f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    sum += ms, most = std::max(most, ms), ++count;
  }
  void print(const char* what) const {
    std::printf("%-30s %8.4f ms, %8.4f at most\n", what, count ? sum / count : 0, most);
  }
};

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 300;
  Game here, truth;                                      // ours; and one that always knows all inputs
  std::array<std::vector<std::byte>, kDelay + 1> saved;  // before frame f: saved[f % size]
  std::vector<Input> guessed;                            // of the other player, by frame
  Cost save, restore, resimulate, frame;
  const auto inputsOf = [&](int f) { return std::array{played(0, f), guessed[static_cast<size_t>(f)]}; };
  for (int now = 0; now < frames; ++now) {
    frame.of([&] {
      // The other's input of some frames ago has come. What we guess from it holds until we know better.
      const int known = now - kDelay;
      guessed.push_back({});
      for (int f = std::max(0, known); f <= now; ++f)
        guessed[static_cast<size_t>(f)] = known < 0 ? Input{} : Input{played(1, known).push, false};
      if (known >= 0) {
        guessed[static_cast<size_t>(known)] = played(1, known);
        restore.of([&] { here.world.restore(saved[static_cast<size_t>(known % (kDelay + 1))]); });
        resimulate.of([&] {
          for (int f = known; f < now; ++f) {
            // The frame that is known for good needs no further snapshot; the others are saved again.
            if (f > known) save.of([&] { here.world.save(saved[static_cast<size_t>(f % (kDelay + 1))]); });
            here.step(inputsOf(f));
          }
        });
      }
      save.of([&] { here.world.save(saved[static_cast<size_t>(now % (kDelay + 1))]); });
      here.step(inputsOf(now));
    });
  }
  // The last inputs come in, and both worlds are the same to the bit.
  const int last = std::max(0, frames - kDelay);
  for (int f = last; f < frames; ++f) guessed[static_cast<size_t>(f)] = played(1, f);
  here.world.restore(saved[static_cast<size_t>(last % (kDelay + 1))]);
  for (int f = last; f < frames; ++f) here.step(inputsOf(f));
  for (int f = 0; f < frames; ++f) truth.step({played(0, f), played(1, f)});

  std::printf("%d frames, each with %d of rollback; %zu bodies, a snapshot of %zu bytes\n", frames, kDelay,
              here.world.bodyCount(), here.world.snapshotSize());
  save.print("save");
  restore.print("restore");
  resimulate.print("eight steps again, with saves");
  frame.print("a frame in all");
  const bool same = here.world.hash() == truth.world.hash();
  std::printf("%s\n",
              same ? "the same, to the bit, as with all inputs in time" : "NOT the same as with inputs in time");
  return same ? 0 : 1;
}
