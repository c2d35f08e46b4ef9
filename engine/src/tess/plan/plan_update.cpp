#include "tess/plan/plan_update.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/bounds/task_size.h"
#include "tess/plan/divide_patches.h"

namespace tessera { inline namespace abi_0_1 {
void PlanUpdate::Lanes::add(PatchSet::Slot slot) {
  if (bits[slot.block] == 0) blocks.push_back(slot.block);
  bits[slot.block] |= 1u << slot.lane;
}

void PlanUpdate::Lanes::clear() {
  for (const std::uint32_t block : blocks) bits[block] = 0;
  blocks.clear();
}

PlanUpdate::PlanUpdate(PlanFacts facts, const PlanOfSet& of)
    : facts_(std::move(facts)),
      touched_(of.set.lane_counts.size()),
      copied_(of.plan.shares_vertices() || !facts_.borders.weld().displacements.empty() ? touched_.bits.size() : 0),
      own_roundings_(copied_.bits.empty() ? 0 : of.set.patches.size()),
      displacements_(own_roundings_.size(), 0.0),
      proven_(of.set.patches.size()) {
  facts_.needs.follow(of.set);
  std::ranges::copy(facts_.borders.weld().displacements, displacements_.begin());
  for (std::size_t patch = 0; patch < own_roundings_.size(); ++patch)
    own_roundings_[patch] =
        facts_.needs.own_rounding(of.set.group_of_block(of.set.slots[patch].block), of.set.slots[patch]);
}

void PlanUpdate::begin() {
  touched_.clear();
  copied_.clear();
  is_view_new_ = false;
}

void PlanUpdate::begin(const Camera& view) {
  begin();
  is_view_new_ = true;
  facts_.needs.look(view);
}

void PlanUpdate::touch(const PatchSet::Impl& set, std::size_t patch) { touched_.add(set.slots[patch]); }

template <class Visit>
void PlanUpdate::for_lanes(const PatchSet::Impl& set, const Lanes& lanes, Visit visit) {
  for (const std::uint32_t block : lanes.blocks)
    for (std::uint32_t left = lanes.bits[block]; left != 0; left &= left - 1)
      visit(set.lane_patches[block * std::size_t{PatchSet::lanes} + static_cast<std::size_t>(std::countr_zero(left))]);
}

template <class Visit>
void PlanUpdate::for_proven(const PatchSet::Impl& set, Visit visit) const {
  if (!is_view_new_) return for_lanes(set, has_copies() ? copied_ : touched_, visit);
  for (std::size_t patch = 0; patch < proven_.size(); ++patch) visit(patch);
}

Result<PlanUpdate::Outcome> PlanUpdate::prove(const PlanOfSet& of, FunctionRef<void(std::uint32_t block)> pack,
                                              const Execution& execution) {
  facts_.needs.follow(of.set);
  is_redivided_ = false;
  is_unknown_ = moves_line_patches(of) || !of.plan.patches().rare->beyond.empty();
  const auto bound = [&](std::size_t begin, std::size_t end) {
    for (const std::uint32_t block : std::span(touched_.blocks).subspan(begin, end - begin)) {
      pack(block);
      bound_block(of, block);
      if (!has_copies() && !is_view_new_) choose(of, block, touched_.bits[block]);
    }
  };
  if (Status status = parallel_for(touched_.blocks.size(), blocks_per_task, execution, bound); !status.ok())
    return status;
  if (has_copies() && !is_unknown_) measure_copies(of);
  if ((has_copies() || is_view_new_) && !is_unknown_) {
    const auto choose_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (is_view_new_)
          choose(of, static_cast<std::uint32_t>(k), ~0u);
        else
          choose(of, copied_.blocks[k], copied_.bits[copied_.blocks[k]]);
    };
    const std::size_t count = is_view_new_ ? of.set.lane_counts.size() : copied_.blocks.size();
    if (Status status = parallel_for(count, blocks_per_task, execution, choose_some); !status.ok()) return status;
  }
  return is_unknown_ ? Outcome::unknown : is_redivided_ ? Outcome::redivided : Outcome::kept;
}

bool PlanUpdate::moves_line_patches(const PlanOfSet& of) const {
  return std::ranges::any_of(of.plan.patches().rare->lines, [&](const RarePatches::LinePatch& line) {
    return line.holder == no_id || is_touched(of.set, line.patch) || is_touched(of.set, line.holder);
  });
}

void PlanUpdate::bound_block(const PlanOfSet& of, std::uint32_t block) {
  const BlockGroup& group = of.set.group_of_block(block);
  PatchNeeds& needs = facts_.needs;
  needs.bound_chords(block, touched_.bits[block]);
  for (std::uint32_t lane = 0; lane < of.set.lane_counts[block]; ++lane) {
    if (!(touched_.bits[block] >> lane & 1u)) continue;
    const std::size_t patch = of.set.lane_patches[block * std::size_t{PatchSet::lanes} + lane];
    const double rounding = needs.own_rounding(group, {block, lane});
    if (has_copies())
      own_roundings_[patch] = rounding;
    else
      needs.set_rounding(patch, rounding);
    const PatchShape& shape = needs.shapes()[patch];
    const SideMask collapsed = of.set.collapsed[patch];
    const bool keeps_shape = collapsed.any() ? PatchShape::of(of.set.patches[patch], collapsed) == shape
                                             : !shape.collapsed.any() && !shape.is_curve;
    // Beyond a share of the tolerance other patches need doubles.
    const bool is_fine =
        rounding <= max_rounding * needs.tolerance_of(patch, of.tolerance) || needs.options().is_f64(patch);
    if (!keeps_shape || !is_fine) is_unknown_ = true;
  }
}

void PlanUpdate::measure_copies(const PlanOfSet& of) {
  for (const std::uint32_t block : touched_.blocks) {
    copied_.blocks.push_back(block);
    copied_.bits[block] = touched_.bits[block];
  }
  const auto look = [&](const auto& copies) {
    for (const auto& copy : copies)
      if (is_touched(of.set, copy.from / 4)) copied_.add(of.set.slots[copy.to / 4]);
  };
  const auto look_at_all = [&](const VertexCopies& copies) {
    look(copies.borders);
    look(copies.corners);
    look(copies.poles);
  };
  look_at_all(of.weld);
  if (of.plan.shares_vertices()) look_at_all(of.joins);
  for_lanes(of.set, copied_, [&](std::size_t patch) { displacements_[patch] = 0; });
  const auto is_copied = [&](std::size_t patch) { return copied_.has(of.set.slots[patch]); };
  measure_displacements(of.set, of.weld, own_roundings_, is_copied, displacements_);
  // Where borders have moved apart, shared vertices follow the patch that owns them and lie beside the other's border.
  if (of.plan.shares_vertices())
    measure_displacements(of.set, of.joins, own_roundings_, is_copied, displacements_, true);
  for_lanes(of.set, copied_, [&](std::size_t patch) {
    facts_.needs.set_rounding(patch, std::max(own_roundings_[patch], displacements_[patch]));
  });
}

void PlanUpdate::choose(const PlanOfSet& of, std::uint32_t block, std::uint32_t wanted) {
  const PlannerOptions& options = facts_.needs.options();
  if (!options.angle && !options.camera) return choose_by_distance(of, block, wanted);
  if (options.camera) facts_.needs.bound_pictures(block);
  const PlanRequest request{.tolerance = of.tolerance,
                            .fewest = options.fewest,
                            .kept = {of.plan.patches().segments, of.spare},
                            .headroom = of.headroom};
  for (std::size_t lane = 0; lane < of.set.lane_counts[block]; ++lane) {
    if (!(wanted >> lane & 1u)) continue;
    const std::size_t patch = of.set.lane_patches[block * std::size_t{PatchSet::lanes} + lane];
    const NeededSegments needed = facts_.needs.segments_for(patch, request, max_rate);
    if (!needed.are_found()) is_unknown_ = true;
    if (!needed.anywhere && of.plan.patches().crosses[patch]) is_redivided_ = true;
    set(of, patch,
        {needed.segments, needed.anywhere, rounded_up(needed.bound), rounded_up(needed.angle),
         rounded_up(needed.pixels)});
  }
}

void PlanUpdate::choose_by_distance(const PlanOfSet& of, std::uint32_t block, std::uint32_t wanted) {
  const std::size_t count = of.set.lane_counts[block];
  const std::uint32_t* const patches = of.set.lane_patches.data() + block * std::size_t{PatchSet::lanes};
  const PatchNeeds& needs = facts_.needs;
  const KeptSegments kept{of.plan.patches().segments, of.spare};
  ChordBlocks::Lanes<double> left;
  left.fill(of.tolerance);
  for (std::size_t lane = 0; lane < count; ++lane)
    left[lane] = needs.tolerance_of(patches[lane], of.tolerance) - needs.given(patches[lane]);
  ChordBlocks::Lanes<double> aimed = left;
  for (double& lane : aimed) lane *= 1 - of.headroom;
  ChordBlocks::Products products;
  const ChordBlocks::Choice best = needs.chords().cheapest(of.set, block, count, aimed, max_rate, products);
  for (std::size_t lane = 0; lane < count; ++lane) {
    if (!(wanted >> lane & 1u)) continue;
    const std::size_t patch = patches[lane];
    if (!(left[lane] > 0) || best.rates[lane].u == 0) {
      is_unknown_ = true;
      continue;
    }
    const ChordBlocks::Products* const sharp = best.sharpened >> lane & 1u ? &products : nullptr;
    const ProvenSegments proven =
        keep_by_distance(needs, patch, left[lane], kept, sharp, {best.rates[lane], best.distance[lane]});
    // If its segments change, its borders do, and redivided() proves them.
    const bool is_kept = proven.segments == of.plan.patches().segments[patch];
    const double crossing = proven.anywhere || !is_kept ? 0 : crossing_distance(of, patch);
    if (!(crossing <= left[lane])) is_redivided_ = true;
    const double bound = std::max(proven.distance, crossing) + needs.given(patch);
    set(of, patch, {proven.segments, proven.anywhere, rounded_up(bound)});
  }
  // The fewest segments are chosen for all patches together.
  if (needs.options().fewest && is_redivided_) is_unknown_ = true;
}

double PlanUpdate::crossing_distance(const PlanOfSet& of, std::size_t patch) const {
  const PatchSegments segments = of.plan.patches().segments[patch];
  const Division& division = of.plan.division(patch);
  double most = 0;
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    const Segments border = division.border[s], opposite = division.border[(s + 2) % 4];
    if (!along_side(side, segments).parts_halves() || border.parts_halves()) continue;
    const int rate =
        opposite.parts_halves() ? border.coarsest_rate() : std::min(border.coarsest_rate(), opposite.coarsest_rate());
    assert(segments.are_uniform());  // if they are not, the border has a point at 1/2
    const auto [piece, rates] = ChordBound::crossing(segments.rates(), side, rate);
    const PatchSet::Slot slot = of.set.slots[patch];
    most = std::max(most, facts_.needs.chords().piece(slot.block, slot.lane, piece).chord(rates));
  }
  return most;
}

void PlanUpdate::set(const PlanOfSet& of, std::size_t patch, const Proven& proven) {
  proven_[patch] = proven;
  if (!(proven.segments == of.plan.patches().segments[patch])) is_redivided_ = true;
}

void PlanUpdate::take_bounds(CertifiedPlan& plan) const {
  for_proven(facts_.needs.set(), [&](std::size_t patch) {
    plan.set_bounds(patch, proven_[patch].bound, proven_[patch].angle, proven_[patch].pixels);
  });
}

CertifiedPlan PlanUpdate::redivided(const PlanOfSet& of) const {
  const DividedPatches& before = of.plan.patches();
  DividedPatches patches{.segments = before.segments,
                         .bounds = before.bounds,
                         .angles = before.angles,
                         .pixels = before.pixels,
                         .crosses = before.crosses,
                         .has_f64_positions = before.has_f64_positions};
  if (!before.rare->f64_patches.empty()) patches.rare.make().f64_patches = before.rare->f64_patches;
  for_proven(of.set, [&](std::size_t patch) {
    const Proven& proven = proven_[patch];
    patches.segments[patch] = proven.segments;
    patches.bounds[patch] = proven.bound;
    if (!patches.angles.empty()) patches.angles[patch] = proven.angle;
    if (!patches.pixels.empty()) patches.pixels[patch] = proven.pixels;
    if (!patches.crosses.empty()) patches.crosses[patch] = proven.anywhere;
  });
  divide_patches(facts_, of.tolerance, patches);
  return CertifiedPlan(std::move(patches));
}

}}  // namespace tessera::abi_0_1
