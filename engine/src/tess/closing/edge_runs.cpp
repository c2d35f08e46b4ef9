#include "tess/closing/edge_runs.h"

#include <cmath>
#include <new>
#include <numeric>

#include "base/impl_access.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"
#include "tess/trimmed/cut_patch.h"
#include "tess/trimmed/patch_sides.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns where a piece has a place along a side, from 0 to 1.
///
/// The piece is monotone, so the Bernstein polynomial of w_i (x_i - place) has one root. It is found by Newton's
/// method, by halves where that would leave the root's interval.
double place_on(const TrimPiece& piece, Side side, double place) {
  const auto last = static_cast<std::size_t>(piece.curve.degree());
  if (last == 1) {
    const double first = piece.curve.weight(0) * (along_side(side, piece.start()) - place),
                 second = piece.curve.weight(1) * (along_side(side, piece.end()) - place);
    return first == 0 ? 0 : second == 0 ? 1 : std::clamp(first / (first - second), 0.0, 1.0);
  }
  std::array<double, max_degree + 1> c, of;
  for (std::size_t k = 0; k <= last; ++k)
    c[k] = piece.curve.weight(k) * (along_side(side, piece.curve.points[k]) - place);
  if (c[0] == 0 || c[last] == 0) return c[0] == 0 ? 0 : 1;
  double low = 0, high = 1, x = std::clamp(c[0] / (c[0] - c[last]), 0.0, 1.0);
  for (int step = 0; step < 60; ++step) {
    const double* from = c.data();
    for (std::size_t n = last; n > 1; --n, from = of.data())
      for (std::size_t k = 0; k < n; ++k) of[k] = (1 - x) * from[k] + x * from[k + 1];
    const double at = (1 - x) * of[0] + x * of[1], slope = static_cast<double>(last) * (of[1] - of[0]);
    if (at == 0) return x;
    ((at < 0) == (c[0] < 0) ? low : high) = x;
    double next = x - at / slope;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (std::abs(next - x) <= 0x1p-52) return next;
    x = next;
  }
  return x;
}

/// The side, of a patch above it, of the line between patches along which a piece runs; none if it runs along none.
std::optional<Side> line_of(const TrimPiece& piece, const CutLines& lines) {
  const ParameterPoint &start = piece.start(), &end = piece.end();
  if (start.v == end.v && lines.v.is_line(start.v)) return Side::v0;
  return start.u == end.u && lines.u.is_line(start.u) ? std::optional(Side::u0) : std::nullopt;
}

/// Whether a piece goes on within the patch, and along the side, of the piece before it.
bool goes_on(const TrimPiece& before, const TrimPiece& next, std::optional<Side> line, const CutLines& lines) {
  if (before.loop != next.loop || before.curve_index != next.curve_index || !(before.end() == next.start()))
    return false;
  if (line_of(next, lines) != line) return false;
  const ParameterPoint& at = next.start();
  if (!line) return !lines.u.is_line(at.u) && !lines.v.is_line(at.v);
  const double place = along_side(*line, at);
  if (along_side(*line, lines).is_line(place)) return false;
  return (along_side(*line, before.start()) < place) == (place < along_side(*line, next.end()));
}

/// A whole border of a patch along an edge.
struct WholeBorder {
  const EdgeRun* run;
  double from, to;       ///< the surface's parameters at its ends
  double low, high;      ///< the edge's parameters there, growing
  std::uint32_t border;  ///< 4 * patch + side
};

/// Returns the border along which a run goes; nothing if it goes along a part of one, or through a patch.
std::optional<WholeBorder> whole_border(const EdgeRuns& runs, const EdgeRun& run, const PatchSet::Impl& set) {
  if (!run.is_side) return {};
  const std::span<const TrimPiece> pieces = runs.pieces(run);
  const auto [begin, end] = range_along(run.side, set.sources[run.patch].domain);
  if (ends_along(run.side, pieces) != std::pair(begin, end)) return {};
  const CurveAlongEdge curve = runs.curve(run);
  const auto [low, high] =
      std::minmax({curve.to_edge(pieces.front().range.from), curve.to_edge(pieces.back().range.to)});
  return WholeBorder{&run, begin, end, low, high, 4 * run.patch + static_cast<std::uint32_t>(run.side)};
}

/// Whether two borders have equal parameters of the edge, within `same`, at their ends and at quarters of them.
bool are_in_step(const EdgeRuns& runs, const WholeBorder& a, const WholeBorder& b, double same) {
  if (std::abs(a.low - b.low) > same || std::abs(a.high - b.high) > same) return false;
  const auto quarter = [&](const WholeBorder& of, int k) {
    const std::span<const TrimPiece> pieces = runs.pieces(*of.run);
    const Side side = of.run->side;
    const bool grows = along_side(side, pieces.front().start()) < along_side(side, pieces.back().end());
    const CurveAlongEdge curve = runs.curve(*of.run);
    const double at = line_at(of.from, of.to, Segments(4), grows == !curve.coedge->reversed ? k : 4 - k);
    return curve.to_edge(parameter_at(pieces, side, at));
  };
  for (int k = 1; k <= 3; ++k)
    if (std::abs(quarter(a, k) - quarter(b, k)) > same) return false;
  return true;
}

}  // namespace

double same_share(const PatchSet::Impl& set, double tolerance) {
  return std::clamp(0.05 * tolerance / set.model_box().diagonal(), least_same_share, largest_same_share);
}

double parameter_at(std::span<const TrimPiece> pieces, Side side, double place) {
  const bool grows = along_side(side, pieces.front().start()) < along_side(side, pieces.back().end());
  const auto piece = std::ranges::partition_point(pieces.first(pieces.size() - 1), [&](const TrimPiece& of) {
    const double end = along_side(side, of.end());
    return grows ? end < place : end > place;
  });
  return piece->range.from + place_on(*piece, side, place) * (piece->range.to - piece->range.from);
}

ParameterPoint point_at(std::span<const TrimPiece> pieces, double t) {
  const auto piece = std::ranges::partition_point(pieces.first(pieces.size() - 1),
                                                  [&](const TrimPiece& of) { return of.range.to < t; });
  const Interval& range = piece->range;
  const double place = std::clamp((t - range.from) / (range.to - range.from), 0.0, 1.0);
  const ParameterPoint offset = relative_point(piece->curve, piece->start(), place);
  return {std::clamp(piece->start().u + offset.u, piece->lower_u(), piece->upper_u()),
          std::clamp(piece->start().v + offset.v, piece->lower_v(), piece->upper_v())};
}

EdgeRuns::EdgeRuns(const PatchSet::Impl& set) : edges_(set.edges.get()) {
  constexpr std::size_t faces_per_task = 8;
  const std::size_t count = edges_->faces.size();
  std::vector<std::uint32_t> uses(count);
  std::uint32_t next_use = 0;
  for (std::size_t face = 0; face < count; ++face) {
    uses[face] = next_use;
    for (const TrimLoop& loop : *edges_->faces[face].loops) next_use += static_cast<std::uint32_t>(loop.coedges.size());
  }
  std::vector<Runs> some((count + faces_per_task - 1) / faces_per_task);
  const auto add_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t face = begin; face < end; ++face)
      add_face(set, static_cast<std::uint32_t>(face), uses[face], some[begin / faces_per_task]);
  };
  if (!parallel_for(count, faces_per_task, {}, add_some).ok()) throw std::bad_alloc();  // the only error
  for (const Runs& of : some) {
    runs_.insert(runs_.end(), of.along_edges.begin(), of.along_edges.end());
    gaps_.insert(gaps_.end(), of.gaps.begin(), of.gaps.end());
  }
  sort();
}

std::span<const TrimPiece> EdgeRuns::pieces(const EdgeRun& run) const {
  return std::span(impl_of(edges_->faces[run.face].region).pieces).subspan(run.first, run.end - run.first);
}

CurveAlongEdge EdgeRuns::curve(std::uint32_t face, const TrimPiece& piece) const {
  if (piece.loop == no_id || piece.curve_index == no_id) return {};
  const TrimLoop& loop = (*edges_->faces[face].loops)[piece.loop];
  if (loop.coedges.empty()) return {};
  return {&loop.coedges[piece.curve_index], &loop.curves[piece.curve_index]};
}

void EdgeRuns::add_face(const PatchSet::Impl& set, std::uint32_t face, std::uint32_t use, Runs& to) const {
  const PatchEdges::Face& of = edges_->faces[face];
  const TrimRegion::Impl& region = impl_of(of.region);
  const std::vector<TrimPiece>& pieces = region.pieces;
  std::vector<std::uint32_t> first_uses;
  std::optional<FaceSides> sides;
  for (const TrimLoop& loop : *of.loops) {
    first_uses.push_back(use);
    use += static_cast<std::uint32_t>(loop.coedges.size());
  }
  for (std::uint32_t piece = 0; piece < pieces.size();) {
    EdgeRun run;
    run.first = piece++;
    const TrimPiece& at = pieces[run.first];
    const Coedge* const coedge = curve(face, at).coedge;
    if (!coedge && at.curve_index != no_id) continue;
    const std::optional<Side> line = line_of(at, region.lines);
    while (piece < pieces.size() && goes_on(pieces[piece - 1], pieces[piece], line, region.lines)) ++piece;
    run.end = piece;
    run.face = face;
    if (coedge) {
      run.edge = of.first_edge + coedge->edge;
      run.use = first_uses[at.loop] + at.curve_index;
    }
    if (line) {
      find_side(run, *line, sides);
    } else {
      const std::size_t a = interval_of(region.lines.u.lines, (at.start().u + at.end().u) / 2);
      run.patch = of.patches[a * region.count_v() + interval_of(region.lines.v.lines, (at.start().v + at.end().v) / 2)];
    }
    const bool is_cut = set.trims && run.patch != no_id && set.trims->is_cut[run.patch];
    if (run.is_side ? run.patch != no_id : is_cut) (coedge ? to.along_edges : to.gaps).push_back(run);
  }
}

// A piece along a line has the face on one side of it. If both patches there are in the set, loops cut at least one.
void EdgeRuns::find_side(EdgeRun& run, Side low, std::optional<FaceSides>& sides) const {
  const PatchEdges::Face& face = edges_->faces[run.face];
  const TrimRegion::Impl& region = impl_of(face.region);
  const TrimPiece& at = region.pieces[run.first];
  const std::vector<double>& across = across_side(low, region.lines).lines;
  const std::vector<double>& along = along_side(low, region.lines).lines;
  const double middle = (along_side(low, at.start()) + along_side(low, region.pieces[run.end - 1].end())) / 2;
  const double value = across_side(low, at.start());
  const auto line = static_cast<std::size_t>(std::ranges::lower_bound(across, value) - across.begin());
  const std::size_t cell = interval_of(along, middle);
  const auto patch_at = [&](std::size_t strip) {
    if (strip + 1 >= across.size()) return no_id;
    return face.patches[runs_along_u(low) ? cell * region.count_v() + strip : strip * region.count_v() + cell];
  };
  const std::uint32_t below = line > 0 ? patch_at(line - 1) : no_id, above = patch_at(line);
  bool is_above = below == no_id;
  if (below != no_id && above != no_id) {
    if (!sides) sides.emplace(face.region);
    for (const SidePoint& point : across_side(low, *sides).points(line, cell, Segments(1)))
      if (point.at <= middle) is_above = point.above;
  }
  run.is_side = true;
  run.patch = is_above ? above : below;
  run.side = is_above ? low : opposite(low);
}

std::vector<std::uint8_t> EdgeRuns::borders_that_meet(std::size_t patches) const {
  std::vector<std::uint8_t> borders(4 * patches, 0);
  for (const EdgeRun& run : runs_)
    if (run.is_side && meet(run.edge)) borders[4 * run.patch + static_cast<std::size_t>(run.side)] = 1;
  return borders;
}

std::vector<std::array<std::uint32_t, 2>> EdgeRuns::borders_in_step(const PatchSet::Impl& set) const {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  std::vector<WholeBorder> borders;
  for (std::uint32_t edge = 0; edge + 1 < first_.size(); ++edge) {
    if (!meet(edge)) continue;
    borders.clear();
    for (const EdgeRun& run : of(edge))
      if (const auto border = whole_border(*this, run, set)) borders.push_back(*border);
    std::ranges::sort(borders, {}, [](const WholeBorder& of) { return std::pair(of.low, of.border); });
    const Interval& range = edges_->edges[edge].range;
    const double same = largest_same_share * (range.to - range.from);
    for (std::size_t k = 1; k < borders.size(); ++k)
      if (are_in_step(*this, borders[k - 1], borders[k], same))
        pairs.push_back({borders[k - 1].border, borders[k].border});
  }
  return pairs;
}

void EdgeRuns::sort() {
  first_.assign(edges_->edges.size() + 1, 0);
  for (const EdgeRun& run : runs_) ++first_[run.edge + 1];
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  std::vector<EdgeRun> sorted(runs_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const EdgeRun& run : runs_) sorted[next[run.edge]++] = run;
  runs_ = std::move(sorted);
  // Pieces along the sides of a periodic surface come after all others of its loops.
  for (std::size_t edge = 0; edge + 1 < first_.size(); ++edge)
    std::ranges::stable_sort(std::span(runs_).subspan(first_[edge], first_[edge + 1] - first_[edge]), {},
                             &EdgeRun::use);
  by_patch_.resize(runs_.size());
  std::iota(by_patch_.begin(), by_patch_.end(), std::uint32_t{0});
  std::ranges::stable_sort(by_patch_, {}, [&](std::uint32_t k) { return runs_[k].patch; });
}

}}  // namespace tessera::abi_0_1
