#pragma once
// The progress of a call that runs several loops one after the other.

#include <cstddef>
#include <span>

#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Turns the progress of a call's loops, each from 0 to 1, into one rise from 0 to 1. Threads: a loop must report one
/// call at a time, and loops must not overlap.
class CallProgress {
 public:
  /// `ends`: the share of the call that is done after each loop, rising to at most 1. A further loop takes half of the
  /// rest. `execution` and `ends` must outlive this object.
  CallProgress(const Execution& execution, std::span<const double> ends)
      : execution_(execution),
        ends_(ends),
        loops_{.cancel = execution.cancel, .progress = {}, .stores = execution.stores, .report = execution.report} {
    if (execution.progress) loops_.progress = [this](double done) { loop_reports(done); };
  }
  CallProgress(const CallProgress&) = delete;
  CallProgress& operator=(const CallProgress&) = delete;

  /// Options for each loop: those of the call, except for progress.
  const Execution& loops() const { return loops_; }

  /// Ends the call and returns `status`. If it is ok, reports 1 unless the last loop did.
  Status finish(Status status) {
    if (status.ok()) report(1);
    return status;
  }

 private:
  /// The reports of a loop rise, so a report that does not rise is the first of the next loop.
  void loop_reports(double done) {
    if (done <= last_) {
      begin_ = end_;
      end_ = ++loop_ < ends_.size() ? ends_[loop_] : begin_ + (1 - begin_) / 2;
    }
    last_ = done;
    report(begin_ + (end_ - begin_) * done);
  }

  void report(double share) {
    if (!execution_.progress || !(share > reported_)) return;
    reported_ = share;
    execution_.progress(share);
  }

  const Execution& execution_;
  std::span<const double> ends_;
  Execution loops_;
  std::size_t loop_ = 0;
  double begin_ = 0, end_ = ends_.empty() ? 0.5 : ends_[0];
  double last_ = 0, reported_ = 0;
};

}}  // namespace tessera::abi_0_1
