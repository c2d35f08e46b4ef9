#pragma once
// Calls of the caller's filter, which may throw, from searches inside of trees, which must not throw.

#include <atomic>
#include <cstdint>
#include <mutex>

#include "ray/line/ray_query.h"
#include "ray/line/set_view.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The filter of one call. Any number of threads.
class BatchFilter {
 public:
  /// Refers to the filter, which must not be empty.
  explicit BatchFilter(const HitFilter& filter) : filter_(filter) {}

  /// Asks the filter, with denormal numbers counted and not flushed to zero. An exception is kept, and stops
  /// the batch.
  HitVerdict ask(const HitCandidate& candidate) noexcept;
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  /// Returns why the batch stopped. Call it once all threads are done.
  Status status() const { return status_; }

 private:
  void stop(Status status) noexcept;

  const HitFilter& filter_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  Status status_;
};

/// Passes the roots of one scene's patches to the filter of a batch.
class SceneFilter final : public RootFilter {
 public:
  SceneFilter(BatchFilter* filter, const SetView& set, std::uint32_t instance = Hit::no_instance)
      : filter_(filter), set_(set), instance_(instance) {}

  /// Returns the filter of a query: null if the batch has none.
  const RootFilter* if_any() const { return filter_ == nullptr ? nullptr : this; }
  HitVerdict decide(const RayQuery& query, const LeafRoot& root) const noexcept override;

 private:
  BatchFilter* filter_;
  const SetView& set_;
  std::uint32_t instance_;
};

}}  // namespace tessera::abi_0_1
