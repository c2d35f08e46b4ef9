#include "ray/scene/batch_filter.h"

#include <string>
#include <utility>

#include "ray/line/flush_denormals.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {

HitVerdict BatchFilter::ask(const HitCandidate& candidate) noexcept {
  if (stopped()) return HitVerdict::stop;
  try {
    const HitVerdict verdict = filter_(candidate);
    if (verdict == HitVerdict::accept || verdict == HitVerdict::reject) return verdict;
    stop(Status(StatusCode::cancelled, "stopped by the filter at ray " + std::to_string(candidate.ray),
                static_cast<std::ptrdiff_t>(candidate.ray)));
  } catch (...) {
    stop(status_of_exception());
  }
  return HitVerdict::stop;
}

/// Keeps the first reason.
void BatchFilter::stop(Status status) noexcept {
  const std::lock_guard lock(mutex_);
  if (stopped_.exchange(true)) return;
  status_ = std::move(status);
}

HitVerdict SceneFilter::decide(const RayQuery& query, const LeafRoot& root) const noexcept {
  const CountDenormals count;
  const PatchSource& source = set_.source(root.patch);
  return filter_->ask({.ray = query.index,
                       .instance = instance_,
                       .surface = source.surface,
                       .patch = root.patch,
                       .t = query.t_of(root),
                       .u = source.domain.u_at(root.u),
                       .v = source.domain.v_at(root.v),
                       .patch_u = root.u,
                       .patch_v = root.v});
}

}}  // namespace tessera::abi_0_1
