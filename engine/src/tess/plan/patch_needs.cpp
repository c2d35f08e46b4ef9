#include "tess/plan/patch_needs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <numbers>

#include "base/infinity.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/graded_segments.h"
#include "tess/bounds/task_size.h"
#include "tess/cells/f64_points.h"
#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

double vertex_rounding(int degree_u, int degree_v, bool rational, double size) {
  const double roundings = (rational ? 2 : 1) * (degree_u + degree_v + 6.0);
  return std::numbers::sqrt3 * roundings * 0x1p-24 * size;
}

}  // namespace

double vertex_rounding(const BezierPatch& patch, const Vec3& origin) {
  double size = 0;
  for (const Vec3& p : patch.points()) size = std::max(size, max_abs(p - origin));
  return vertex_rounding(patch.degree_u(), patch.degree_v(), patch.is_rational(), size);
}

PatchNeeds::PatchNeeds(const PatchSet::Impl& set, const PlannerOptions& options)
    : set_(&set),
      options_(options),
      fit_error_(set.fit_error.distance),
      chords_(set, options.f64_positions, options.weld.reach),
      shapes_(set.patches.size()),
      roundings_(set.patches.size()) {
  if (keeps_turnings(options)) own_turnings_.resize(shapes_.size());
}

void PatchNeeds::bound_block(std::size_t block) {
  const PatchSet::Impl& set = *set_;
  chords_.bound(set, block);
  const BlockGroup& group = set.group_of_block(block);
  const PatchShape whole{
      static_cast<std::uint8_t>(group.degree_u), static_cast<std::uint8_t>(group.degree_v), {}, false};
  const bool are_packed = !options_.f64_positions && options_.f64_patches.empty();
  const double per_size = vertex_rounding(group.degree_u, group.degree_v, group.rational, 1);
  for (std::uint32_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    const std::size_t k = set.lane_patches[block * PatchSet::lanes + lane];
    shapes_[k] = set.collapsed[k].any() ? PatchShape::of(set.patches[k], set.collapsed[k]) : whole;
    const std::optional<double> size = are_packed ? chords_.size(block, lane) : std::nullopt;
    roundings_[k] = size ? per_size * *size + chords_.slack(block, lane)
                         : own_rounding(group, {static_cast<std::uint32_t>(block), lane});
  }
}

void PatchNeeds::bound_turning(std::size_t patch) {
  if (own_turnings_.empty()) return;
  const PatchSet::Impl& set = *set_;
  const bool is_curve = set.collapsed[patch].any() && PatchShape::of(set.patches[patch], set.collapsed[patch]).is_curve;
  if (!is_curve) own_turnings_[patch] = {TurningBound(set.patches[patch], *options_.angle)};
}

double PatchNeeds::own_rounding(const BlockGroup& group, PatchSet::Slot slot) const {
  const std::optional<double> size = chords_.size(slot.block, slot.lane);
  const std::size_t index = set_->lane_patches[slot.block * std::size_t{PatchSet::lanes} + slot.lane];
  const auto patch = [&]() -> const BezierPatch& { return set_->patches[index]; };
  const double vertices = options_.f64_positions   ? f64_position_rounding(patch(), set_->origin)
                          : options_.is_f64(index) ? f64_vertex_rounding(patch(), set_->origin)
                          : size ? vertex_rounding(group.degree_u, group.degree_v, group.rational, *size)
                                 : vertex_rounding(patch(), set_->origin);
  return vertices + chords_.slack(slot.block, slot.lane);
}

void PatchNeeds::take_weld(const Weld& weld) {
  for (const double rounding : roundings_) largest_rounding_ = std::max(largest_rounding_, rounding);
  for (std::size_t k = 0; k < weld.displacements.size(); ++k)
    roundings_[k] = std::max(roundings_[k], weld.displacements[k]);
  for (std::size_t k = 0; k < weld.shapes.size(); ++k) {
    SideMask poles;
    for (const Side side : all_sides)
      if (weld.shapes[k].collapsed.has(side) && !shapes_[k].collapsed.has(side)) poles.add(side);
    welded_poles_.push_back(poles);
  }
}

void PatchNeeds::follow(const PatchSet::Impl& set) {
  set_ = &set;
  turnings_ = {};  // of the patches as they were
}

Status PatchNeeds::bound_views(const Execution& execution) {
  if (options_.camera) {
    pictures_.resize(shapes_.size());
    const auto see = [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block) bound_pictures(block);
    };
    if (Status status = parallel_for(set_->lane_counts.size(), blocks_per_task, execution, see); !status.ok())
      return status;
  }
  if (own_turnings_.empty()) return {};
  std::vector<NormalTurning> found = std::move(own_turnings_);
  own_turnings_ = {};
  const auto bound = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!shapes_[k].is_curve && !found[k].bound.is_finite()) found[k] = turning_of(k);
  };
  const Status status = parallel_for(shapes_.size(), patches_per_task, execution, bound);
  turnings_ = std::move(found);
  return status;
}

void PatchNeeds::bound_pictures(std::size_t block) {
  std::array<double, PatchSet::lanes> moved{};
  for (std::size_t lane = 0; lane < set_->lane_counts[block]; ++lane)
    moved[lane] = given(set_->lane_patches[block * PatchSet::lanes + lane]);
  ScreenSpaceBound::find(*options_.camera, *set_, block, moved, options_.pixels, pictures_.data());
}

PatchNeeds::NormalTurning PatchNeeds::turning_of(std::size_t patch) const {
  if (!turnings_.empty()) return turnings_[patch];
  const auto is_made_pole = [&](Side side) {  // by welding
    return !welded_poles_.empty() && welded_poles_[patch].has(side);
  };
  const TurningBound turning(set_->patches[patch], *options_.angle);
  if (turning.is_finite() || std::ranges::none_of(all_sides, is_made_pole)) return {turning};
  BezierPatch moved = set_->patches[patch];
  for (const Side side : all_sides) {
    if (!is_made_pole(side)) continue;
    Result<BezierPatch> pole = with_pole(moved, side);
    if (!pole) throw std::bad_alloc();  // no other error is possible: the points are those of the patch
    moved = *std::move(pole);
  }
  return {TurningBound(moved, *options_.angle), false};
}

namespace {

std::optional<Rates> rates_for(const CellLimits& limits, int most) {
  const bool distance_alone = limits.chord && !limits.turning && !limits.picture;
  return distance_alone ? limits.chord->cheapest(limits.distance, most) : cheapest(limits, most);
}

/// Returns the rates of uniform segments, of at least min_rate.
std::optional<Rates> uniform_rates(const CellLimits& limits, int min_rate, int most) {
  std::optional<Rates> rates = rates_for(limits, most);
  if (!rates || min_rate == 1) return rates;
  rates = {std::max(rates->u, min_rate), std::max(rates->v, min_rate)};
  // Raised rates may have become odd: bounds of halves may not hold for the whole.
  return most > max_rate || limits.keeps(*rates) ? *rates : Rates{rates->u + rates->u % 2, rates->v + rates->v % 2};
}

CellLimits part_of(CellLimits limits, double part) {
  limits.distance *= part;
  limits.pixels *= part;
  limits.angle *= part;
  return limits;
}

/// Whether the kept segments of a patch are few enough compared with the best.
bool are_few(const KeptSegments& kept, std::size_t patch, PatchSegments best) {
  return !kept.segments.empty() && kept.segments[patch].cells() <= (1 + kept.spare) * best.cells();
}

/// Whether segments of at least a rate keep all limits but that of the distance.
bool keeps_besides_chord(CellLimits limits, PatchSegments segments, int min_rate) {
  limits.chord = nullptr;
  const Rates least = segments.coarsest();
  return std::min(least.u, least.v) >= min_rate && limits.keeps(segments);
}

/// The distance that a patch keeps by bounds of small pieces; infinite unless PlannerOptions::fewest.
double local_distance_of(const PatchNeeds& needs, std::size_t patch, PatchSegments segments) {
  return needs.options().fewest ? local_distance(needs.set().patches[patch], segments) : infinity;
}

/// Returns the distance that segments keep besides the rounding of vertices; see ChordBound::distance_of().
double distance_of(const PatchNeeds& needs, std::size_t patch, PatchSegments segments, bool anywhere) {
  const PatchSet::Slot slot = needs.set().slots[patch];
  return anywhere ? needs.chord(patch).distance_of(segments, true)
                  : needs.chords().distance_of(segments, slot.block, slot.lane, nullptr);
}

/// Returns the kept segments of a patch if they keep the limits.
std::optional<ProvenSegments> kept_segments(const PatchNeeds& needs, std::size_t patch, const CellLimits& limits,
                                            int min_rate, const KeptSegments& kept) {
  const PatchSegments had = kept.segments[patch];
  if (!keeps_besides_chord(limits, had, min_rate)) return {};
  const bool anywhere = !limits.is_for_halves();
  double keeps = distance_of(needs, patch, had, anywhere);
  if (limits.chord && !(keeps <= limits.distance)) keeps = local_distance_of(needs, patch, had);
  if (limits.chord && !(keeps <= limits.distance)) return {};
  return ProvenSegments{had, keeps, anywhere};
}

/// Returns the kept segments of a patch if they keep the limits, and no others that keep the `aimed` ones have far
/// fewer cells: the best ones need not be found then.
std::optional<ProvenSegments> surely_kept(const PatchNeeds& needs, std::size_t patch, const CellLimits& limits,
                                          const CellLimits& aimed, int min_rate, const PlanRequest& request) {
  if (request.kept.segments.empty() || request.fewest) return {};
  const auto kept = kept_segments(needs, patch, limits, min_rate, request.kept);
  const bool is_sure = kept && !may_have_fewer(aimed, kept->segments.cells() / (1 + request.kept.spare));
  return is_sure ? kept : std::nullopt;
}

}  // namespace

NeededSegments PatchNeeds::segments_for(std::size_t patch, const PlanRequest& request, int most) const {
  const double tolerance = request.slack * tolerance_of(patch, request.tolerance),
               pixels = request.slack * options_.pixels;
  const double given = this->given(patch);
  const ScreenSpaceBound* const picture = options_.camera ? &pictures_[patch] : nullptr;
  std::optional<NormalTurning> turning;
  if (options_.angle && !shapes_[patch].is_curve) turning = turning_of(patch);
  std::optional<ChordBound> chord;
  NeededSegments needed;
  CellLimits limits;
  const double distance = picture ? std::min(tolerance, request.slack * picture->distance()) : tolerance;
  if (!(given < distance))
    needed.failure = given < tolerance ? NeededSegments::Failure::rough_pixels : NeededSegments::Failure::rough;
  if (std::isfinite(distance)) limits.chord = &chord.emplace(this->chord(patch));
  limits.distance = request.share * (distance - given);
  const std::optional<ChordBound> projected = picture ? picture->projected() : std::nullopt;
  if (projected) {
    limits.picture = &*projected;
    limits.pixels = request.share * (pixels - picture->moved_pixels());
    if (!(limits.pixels > 0)) needed.failure = NeededSegments::Failure::rough_pixels;
  }
  if (!needed.are_found()) return needed;
  const bool bounded = turning && turning->bound.is_finite();
  if (bounded) {
    limits.turning = &turning->bound;
    limits.angle = request.share * request.slack * *options_.angle;
  }
  const CellLimits aimed = part_of(limits, 1 - request.headroom);
  const auto finish = [&](const ProvenSegments& proven) {
    needed.segments = proven.segments;
    needed.anywhere = proven.anywhere;
    needed.bound = given + proven.distance;
    if (turning) needed.angle = bounded && turning->is_certified ? turning->bound.angle(proven.segments) : infinity;
    if (picture) needed.pixels = picture->pixels(projected, proven.segments, needed.bound);
    return needed;
  };
  const int min_rate = turning && !bounded ? options_.angle_rate : 1;
  if (const auto kept = surely_kept(*this, patch, limits, aimed, min_rate, request)) return finish(*kept);
  const std::optional<Rates> rates = uniform_rates(aimed, min_rate, most);
  if (!rates) {
    needed.failure = NeededSegments::Failure::wide;
    return needed;
  }
  needed.cells = double(rates->u) * rates->v;
  return most > max_rate ? needed : finish(settle(patch, aimed, limits, min_rate, request, *rates));
}

ProvenSegments PatchNeeds::settle(std::size_t patch, const CellLimits& limits, const CellLimits& kept_limits,
                                  int min_rate, const PlanRequest& request, Rates rates) const {
  const auto keeps_others = [&](PatchSegments segments) { return keeps_besides_chord(limits, segments, min_rate); };
  const bool anywhere = !limits.is_for_halves();
  const auto proven_for = [&](PatchSegments segments) {
    return ProvenSegments{segments, distance_of(*this, patch, segments, anywhere), anywhere};
  };
  const bool is_one_cell = rates == Rates{1, 1};
  const auto graded = min_rate == 1 && limits.is_for_more_than_distance() && !request.uniform && !is_one_cell
                          ? graded_segments(limits, rates)
                          : std::nullopt;
  ProvenSegments proven = proven_for(graded ? *graded : rates);
  if (request.fewest && limits.chord) {
    SegmentChoices choices(proven_for(rates));
    find_fewer(set_->patches[patch], limits.distance, keeps_others, choices);
    if (choices.fewest().segments.cells() < proven.segments.cells()) proven = choices.fewest();
    proven.anywhere = false;
  }
  if (!are_few(request.kept, patch, proven.segments)) return proven;
  return kept_segments(*this, patch, kept_limits, min_rate, request.kept).value_or(proven);
}

ProvenSegments keep_by_distance(const PatchNeeds& needs, std::size_t patch, double distance, const KeptSegments& kept,
                                const ChordBlocks::Products* products, const ProvenSegments& best) {
  if (!are_few(kept, patch, best.segments) || kept.segments[patch] == best.segments) return best;
  const PatchSet::Slot slot = needs.set().slots[patch];
  const PatchSegments had = kept.segments[patch];
  double keeps = needs.chords().distance_of(had, slot.block, slot.lane, products);
  const bool by_halves = keeps <= distance;
  if (!by_halves) keeps = local_distance_of(needs, patch, had);
  return keeps <= distance ? ProvenSegments{had, keeps, !by_halves && had.are_uniform()} : best;
}

// Chords far below the errors of the vertices gain nothing. Grids of cut patches stay within a few ten megabytes.
NeededSegments segments_beyond(const PatchNeeds& needs, std::size_t patch, const PlanRequest& request) {
  constexpr int max_rate_of_cut = 512;
  const PatchSet::Impl& set = needs.set();
  const bool is_cut = set.trims && set.trims->is_cut[patch];
  const double given = 1.25 * needs.given(patch);
  PlanRequest relaxed = request;
  relaxed.fewest = false, relaxed.kept = {};
  constexpr int most = 64;  // the last limits are infinite, so it ends
  for (int k = 1;; ++k) {
    relaxed.slack = k < most ? std::ldexp(1.0, k) : infinity;
    if (k < most && !(relaxed.slack * needs.tolerance_of(patch, request.tolerance) > given)) continue;
    const NeededSegments needed = needs.segments_for(patch, relaxed, is_cut ? max_rate_of_cut : max_rate);
    if (needed.are_found() || k == most) return needed;
  }
}

namespace {

/// Adds the whole patches that give vertices to cut ones that need doubles.
void add_givers_of_cut(const PatchSet::Impl& set, const SharedEdges& shared, std::vector<std::uint8_t>& patches) {
  std::vector<std::uint8_t> edges(shared.count(), 0);
  const auto for_sides = [&](std::size_t patch, auto visit) {
    for (const Side side : all_sides)
      if (const std::uint32_t edge = shared.edge(patch, side); edge != no_id) visit(edges[edge]);
  };
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (set.trims->is_cut[k] && patches[k]) for_sides(k, [](std::uint8_t& edge) { edge = 1; });
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (!set.trims->is_cut[k]) for_sides(k, [&](std::uint8_t edge) { patches[k] |= edge; });
}

}  // namespace

std::vector<std::uint8_t> patches_that_need_f64(const PatchNeeds& needs, const SharedEdges& edges, double tolerance) {
  const PatchSet::Impl& set = needs.set();
  const bool is_any_rough = needs.largest_rounding() > max_rounding * needs.options().least_share * tolerance;
  const std::span<const ScreenSpaceBound> pictures = needs.pictures();
  if (!is_any_rough && pictures.empty()) return {};
  const auto is_rough_in_picture = [&](std::size_t k) {
    const ScreenSpaceBound& picture = pictures[k];
    return !(needs.given(k) < picture.distance()) ||
           (picture.projected() && !(picture.moved_pixels() < needs.options().pixels));
  };
  std::vector<std::uint8_t> patches(needs.shapes().size(), 0);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const PatchSet::Slot slot = set.slots[k];
    patches[k] = (is_any_rough && needs.own_rounding(set.group_of_block(slot.block), slot) >
                                      max_rounding * needs.tolerance_of(k, tolerance)) ||
                 (!pictures.empty() && is_rough_in_picture(k));
  }
  if (std::ranges::find(patches, 1) == patches.end()) return {};
  if (!pictures.empty() && set.trims) add_givers_of_cut(set, edges, patches);
  return patches;
}

bool is_rough(const PatchNeeds& needs, double tolerance) {
  for (std::size_t k = 0; k < needs.roundings().size(); ++k)
    if (!(2 * needs.given(k) < needs.tolerance_of(k, tolerance))) return true;
  return false;
}

}}  // namespace tessera::abi_0_1
