#include "tess/plan/rates.h"

#include <algorithm>
#include <utility>

#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/bounds/task_size.h"
#include "tess/edges/segment_choices.h"
#include "tess/plan/refusals.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Chooses for all patches by a distance alone, block by block.
class RatesByDistance {
 public:
  RatesByDistance(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                  std::span<std::uint8_t> beyond)
      : facts_(facts), needs_(facts.needs), request_(request), patches_(patches), beyond_(beyond) {}

  /// Errors: cancelled.
  Status run(const Execution& execution) {
    if (request_.fewest) choices_.resize(beyond_.size());
    const auto choose_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block) choose_block(block);
    };
    const Execution quiet{.cancel = execution.cancel}, &first = choices_.empty() ? execution : quiet;
    return parallel_for(needs_.set().lane_counts.size(), blocks_per_task, first, choose_some);
  }

  /// Replaces the rates by those with which the patches together have the fewest triangles, if these are wanted.
  /// Errors: cancelled.
  Status take_fewest(const Execution& execution) {
    if (choices_.empty()) return {};
    const auto no_others = [](PatchSegments) { return true; };
    const auto find = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (const double left = left_of(k); !needs_.shapes()[k].is_curve && left > 0)
          find_fewer(needs_.set().patches[k], (1 - request_.headroom) * left, no_others, choices_[k]);
    };
    if (Status status = parallel_for(choices_.size(), 1, execution, find); !status.ok()) return status;
    const Borders& borders = facts_.borders;
    const auto chosen =
        choose_together(borders.shapes(needs_), borders.edges(), borders.against(needs_), choices_, execution.cancel);
    if (!chosen) return chosen.status();
    for (std::size_t k = 0; k < choices_.size(); ++k) set(k, choices_[k][(*chosen)[k]], left_of(k), nullptr);
    return {};
  }

 private:
  double left_of(std::size_t patch) const {
    return needs_.tolerance_of(patch, request_.tolerance) - needs_.given(patch);
  }

  void choose_block(std::size_t block) {
    const std::uint32_t* patches = needs_.set().lane_patches.data() + block * PatchSet::lanes;
    const std::size_t count = needs_.set().lane_counts[block];
    ChordBlocks::Lanes<double> left, given;
    left.fill(request_.tolerance);
    for (std::size_t lane = 0; lane < count; ++lane) {
      given[lane] = needs_.given(patches[lane]);
      left[lane] = needs_.tolerance_of(patches[lane], request_.tolerance) - given[lane];
    }
    ChordBlocks::Lanes<double> aimed = left;
    for (double& of : aimed) of *= 1 - request_.headroom;
    ChordBlocks::Products products;
    const ChordBlocks::Choice choice = needs_.chords().cheapest(needs_.set(), block, count, aimed, max_rate, products);
    const bool takes_best = choices_.empty() && request_.kept.segments.empty();
    PatchSegments* const segments = patches_.segments.data();
    float* const bounds = patches_.bounds.data();
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::size_t k = patches[lane];
      const bool is_beyond = !(left[lane] > 0) || choice.rates[lane].u == 0;
      if (is_beyond || !takes_best) {
        const bool is_sharp = choice.sharpened >> lane & 1u;
        take(k, {choice.rates[lane], choice.distance[lane]}, is_beyond, left[lane], is_sharp ? &products : nullptr);
      } else {
        segments[k] = choice.rates[lane];
        bounds[k] = rounded_up(choice.distance[lane] + given[lane]);
      }
    }
  }

  /// Takes what was found for a patch: as a choice, or to be set.
  void take(std::size_t patch, ProvenSegments proven, bool is_beyond, double left,
            const ChordBlocks::Products* products) {
    if (is_beyond) {
      beyond_[patch] = 1;
      proven.segments = segments_beyond(needs_, patch, request_).segments;
      proven.distance = needs_.chord(patch).distance_of(proven.segments);
    }
    if (!choices_.empty())
      choices_[patch] = SegmentChoices(proven);
    else
      set(patch, proven, left, products);
  }

  /// Sets the segments of a patch, or those that it keeps. `products`: see keep_by_distance().
  void set(std::size_t patch, const ProvenSegments& best, double left, const ChordBlocks::Products* products) {
    const ProvenSegments proven =
        request_.kept.segments.empty() ? best : keep_by_distance(needs_, patch, left, request_.kept, products, best);
    patches_.segments[patch] = proven.segments;
    patches_.bounds[patch] = rounded_up(proven.distance + needs_.given(patch));
    if (proven.anywhere) patches_.crosses[patch] = 1;
  }

  const PlanFacts& facts_;
  const PatchNeeds& needs_;
  const PlanRequest& request_;
  DividedPatches& patches_;
  std::span<std::uint8_t> beyond_;
  std::vector<SegmentChoices> choices_;  ///< `[patch]`; empty unless the fewest triangles are wanted
};

/// Chooses for all patches by all limits, one by one. Errors: cancelled.
Status choose_one_by_one(const PatchNeeds& needs, const PlanRequest& request, DividedPatches& patches,
                         std::span<std::uint8_t> beyond, const Execution& execution) {
  const auto choose_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      NeededSegments needed = needs.segments_for(k, request, max_rate);
      beyond[k] = !needed.are_found();
      if (beyond[k]) needed = segments_beyond(needs, k, request);
      patches.segments[k] = needed.segments;
      patches.crosses[k] = needed.anywhere;
      patches.bounds[k] = rounded_up(needed.bound);
      if (!patches.angles.empty()) patches.angles[k] = rounded_up(needed.angle);
      if (!patches.pixels.empty()) patches.pixels[k] = rounded_up(needed.pixels);
    }
  };
  return parallel_for(beyond.size(), normals_per_task, execution, choose_some);
}

/// States the patches beyond their limits. A tolerance that some patches keep is that of the mesh, and the others state
/// their bounds. One that none keeps is a mistake. Errors: invalid_argument.
Status keep_beyond(const PlanFacts& facts, const PlanRequest& request, std::span<const std::uint8_t> is_beyond,
                   DividedPatches& patches) {
  for (auto at = std::ranges::find(is_beyond, 1); at != is_beyond.end(); at = std::find(at + 1, is_beyond.end(), 1))
    patches.rare.make().beyond.push_back(static_cast<std::uint32_t>(at - is_beyond.begin()));
  const std::vector<std::uint32_t>& beyond = patches.rare->beyond;
  return beyond.empty() || beyond.size() < is_beyond.size() ? Status() : refusal(facts, request, beyond.front());
}

}  // namespace

Status choose_rates(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                    const Execution& execution) {
  const PlannerOptions& options = facts.needs.options();
  const std::size_t count = facts.needs.shapes().size();
  patches.segments.resize(count);
  patches.bounds.resize(count);
  if (options.fewest || options.angle || options.camera) patches.crosses.resize(count);
  if (options.angle) patches.angles.resize(count);
  if (options.camera) patches.pixels.resize(count);
  std::vector<std::uint8_t> beyond(count, 0);
  if (options.angle || options.camera) {
    Status status = choose_one_by_one(facts.needs, request, patches, beyond, execution);
    return status.ok() ? keep_beyond(facts, request, beyond, patches) : status;
  }
  RatesByDistance rates(facts, request, patches, beyond);
  if (Status status = rates.run(execution); !status.ok()) return status;
  if (Status status = keep_beyond(facts, request, beyond, patches); !status.ok()) return status;
  return rates.take_fewest(execution);
}

}}  // namespace tessera::abi_0_1
