#include "tess/plan/face_cutter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "block/patch_edges.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/rounded_up.h"
#include "tess/edges/side_curve.h"
#include "tess/plan/divide_patches.h"
#include "tess/plan/refusals.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Triangles of the band may be wider than a cell, so cells take a part of the room. Larger ones are halved.
constexpr double cell_share = 0.6, sliver_share = 0.25;
constexpr double band_share = 1.5;  // a bound of most triangles of the band over that of cells
constexpr int max_cuts = 24;
constexpr std::size_t cuts_per_task = 1, rooms_per_task = 16, edges_per_task = 4;

/// The largest number of triangles of a patch, and of all cut ones, at which a plan goes on: some times the limit, so
/// that messages can say how many a mesh takes that exceeds it by less.
std::uint64_t max_while_cutting(std::uint64_t max_triangles) {
  return 8 * std::min(max_triangles, std::uint64_t{1} << 28);
}

/// Returns `[edge]`: 1 if two borders or more have it.
std::vector<std::uint8_t> with_two_borders(const SharedEdges& edges) {
  std::vector<std::uint8_t> borders(edges.count(), 0);
  for (const std::uint32_t edge : edges.of_borders())
    if (edge != no_id) borders[edge] += borders[edge] < 2;
  for (std::uint8_t& count : borders) count = count == 2;
  return borders;
}

}  // namespace

FaceCutter::FaceCutter(const PlanFacts& facts, const PlanRequest& request, DividedPatches& patches,
                       const Execution& execution)
    : facts_(facts),
      set_(facts.needs.set()),
      request_(request),
      patches_(patches),
      rare_(patches.rare.make()),
      quiet_{.cancel = execution.cancel},
      is_shared_(with_two_borders(facts.borders.edges())),
      parts_(set_.trims->cuts.size(), 1),
      shares_(parts_.size(), cell_share),
      excess_(parts_.size(), 0),
      rooms_(parts_.size()) {
  rare_.trims = set_.trims;
  rare_.cuts.resize(parts_.size());
  find_same_borders();
}

FaceCutter::Room FaceCutter::room_of(const CutPatch& cut, double share) const {
  const PatchNeeds& needs = facts_.needs;
  const PlannerOptions& options = needs.options();
  const std::span<const double> roundings = needs.roundings();
  const std::size_t patch = cut.patch;
  Room room;
  room.limits.speed = SpeedBound::of(set_.patches[patch]);
  room.limits.segments = patches_.segments[patch];
  // Parameters of a vertex in its patch are off by three roundings.
  room.given = roundings[patch] + 0x1p-51 * (room.limits.speed.u + room.limits.speed.v) + needs.fit_error();
  for (const Side side : all_sides) {
    const CutPatch::SameBorder same = cut.same[static_cast<std::size_t>(side)];
    if (same.border == no_id) continue;
    const SideCurve own(set_.patches[patch], side), taken(set_.patches[same.border / 4], all_sides[same.border % 4]);
    const double moved = distance_bound(own, taken, same.reversed) + roundings[same.border / 4];
    room.given = std::max(room.given, moved + needs.fit_error());
  }
  room.tolerance = share * needs.tolerance_of(patch, request_.tolerance);
  double sliver = std::numeric_limits<double>::infinity();
  if (options.camera) {
    const ScreenSpaceBound& picture = needs.pictures()[patch];
    room.tolerance = std::min(room.tolerance, picture.distance());
    if (picture.projected() && picture.moved_pixels() > 0)
      sliver = sliver_share * (options.pixels - picture.moved_pixels()) * room.given / picture.moved_pixels();
  }
  if (std::isfinite(room.tolerance)) {
    // Slivers get the rest that flat patches leave.
    const double cells = needs.chord(patch).distance_of(room.limits.segments);
    const double left = (cells > 0 ? 0.95 : 1 - 0x1p-40) * room.tolerance - room.given - band_share * cells;
    sliver = std::min(sliver, std::max(sliver_share * room.tolerance, left));
  }
  room.limits.sliver = sliver;
  room.limits.room = std::isfinite(room.tolerance) ? room.tolerance - room.given : room.tolerance;
  room.limits.in_cells = options.angle || options.camera;
  room.limits.rounding = {&set_.patches[patch], set_.origin, options.f64_positions, roundings[patch]};
  room.limits.domain = set_.sources[patch].domain;
  room.limits.max_triangles = max_while_cutting(request_.max_triangles);
  room.limits.bend = options.angle ? *options.angle / 8 : std::numeric_limits<double>::infinity();
  return room;
}

Status FaceCutter::find_rooms() {
  const auto find = [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) rooms_[c] = room_of(rare_.cuts[c], parts_[c]);
  };
  return parallel_for(rooms_.size(), rooms_per_task, quiet_, find);
}

double FaceCutter::bound(const Room& room, const CutPatch& cut) {
  const PatchNeeds& needs = facts_.needs;
  const PlannerOptions& options = needs.options();
  const std::size_t k = cut.patch;
  const double bound = cut.distance + cut.sliver + room.given;
  double excess = std::isfinite(room.tolerance) ? bound / room.tolerance : 0;
  patches_.bounds[k] = cut.is_crossed ? std::numeric_limits<float>::infinity() : rounded_up(bound);
  if (options.angle && !needs.shapes()[k].is_curve) {
    const TurningBound turning = needs.turning_of(k).bound;  // welding does not move borders of cut patches
    const double angle = turning.is_finite() ? turning.angle(cut.widest) : std::numeric_limits<double>::infinity();
    patches_.angles[k] = rounded_up(angle);
    if (turning.is_finite()) excess = std::max(excess, angle / *options.angle);
  }
  if (options.camera && needs.pictures()[k].projected()) {
    const ScreenSpaceBound picture(*options.camera, set_.patches[k], room.given + cut.sliver, options.pixels);
    const double pixels = picture.pixels(cut.widest, bound);
    patches_.pixels[k] = rounded_up(pixels);
    excess = std::max(excess, pixels / options.pixels);
  }
  return excess;
}

void FaceCutter::find_same_borders() {
  const SharedEdges& edges = facts_.borders.edges();
  const EdgeDirections directions = facts_.borders.directions(facts_.needs);
  const std::span<const PatchShape> shapes = facts_.borders.shapes(facts_.needs);
  for (std::size_t c = 0; c < rare_.cuts.size(); ++c) {
    CutPatch& cut = rare_.cuts[c];
    cut.patch = set_.trims->cuts[c].patch;
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges.edge(cut.patch, side);
      if (edge == no_id) continue;
      const std::uint32_t whole = directions.leading(edge), border = 4 * cut.patch + static_cast<std::uint32_t>(side);
      if (whole == no_id || shapes[whole / 4].is_curve) continue;
      cut.same[static_cast<std::size_t>(side)] = {whole, directions.runs_against_leading(border)};
    }
  }
}

void FaceCutter::choose_segments() {
  PlanRequest own = request_;
  own.uniform = true;  // triangles of the band may be as wide as the widest cell
  own.fewest = false;
  own.headroom = 0;  // each update cuts anew
  for (std::size_t c = 0; c < rare_.cuts.size(); ++c) {
    if (!shares_.is_due(c)) continue;
    const std::size_t patch = rare_.cuts[c].patch;
    own.share = shares_.share(c);
    const NeededSegments needed = facts_.needs.segments_for(patch, own, max_rate);
    if (needed.are_found())
      patches_.segments[patch] = needed.segments;
    else
      shares_.settle(c);
  }
}

double FaceCutter::cut_patch(std::size_t c, CutPatchMaker& maker) {
  const PatchTrims::Cut& cut = set_.trims->cuts[c];
  const CutFaces& faces = facts_.faces;
  CutPatch& made = rare_.cuts[c];
  Room room = rooms_[c];
  for (const Side side : all_sides) {
    const std::uint32_t edge = facts_.borders.edges().edge(cut.patch, side);
    room.limits.is_shared[static_cast<std::size_t>(side)] = edge != no_id && is_shared_[edge];
  }
  room.limits.cancel = quiet_.cancel;
  PatchStations stations;
  if (stations_ && faces.names_edges[c]) room.limits.stations = &(stations = stations_->of(cut.patch));
  maker.make(set_.trims->regions[cut.region], faces.sides[cut.region], cut, room.limits,
             patches_.divisions[cut.patch].border, facts_.borders.shapes(facts_.needs)[cut.patch].collapsed,
             facts_.needs.chord(cut.patch), made);
  return made.has_too_many ? std::numeric_limits<double>::infinity() : bound(room, made);
}

Status FaceCutter::find_stations(std::vector<std::uint8_t>& is_changed) {
  const EdgeRuns& runs = *facts_.faces.runs;
  const std::size_t edges = set_.edges->edges.size();
  std::vector<ChordLimits> of_cuts;
  for (const Room& room : rooms_) of_cuts.emplace_back(chord_limits(room.limits)).cancel = quiet_.cancel;
  const auto segments = [&](std::uint32_t patch, Side side) -> std::optional<Segments> {
    if (set_.trims->is_cut[patch]) return {};
    return patches_.divisions[patch].border[static_cast<std::size_t>(side)];
  };
  const std::span<const CutPatch> cuts = rare_.cuts;
  const auto limits = [&](std::uint32_t patch) -> const ChordLimits& {
    return of_cuts[static_cast<std::size_t>(find_cut(cuts, patch) - cuts.data())];
  };
  std::optional<EdgeStations> before = std::exchange(stations_, std::nullopt);
  EdgeStations& now =
      stations_.emplace(runs, same_share(set_, facts_.needs.options().least_share * request_.tolerance));
  const auto find = [&](std::size_t begin, std::size_t end) {
    EdgeStations::Workspace workspace;
    for (std::size_t edge = begin; edge < end; ++edge)
      if (!before || std::ranges::any_of(runs.of(edge), [&](const EdgeRun& run) { return is_changed[run.patch]; }))
        now.find(set_, edge, segments, limits, workspace);
      else
        now.keep(*before, edge);
  };
  Status status = parallel_for(edges, edges_per_task, quiet_, find);
  if (!status.ok() || !before) return status;
  for (std::size_t edge = 0; edge < edges; ++edge)
    if (!now.has_same(*before, edge))
      for (const EdgeRun& run : runs.of(edge)) is_changed[run.patch] = 1;
  return {};
}

Status FaceCutter::cut() {
  rare_.crossed.clear();
  std::erase_if(rare_.beyond, [this](std::uint32_t patch) { return set_.trims->is_cut[patch]; });
  for (int attempt = 0; attempt < max_cuts && shares_.is_any_due(); ++attempt)
    if (Status status = cut_once(); !status.ok()) return status;
  count_open_edges();
  for (std::size_t c = 0; c < rare_.cuts.size(); ++c) {
    if (rare_.cuts[c].is_crossed) rare_.crossed.push_back(rare_.cuts[c].patch);
    if (shares_.is_beyond(c)) rare_.beyond.push_back(rare_.cuts[c].patch);
  }
  std::ranges::sort(rare_.beyond);
  return {};
}

std::vector<std::uint8_t> FaceCutter::divide() {
  const std::vector<Division> before = std::exchange(patches_.divisions, {});
  divide_patches(facts_, request_.tolerance, patches_);
  std::vector<std::uint8_t> is_changed(patches_.divisions.size(), before.empty());
  for (std::size_t k = 0; k < before.size(); ++k) is_changed[k] = !(before[k] == patches_.divisions[k]);
  for (std::size_t c = 0; c < rare_.cuts.size(); ++c) is_changed[rare_.cuts[c].patch] |= shares_.is_due(c);
  return is_changed;
}

Status FaceCutter::cut_once() {
  choose_segments();
  std::vector<std::uint8_t> is_changed = divide();
  if (Status status = find_rooms(); !status.ok()) return status;
  if (facts_.faces.runs)
    if (Status status = find_stations(is_changed); !status.ok()) return status;
  const std::vector<CutPatch>& cuts = rare_.cuts;
  const auto cut_some = [&](std::size_t begin, std::size_t end) {
    const auto maker = makers_.take();
    for (std::size_t c = begin; c < end; ++c)
      if (is_changed[cuts[c].patch]) excess_[c] = cut_patch(c, *maker);
  };
  if (Status status = parallel_for(cuts.size(), cuts_per_task, quiet_, cut_some); !status.ok()) return status;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    if (cuts[c].has_too_many) return too_many_of_patch(facts_.needs.options(), request_, cuts[c].patch);
    const double tolerance = facts_.needs.tolerance_of(cuts[c].patch, request_.tolerance);
    if (!(cuts[c].sliver < tolerance)) shares_.settle(c);  // smaller cells leave the slivers as they are
    shares_.take(c, excess_[c]);
  }
  return check_triangles();
}

double FaceCutter::bound_edited(std::size_t c) { return bound(room_of(rare_.cuts[c], 1), rare_.cuts[c]); }

void FaceCutter::cut_again(std::size_t c, double factor) {
  shares_.restart(c, factor);
  parts_[c] *= factor;
}

// Later attempts have more triangles.
Status FaceCutter::check_triangles() const {
  std::uint64_t triangles = 0;
  for (const CutPatch& cut : rare_.cuts) triangles += cut.triangles.size();
  if (triangles <= max_while_cutting(request_.max_triangles)) return {};
  return too_many_of_cuts(facts_.needs.options(), request_, triangles);
}

void FaceCutter::count_open_edges() {
  const SharedEdges& edges = facts_.borders.edges();
  std::vector<std::uint32_t> borders(edges.count(), 0);
  const auto visit_border = [&](std::size_t patch, Side side, const auto& visit) {
    if (const std::uint32_t edge = edges.edge(patch, side); edge != no_id)
      visit(edge, patches_.divisions[patch].border[static_cast<std::size_t>(side)].rate());
  };
  const auto for_borders = [&](const auto& visit) {
    for (std::size_t patch = 0; patch < patches_.divisions.size(); ++patch)
      for (const Side side : all_sides)
        if (!patches_.divisions[patch].empty) visit_border(patch, side, visit);
    for (const CutPatch& cut : rare_.cuts)
      for (const Side side : all_sides)
        if (!cut.is_crossed && cut.is_full[static_cast<std::size_t>(side)]) visit_border(cut.patch, side, visit);
  };
  for_borders([&](std::uint32_t edge, int) { ++borders[edge]; });
  patches_.open_edges = 0;
  for_borders([&](std::uint32_t edge, int rate) {
    if (borders[edge] == 1) patches_.open_edges += static_cast<std::uint32_t>(rate);
  });
  for (const CutPatch& cut : rare_.cuts) patches_.open_edges += cut.open_edges;
}

}}  // namespace tessera::abi_0_1
