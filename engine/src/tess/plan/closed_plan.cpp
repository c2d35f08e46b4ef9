// Closes the edges of shapes in a plan.

#include <algorithm>
#include <memory>
#include <utility>

#include "base/union_find.h"
#include "parallel/parallel_for.h"
#include "tess/plan/certified_plan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t edges_per_task = 16;

}  // namespace

Status CertifiedPlanner::find_stops(std::span<const CutRoom> rooms, const CertifiedPlan& plan,
                                    std::optional<EdgeStops>& stops, std::vector<std::uint8_t>& is_changed,
                                    const Request& request, const Execution& execution) const {
  std::vector<ChordLimits> of_cuts;
  for (const CutRoom& room : rooms) of_cuts.emplace_back(chord_limits(room.limits)).cancel = execution.cancel;
  const auto segments = [&](std::uint32_t patch, Side side) -> std::optional<Segments> {
    if (set_->trims && set_->trims->is_cut[patch]) return {};
    return plan.divisions_[patch].border[static_cast<std::size_t>(side)];
  };
  const auto limits = [&](std::uint32_t patch) -> const ChordLimits& {
    return of_cuts[static_cast<std::size_t>(find_cut(plan.cuts(), patch) - plan.cuts().data())];
  };
  std::optional<EdgeStops> before = std::exchange(stops, std::nullopt);
  EdgeStops& now = stops.emplace(*runs_, same_share(request));
  const auto find = [&](std::size_t begin, std::size_t end) {
    EdgeStops::Workspace workspace;
    for (std::size_t edge = begin; edge < end; ++edge)
      if (!before || std::ranges::any_of(runs_->of(edge), [&](const EdgeRun& run) { return is_changed[run.patch]; }))
        now.find(*set_, edge, segments, limits, workspace);
      else
        now.keep(*before, edge);
  };
  Status status = parallel_for(set_->edges->edges.size(), edges_per_task, {.cancel = execution.cancel}, find);
  if (!status.ok() || !before) return status;
  for (std::size_t edge = 0; edge < set_->edges->edges.size(); ++edge)
    if (!now.has_same(*before, edge))
      for (const EdgeRun& run : runs_->of(edge)) is_changed[run.patch] = 1;
  return {};
}

// An edge is rarely longer than a few diagonals of the set, so vertices move by a small part of the tolerance.
double CertifiedPlanner::same_share(const Request& request) const {
  return std::clamp(0.05 * request.tolerance / set_->model_box().diagonal(), least_same_share, largest_same_share);
}

// Vertices that are inserted into cut patches may make triangles a little larger than they were cut for: then these
// patches are cut anew for less, and so are all to which vertices were added. In the last attempt they keep the bounds
// that they have.
Status CertifiedPlanner::close_edges(const Request& request, CertifiedPlan& plan, const Execution& execution) const {
  constexpr int max_attempts = 6;
  std::vector<double> shares(set_->trims ? set_->trims->cuts.size() : 0, 1);
  Request cut = request;
  cut.cut_shares = shares;
  Cutting cutting;
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    if (set_->trims)
      if (Status status = divide_and_cut(cut, plan, cutting, execution); !status.ok()) return status;
    if (!plan.rare_) plan.rare_ = std::make_unique<CertifiedPlan::Rare>();
    Result<ClosedEdges> made = tessera::close_edges(
        *set_, *runs_, plan.divisions_, plan.rare_->cuts, cutting.stops ? &*cutting.stops : nullptr, options_.max_gap,
        same_share(request), joined_borders(plan), [this](std::uint32_t patch) { return chord(patch); },
        execution.cancel);
    if (!made) return made.status();
    const ClosedEdges& closed = plan.rare_->closed.emplace(*std::move(made));
    plan.open_edges_ =
        static_cast<std::uint32_t>(std::max(std::int64_t{0}, std::int64_t{plan.open_edges_} - closed.closed_segments));
    std::vector<std::uint32_t>& beyond = plan.rare_->beyond;
    const std::size_t known = beyond.size();
    for (const std::uint32_t c : closed.edited_cuts) {
      CutPatch& edited = plan.rare_->cuts[c];
      const double excess = bound_cut(room_of(edited, 1, request, plan), edited, plan);
      const bool is_known = std::binary_search(beyond.begin(), beyond.begin() + std::ptrdiff_t(known), edited.patch);
      const double factor = excess <= 1 || is_known ? 1 : 0.95 / excess;
      cutting.shares->restart(c, factor);
      shares[c] *= factor;
      if (factor < 1) beyond.push_back(edited.patch);
    }
    if (beyond.size() == known) break;
    std::ranges::sort(beyond);
  }
  return {};
}

void CertifiedPlanner::find_edges_in_step() {
  UnionFind groups(edges_.count());
  const auto edge_of_border = [&](std::uint32_t border) { return edges_.edge(border / 4, all_sides[border % 4]); };
  for (const auto& [a, b] : runs_->borders_in_step(*set_))
    if (const std::uint32_t of_a = edge_of_border(a), of_b = edge_of_border(b); of_a != no_id && of_b != no_id)
      groups.unite(of_a, of_b);
  std::vector<std::uint32_t> places(edges_.count(), no_id);
  for (std::uint32_t edge = 0; edge < edges_.count(); ++edge) {
    const std::uint32_t first = groups.find(edge).member;
    if (first == edge) continue;
    if (places[first] == no_id) {
      places[first] = static_cast<std::uint32_t>(edges_in_step_.size());
      edges_in_step_.push_back({first});
    }
    edges_in_step_[places[first]].push_back(edge);
  }
}

std::vector<std::uint8_t> CertifiedPlanner::joined_borders(const CertifiedPlan& plan) const {
  std::vector<std::uint8_t> borders(edges_.count(), 0), is_joined(4 * shapes_.size(), 0);
  const auto full_borders = [&](auto visit) {
    const auto visit_side = [&](std::size_t patch, Side side) {
      if (const std::uint32_t edge = edges_.edge(patch, side); edge != no_id)
        visit(4 * patch + static_cast<std::size_t>(side), edge);
    };
    for (std::size_t patch = 0; patch < shapes_.size(); ++patch)
      for (const Side side : all_sides)
        if (!plan.divisions_[patch].empty) visit_side(patch, side);
    for (const CutPatch& cut : plan.cuts())
      for (const Side side : all_sides)
        if (cut.is_full[static_cast<std::size_t>(side)]) visit_side(cut.patch, side);
  };
  full_borders([&](std::size_t, std::uint32_t edge) { borders[edge] += borders[edge] < 2; });
  full_borders([&](std::size_t border, std::uint32_t edge) { is_joined[border] = borders[edge] == 2; });
  for (const CutPatch& cut : plan.cuts())
    for (std::size_t side = 0; side < 4; ++side) is_joined[4 * cut.patch + side] |= cut.is_shared[side];
  return is_joined;
}

}}  // namespace tessera::abi_0_1
