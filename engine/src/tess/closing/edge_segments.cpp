#include "tess/closing/edge_segments.h"

#include <algorithm>
#include <bit>
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
bool is_convex(std::span<const TrimPiece> pieces, const CurveAlongEdge& curve, const EdgeSegment& segment) {
  const auto [from, to] = std::minmax({curve.to_curve(segment.from), curve.to_curve(segment.to)});
  const auto piece = std::ranges::partition_point(pieces.first(pieces.size() - 1),
                                                  [&](const TrimPiece& of) { return of.range.to <= (from + to) / 2; });
  const double same = least_same_share * (piece->range.to - piece->range.from);
  return from >= piece->range.from - same && to <= piece->range.to + same && is_convex(*piece);
}

}  // namespace

EdgeSegments::EdgeSegments(const PatchSet::Impl& set, const EdgeRuns& runs, std::span<const Division> divisions,
                           std::span<const CutPatch> cuts, const EdgeStations* stations)
    : set_(set), runs_(runs), divisions_(divisions), cuts_(cuts), stations_(stations) {}

void EdgeSegments::append(std::size_t edge, std::vector<EdgeSegment>& segments) {
  const std::span<const EdgeRun> runs = runs_.of(edge);
  for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
    const std::size_t first = segments.size();
    for (; end < runs.size() && runs[end].use == runs[begin].use; ++end) append(runs[end], segments);
    const std::span<EdgeSegment> of_use = std::span(segments).subspan(first);
    std::ranges::sort(of_use, [](const EdgeSegment& a, const EdgeSegment& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
  }
}

void EdgeSegments::append_gaps(std::vector<EdgeSegment>& segments) {
  for (const EdgeRun& run : runs_.gaps()) append(run, segments);
}

void EdgeSegments::append(EdgeSegment segment, const CurveAlongEdge& curve, double from, double to,
                          std::vector<EdgeSegment>& segments) {
  if (curve.coedge) segment.from = curve.to_edge(from), segment.to = curve.to_edge(to);
  if (segment.from > segment.to) std::swap(segment.from, segment.to), std::swap(segment.low, segment.high);
  segments.push_back(segment);
}

void EdgeSegments::append_chords(const EdgeRun& run, std::vector<EdgeSegment>& segments) {
  const CutPatch* const cut = cut_of(run.patch);
  if (!cut) return;
  const CurveAlongEdge curve = runs_.curve(run);
  const bool has_neighbours = runs_.edges().faces[run.face].patches.size() > 1;
  std::uint32_t before = no_id;  // the vertex where the last chord ends
  auto chord = std::ranges::lower_bound(cut->loop_segments, run.first, {}, &CutPatch::LoopSegment::piece);
  for (; chord != cut->loop_segments.end() && chord->piece < run.end; ++chord) {
    if (has_neighbours && chord->start != before) join_across(run, *cut, chord->start);
    if (has_neighbours) join_across(run, *cut, chord->end);
    before = chord->end;
    append({.run = &run,
            .low = {run.patch, chord->start},
            .high = {run.patch, chord->end},
            .start = chord->start,
            .end = chord->end,
            .has_triangle = chord->has_triangle},
           curve, chord->from, chord->to, segments);
  }
}

void EdgeSegments::append_side(const EdgeRun& run, std::vector<EdgeSegment>& segments) {
  const CutPatch* const cut = cut_of(run.patch);
  const SideVertices side = vertices_of(run.patch, run.side);
  if (side.empty()) return;
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const CurveAlongEdge curve = runs_.curve(run);
  join_corner(runs_.edges().faces[run.face], pieces.front().start());
  join_corner(runs_.edges().faces[run.face], pieces.back().end());
  const bool is_point =
      cut ? cut->poles[static_cast<std::size_t>(run.side)] != no_id : divisions_[run.patch].collapsed.has(run.side);
  if (is_point) {
    const PatchVertex point{run.patch, side[0].vertex};
    for (std::size_t k = 0; k < side.size(); ++k) same_.push_back({point, PatchVertex{run.patch, side[k].vertex}});
    append({.run = &run, .low = point, .high = point, .start = point.vertex, .end = point.vertex}, curve,
           pieces.front().range.from, pieces.back().range.to, segments);
    return;
  }
  const auto [from, to] = ends_along(run.side, pieces);
  std::optional<double> before;  // the parameter where the last segment ends
  std::span<const double> inside;
  if (stations_ && run.edge != no_id) inside = stations_->at_vertices(run);
  std::size_t k = std::max<std::size_t>(side.count_up_to(from), 1);
  for (Place end = side[k - 1]; k < side.size() && end.along < to; ++k) {
    const Place start = std::exchange(end, side[k]);
    const double low = std::max(start.along, from), high = std::min(end.along, to);
    if (!(low < high)) continue;
    if (!before) before = parameter_at(pieces, run.side, low);
    const bool is_known = end.along < to && !inside.empty();
    const double next = is_known ? inside.front() : parameter_at(pieces, run.side, high);
    if (is_known) inside = inside.subspan(1);
    append({.run = &run,
            .low = vertex_at(run.patch, run.side, start, end, low),
            .high = vertex_at(run.patch, run.side, start, end, high),
            .start = start.vertex,
            .end = end.vertex},
           curve, *before, next, segments);
    before = next;
  }
}

SideVertices EdgeSegments::vertices_of(std::uint32_t patch, Side side) const {
  if (const CutPatch* const cut = cut_of(patch)) return {*cut, side};
  return {divisions_[patch], set_.sources[patch].domain, side};
}

PatchVertex EdgeSegments::vertex_at(std::uint32_t patch, Side side, const Place& a, const Place& b, double along) {
  if (along == a.along) return {patch, a.vertex};
  if (along == b.along) return {patch, b.vertex};
  const std::uint64_t key =
      std::bit_cast<std::uint64_t>(along) * 0x9E3779B97F4A7C15u + 4 * patch + static_cast<std::uint64_t>(side);
  const auto [first, last] = on_sides_.equal_range(key);
  for (auto known = first; known != last; ++known) {
    const InsertedVertex& vertex = inserted_[known->second];
    if (vertex.patch == patch && vertex.start == a.vertex && vertex.end == b.vertex && vertex.at == along)
      return {patch, PatchVertex::inserted | known->second};
  }
  on_sides_.emplace(key, static_cast<std::uint32_t>(inserted_.size()));
  return insert_on_side(patch, side, a.vertex, b.vertex, along);
}

PatchVertex EdgeSegments::insert_on_side(std::uint32_t patch, Side side, std::uint32_t start, std::uint32_t end,
                                         double along) {
  const Domain domain = set_.sources[patch].domain;
  const double place = runs_along_u(side) ? domain.local_u(along) : domain.local_v(along);
  const ParameterPoint local = point_beside(side, place, is_far(side));
  inserted_.push_back({patch, start, end, along, local});
  return {patch, PatchVertex::inserted | static_cast<std::uint32_t>(inserted_.size() - 1)};
}

PatchVertex EdgeSegments::insert(const EdgeSegment& segment, double s) {
  const EdgeRun& run = *segment.run;
  const std::span<const TrimPiece> pieces = runs_.pieces(run);
  const double t = runs_.curve(run).to_curve(s);
  const ParameterPoint at = point_at(pieces, t);
  if (run.is_side) return insert_on_side(run.patch, run.side, segment.start, segment.end, along_side(run.side, at));
  const Domain domain = set_.sources[run.patch].domain;
  inserted_.push_back({run.patch,
                       segment.start,
                       segment.end,
                       t,
                       {std::clamp(domain.local_u(at.u), 0.0, 1.0), std::clamp(domain.local_v(at.v), 0.0, 1.0)},
                       !is_convex(pieces, runs_.curve(run), segment)});
  return {run.patch, PatchVertex::inserted | static_cast<std::uint32_t>(inserted_.size() - 1)};
}

std::optional<std::uint32_t> EdgeSegments::corner_vertex(std::uint32_t patch, bool end_u, bool end_v) const {
  if (const CutPatch* const cut = cut_of(patch)) {
    const Domain domain = set_.sources[patch].domain;
    for (const CutPatch::SideVertex& vertex : cut->side_vertices)
      if (vertex.side == (end_v ? Side::v1 : Side::v0) && vertex.along == (end_u ? domain.u1 : domain.u0))
        return vertex.vertex;
    return {};
  }
  if (divisions_[patch].empty) return {};
  const SideVertices side = vertices_of(patch, end_v ? Side::v1 : Side::v0);
  return side[end_u ? side.size() - 1 : 0].vertex;
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
  if (face.patches.size() == 1) return;
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
