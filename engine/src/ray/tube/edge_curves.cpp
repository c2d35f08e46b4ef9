#include "ray/tube/edge_curves.h"

#include <cmath>
#include <iterator>
#include <limits>

#include "block/patch_trims.h"
#include "ray/line/first_order.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The index into link_sides of a patch's side.
int index_of(Side side) { return static_cast<int>(std::ranges::find(link_sides, side) - link_sides.begin()); }

/// The part of the edge's range that a curve covers.
double extent(const EdgeCurve& curve) {
  double sum = 0;
  for (const EdgeStretch& stretch : curve) sum += stretch.high() - stretch.low();
  return sum;
}

/// Whether a line is a part of the seam of a surface that closes: it joins loops that go around the surface.
bool is_seam(const TrimRegion::Impl& region, const TrimPiece& piece) {
  const auto runs_along = [](const CutAxis& axis, double a, double b) {
    return axis.periodic && a == b && (a == axis.from() || a == axis.to());
  };
  const ParameterPoint &a = piece.start(), &b = piece.end();
  return runs_along(region.lines.u, a.u, b.u) || runs_along(region.lines.v, a.v, b.v);
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

EdgeCurves::EdgeCurves(const SetView& set, const SceneFrame& frame)
    : set_(&set), frame_(frame), runs_(set.impl()), edges_(set.impl().edges.get()) {
  find_bridges();
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
          {&piece, along, run.patch, run.face, along.to_edge(piece.range.from), along.to_edge(piece.range.to)});
  }
  for (EdgeCurve& curve : curves) std::ranges::stable_sort(curve, {}, &EdgeStretch::low);
  std::ranges::stable_sort(curves, std::greater<>(), extent);
  if (!bridges_.empty() && !this->edge(edge).degenerate) close_gaps(this->edge(edge), curves);
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
  if (stretch.is_line()) {
    const double along = stretch.to - stretch.from;
    return at_place(stretch, stretch.place(along != 0 ? std::clamp((s - stretch.from) / along, 0.0, 1.0) : 0));
  }
  const Interval& range = stretch.piece->range;
  const double t = stretch.along.to_curve(s), wide = range.to - range.from;
  return at_place(stretch, wide > 0 ? std::clamp((t - range.from) / wide, 0.0, 1.0) : 0);
}

double EdgeCurves::parameter(const EdgeStretch& stretch, double x) const {
  if (stretch.is_line()) {
    const double wide = stretch.end - stretch.begin, share = wide != 0 ? (x - stretch.begin) / wide : 0;
    return (1 - share) * stretch.from + share * stretch.to;
  }
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

const EdgeStretch* EdgeCurves::stretch_at(const EdgeCurve& curve, const PatchEdges::Edge& edge, double s) {
  const auto next = std::ranges::lower_bound(curve, s, {}, &EdgeStretch::high);
  if (next != curve.end() && next->low() <= s) return &*next;
  if (next != curve.end() && is_same(edge, next->low(), s)) return &*next;
  return next != curve.begin() && is_same(edge, std::prev(next)->high(), s) ? &*std::prev(next) : nullptr;
}

/// Joins lines that meet where no edge begins or ends. Lines may run against their loop.
void EdgeCurves::find_bridges() {
  const auto is_free = [&](std::uint32_t face, const ParameterPoint& point) { return touching(face, point).empty(); };
  for (const EdgeRun& run : runs_.gaps())
    for (const TrimPiece& piece : runs_.pieces(run)) {
      if (is_seam(impl_of(edges_->faces[run.face].region), piece)) continue;
      EdgeStretch line{.piece = &piece, .along = {}, .patch = run.patch, .face = run.face};
      if (bridges_.empty() || bridges_.back().front().face != run.face) {
        bridges_.push_back({line});
        continue;
      }
      Bridge& last = bridges_.back();
      const auto meets = [&](const ParameterPoint& point) {
        return (point == piece.start() || point == piece.end()) && is_free(run.face, point);
      };
      if (last.size() == 1 && meets(last.front().first_point())) last = turned(last);
      const ParameterPoint at = last.back().last_point();
      if (!meets(at)) {
        bridges_.push_back({line});
        continue;
      }
      if (piece.start() != at) std::swap(line.begin, line.end);
      last.push_back(line);
    }
}

EdgeCurves::Bridge EdgeCurves::turned(Bridge bridge) {
  std::ranges::reverse(bridge);
  for (EdgeStretch& line : bridge) std::swap(line.begin, line.end), std::swap(line.from, line.to);
  return bridge;
}

/// Returns the pieces along edges that start or end at a point.
std::vector<const TrimPiece*> EdgeCurves::touching(std::uint32_t face, const ParameterPoint& point) const {
  std::vector<const TrimPiece*> found;
  for (const TrimPiece& piece : impl_of(edges_->faces[face].region).pieces)
    if ((piece.start() == point || piece.end() == point) && runs_.curve(face, piece).coedge != nullptr)
      found.push_back(&piece);
  return found;
}

/// Returns the lines of a face from one point to another, or to wherever they lead; none if there are none.
EdgeCurves::Bridge EdgeCurves::bridge(std::uint32_t face, const ParameterPoint& from, const ParameterPoint* to) const {
  const auto face_of = [](const Bridge& bridge) { return bridge.front().face; };
  for (const Bridge& of : std::ranges::equal_range(bridges_, face, {}, face_of)) {
    const ParameterPoint first = of.front().first_point(), last = of.back().last_point();
    if (first == from && (to == nullptr || last == *to)) return of;
    if (last == from && (to == nullptr || first == *to)) return turned(of);
  }
  return {};
}

/// Adds the lines that close gaps of the curves: between two stretches of one curve, and from its ends to vertices.
void EdgeCurves::close_gaps(const PatchEdges::Edge& edge, std::span<EdgeCurve> curves) const {
  const std::optional<Vec3> start = end_of(edge, curves, edge.range.from), end = end_of(edge, curves, edge.range.to);
  for (EdgeCurve& curve : curves) {
    const EdgeCurve given = curve;
    const EdgeStretch &first = given.front(), &last = given.back();
    for (std::size_t k = 1; k < given.size(); ++k) {
      const ParameterPoint to = given[k].low_point();
      if (given[k].low() > given[k - 1].high() && !is_same(edge, given[k].low(), given[k - 1].high()))
        add_bridge(bridge(first.face, given[k - 1].high_point(), &to), given[k - 1].high(), given[k].low(), curve);
    }
    if (start && !is_same(edge, first.low(), edge.range.from))
      add_bridge(up_to(bridge(first.face, first.low_point(), nullptr), *start), first.low(), edge.range.from, curve);
    if (end && !is_same(edge, last.high(), edge.range.to))
      add_bridge(up_to(bridge(first.face, last.high_point(), nullptr), *end), last.high(), edge.range.to, curve);
    std::ranges::stable_sort(curve, {}, &EdgeStretch::low);
  }
}

/// Adds lines with parameters of the edge by their lengths.
void EdgeCurves::add_bridge(Bridge bridge, double from, double to, EdgeCurve& curve) const {
  std::vector<double> lengths;
  double whole = 0, sum = 0;
  for (const EdgeStretch& line : bridge) {
    lengths.push_back(length(at_place(line, line.end).position - at_place(line, line.begin).position));
    whole += lengths.back();
  }
  for (std::size_t k = 0; k < bridge.size(); ++k) {
    const auto parameter = [&](double at) { return whole > 0 ? from + (to - from) * (at / whole) : from; };
    bridge[k].from = k == 0 ? from : bridge[k - 1].to;
    sum += lengths[k];
    bridge[k].to = k + 1 == bridge.size() ? to : parameter(sum);
    curve.push_back(bridge[k]);
  }
}

/// Returns the lines from their start up to their point nearest to a vertex.
EdgeCurves::Bridge EdgeCurves::up_to(Bridge bridge, const Vec3& vertex) const {
  constexpr int samples = 32;
  std::size_t nearest = 0;
  double share = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < bridge.size(); ++k)
    for (int n = 0; n <= samples; ++n) {
      const double at = static_cast<double>(n) / samples;
      const double off = length(at_place(bridge[k], bridge[k].place(at)).position - vertex);
      if (off < least) least = off, nearest = k, share = at;
    }
  if (bridge.empty()) return bridge;
  bridge.resize(nearest + 1);
  bridge.back().end = bridge.back().place(share);
  return bridge;
}

/// Returns the place where the longest of the curves that reach an end of the edge has it.
std::optional<Vec3> EdgeCurves::end_of(const PatchEdges::Edge& edge, std::span<const EdgeCurve> curves,
                                       double s) const {
  for (const EdgeCurve& curve : curves)
    if (is_same(edge, curve.front().low(), s) || is_same(edge, curve.back().high(), s)) return at(curve, s).position;
  return {};
}

// Lines along the seams of periodic surfaces begin elsewhere: the patches on both sides meet there. Lines from or to
// other places than vertices are stretches of curves.
std::vector<VertexLine> EdgeCurves::vertex_lines() const {
  std::vector<VertexLine> lines;
  for (const Bridge& bridge : bridges_) {
    const std::uint32_t face = bridge.front().face;
    std::uint32_t vertex = no_id;
    bool is_stretch = false;
    for (const ParameterPoint& point : {bridge.front().first_point(), bridge.back().last_point()}) {
      const std::vector<const TrimPiece*> pieces = touching(face, point);
      std::uint32_t here = no_id;
      for (const TrimPiece* piece : pieces)
        if (here == no_id) here = vertex_at(face, *piece, piece->end() == point);
      if (vertex == no_id) vertex = here;
      is_stretch |= here == no_id && !pieces.empty();
    }
    if (vertex == no_id || is_stretch) continue;
    for (const EdgeStretch& line : bridge) lines.push_back({vertex, line.patch, line.piece});
  }
  return lines;
}

std::uint32_t EdgeCurves::vertex_at(std::uint32_t face, const TrimPiece& piece, bool at_end) const {
  const CurveAlongEdge along = runs_.curve(face, piece);
  const PatchEdges::Edge& edge = edges_->edges[edges_->faces[face].first_edge + along.coedge->edge];
  const bool is_last = along.coedge->reversed != at_end;
  const double s = along.to_edge(at_end ? piece.range.to : piece.range.from);
  return is_same(edge, s, is_last ? edge.range.to : edge.range.from) ? (is_last ? edge.end : edge.start) : no_id;
}

}}  // namespace tessera::abi_0_1
