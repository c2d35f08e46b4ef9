#include "tess/mesh/present_bounds.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "parallel/parallel_for.h"
#include "tess/bounds/local_chord.h"
#include "tess/cells/f64_points.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t blocks_per_task = 8;
/// Bounds of one net by different sums differ by less than this factor; the planner's bounds include it already.
constexpr double float_sums = 1 + 0x1p-20;

/// Returns the chord distance of a patch, including that of triangles at borders of odd rates beside even ones.
double distance(const ChordBound& chord, PatchSegments segments, const Division& division) {
  double most = chord.distance_of(segments);
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    const Segments border = division.border[s], opposite = division.border[(s + 2) % 4];
    if (!(runs_along_u(side) ? segments.u : segments.v).parts_halves() || border.parts_halves()) continue;
    const int rate = opposite.parts_halves() ? border.rate() : std::min(border.rate(), opposite.rate());
    assert(segments.are_uniform());  // if they are not, the border has a point at 1/2
    const auto straddling = ChordBound::straddling(segments.rates(), edge_of(side), rate);
    most = std::max(most, chord.pieces()[straddling.piece].chord(straddling.rates));
  }
  return most;
}

}  // namespace

PresentBounds::PresentBounds(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan)
    : is_f64_(plan.plan().is_f64()),
      has_f64_positions_(plan.plan().has_f64_positions()),
      chords_(set, has_f64_positions_),
      roundings_(set.patches.size()),
      displacements_(plan.plan().shares_vertices() ? set.patches.size() : plan.weld().displacements.size(), 0.0),
      bounds_(plan.plan().bounds().begin(), plan.plan().bounds().end()),
      moved_(displacements_.size(), 0),
      is_unproven_(set.patches.size(), 0),
      is_unknown_(set.patches.size(), 0),
      touched_lanes_(set.lane_counts.size(), 0) {
  touched_blocks_.reserve(set.lane_counts.size());
  // With displacements, bounds and roundings of patches that are not touched matter as well.
  std::copy(plan.weld().displacements.begin(), plan.weld().displacements.end(), displacements_.begin());
  for (std::size_t k = 0; k < displacements_.size(); ++k)
    roundings_[k] = is_f64_ ? f64_rounding(set.patches[k], set.origin) : vertex_rounding(set.patches[k], set.origin);
  if (displacements_.empty()) return;
  for (std::uint32_t block = 0; block < set.lane_counts.size(); ++block) {
    chords_.bound(set, block);
    for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane)
      roundings_[set.lane_patches[block * PatchSet::lanes + lane]] += chords_.slack(block, lane);
  }
}

double PresentBounds::f64_rounding(const BezierPatch& patch, const Vec3& origin) const {
  return has_f64_positions_ ? f64_position_rounding(patch, origin) : f64_vertex_rounding(patch, origin);
}

void PresentBounds::touch(const PatchSet::Impl& set, std::span<const std::uint32_t> patches) {
  for (const std::uint32_t patch : patches) {
    const PatchSet::Slot slot = set.slots[patch];
    if (touched_lanes_[slot.block] == 0) touched_blocks_.push_back(slot.block);
    touched_lanes_[slot.block] |= 1u << slot.lane;
  }
}

Status PresentBounds::bound_blocks(const PatchSet::Impl& set, const Execution& execution) {
  return parallel_for(touched_blocks_.size(), blocks_per_task, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t block = touched_blocks_[k], wanted = touched_lanes_[block];
      chords_.bound(set, block, wanted);
      for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
        if (!(wanted >> lane & 1u)) continue;
        const std::size_t patch = set.lane_patches[block * PatchSet::lanes + lane];
        const BezierPatch& net = set.patches[patch];
        const std::optional<double> size = chords_.size(block, lane);
        const double vertices = is_f64_ ? f64_rounding(net, set.origin)
                                : size  ? vertex_rounding(net.degree_u(), net.degree_v(), net.is_rational(), *size)
                                        : vertex_rounding(net, set.origin);
        roundings_[patch] = vertices + chords_.slack(block, lane);
      }
    }
  });
}

void PresentBounds::find_moved(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan) {
  std::fill(moved_.begin(), moved_.end(), std::uint8_t{0});
  const auto look = [&](const auto& copies) {
    for (const auto& copy : copies)
      if (is_touched(set, copy.from / 4) || is_touched(set, copy.to / 4)) moved_[copy.to / 4] = 1;
  };
  const auto look_at_all = [&](const VertexCopies& copies) {
    look(copies.borders);
    look(copies.corners);
    look(copies.poles);
  };
  look_at_all(plan.weld());
  if (plan.plan().shares_vertices()) look_at_all(plan.joins());
  for (std::size_t patch = 0; patch < moved_.size(); ++patch)
    if (moved_[patch]) displacements_[patch] = 0;
  const auto is_moved = [&](std::size_t patch) { return moved_[patch] != 0; };
  measure_displacements(set, plan.weld(), roundings_, is_moved, displacements_);
  // Where borders have moved apart, shared vertices follow the patch that owns them and lie beside the other's border.
  if (plan.plan().shares_vertices())
    measure_displacements(set, plan.joins(), roundings_, is_moved, displacements_, true);
}

void PresentBounds::set_bound(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan, std::size_t patch,
                              ChordBlocks::Products& products) {
  const PatchSet::Slot slot = set.slots[patch];
  const double moved = displacements_.empty() ? 0 : displacements_[patch];
  const PatchSegments segments = plan.plan().segments()[patch];
  const double given = std::max(roundings_[patch], moved) + set.fit_error.distance;
  const Division& division = plan.plan().division(patch);
  double bound = distance(chords_.chord(slot.block, slot.lane), segments, division) + given;
  if (!(bound <= plan.tolerance())) {
    products.find(chords_, set, slot.block);
    bound = distance(chords_.chord(slot.block, slot.lane, &products), segments, division) + given;
  }
  if (!(bound <= plan.tolerance()) && plan.options().fewest)
    bound = std::min(bound, local_distance(set.patches[patch], segments) + given);
  bounds_[patch] = rounded_up(bound);
  if (is_touched(set, patch) && (plan.options().angle || plan.options().pixels)) is_unknown_[patch] = 1;
  is_unproven_[patch] = is_unknown_[patch] != 0 || !(bound <= plan.tolerance() * float_sums);
}

Status PresentBounds::restate(const PatchSet::Impl& set, const CertifiedTessellation::Impl& plan,
                              const Execution& execution) {
  if (Status status = bound_blocks(set, execution); !status.ok()) return status;
  if (!displacements_.empty()) find_moved(set, plan);
  const auto state = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      ChordBlocks::Products products;
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
        if (touched_lanes_[touched_blocks_[k]] >> lane & 1u)
          set_bound(set, plan, set.lane_patches[touched_blocks_[k] * std::size_t{PatchSet::lanes} + lane], products);
    }
  };
  if (Status status = parallel_for(touched_blocks_.size(), blocks_per_task, execution, state); !status.ok())
    return status;
  for (std::size_t patch = 0; patch < moved_.size(); ++patch) {
    if (!moved_[patch] || is_touched(set, patch)) continue;
    ChordBlocks::Products products;
    set_bound(set, plan, patch, products);
  }
  for (const std::uint32_t block : touched_blocks_) touched_lanes_[block] = 0;
  touched_blocks_.clear();
  unproven_ = std::accumulate(is_unproven_.begin(), is_unproven_.end(), std::size_t{0});
  return {};
}

double PresentBounds::bound() const {
  double most = 0;
  for (const float bound : bounds_) most = std::max(most, double(bound));
  return most;
}

}  // namespace tessera::inline abi_0_1
