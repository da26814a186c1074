// Every piece runs once, whoever helps, and however badly.
#include "base/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace avbd {
namespace {

/// How often each of `count` pieces ran in each of some rounds; all must be 1.
void expectOnce(Jobs& jobs, uint32_t count, int rounds) {
  std::vector<std::atomic<int>> runs(count);
  for (int round = 1; round <= rounds; ++round) {
    jobs.run(count, [&](uint32_t piece, int worker) {
      EXPECT_GE(worker, 0);
      EXPECT_LT(worker, jobs.workers());
      ++runs[piece];
    });
    for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(runs[i], round) << "piece " << i;
  }
}

TEST(Jobs, RunEveryPieceOnce) {
  for (const int workers : {1, 2, 3, 8}) {
    Jobs jobs(workers, {});
    for (const uint32_t count : {0u, 1u, 2u, 7u, 100u}) expectOnce(jobs, count, 200);
  }
}

TEST(Jobs, RangesAreCutByCountAlone) {
  for (const int workers : {1, 2, 5}) {
    Jobs jobs(workers, {});
    std::vector<std::pair<uint32_t, uint32_t>> cut(4);
    jobs.forRange(25, 8, [&](uint32_t begin, uint32_t end, int) { cut[begin / 8] = {begin, end}; });
    EXPECT_EQ(cut, (std::vector<std::pair<uint32_t, uint32_t>>{{0, 8}, {8, 16}, {16, 24}, {24, 25}}));
  }
}

// What a piece finds is placed by its number, also where pieces are smaller than was asked for.
TEST(Jobs, PiecesOfRangesHaveNumbers) {
  Jobs jobs(3, {});
  constexpr uint32_t kGrain = Jobs::grainOf(32);
  std::vector<std::atomic<int>> pieces((100 + kGrain - 1) / kGrain);
  jobs.forRange(100, 32, [&](uint32_t begin, uint32_t, int) { ++pieces[begin / kGrain]; });
  for (const std::atomic<int>& piece : pieces) EXPECT_EQ(piece, 1);
}

TEST(Jobs, ThrowWhatTheLowestPieceThrew) {
  for (const int workers : {1, 2, 8}) {
    Jobs jobs(workers, {});
    for (int round = 0; round < 50; ++round) {
      try {
        jobs.run(64, [](uint32_t piece, int) {
          if (piece == 9 || piece == 40) throw std::runtime_error(std::to_string(piece));
        });
        FAIL();
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "9");
      }
      expectOnce(jobs, 10, 1);
    }
  }
}

TEST(Jobs, TwoWorkersWorkAtOnce) {
  Jobs jobs(2, {});
  std::atomic<int> inside{0};
  // Each piece waits for the other.
  jobs.run(2, [&](uint32_t, int) {
    ++inside;
    while (inside < 2) std::this_thread::yield();
  });
  EXPECT_EQ(inside, 2);
}

TEST(TaskSystem, MayNotHelpAtAll) {
  Jobs jobs(1, {4, [](const std::function<void()>&, int) {}});
  EXPECT_EQ(jobs.workers(), 4);
  expectOnce(jobs, 50, 20);
}

TEST(TaskSystem, MayHelpAtOnceTwiceAndMoreOftenThanAsked) {
  Jobs jobs(1, {3, [](const std::function<void()>& help, int count) {
                  for (int i = 0; i < 2 * count + 3; ++i) help();
                }});
  expectOnce(jobs, 50, 20);
}

TEST(TaskSystem, MayHelpLateAndFromManyThreads) {
  std::vector<std::function<void()>> kept;
  std::vector<std::thread> threads;
  std::atomic<bool> stop{false};
  {
    Jobs jobs(1, {3, [&](const std::function<void()>& help, int count) {
                    for (int i = 0; i < count && kept.size() < 8; ++i) {
                      kept.push_back(help);
                      threads.emplace_back([help, &stop] {
                        while (!stop) help();
                      });
                    }
                  }});
    expectOnce(jobs, 50, 500);
  }
  // The world is gone; who still helps finds nothing to do.
  for (const auto& help : kept) help();
  stop = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(kept.size(), 8u);
}

TEST(TaskSystem, ItsExceptionComesWhenTheWorkIsDone) {
  Jobs jobs(1, {3, [](const std::function<void()>&, int) { throw std::runtime_error("no threads"); }});
  expectOnce(jobs, 50, 3);
  EXPECT_THROW(jobs.throwFailure(), std::runtime_error);
  EXPECT_NO_THROW(jobs.throwFailure());
}

}  // namespace
}  // namespace avbd
