#include "parallel/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "parallel/tbb_loop.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Counts pieces and reports to the caller, one call at a time and about a hundred times in all.
class Progress {
 public:
  Progress(const Execution& execution, std::size_t pieces) : execution_(execution), pieces_(pieces) {}

  void piece_done() {
    if (!execution_.progress) return;
    const std::size_t done = ++done_;
    if (done != pieces_ && done * 100 / pieces_ == (done - 1) * 100 / pieces_) return;
    const std::lock_guard lock(mutex_);
    if (done <= reported_) return;  // a later piece has reported first
    reported_ = done;
    // Another piece on this thread would wait for the lock that this thread holds.
    without_other_tasks([&] { execution_.progress(static_cast<double>(done) / static_cast<double>(pieces_)); });
  }

 private:
  const Execution& execution_;
  std::size_t pieces_;
  std::atomic<std::size_t> done_{0};
  std::size_t reported_ = 0;
  std::mutex mutex_;
};

}  // namespace

Status parallel_for(std::size_t count, std::size_t grain, const Execution& execution,
                    FunctionRef<void(std::size_t, std::size_t)> body) {
  return guarded([&]() -> Status {
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t pieces = count / grain + (count % grain != 0);
    if (execution.report) execution.report->tasks = pieces;
    Progress progress(execution, pieces);
    std::atomic<bool> was_cancelled = false;  // the flag may be lowered again, but pieces are missing
    const auto cancelled = [&] {
      if (execution.cancel && execution.cancel->load(std::memory_order_relaxed))
        was_cancelled.store(true, std::memory_order_relaxed);
      return was_cancelled.load(std::memory_order_relaxed);
    };
    const auto run_piece = [&](std::size_t piece) {
      if (cancelled()) return;
      body(piece * grain, std::min(count, (piece + 1) * grain));
      progress.piece_done();
    };
    if (pieces <= 1) {
      if (pieces == 1) run_piece(0);
      if (pieces == 0 && execution.progress) execution.progress(1);
    } else {
      tbb_loop(pieces, run_piece);
    }
    if (cancelled()) return Status(StatusCode::cancelled, "cancelled by the caller");
    return {};
  });
}

}}  // namespace tessera::abi_0_1
