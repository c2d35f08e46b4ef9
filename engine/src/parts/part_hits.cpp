#include "tessera/part_hits.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/text.h"
#include "parts/packed_message.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::uint64_t max_rays = std::uint64_t{1} << 31, max_patches = std::uint64_t{1} << 32;

/// The facts of a hit that the part must know that answers for its ray. Without a hit t is infinite.
struct HitCandidate {
  std::uint32_t ray : 31 = 0, incomplete : 1 = 0;
  std::uint32_t patch = 0;  ///< of the model
  double t = std::numeric_limits<double>::infinity();

  bool is_before(const HitCandidate& other) const { return t < other.t || (t == other.t && patch < other.patch); }
};
static_assert(sizeof(HitCandidate) == 16);
// Without gaps, so that a hit's bytes depend on its numbers alone.
static_assert(std::is_trivially_copyable_v<Hit> && sizeof(Hit) == 16 + 18 * sizeof(double));

/// The merging of one list of hits.
class HitMerger {
 public:
  HitMerger(Transport& transport, std::span<const Hit> hits, std::uint64_t first_patch)
      : transport_(transport), hits_(hits), first_patch_(first_patch), own_(run_of(transport.part())) {}

  Result<std::vector<Hit>> merge() {
    Result<std::vector<Message>> candidates = transport_.exchange(candidates_of_runs());
    if (!candidates) return candidates.status();
    choose(*candidates);
    Result<std::vector<Message>> wanted = transport_.exchange(rays_of_winners());
    if (!wanted) return wanted.status();
    const Result<std::vector<Message>> won = transport_.exchange(hits_that_won(*wanted));
    if (!won) return won.status();
    return merged(*won);
  }

 private:
  PartRun run_of(std::size_t part) const { return run_of_part(hits_.size(), part, transport_.part_count()); }

  /// Hits of the other parts' runs, for these.
  std::vector<Message> candidates_of_runs() const {
    std::vector<Message> messages(transport_.part_count());
    for (std::size_t part = 0; part < messages.size(); ++part) {
      const PartRun run = run_of(part);
      for (std::size_t ray = run.begin; ray < run.end && part != transport_.part(); ++ray)
        if (is_told(hits_[ray])) append(messages[part], candidate(ray, run));
    }
    return messages;
  }

  static bool is_told(const Hit& hit) { return hit.kind == HitKind::hit || hit.flags.incomplete; }

  HitCandidate candidate(std::size_t ray, const PartRun& run) const {
    const Hit& hit = hits_[ray];
    HitCandidate out;
    out.ray = static_cast<std::uint32_t>(ray - run.begin) & 0x7FFFFFFFu;
    out.incomplete = hit.flags.incomplete ? 1 : 0;
    if (hit.kind != HitKind::hit) return out;
    out.patch = static_cast<std::uint32_t>(first_patch_ + hit.patch);
    out.t = hit.t;
    return out;
  }

  /// Finds for each ray of the own run the part that has the nearest hit.
  void choose(const std::vector<Message>& candidates) {
    const auto own = static_cast<std::uint32_t>(transport_.part());
    best_.reserve(own_.end - own_.begin);
    for (std::size_t ray = own_.begin; ray < own_.end; ++ray) best_.push_back(candidate(ray, own_));
    winners_.assign(best_.size(), own);
    for (std::size_t part = 0; part < candidates.size(); ++part) {
      for (std::size_t k = 0; k < count_in<HitCandidate>(candidates[part]); ++k) {
        const auto other = element<HitCandidate>(candidates[part], k);
        HitCandidate& best = best_[other.ray];
        const bool is_incomplete = best.incomplete != 0 || other.incomplete != 0;
        if (other.is_before(best)) best = other, winners_[other.ray] = static_cast<std::uint32_t>(part);
        best.incomplete = is_incomplete ? 1 : 0;
      }
    }
  }

  std::vector<Message> rays_of_winners() const {
    std::vector<Message> messages(transport_.part_count());
    for (std::uint32_t k = 0; k < winners_.size(); ++k)
      if (winners_[k] != transport_.part()) append(messages[winners_[k]], k);
    return messages;
  }

  std::vector<Message> hits_that_won(const std::vector<Message>& wanted) const {
    std::vector<Message> messages(wanted.size());
    for (std::size_t part = 0; part < wanted.size(); ++part)
      for (std::size_t k = 0; k < count_in<std::uint32_t>(wanted[part]); ++k)
        append(messages[part], model_hit(run_of(part).begin + element<std::uint32_t>(wanted[part], k)));
    return messages;
  }

  /// A hit of this part with its patch in the model.
  Hit model_hit(std::size_t ray) const {
    Hit hit = hits_[ray];
    if (hit.kind == HitKind::hit) hit.patch = static_cast<std::uint32_t>(first_patch_ + hit.patch);
    return hit;
  }

  std::vector<Hit> merged(const std::vector<Message>& won) const {
    std::vector<Hit> out;
    out.reserve(winners_.size());
    std::vector<std::size_t> next(won.size());
    for (std::size_t k = 0; k < winners_.size(); ++k) {
      const std::uint32_t winner = winners_[k];
      out.push_back(winner == transport_.part() ? model_hit(own_.begin + k)
                                                : element<Hit>(won[winner], next[winner]++));
      if (best_[k].incomplete != 0) out.back().flags.incomplete = true;
    }
    return out;
  }

  Transport& transport_;
  std::span<const Hit> hits_;
  std::uint64_t first_patch_;
  PartRun own_;
  std::vector<HitCandidate> best_;      ///< by ray of the own run
  std::vector<std::uint32_t> winners_;  ///< the parts of these
};

Status check_hits(std::span<const Hit> hits, std::uint64_t first_patch) {
  const auto unsupported = [](std::string why) { return Status(StatusCode::unsupported, std::move(why)); };
  if (hits.size() >= max_rays) return unsupported("there are " + counted(hits.size(), "ray") + ", 2^31 or more");
  for (const Hit& hit : hits) {
    if (hit.kind != HitKind::hit) continue;
    if (hit.instance != Hit::no_instance) return unsupported("a hit is in an instance; scenes of parts have patches");
    if (first_patch >= max_patches || first_patch + hit.patch >= max_patches)
      return unsupported("a hit is in patch " + std::to_string(first_patch) + " + " + std::to_string(hit.patch) +
                         " of the model, 2^32 or more");
  }
  return {};
}

/// All parts must have as many rays, and hits that can be merged.
Status agree_on_hits(Transport& transport, const Status& own, std::size_t count) {
  if (Status status = transport.agree(own); !status.ok()) return status;
  double range[] = {static_cast<double>(count), -static_cast<double>(count)};
  if (Status status = transport.reduce_max(range); !status.ok()) return status;
  if (range[0] == -range[1]) return {};
  return Status(StatusCode::count_mismatch, "parts have from " + text(-range[1]) + " to " + text(range[0]) +
                                                " rays, expected the same rays in each");
}

}  // namespace

Result<std::vector<Hit>> merge_closest(Transport& transport, std::span<const Hit> hits, std::uint64_t first_patch) {
  return guarded([&]() -> Result<std::vector<Hit>> {
    if (Status status = agree_on_hits(transport, check_hits(hits, first_patch), hits.size()); !status.ok())
      return status;
    return HitMerger(transport, hits, first_patch).merge();
  });
}

Result<std::vector<Hit>> closest_in_parts(Transport& transport, const RayScene& scene, std::uint64_t first_patch,
                                          std::span<const Ray> rays, const Execution& execution) {
  return guarded([&]() -> Result<std::vector<Hit>> {
    std::vector<Hit> hits;
    const Status traced = guarded([&] {
      hits.resize(rays.size());
      return scene.closest(rays, hits, execution);
    });
    Status own = traced.ok() ? check_hits(hits, first_patch) : traced;
    if (Status status = agree_on_hits(transport, own, rays.size()); !status.ok()) return status;
    return HitMerger(transport, hits, first_patch).merge();
  });
}

}}  // namespace tessera::abi_0_1
