#include "tess/plan/certified_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <string>

#include "base/text.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/graded_segments.h"
#include "tess/bounds/task_size.h"
#include "tess/cells/f64_points.h"
#include "tess/edges/side_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double no_angle = std::numeric_limits<double>::infinity();

/// Whether the kept segments of a patch are few enough compared with the best.
bool is_spared(const KeptSegments& kept, std::size_t patch, PatchSegments best) {
  return !kept.segments.empty() && kept.segments[patch].cells() <= (1 + kept.spare) * best.cells();
}

}  // namespace

double vertex_rounding(int degree_u, int degree_v, bool rational, double size) {
  const double roundings = (rational ? 2 : 1) * (degree_u + degree_v + 6.0);
  return std::numbers::sqrt3 * roundings * 0x1p-24 * size;
}

double vertex_rounding(const BezierPatch& patch, const Vec3& origin) {
  double size = 0;
  for (const Vec3& p : patch.points()) size = std::max(size, max_abs(p - origin));
  return vertex_rounding(patch.degree_u(), patch.degree_v(), patch.is_rational(), size);
}

Result<CertifiedPlanner> CertifiedPlanner::make(const PatchSet::Impl& set, const PlannerOptions& options,
                                                const Execution& execution) {
  CertifiedPlanner planner(set, options);
  if (Status status = planner.find_edges_and_bounds(execution); !status.ok()) return status;
  for (const double rounding : planner.roundings_)
    planner.largest_rounding_ = std::max(planner.largest_rounding_, rounding);
  planner.find_cut_faces();
  planner.find_weld();
  if (planner.runs_) planner.find_edges_in_step();
  if (Status status = planner.bound_turning_and_picture(execution); !status.ok()) return status;
  return planner;
}

Status CertifiedPlanner::find_edges_and_bounds(const Execution& execution) {
  shapes_.resize(set_->patches.size());
  roundings_.resize(set_->patches.size());
  const std::size_t blocks = set_->lane_counts.size();
  BorderHashes hashes(*set_);
  const auto hash = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) hashes.find(*set_, block);
  };
  Status status = parallel_for(blocks, 4 * blocks_per_task, {.cancel = execution.cancel}, hash);
  if (!status.ok()) return status;
  // One thread finds the edges, one after the other, while the others find the bounds.
  const std::size_t pieces = 1 + (blocks + blocks_per_task - 1) / blocks_per_task;
  const auto find_or_bound = [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      if (piece == 0) {
        edges_ = SharedEdges(*set_, hashes);
        continue;
      }
      const std::size_t last = std::min(blocks, piece * blocks_per_task);
      for (std::size_t block = (piece - 1) * blocks_per_task; block < last; ++block) bound_block(block);
    }
  };
  return parallel_for(pieces, pieces > 2 ? 1 : 2, execution, find_or_bound);
}

void CertifiedPlanner::bound_block(std::size_t block) {
  const PatchSet::Impl& set = *set_;
  chords_.bound(set, block);
  const BlockGroup& group = set.group_of_block(block);
  const PatchShape whole{
      static_cast<std::uint8_t>(group.degree_u), static_cast<std::uint8_t>(group.degree_v), {}, false};
  for (std::size_t lane = 0; lane < set.lane_counts[block]; ++lane) {
    const std::size_t k = set.lane_patches[block * PatchSet::lanes + lane];
    shapes_[k] = set.collapsed[k].any() ? PatchShape::of(set.patches[k], set.collapsed[k]) : whole;
    roundings_[k] = own_rounding(group, set.slots[k]);
  }
}

double CertifiedPlanner::own_rounding(const BlockGroup& group, PatchSet::Slot slot) const {
  const std::optional<double> size = chords_.size(slot.block, slot.lane);
  const std::size_t index = set_->lane_patches[slot.block * std::size_t{PatchSet::lanes} + slot.lane];
  const auto patch = [&]() -> const BezierPatch& { return set_->patches[index]; };
  const double vertices = options_.f64_positions ? f64_position_rounding(patch(), set_->origin)
                          : is_f64(index)        ? f64_vertex_rounding(patch(), set_->origin)
                          : size ? vertex_rounding(group.degree_u, group.degree_v, group.rational, *size)
                                 : vertex_rounding(patch(), set_->origin);
  return vertices + chords_.slack(slot.block, slot.lane);
}

void CertifiedPlanner::find_weld() {
  WeldRules rules = options_.weld;
  std::vector<std::uint8_t> stay;
  if (runs_) stay = runs_->borders_that_meet(shapes_.size());
  rules.stay = stay;
  rules.f64_patches = options_.f64_patches;
  if (options_.f64_positions) {
    // Far from zero the last bits of doubles affect the floats of coordinates that are small relative to the origin.
    const Box3 box = set_->model_box();
    rules.reach = std::max(rules.reach, 0x1p-50 * std::max(max_abs(box.lower), max_abs(box.upper)));
    edges_ = parted_by_doubles(*set_, edges_);
  }
  if (!(rules.reach > 0) && rules.f64_patches.empty()) return;
  weld_ = weld_borders(*set_, own_shapes(), roundings_, rules, edges_);
  for (std::size_t k = 0; k < weld_.displacements.size(); ++k)
    roundings_[k] = std::max(roundings_[k], weld_.displacements[k]);
}

Status CertifiedPlanner::bound_turning_and_picture(const Execution& execution) {
  if (options_.camera) {
    pictures_.resize(shapes_.size());
    const auto see = [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block) bound_pictures(block);
    };
    if (Status status = parallel_for(set_->lane_counts.size(), blocks_per_task, execution, see); !status.ok())
      return status;
  }
  if (!options_.angle || !options_.keeps_bounds) return {};
  turnings_.resize(shapes_.size());
  const auto bound = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!shapes_[k].is_curve) turnings_[k] = turning_of(k);
  };
  return parallel_for(shapes_.size(), patches_per_task, execution, bound);
}

void CertifiedPlanner::bound_pictures(std::size_t block) {
  std::array<double, PatchSet::lanes> moved{};
  for (std::size_t lane = 0; lane < set_->lane_counts[block]; ++lane)
    moved[lane] = roundings_[set_->lane_patches[block * PatchSet::lanes + lane]] + fit_error_;
  ScreenSpaceBound::find(*options_.camera, *set_, block, moved, options_.pixels, pictures_.data());
}

CertifiedPlanner::NormalTurning CertifiedPlanner::turning_of(std::size_t patch) const {
  const auto is_made_pole = [&](Side side) {  // by welding
    return divided_shapes()[patch].collapsed.has(edge_of(side)) && !shapes_[patch].collapsed.has(edge_of(side));
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

std::optional<Rates> CertifiedPlanner::rates_for(const CellLimits& limits, int most) const {
  const bool distance_alone = limits.chord && !limits.turning && !limits.picture;
  return distance_alone ? limits.chord->cheapest(limits.distance, most) : cheapest(limits, most);
}

CertifiedPlanner::Choice CertifiedPlanner::choose(std::size_t patch, const Request& request, int most) const {
  const double tolerance = request.slack * request.tolerance, pixels = request.slack * options_.pixels;
  const double given = roundings_[patch] + fit_error_;
  const ScreenSpaceBound* const picture = options_.camera ? &pictures_[patch] : nullptr;
  std::optional<NormalTurning> turning;
  if (options_.angle && !shapes_[patch].is_curve) turning = turnings_.empty() ? turning_of(patch) : turnings_[patch];
  const ChordBound chord = this->chord(patch);
  Choice choice;
  CellLimits limits;
  const double distance = picture ? std::min(tolerance, request.slack * picture->distance()) : tolerance;
  if (!(given < distance)) choice.failure = given < tolerance ? Failure::rough_pixels : Failure::rough;
  if (std::isfinite(distance)) limits.chord = &chord;
  limits.distance = request.share * (distance - given);
  const std::optional<ChordBound> projected = picture ? picture->projected() : std::nullopt;
  if (projected) {
    limits.picture = &*projected;
    limits.pixels = request.share * (pixels - picture->moved_pixels());
    if (!(limits.pixels > 0)) choice.failure = Failure::rough_pixels;
  }
  if (choice.failure != Failure::none) return choice;
  const bool bounded = turning && turning->bound.is_finite();
  if (bounded) {
    limits.turning = &turning->bound;
    limits.angle = request.share * request.slack * *options_.angle;
  }
  std::optional<Rates> rates = rates_for(limits, most);
  if (rates && turning && !bounded)
    rates = Rates{std::max(rates->u, options_.angle_rate), std::max(rates->v, options_.angle_rate)};
  if (!rates) {
    choice.failure = Failure::wide;
    return choice;
  }
  choice.cells = double(rates->u) * rates->v;
  if (most > max_rate) return choice;
  // Raised rates may have become odd: bounds of halves may not hold for the whole.
  if (turning && !bounded && !limits.keeps(*rates)) rates = {rates->u + rates->u % 2, rates->v + rates->v % 2};
  const int min_rate = turning && !bounded ? options_.angle_rate : 1;
  const ProvenSegments proven = settle(patch, limits, chord, min_rate, request, *rates);
  choice.segments = proven.segments;
  choice.anywhere = proven.anywhere;
  choice.bound = given + proven.distance;
  if (turning) choice.angle = bounded && turning->is_proven ? turning->bound.angle(proven.segments) : no_angle;
  if (picture) choice.pixels = picture->pixels(proven.segments, choice.bound);
  return choice;
}

ProvenSegments CertifiedPlanner::settle(std::size_t patch, const CellLimits& limits, const ChordBound& chord,
                                        int min_rate, const Request& request, Rates rates) const {
  const KeptSegments& kept = request.kept;
  CellLimits others = limits;
  others.chord = nullptr;
  const auto keeps_others = [&](PatchSegments segments) {
    const Rates least = segments.coarsest();
    return std::min(least.u, least.v) >= min_rate && others.keeps(segments);
  };
  const bool anywhere = !limits.is_for_halves();
  const auto proven_for = [&](PatchSegments segments) {
    return ProvenSegments{segments, chord.distance_of(segments, anywhere), anywhere};
  };
  const auto graded = min_rate == 1 && limits.is_for_more_than_distance() && !request.uniform
                          ? graded_segments(limits, rates)
                          : std::nullopt;
  ProvenSegments proven = proven_for(graded ? *graded : rates);
  if (request.fewest && limits.chord) {
    SegmentChoices choices(proven_for(rates));
    find_fewer(set_->patches[patch], limits.distance, keeps_others, choices);
    if (choices.fewest().segments.cells() < proven.segments.cells()) proven = choices.fewest();
    proven.anywhere = false;
  }
  if (!is_spared(kept, patch, proven.segments) || !keeps_others(kept.segments[patch])) return proven;
  const PatchSegments had = kept.segments[patch];
  double keeps = chord.distance_of(had, anywhere);
  if (limits.chord && !(keeps <= limits.distance)) keeps = local_distance(patch, had);
  if (limits.chord && !(keeps <= limits.distance)) return proven;
  return {had, keeps, anywhere};
}

double CertifiedPlanner::local_distance(std::size_t patch, PatchSegments segments) const {
  if (!options_.fewest) return std::numeric_limits<double>::infinity();
  return tessera::local_distance(set_->patches[patch], segments);
}

ProvenSegments CertifiedPlanner::keep_by_distance(std::size_t patch, double distance, const KeptSegments& kept,
                                                  const ChordBlocks::Products* products,
                                                  const ProvenSegments& best) const {
  if (!is_spared(kept, patch, best.segments) || kept.segments[patch] == best.segments) return best;
  const PatchSet::Slot slot = set_->slots[patch];
  const PatchSegments had = kept.segments[patch];
  double keeps = chords_.distance_of(had, slot.block, slot.lane, products);
  const bool by_halves = keeps <= distance;
  if (!by_halves) keeps = local_distance(patch, had);
  return keeps <= distance ? ProvenSegments{had, keeps, !by_halves && had.are_uniform()} : best;
}

Result<std::vector<ProvenSegments>> CertifiedPlanner::find_fewest(double tolerance, std::vector<SegmentChoices> choices,
                                                                  const Execution& execution) const {
  const auto no_others = [](PatchSegments) { return true; };
  const auto find = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (const double left = tolerance - (roundings_[k] + fit_error_); !shapes_[k].is_curve && left > 0)
        find_fewer(set_->patches[k], left, no_others, choices[k]);
  };
  if (Status status = parallel_for(choices.size(), 1, execution, find); !status.ok()) return status;
  const auto chosen = choose_together(divided_shapes(), edges_, borders_against(), choices, execution.cancel);
  if (!chosen) return chosen.status();
  std::vector<ProvenSegments> proven(choices.size());
  for (std::size_t k = 0; k < proven.size(); ++k) proven[k] = choices[k][(*chosen)[k]];
  return proven;
}

void CertifiedPlanner::set_segments(std::size_t patch, const ProvenSegments& proven, CertifiedPlan& plan) const {
  plan.segments_[patch] = proven.segments;
  plan.bounds_[patch] = rounded_up(proven.distance + (roundings_[patch] + fit_error_));
  if (proven.anywhere) plan.straddles_[patch] = 1;
}

void CertifiedPlanner::choose_block(std::size_t block, const Request& request, std::span<SegmentChoices> choices,
                                    CertifiedPlan& plan, std::span<std::uint8_t> beyond) const {
  const std::uint32_t* patches = set_->lane_patches.data() + block * PatchSet::lanes;
  const std::size_t count = set_->lane_counts[block];
  ChordBlocks::Lanes<double> left;
  left.fill(request.tolerance);
  for (std::size_t lane = 0; lane < count; ++lane)
    left[lane] = request.tolerance - (roundings_[patches[lane]] + fit_error_);
  ChordBlocks::Products products;
  ChordBlocks::Choice choice = chords_.cheapest(*set_, block, count, left, max_rate, products);
  for (std::size_t lane = 0; lane < count; ++lane) {
    const std::size_t k = patches[lane];
    ProvenSegments proven{choice.rates[lane], choice.distance[lane]};
    beyond[k] = !(left[lane] > 0) || choice.rates[lane].u == 0;
    if (beyond[k])
      proven.segments = choose_beyond(k, request).segments, proven.distance = chord(k).distance_of(proven.segments);
    if (!choices.empty()) {
      choices[k] = SegmentChoices(proven);
    } else if (request.kept.segments.empty()) {
      set_segments(k, proven, plan);
    } else {
      const ChordBlocks::Products* const sharp = choice.sharpened >> lane & 1u ? &products : nullptr;
      set_segments(k, keep_by_distance(k, left[lane], request.kept, sharp, proven), plan);
    }
  }
}

Status CertifiedPlanner::choose_by_distance(const Request& request, CertifiedPlan& plan,
                                            const Execution& execution) const {
  const double tolerance = request.tolerance;
  const KeptSegments& kept = request.kept;
  std::vector<std::uint8_t> beyond(shapes_.size(), 0);
  std::vector<SegmentChoices> choices(request.fewest ? shapes_.size() : 0);
  const auto choose_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) choose_block(block, request, choices, plan, beyond);
  };
  const Execution quiet{.cancel = execution.cancel}, &first = choices.empty() ? execution : quiet;
  if (Status status = parallel_for(set_->lane_counts.size(), blocks_per_task, first, choose_some); !status.ok())
    return status;
  if (Status status = keep_beyond(request, beyond, plan); !status.ok() || choices.empty()) return status;
  const auto fewest = find_fewest(tolerance, std::move(choices), execution);
  if (!fewest) return fewest.status();
  for (std::size_t k = 0; k < fewest->size(); ++k) {
    if (kept.segments.empty()) {
      set_segments(k, (*fewest)[k], plan);
    } else {
      const double left = tolerance - (roundings_[k] + fit_error_);
      set_segments(k, keep_by_distance(k, left, kept, nullptr, (*fewest)[k]), plan);
    }
  }
  return {};
}

Status CertifiedPlanner::choose_rates(const Request& request, CertifiedPlan& plan, const Execution& execution) const {
  const std::size_t patches = shapes_.size();
  plan.segments_.resize(patches);
  plan.bounds_.resize(patches);
  if (options_.fewest || options_.angle || options_.camera) plan.straddles_.resize(patches);
  if (!options_.angle && !options_.camera) return choose_by_distance(request, plan, execution);
  if (options_.angle) plan.angles_.resize(patches);
  if (options_.camera) plan.pixels_.resize(patches);
  std::vector<std::uint8_t> beyond(patches, 0);
  const auto choose_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Choice choice = choose(k, request, max_rate);
      beyond[k] = choice.failure != Failure::none;
      if (beyond[k]) choice = choose_beyond(k, request);
      plan.segments_[k] = choice.segments;
      plan.straddles_[k] = choice.anywhere;
      plan.bounds_[k] = rounded_up(choice.bound);
      if (options_.angle) plan.angles_[k] = rounded_up(choice.angle);
      if (options_.camera) plan.pixels_[k] = rounded_up(choice.pixels);
    }
  };
  if (Status status = parallel_for(patches, patches_per_task, execution, choose_some); !status.ok()) return status;
  return keep_beyond(request, beyond, plan);
}

Result<CertifiedPlan> CertifiedPlanner::plan(const Request& request, const Execution& execution) const {
  CertifiedPlan plan;
  plan.set_f64_patches(options_.f64_patches);
  plan.has_f64_positions_ = options_.f64_positions;
  if (Status status = choose_rates(request, plan, execution); !status.ok()) return status;
  if (!set_->trims) divide(request.tolerance, plan);
  if (runs_) {
    if (Status status = close_edges(request, plan, execution); !status.ok()) return status;
  } else if (set_->trims) {
    Cutting cutting;
    if (Status status = divide_and_cut(request, plan, cutting, execution); !status.ok()) return status;
  }
  plan.lay_out();
  return plan;
}

Result<CertifiedPlan> CertifiedPlanner::leaner_plan(const Request& request, const Execution& execution) const {
  Result<CertifiedPlan> best = plan(request, execution);
  if (!best || !request.fewest || !request.kept.segments.empty()) return best;
  // Segments are chosen by an estimate of their neighbours' costs: rarely, the plain ones have fewer triangles.
  const Request of_plain{.tolerance = request.tolerance, .max_triangles = request.max_triangles};
  Result<CertifiedPlan> plain = plan(of_plain, {.cancel = execution.cancel});
  if (!plain) return plain.status().code() == StatusCode::cancelled ? std::move(plain) : std::move(best);
  if (plain->capacity().triangles < best->capacity().triangles) return plain;
  return best;
}

Result<CertifiedPlan> CertifiedPlanner::plan(double tolerance, std::uint64_t max_triangles, const Execution& execution,
                                             const KeptSegments& kept) const {
  Result<CertifiedPlan> best = leaner_plan({tolerance, options_.fewest, kept, max_triangles}, execution);
  if (!best) return best;
  const auto [vertices, triangles, quads] = best->capacity();
  if (triangles <= max_triangles && vertices <= max_vertices) return best;
  return Status(StatusCode::invalid_argument, wanted(tolerance) + " takes " + std::to_string(triangles) +
                                                  " triangles and " + std::to_string(vertices) +
                                                  " vertices, the limits are " + std::to_string(max_triangles) +
                                                  " and " + std::to_string(max_vertices));
}

}}  // namespace tessera::abi_0_1
