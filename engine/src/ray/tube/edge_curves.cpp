#include "ray/tube/edge_curves.h"

#include <algorithm>
#include <cmath>

#include "block/patch_trims.h"
#include "ray/line/first_order.h"
#include "trim/trim_region_impl.h"

namespace tessera::inline abi_0_1 {
namespace {

/// The index into all_edges of a patch's side.
int index_of(Side side) { return static_cast<int>(std::ranges::find(all_edges, edge_of(side)) - all_edges.begin()); }

/// The part of the edge's range that a curve covers.
double extent(const EdgeCurve& curve) {
  double sum = 0;
  for (const EdgeStretch& stretch : curve) sum += stretch.high() - stretch.low();
  return sum;
}

}  // namespace

LoopPoint loop_point(const SetView& set, const SceneFrame& frame, const TrimPiece& piece, std::uint32_t patch,
                     double x) {
  const ParameterPoint offset = relative_point(piece.curve, piece.start(), x);
  const Domain& domain = set.source(patch).domain;
  const double wide = domain.u1 - domain.u0, high = domain.v1 - domain.v0;
  LoopPoint out;
  out.patch = patch;
  out.u = std::clamp((piece.start().u + offset.u - domain.u0) / wide, 0.0, 1.0);
  out.v = std::clamp((piece.start().v + offset.v - domain.v0) / high, 0.0, 1.0);
  const FirstOrder at = first_order(set.patch(patch), out.u, out.v, frame.centre);
  out.position = frame.scale * at.position;
  out.unsure = frame.scale * (piece.error.u / wide * length(at.du) + piece.error.v / high * length(at.dv));
  return out;
}

std::vector<EdgeCurve> EdgeCurves::of(std::size_t edge) const {
  std::vector<EdgeCurve> curves;
  const EdgeRun* before = nullptr;
  for (const EdgeRun& run : runs_.of(edge)) {
    if (before == nullptr || before->use != run.use) curves.emplace_back();
    before = &run;
    const CurveAlongEdge along = runs_.curve(run);
    for (const TrimPiece& piece : runs_.pieces(run))
      curves.back().push_back(
          {&piece, along, run.patch, along.to_edge(piece.range.from), along.to_edge(piece.range.to)});
  }
  for (EdgeCurve& curve : curves) std::ranges::stable_sort(curve, {}, &EdgeStretch::low);
  std::ranges::stable_sort(curves, std::greater<>(), extent);
  return curves;
}

bool EdgeCurves::is_joined(std::size_t edge, const Adjacency& adjacency) const {
  const std::span<const EdgeRun> runs = runs_.of(edge);
  const PatchTrims* const trims = set_->impl().trims.get();
  return std::ranges::all_of(runs, [&](const EdgeRun& run) {
    if (!run.is_side || (trims != nullptr && trims->is_cut[run.patch])) return false;
    const EdgeLink& link = adjacency.across(run.patch, index_of(run.side));
    return link.exists() && std::ranges::any_of(runs, [&](const EdgeRun& other) {
             return other.use != run.use && other.is_side && other.patch == link.patch &&
                    index_of(other.side) == link.edge;
           });
  });
}

bool EdgeCurves::has_marked(std::size_t edge, const std::vector<bool>& marks) const {
  return std::ranges::any_of(runs_.of(edge), [&](const EdgeRun& run) { return marks[run.patch]; });
}

LoopPoint EdgeCurves::at(const EdgeStretch& stretch, double s) const {
  const Interval& range = stretch.piece->range;
  const double t = stretch.along.to_curve(s), wide = range.to - range.from;
  return at_place(stretch, wide > 0 ? std::clamp((t - range.from) / wide, 0.0, 1.0) : 0);
}

double EdgeCurves::parameter(const EdgeStretch& stretch, double x) const {
  const Interval& range = stretch.piece->range;
  return stretch.along.to_edge((1 - x) * range.from + x * range.to);
}

bool is_same(const PatchEdges::Edge& edge, double a, double b) {
  constexpr double share = 1e-6;
  return std::abs(a - b) <= share * (edge.range.to - edge.range.from);
}

LoopPoint EdgeCurves::at(const EdgeCurve& curve, double s) const {
  const auto next = std::ranges::lower_bound(curve, s, {}, &EdgeStretch::high);
  return at(next == curve.end() ? curve.back() : *next, s);
}

// Lines along the seams of periodic surfaces begin elsewhere: the patches on both sides meet there.
std::vector<VertexLine> EdgeCurves::vertex_lines() const {
  std::vector<VertexLine> lines;
  for (const EdgeRun& run : runs_.gaps()) {
    const std::span<const TrimPiece> all = impl_of(edges_->faces[run.face].region).pieces;
    const std::span<const TrimPiece> gap = runs_.pieces(run);
    const auto leads_to_gap = [&](const TrimPiece& piece) {
      return piece.end() == gap.front().start() && runs_.curve(run.face, piece).coedge != nullptr;
    };
    auto before = all.begin() + std::max<std::ptrdiff_t>(run.first, 1) - 1;
    if (!leads_to_gap(*before)) before = std::ranges::find_if(all, leads_to_gap);
    if (before == all.end()) continue;
    const CurveAlongEdge along = runs_.curve(run.face, *before);
    const PatchEdges::Edge& edge = edges_->edges[edges_->faces[run.face].first_edge + along.coedge->edge];
    const std::uint32_t vertex = along.coedge->reversed ? edge.start : edge.end;
    const double end = along.coedge->reversed ? edge.range.from : edge.range.to;
    if (vertex == no_id || !is_same(edge, along.to_edge(before->range.to), end)) continue;
    for (const TrimPiece& piece : gap) lines.push_back({vertex, run.patch, &piece});
  }
  return lines;
}

}  // namespace tessera::inline abi_0_1
