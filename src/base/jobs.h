// Work shared by the threads of a world: pieces of a range, cut by count alone, so that what is computed does not
// depend on who computes it.
#pragma once

#include <avbd/tasks.h>

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>

#include "base/function_ref.h"

namespace avbd {

/// For the thread sanitizer even a small world's work is shared, by more threads and in smaller pieces than pays.
#ifdef AVBD_SHARE_ALL
inline constexpr bool kShareAll = true;
#else
inline constexpr bool kShareAll = false;
#endif

class Jobs {
 public:
  static constexpr int kMostWorkers = 64;

  /// `workers` threads, the caller of run() included; with a task system of the user's none are started.
  Jobs(int workers, TaskSystem tasks);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Threads that work at once at most. Those that do have numbers below it.
  int workers() const { return workers_; }

  /// Calls f(piece, worker) once for each piece of 0 .. count - 1 and returns when all have ended. Of what the pieces
  /// throw the lowest one's exception is thrown on.
  void run(uint32_t count, FunctionRef<void(uint32_t piece, int worker)> f);

  /// What forRange() makes of a grain: a piece begins at each multiple of it.
  static constexpr uint32_t grainOf(uint32_t grain) { return kShareAll && grain > 8 ? 8 : grain; }

  /// Calls f(begin, end, worker) for 0 .. count in pieces of grainOf(grain).
  template <class F>
  void forRange(uint32_t count, uint32_t grain, F&& f) {
    grain = grainOf(grain);
    const uint32_t pieces = (count + grain - 1) / grain;
    if (pieces == 0) return;
    run(pieces, [&](uint32_t piece, int worker) {
      const uint32_t begin = piece * grain;
      f(begin, begin + grain < count ? begin + grain : count, worker);
    });
  }

  /// How many runs of two pieces or more there were so far, each with a wait for the last of them, and the [s] of wall
  /// time in them.
  uint64_t sharedRuns() const { return sharedRuns_; }
  double sharedSeconds() const { return sharedSeconds_; }

  /// Throws what the user's task system threw since the last call.
  void throwFailure();

 private:
  struct Shared;
  void askForHelp(uint32_t count);
  void share(uint32_t count, FunctionRef<void(uint32_t, int)> f);

  int workers_;
  TaskSystem tasks_;
  std::shared_ptr<Shared> shared_;  ///< outlives the world in the user's copies of `help`
  std::function<void()> help_;
  struct Threads;
  std::unique_ptr<Threads> threads_;
  std::exception_ptr failure_;
  uint64_t sharedRuns_ = 0;
  double sharedSeconds_ = 0;
};

}  // namespace avbd
