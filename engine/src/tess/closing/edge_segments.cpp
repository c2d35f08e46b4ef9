#include "tess/closing/edge_segments.h"

#include <algorithm>
#include <utility>

#include "base/impl_access.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

namespace {

/// Whether the control points of a piece turn to one side alone. So does the curve, as weights are positive; the piece
/// is monotone, so it turns by at most a right angle.
bool is_convex(const TrimPiece& piece) {
  double least = 0, most = 0, before_u = 0, before_v = 0;
  const auto& at = piece.curve.points;
  for (std::size_t k = 1; k < at.size(); ++k) {
    const double u = at[k].u - at[k - 1].u, v = at[k].v - at[k - 1].v;
    if (u == 0 && v == 0) continue;  // a point that is there twice
    const double turn = before_u * v - before_v * u;
    least = std::min(least, turn), most = std::max(most, turn);
    before_u = u, before_v = v;
  }
  return least == 0 || most == 0;
}

/// Whether a chord's curve is convex. Then chords between points of the curve lie between the chord and the curve, and
/// their slivers within its own. Points that are moved towards the chord meet these chords first; those moved the other
/// way meet the curve where they did before.
bool is_convex(std::span<const TrimPiece> pieces, const CurveAlongEdge& curve, const Interval& of_edge) {
  const auto [from, to] = std::minmax({curve.to_curve(of_edge.from), curve.to_curve(of_edge.to)});
  const auto piece = std::ranges::partition_point(pieces.first(pieces.size() - 1),
                                                  [&](const TrimPiece& of) { return of.range.to <= (from + to) / 2; });
  const double same = least_same_share * (piece->range.to - piece->range.from);
  return from >= piece->range.from - same && to <= piece->range.to + same && is_convex(*piece);
}

}  // namespace

EdgeSegments::EdgeSegments(const PatchSet::Impl& set, const EdgeRuns& runs, std::span<const Division> divisions,
                           std::span<const CutPatch> cuts, const EdgeStations* stations)
    : set_(set), runs_(runs), divisions_(divisions), cuts_(cuts), stations_(stations) {}

void EdgeSegments::append(std::size_t edge, SegmentList& to) {
  const std::span<const EdgeRun> runs = runs_.of(edge);
  const auto range = [&](const EdgeSegment& of) { return std::pair(to.low(of).s, to.high(of).s); };
  for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
    const std::size_t first = to.segments.size();
    while (end < runs.size() && runs[end].use == runs[begin].use) ++end;
    const bool reversed = end - begin > 1 && runs_.curve(runs[begin]).coedge->reversed;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first_of_run = to.segments.size();
      append(runs[reversed ? begin + end - 1 - k : k], to);
      const std::span<EdgeSegment> of_run = std::span(to.segments).subspan(first_of_run);
      if (of_run.size() > 1 && range(of_run.back()) < range(of_run.front())) std::ranges::reverse(of_run);
    }
    const std::span<EdgeSegment> of_use = std::span(to.segments).subspan(first);
    if (!std::ranges::is_sorted(of_use, {}, range)) std::ranges::stable_sort(of_use, {}, range);
  }
}

void EdgeSegments::append_gaps(SegmentList& to) {
  for (const EdgeRun& run : runs_.gaps()) append(run, to);
}

void EdgeSegments::append_chords(const EdgeRun& run, SegmentList& to) {
  const CutPatch* const cut = cut_of(run.patch);
  if (!cut) return;
  const CurveAlongEdge curve = runs_.curve(run);
  const bool has_neighbours = runs_.edges().faces[run.face].patches.size() > 1;
  std::uint32_t before = no_id, end = 0;  // the vertex where the last chord ends, and its place in the list
  double at = 0;                          // the curve's parameter there
  const auto put_end = [&](std::uint32_t vertex, double t) {
    if (has_neighbours && vertex != before) join_across(run, *cut, vertex);
    if (vertex != before || t != at) end = put(curve.coedge ? curve.to_edge(t) : 0, {run.patch, vertex}, to);
    before = vertex, at = t;
    return end;
  };
  auto chord = std::ranges::lower_bound(cut->loop_segments, run.first, {}, &CutPatch::LoopSegment::piece);
  for (; chord != cut->loop_segments.end() && chord->piece < run.end; ++chord) {
    const std::uint32_t first = put_end(chord->start, chord->from), last = put_end(chord->end, chord->to);
    append({.run = &run, .start = chord->start, .end = chord->end, .has_triangle = chord->has_triangle}, {first, last},
           to);
  }
}

void EdgeSegments::append_point(const EdgeRun& run, const SideVertices& side, SegmentList& to) {
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const CurveAlongEdge curve = runs_.curve(run);
  const Place at = side[0];
  const PatchVertex point{run.patch, at.vertex};
  for (std::size_t k = 0; k < side.size(); ++k) same_.push_back({point, PatchVertex{run.patch, side[k].vertex}});
  const auto put_end = [&](double t) { return put(curve.coedge ? curve.to_edge(t) : 0, point, to); };
  const std::uint32_t first = put_end(pieces.front().range.from), last = put_end(pieces.back().range.to);
  append({.run = &run, .start = at.vertex, .end = at.vertex}, {first, last}, to);
}

void EdgeSegments::append_border(const EdgeRun& run, const SideVertices& side, std::span<const double> inside,
                                 SegmentList& to) {
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const CurveAlongEdge curve = runs_.curve(run);
  const bool is_known = inside.size() + 2 == side.size();
  std::array<std::uint32_t, 2> ends{};
  Place before{};
  for (std::size_t k = 0; k < side.size(); ++k) {
    const Place at = side[k];
    const Place start = std::exchange(before, at);
    if (k > 0 && !(start.along < at.along)) continue;
    const bool is_inside = k > 0 && k + 1 < side.size();
    const double t = is_known && is_inside ? inside[k - 1] : parameter_at(pieces, run.side, at.along);
    ends[1] = put(curve.coedge ? curve.to_edge(t) : 0, {run.patch, at.vertex}, to);
    if (k > 0) append({.run = &run, .start = start.vertex, .end = at.vertex}, ends, to);
    ends[0] = ends[1];
  }
}

void EdgeSegments::append_side(const EdgeRun& run, SegmentList& to) {
  const CutPatch* const cut = cut_of(run.patch);
  const SideVertices side = vertices_of(run.patch, run.side);
  if (side.empty()) return;
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const CurveAlongEdge curve = runs_.curve(run);
  join_corner(runs_.edges().faces[run.face], pieces.front().start());
  join_corner(runs_.edges().faces[run.face], pieces.back().end());
  const bool is_point =
      cut ? cut->poles[static_cast<std::size_t>(run.side)] != no_id : divisions_[run.patch].collapsed.has(run.side);
  if (is_point) return append_point(run, side, to);
  const auto [from, to_place] = ends_along(run.side, pieces);
  std::span<const double> inside;
  if (stations_ && run.edge != no_id) inside = stations_->at_vertices(run);
  const auto put_end = [&](const Place& a, const Place& b, double along, double t) {
    const double s = curve.coedge ? curve.to_edge(t) : 0;
    const PatchVertex vertex = along == a.along   ? PatchVertex{run.patch, a.vertex}
                               : along == b.along ? PatchVertex{run.patch, b.vertex}
                                                  : vertex_between(run.patch, run.side, a, b, along);
    return put(s, vertex, to);
  };
  if (!cut && side[0].along == from && side[side.size() - 1].along == to_place) {
    append_border(run, side, inside, to);
    return;
  }
  std::optional<std::uint32_t> before;  // where the last segment ends
  const std::size_t before_run = side[0].along == from ? 1 : side.count_up_to(from);
  std::size_t k = std::max<std::size_t>(before_run, 1);
  for (Place end = side[k - 1]; k < side.size() && end.along < to_place; ++k) {
    const Place start = std::exchange(end, side[k]);
    const double low = std::max(start.along, from), high = std::min(end.along, to_place);
    if (!(low < high)) continue;
    if (!before) before = put_end(start, end, low, parameter_at(pieces, run.side, low));
    const bool is_known = end.along < to_place && !inside.empty();
    const double next = is_known ? inside.front() : parameter_at(pieces, run.side, high);
    if (is_known) inside = inside.subspan(1);
    const std::uint32_t last = put_end(start, end, high, next);
    append({.run = &run, .start = start.vertex, .end = end.vertex}, {*before, last}, to);
    before = last;
  }
}

SideVertices EdgeSegments::vertices_of(std::uint32_t patch, Side side) const {
  if (const CutPatch* const cut = cut_of(patch)) return {*cut, side};
  return {divisions_[patch], set_.sources[patch].domain, side};
}

PatchVertex EdgeSegments::vertex_between(std::uint32_t patch, Side side, const Place& a, const Place& b, double along) {
  const std::tuple place(patch, a.vertex, b.vertex, along);
  std::vector<std::uint32_t>& on_sides = inserted_.on_sides;
  const auto place_of = [&](std::uint32_t k) { return inserted_.all[k].place(); };
  const auto known = std::ranges::lower_bound(on_sides, place, {}, place_of);
  if (known != on_sides.end() && place_of(*known) == place) return {patch, PatchVertex::inserted | *known};
  on_sides.insert(known, static_cast<std::uint32_t>(inserted_.all.size()));
  return insert_on_side(patch, side, a.vertex, b.vertex, along);
}

PatchVertex EdgeSegments::insert_on_side(std::uint32_t patch, Side side, std::uint32_t start, std::uint32_t end,
                                         double along) {
  const Domain domain = set_.sources[patch].domain;
  const double place = runs_along_u(side) ? domain.local_u(along) : domain.local_v(along);
  const ParameterPoint local = point_beside(side, place, is_far(side));
  inserted_.all.push_back({patch, start, end, along, local});
  return {patch, PatchVertex::inserted | static_cast<std::uint32_t>(inserted_.all.size() - 1)};
}

SegmentEnd EdgeSegments::insert(const EdgeSegment& segment, const Interval& range, double s) {
  const EdgeRun& run = *segment.run;
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const CurveAlongEdge curve = runs_.curve(run);
  const double t = curve.to_curve(s);
  const ParameterPoint at = point_at(pieces, t);
  SegmentEnd end{.s = s};
  if (run.is_side) {
    end.vertex = insert_on_side(run.patch, run.side, segment.start, segment.end, along_side(run.side, at));
  } else {
    const Domain domain = set_.sources[run.patch].domain;
    end.vertex = {run.patch, PatchVertex::inserted | static_cast<std::uint32_t>(inserted_.all.size())};
    inserted_.all.push_back({run.patch,
                             segment.start,
                             segment.end,
                             t,
                             {std::clamp(domain.local_u(at.u), 0.0, 1.0), std::clamp(domain.local_v(at.v), 0.0, 1.0)},
                             !is_convex(pieces, curve, range)});
  }
  return end;
}

std::optional<std::uint32_t> EdgeSegments::corner_vertex(std::uint32_t patch, bool end_u, bool end_v) const {
  if (const CutPatch* const cut = cut_of(patch)) {
    const Domain domain = set_.sources[patch].domain;
    for (const CutPatch::SideVertex& vertex : cut->side_vertices)
      if (vertex.side == (end_v ? Side::v1 : Side::v0) && vertex.along == (end_u ? domain.u1 : domain.u0))
        return vertex.vertex;
    return {};
  }
  const Division& division = divisions_[patch];
  if (division.empty) return {};
  int on_ring = 0;
  for (std::size_t side = 0; side < (end_v ? (end_u ? 2u : 3u) : (end_u ? 1u : 0u)); ++side)
    on_ring += division.border[side].rate();
  return static_cast<std::uint32_t>(division.inner_count()) + static_cast<std::uint32_t>(on_ring);
}

// A neighbour often has the vertex in a run of its own, but not where the loop leaves the patch along a line that
// closes a gap, or where rounding puts a chord's end on a side.
void EdgeSegments::join_across(const EdgeRun& run, const CutPatch& cut, std::uint32_t vertex) {
  const ParameterPoint& local = cut.vertices[vertex];
  const bool on_u = local.u == 0 || local.u == 1, on_v = local.v == 0 || local.v == 1;
  const PatchEdges::Face& face = runs_.edges().faces[run.face];
  if (!on_u && !on_v) return;
  const Domain& domain = set_.sources[run.patch].domain;
  if (on_u && on_v)
    return join_corner(face, {local.u == 0 ? domain.u0 : domain.u1, local.v == 0 ? domain.v0 : domain.v1});
  const bool before = (on_u ? local.u : local.v) == 0;
  const Side side = on_u ? (before ? Side::u0 : Side::u1) : (before ? Side::v0 : Side::v1);
  const TrimRegion::Impl& region = impl_of(face.region);
  std::size_t a = interval_of(region.lines.u.lines, domain.u0), b = interval_of(region.lines.v.lines, domain.v0);
  if (before && (on_u ? a : b) == 0) return;
  if (on_u)
    before ? --a : ++a;
  else
    before ? --b : ++b;
  if (a + 1 == region.lines.u.lines.size() || b == region.count_v()) return;
  const std::uint32_t other = face.patches[a * region.count_v() + b];
  const auto own = std::ranges::find_if(
      cut.side_vertices, [&](const CutPatch::SideVertex& of) { return of.side == side && of.vertex == vertex; });
  if (other == no_id || own == cut.side_vertices.end()) return;
  const SideVertices places = vertices_of(other, opposite(side));
  const std::size_t place = places.count_before(own->along);
  if (place < places.size() && places[place].along == own->along)
    same_.push_back({PatchVertex{run.patch, vertex}, PatchVertex{other, places[place].vertex}});
}

void EdgeSegments::join_corner(const PatchEdges::Face& face, const ParameterPoint& at) {
  if (face.patches.size() == 1 || (last_face_ == &face && last_corner_ == at)) return;
  last_face_ = &face, last_corner_ = at;
  const TrimRegion::Impl& region = impl_of(face.region);
  const std::vector<double>&u = region.lines.u.lines, &v = region.lines.v.lines;
  const auto i = std::ranges::lower_bound(u, at.u) - u.begin(), j = std::ranges::lower_bound(v, at.v) - v.begin();
  if (i == std::ssize(u) || u[static_cast<std::size_t>(i)] != at.u || j == std::ssize(v) ||
      v[static_cast<std::size_t>(j)] != at.v)
    return;
  std::optional<PatchVertex> first;
  for (const bool end_u : {true, false}) {
    for (const bool end_v : {true, false}) {
      const std::ptrdiff_t a = i - end_u, b = j - end_v;
      if (a < 0 || b < 0 || a + 1 >= std::ssize(u) || b + 1 >= std::ssize(v)) continue;
      const std::uint32_t patch =
          face.patches[static_cast<std::size_t>(a) * region.count_v() + static_cast<std::size_t>(b)];
      const std::optional<std::uint32_t> vertex = patch == no_id ? std::nullopt : corner_vertex(patch, end_u, end_v);
      if (!vertex) continue;
      if (first)
        same_.push_back({*first, PatchVertex{patch, *vertex}});
      else
        first = PatchVertex{patch, *vertex};
    }
  }
}

}}  // namespace tessera::abi_0_1
