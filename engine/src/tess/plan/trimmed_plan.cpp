// Plans the patches that trimming loops cut, together with their neighbours.
//
// Proof of the bound of a cut patch:
// 1. A triangle with its corners on a patch lies within f of it: tess/bounds/chord_bound.h, by its own parameter box.
//    Each point of the triangle is near a point of the patch at parameters in the triangle, and the other way round.
// 2. The triangles cover the polygon of the chords, once: PolygonTriangles, by exact signs.
// 3. A point of the polygon outside of the loops lies in a sliver between a chord and its curve. So does a point
//    within the loops outside of the polygon. Both are within e of a point on the other's border: PieceChords.
// 4. Vertices are moved by at most r: by rounding, or by taking the vertices of a whole neighbour. So the bound is
//    f + e + r, each its largest.
//
// Angles and pixels hold as for whole patches, at rates whose cells are as wide as the widest triangle.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "parallel/parallel_for.h"
#include "tess/edges/side_curve.h"
#include "tess/plan/certified_plan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Triangles of the band may be wider than a cell, so cells take a part of the room. Larger ones are halved.
constexpr double cell_share = 0.6, sliver_share = 0.25;
constexpr double band_share = 1.5;  // a bound of most triangles of the band over that of cells
constexpr int max_attempts = 24;
constexpr std::size_t cuts_per_task = 4, rooms_per_task = 64;

/// The largest number of triangles of a patch, and of all cut ones, at which a plan goes on: some times the limit, so
/// that messages can say how many a mesh takes that exceeds it by less.
std::uint64_t max_while_cutting(std::uint64_t max_triangles) {
  return 8 * std::min(max_triangles, std::uint64_t{1} << 28);
}

}  // namespace

void CertifiedPlanner::find_cut_faces() {
  if (set_->edges && options_.closes_edges) runs_.emplace(*set_);
  if (!set_->trims) return;
  drawn_ = shapes_;
  for (const PatchTrims::Cut& cut : set_->trims->cuts) drawn_[cut.patch].is_curve = true;
  for (const TrimRegion& region : set_->trims->regions) face_sides_.emplace_back(region);
  if (!runs_) return;
  std::vector<std::uint32_t> faces(set_->patches.size(), no_id);
  for (std::uint32_t face = 0; face < set_->edges->faces.size(); ++face)
    for (const std::uint32_t patch : set_->edges->faces[face].patches)
      if (patch != no_id) faces[patch] = face;
  for (const PatchTrims::Cut& cut : set_->trims->cuts) cut_faces_.push_back(faces[cut.patch]);
}

CertifiedPlanner::CutRoom CertifiedPlanner::room_of(const CutPatch& cut, double share, const Request& request,
                                                    const CertifiedPlan& plan) const {
  const std::size_t patch = cut.patch;
  CutRoom room;
  room.limits.speed = SpeedBound::of(set_->patches[patch]);
  room.limits.segments = plan.segments_[patch];
  // Parameters of a vertex in its patch are off by three roundings.
  room.given = roundings_[patch] + 0x1p-51 * (room.limits.speed.u + room.limits.speed.v) + fit_error_;
  for (const Side side : all_sides) {
    const CutPatch::SameBorder same = cut.same[static_cast<std::size_t>(side)];
    if (same.border == no_id) continue;
    const SideCurve own(set_->patches[patch], side), taken(set_->patches[same.border / 4], all_sides[same.border % 4]);
    const double moved = distance_bound(own, taken, same.reversed) + roundings_[same.border / 4];
    room.given = std::max(room.given, moved + fit_error_);
  }
  room.tolerance = share * request.tolerance;
  double sliver = std::numeric_limits<double>::infinity();
  if (options_.camera) {
    const ScreenSpaceBound& picture = pictures_[patch];
    room.tolerance = std::min(room.tolerance, picture.distance());
    if (picture.projected() && picture.moved_pixels() > 0)
      sliver = sliver_share * (options_.pixels - picture.moved_pixels()) * room.given / picture.moved_pixels();
  }
  if (std::isfinite(room.tolerance)) {
    // Slivers get the rest that flat patches leave.
    const double cells = chord(patch).distance_of(room.limits.segments);
    const double left = (cells > 0 ? 0.95 : 1 - 0x1p-40) * room.tolerance - room.given - band_share * cells;
    sliver = std::min(sliver, std::max(sliver_share * room.tolerance, left));
  }
  room.limits.sliver = sliver;
  room.limits.room = std::isfinite(room.tolerance) ? room.tolerance - room.given : room.tolerance;
  room.limits.in_cells = options_.angle || options_.camera;
  room.limits.rounding = {&set_->patches[patch], set_->origin, options_.f64_positions, roundings_[patch]};
  room.limits.domain = set_->sources[patch].domain;
  room.limits.max_triangles = max_while_cutting(request.max_triangles);
  room.limits.bend = options_.angle ? *options_.angle / 8 : std::numeric_limits<double>::infinity();
  return room;
}

Result<std::vector<CertifiedPlanner::CutRoom>> CertifiedPlanner::find_rooms(const Request& request,
                                                                            const CertifiedPlan& plan,
                                                                            const Execution& execution) const {
  std::vector<CutRoom> rooms(plan.cuts().size());
  const auto find = [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      rooms[c] = room_of(plan.cuts()[c], request.cut_shares.empty() ? 1 : request.cut_shares[c], request, plan);
  };
  Status status = parallel_for(rooms.size(), rooms_per_task, {.cancel = execution.cancel}, find);
  if (!status.ok()) return status;
  return rooms;
}

double CertifiedPlanner::bound_cut(const CutRoom& room, const CutPatch& cut, CertifiedPlan& plan) const {
  const std::size_t k = cut.patch;
  const double bound = cut.distance + cut.sliver + room.given;
  double excess = std::isfinite(room.tolerance) ? bound / room.tolerance : 0;
  plan.bounds_[k] = cut.is_crossed ? std::numeric_limits<float>::infinity() : rounded_up(bound);
  if (options_.angle && !shapes_[k].is_curve) {
    const TurningBound turning = turning_of(k).bound;  // welding does not move borders of cut patches
    const double angle = turning.is_finite() ? turning.angle(cut.widest) : std::numeric_limits<double>::infinity();
    plan.angles_[k] = rounded_up(angle);
    if (turning.is_finite()) excess = std::max(excess, angle / *options_.angle);
  }
  if (options_.camera && pictures_[k].projected()) {
    const ScreenSpaceBound picture(*options_.camera, set_->patches[k], room.given + cut.sliver, options_.pixels);
    const double pixels = picture.pixels(cut.widest, bound);
    plan.pixels_[k] = rounded_up(pixels);
    excess = std::max(excess, pixels / options_.pixels);
  }
  return excess;
}

void CertifiedPlanner::find_same_borders(CertifiedPlan& plan) const {
  const EdgeDirections directions = edge_directions();
  const std::span<const PatchShape> shapes = divided_shapes();
  for (std::size_t c = 0; c < plan.rare_->cuts.size(); ++c) {
    CutPatch& cut = plan.rare_->cuts[c];
    cut.patch = set_->trims->cuts[c].patch;
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(cut.patch, side);
      if (edge == no_id) continue;
      const std::uint32_t whole = directions.leading(edge), border = 4 * cut.patch + static_cast<std::uint32_t>(side);
      if (whole == no_id || shapes[whole / 4].is_curve) continue;
      cut.same[static_cast<std::size_t>(side)] = {whole, directions.runs_against_leading(border)};
    }
  }
}

void CertifiedPlanner::choose_cut(const Request& request, CutShares& shares, CertifiedPlan& plan) const {
  Request own = request;
  own.uniform = true;  // triangles of the band may be as wide as the widest cell
  own.fewest = false;
  for (std::size_t c = 0; c < plan.cuts().size(); ++c) {
    if (!shares.is_due(c)) continue;
    const std::size_t patch = plan.cuts()[c].patch;
    own.share = shares.share(c);
    const Choice choice = choose(patch, own, max_rate);
    if (choice.failure == Failure::none)
      plan.segments_[patch] = choice.segments;
    else
      shares.settle(c);
  }
}

std::vector<std::uint8_t> CertifiedPlanner::shared_edges() const {
  std::vector<std::uint8_t> borders(edges_.count(), 0);
  for (const std::uint32_t edge : edges_.of_borders())
    if (edge != no_id) borders[edge] += borders[edge] < 2;
  for (std::uint8_t& count : borders) count = count == 2;
  return borders;
}

double CertifiedPlanner::cut_patch(std::size_t c, const CutPass& pass, CutPatchMaker& maker,
                                   CertifiedPlan& plan) const {
  const PatchTrims::Cut& cut = set_->trims->cuts[c];
  CutRoom room = pass.rooms[c];
  for (const Side side : all_sides) {
    const std::uint32_t edge = edges_.edge(cut.patch, side);
    room.limits.is_shared[static_cast<std::size_t>(side)] = edge != no_id && pass.is_shared[edge];
  }
  room.limits.cancel = pass.cancel;
  std::optional<PatchStops> demands;
  if (pass.stops && cut_faces_[c] != no_id) room.limits.edges = &demands.emplace(*pass.stops, cut.patch, cut_faces_[c]);
  maker.make(set_->trims->regions[cut.region], face_sides_[cut.region], cut, room.limits,
             plan.divisions_[cut.patch].border, divided_shapes()[cut.patch].collapsed, chord(cut.patch),
             plan.rare_->cuts[c]);
  const bool has_too_many = plan.rare_->cuts[c].has_too_many;
  return has_too_many ? std::numeric_limits<double>::infinity() : bound_cut(room, plan.rare_->cuts[c], plan);
}

Status CertifiedPlanner::divide_and_cut(const Request& request, CertifiedPlan& plan, Cutting& cutting,
                                        const Execution& execution) const {
  const std::vector<PatchTrims::Cut>& cuts = set_->trims->cuts;
  if (!plan.rare_) plan.rare_ = std::make_unique<CertifiedPlan::Rare>();
  plan.rare_->trims = set_->trims;
  plan.rare_->cuts.resize(cuts.size());
  plan.rare_->crossed.clear();
  std::erase_if(plan.rare_->beyond, [this](std::uint32_t patch) { return is_cut(patch); });
  find_same_borders(plan);
  const std::vector<std::uint8_t> is_shared = shared_edges();
  if (!cutting.shares) cutting.shares.emplace(cuts.size(), cell_share);
  cutting.excess.resize(cuts.size(), 0);
  for (int attempt = 0; attempt < max_attempts && cutting.shares->is_any_due(); ++attempt)
    if (Status status = cut_once(request, is_shared, plan, cutting, execution); !status.ok()) return status;
  plan.count_open_edges_beside_loops(edges_);
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    if (plan.cuts()[c].is_crossed) plan.rare_->crossed.push_back(cuts[c].patch);
    if (cutting.shares->is_beyond(c)) plan.rare_->beyond.push_back(cuts[c].patch);
  }
  std::ranges::sort(plan.rare_->beyond);
  return {};
}

Status CertifiedPlanner::cut_once(const Request& request, std::span<const std::uint8_t> is_shared, CertifiedPlan& plan,
                                  Cutting& cutting, const Execution& execution) const {
  const std::vector<PatchTrims::Cut>& cuts = set_->trims->cuts;
  CutShares& shares = *cutting.shares;
  std::vector<double>& excess = cutting.excess;
  choose_cut(request, shares, plan);
  const std::vector<Division> before = std::exchange(plan.divisions_, {});
  divide(request.tolerance, plan);
  std::vector<std::uint8_t> is_changed(plan.divisions_.size(), before.empty());
  for (std::size_t k = 0; k < before.size(); ++k) is_changed[k] = !(before[k] == plan.divisions_[k]);
  for (std::size_t c = 0; c < cuts.size(); ++c) is_changed[cuts[c].patch] |= shares.is_due(c);
  const Result<std::vector<CutRoom>> rooms = find_rooms(request, plan, execution);
  if (!rooms) return rooms.status();
  if (runs_)
    if (Status status = find_stops(*rooms, plan, cutting.stops, is_changed, request, execution); !status.ok())
      return status;
  const auto cut_some = [&](std::size_t begin, std::size_t end) {
    const auto maker = cutting.makers.take();
    const CutPass pass{*rooms, cutting.stops ? &*cutting.stops : nullptr, is_shared, execution.cancel};
    for (std::size_t c = begin; c < end; ++c)
      if (is_changed[cuts[c].patch]) excess[c] = cut_patch(c, pass, *maker, plan);
  };
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = parallel_for(cuts.size(), cuts_per_task, quiet, cut_some); !status.ok()) return status;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    if (plan.cuts()[c].has_too_many) return too_many(request, cuts[c].patch);
    if (!(plan.cuts()[c].sliver < request.tolerance)) shares.settle(c);  // smaller cells leave the slivers as they are
    shares.take(c, excess[c]);
  }
  return check_triangles(request, plan);
}

Status CertifiedPlanner::too_many(const Request& request, std::size_t patch) const {
  return {StatusCode::invalid_argument,
          wanted(request.tolerance) + " takes more triangles for patch " + std::to_string(patch) +
              " alone than the limit of " + std::to_string(request.max_triangles),
          static_cast<std::ptrdiff_t>(patch)};
}

// Later attempts have more triangles.
Status CertifiedPlanner::check_triangles(const Request& request, const CertifiedPlan& plan) const {
  std::uint64_t triangles = 0;
  for (const CutPatch& cut : plan.cuts()) triangles += cut.triangles.size();
  if (triangles <= max_while_cutting(request.max_triangles)) return {};
  return {StatusCode::invalid_argument, wanted(request.tolerance) + " takes more than " + std::to_string(triangles) +
                                            " triangles, the limit is " + std::to_string(request.max_triangles)};
}

}}  // namespace tessera::abi_0_1
