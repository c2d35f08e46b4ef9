#pragma once
// Runs work in an arena of a number of threads, and proves that all of them took part.

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

namespace tessera::test {

/// Blocks threads until enough different ones have come, or for ten seconds.
class Meeting {
 public:
  explicit Meeting(std::size_t threads) : threads_(threads) {}

  void join() {
    std::unique_lock lock(mutex_);
    ids_.insert(std::this_thread::get_id());
    if (ids_.size() >= threads_) met_.notify_all();
    met_.wait_for(lock, std::chrono::seconds(10), [&] { return ids_.size() >= threads_; });
  }
  std::size_t threads() const {
    const std::lock_guard lock(mutex_);
    return ids_.size();
  }

 private:
  std::size_t threads_;
  mutable std::mutex mutex_;
  std::condition_variable met_;
  std::set<std::thread::id> ids_;
};

/// Runs body() in an arena of `threads` threads, all of which have worked there before. Returns how many different
/// ones.
template <class Body>
std::size_t with_workers(int threads, Body&& body) {
  // The arena may be larger than the machine; without this limit oneTBB would make no more workers than it has cores.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Meeting meeting(static_cast<std::size_t>(threads));
  arena.execute([&] {
    tbb::parallel_for(
        0, threads, [&](int) { meeting.join(); }, tbb::simple_partitioner());
    body();
  });
  return meeting.threads();
}

}  // namespace tessera::test
