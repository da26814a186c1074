// The user's own threads for a world's steps.
#pragma once

#include <functional>

namespace avbd {

/// A task system that helps a world's steps, in place of the threads that the world would start itself.
///
/// Whenever a stage has work to share, the thread that called World::step() calls `run` once. `run` should call `help`
/// from up to `count` other threads, or hand it to tasks that do, and may return at once. A call of `help` takes what
/// is left of the stage's work, piece by piece, and returns when nothing is left. No call is needed for the result:
/// what nobody took the caller does itself. So calls may come in any order, late (in a later stage or step they help
/// there; after the world has died they do nothing), more often than asked, or never; the bits of the result are the
/// same.
struct TaskSystem {
  /// Threads that may help at once, the caller of step() included: 1 .. 64. More return from `help` at once.
  int workers = 1;
  /// Empty: the world starts WorldDef::workers - 1 threads of its own. A copy of `help` may be kept as long as wanted.
  /// What `run` throws, World::step() throws when the step is done.
  std::function<void(const std::function<void()>& help, int count)> run{};
};

}  // namespace avbd
