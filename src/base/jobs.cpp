// Threads and the tickets that they take pieces from.
//
// A job's pieces are cut into as many runs as there are workers, each with a ticket: which piece is next, and which is
// beyond the last. Whoever raises the first number owns that piece, and the job cannot end before its pieces have: so
// whoever comes late, or twice, either takes a piece of the job that runs or finds none. A worker takes from its own
// run first, so that in job after job over the same things the same processor has them in its cache.
#include "base/jobs.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/float_mode.h"

namespace avbd {

namespace {

/// Looks at the ticket before a thread sleeps: a millisecond or two, more than the stages between two that share work.
/// To be woken takes some tens of microseconds, as long as a whole piece.
constexpr int kSpins = 60000;

void relax() {
#if defined(__SSE2__)
  _mm_pause();
#endif
}

struct alignas(64) Ticket {
  std::atomic<uint64_t> value{0};  ///< end << 32 | next

  static bool isOpen(uint64_t value) { return static_cast<uint32_t>(value) < static_cast<uint32_t>(value >> 32); }
  bool isOpen() const { return isOpen(value.load(std::memory_order_acquire)); }
  void open(uint32_t begin, uint32_t end) { value.store(uint64_t(end) << 32 | begin, std::memory_order_release); }
  bool take(uint32_t& mine) {
    uint64_t seen = value.load(std::memory_order_acquire);
    while (isOpen(seen)) {
      if (!value.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel, std::memory_order_acquire)) continue;
      mine = static_cast<uint32_t>(seen);
      return true;
    }
    return false;
  }
};

}  // namespace

struct Jobs::Shared {
  explicit Shared(int workers) : slots(workers), tickets(static_cast<size_t>(workers)) {}

  const int slots;
  std::vector<Ticket> tickets;       ///< by worker
  std::atomic<uint32_t> ended{0};    ///< pieces of the job
  std::atomic<uint64_t> helpers{1};  ///< bit by worker number that is in use; 0 is the caller's
  std::atomic<uint32_t> jobs{0};     ///< how many were begun
  std::atomic<bool> stops{false};
  std::optional<FunctionRef<void(uint32_t, int)>> piece;
  std::mutex failing;
  std::exception_ptr failure;  ///< of the lowest piece that threw
  uint32_t failed = 0;

  void open(uint32_t count) {
    const uint64_t runs = tickets.size();
    for (uint64_t i = 0; i < runs; ++i)
      tickets[i].open(static_cast<uint32_t>(count * i / runs), static_cast<uint32_t>(count * (i + 1) / runs));
  }

  /// The number of a piece that is now the caller's alone, from its own run or else the next; false if none is left.
  bool take(int worker, uint32_t& mine) {
    const size_t runs = tickets.size(), own = static_cast<size_t>(worker);
    for (size_t i = 0; i < runs; ++i)
      if (tickets[(own + i) % runs].take(mine)) return true;
    return false;
  }

  bool hasWork() const {
    return std::any_of(tickets.begin(), tickets.end(), [](const Ticket& ticket) { return ticket.isOpen(); });
  }

  void work(int worker) {
    for (uint32_t mine; take(worker, mine);) {
      try {
        (*piece)(mine, worker);
      } catch (...) {
        const std::lock_guard lock(failing);
        if (!failure || mine < failed) failure = std::current_exception(), failed = mine;
      }
      ended.fetch_add(1, std::memory_order_acq_rel);
    }
  }

  /// A worker's number, or -1 where as many work as may.
  int enter() {
    uint64_t used = helpers.load(std::memory_order_relaxed);
    for (;;) {
      int free = 0;
      while (free < slots && (used >> free & 1)) ++free;
      if (free == slots) return -1;
      if (helpers.compare_exchange_weak(used, used | uint64_t(1) << free, std::memory_order_acquire)) return free;
    }
  }
  void leave(int worker) { helpers.fetch_and(~(uint64_t(1) << worker), std::memory_order_release); }

  void help() {
    if (!hasWork()) return;
    const int worker = enter();
    if (worker < 0) return;
    const FloatMode mode;
    work(worker);
    leave(worker);
  }
};

struct Jobs::Threads {
  std::vector<std::thread> list;
  Shared& shared;

  Threads(Shared& s, int count) : shared(s) {
    for (int i = 0; i < count; ++i) list.emplace_back([this, i] { loop(i + 1); });
  }
  ~Threads() {
    shared.stops = true;
    shared.jobs.fetch_add(1);
    shared.jobs.notify_all();
    for (std::thread& thread : list) thread.join();
  }

  void loop(int worker) {
    const FloatMode mode;
    // More threads than cores: waiting awake would keep the others from working.
    const unsigned cores = std::thread::hardware_concurrency();
    const int spins = cores == 0 || static_cast<unsigned>(shared.slots) <= cores ? kSpins : 0;
    uint32_t seen = 0;
    while (!shared.stops) {
      for (int i = 0; i < spins && shared.jobs.load(std::memory_order_acquire) == seen; ++i) relax();
      shared.jobs.wait(seen, std::memory_order_acquire);
      seen = shared.jobs.load(std::memory_order_acquire);
      shared.work(worker);
    }
  }
};

Jobs::Jobs(int workers, TaskSystem tasks)
    : workers_(tasks.run ? tasks.workers : workers),
      tasks_(std::move(tasks)),
      shared_(std::make_shared<Shared>(workers_)) {
  if (tasks_.run)
    help_ = [shared = shared_] { shared->help(); };
  else if (workers_ > 1)
    threads_ = std::make_unique<Threads>(*shared_, workers_ - 1);
}

Jobs::~Jobs() = default;

void Jobs::askForHelp(uint32_t count) {
  const int wanted = count - 1 < static_cast<uint32_t>(workers_ - 1) ? static_cast<int>(count - 1) : workers_ - 1;
  if (threads_) {
    shared_->jobs.fetch_add(1, std::memory_order_acq_rel);
    shared_->jobs.notify_all();
    return;
  }
  try {
    tasks_.run(help_, wanted);
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
}

void Jobs::run(uint32_t count, FunctionRef<void(uint32_t, int)> f) {
  if (count < 2) {
    if (count == 1) f(0, 0);
    return;
  }
  const double start = wallSeconds();
  if (workers_ == 1)
    for (uint32_t i = 0; i < count; ++i) f(i, 0);
  else
    share(count, f);
  ++sharedRuns_;
  sharedSeconds_ += wallSeconds() - start;
}

void Jobs::share(uint32_t count, FunctionRef<void(uint32_t, int)> f) {
  Shared& shared = *shared_;
  shared.piece = f;
  shared.ended.store(0, std::memory_order_relaxed);
  shared.open(count);
  askForHelp(count);
  shared.work(0);
  for (int i = 0; shared.ended.load(std::memory_order_acquire) != count; ++i)
    i < kSpins ? relax() : std::this_thread::yield();
  if (shared.failure) std::rethrow_exception(std::exchange(shared.failure, nullptr));
}

void Jobs::throwFailure() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace avbd
