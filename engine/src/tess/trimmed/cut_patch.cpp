#include "tess/trimmed/cut_patch.h"

#include <cmath>
#include <limits>

#include "base/impl_access.h"
#include "tess/trimmed/band_flipper.h"
#include "tess/trimmed/divided_chords.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The piece of ChordBound::pieces() in which a box of parameters lies.
std::size_t piece_of(double u0, double u1, double v0, double v1) {
  const std::size_t low_u = u1 <= 0.5, high_u = u0 >= 0.5, low_v = v1 <= 0.5, high_v = v0 >= 0.5;
  const bool half_u = low_u || high_u, half_v = low_v || high_v;
  if (half_u && half_v) return 5 + 2 * high_u + high_v;
  if (half_u) return 1 + high_u;
  return half_v ? 3 + high_v : 0;
}

constexpr double parameter_error = 0x1p-24;  // of a box's width: three roundings

/// The largest odd rate whose cells are no smaller than `width`. Bounds of odd rates hold wherever a cell lies.
int rate_of(double width) {
  const int rate = width * max_rate > 1 ? static_cast<int>(1 / width) : max_rate;
  return std::max(1, rate - (rate % 2 == 0));
}

/// The measure of edges that are halved until triangles are no longer large.
///
/// Proof that a large triangle has an edge with a measure of 1/2: with boxes h x k, its distance is at most
///   (h^2 uu + 2 h k uv + k^2 vv) / 8 <= (h^2 (uu + s uv) + k^2 (vv + uv / s)) / 8 = room (h^2 a + k^2 b),
/// for any s > 0; cells are no larger than h^2 a <= 1 and k^2 b <= 1 if triangles must not be wider than these. So the
/// triangle's box has a measure h^2 a + k^2 b above 1. One edge has all of its width, and one has all of its height.
class EdgeMeasure {
 public:
  /// `room`: of the distance, infinite if there is no limit. `width`, `height`: of cells.
  EdgeMeasure(const ChordBound& chord, double room, double width, double height, bool in_cells) {
    if (std::isfinite(room)) {
      SecondDerivatives most;
      for (const SecondDerivatives& piece : chord.pieces())
        most = {std::max(most.uu, piece.uu), std::max(most.uv, piece.uv), std::max(most.vv, piece.vv)};
      const double s = height / width;
      a_ = (most.uu + s * most.uv) / (8 * room), b_ = (most.vv + most.uv / s) / (8 * room);
    }
    if (in_cells) a_ = std::max(a_, 1 / (width * width)), b_ = std::max(b_, 1 / (height * height));
  }
  bool is_finite() const { return std::isfinite(a_ + b_); }
  /// The measure of an edge with this box. It is 0 where a half of the edge would have more than 3/4 of it, as the
  /// boxes of triangles are taken to be wider by the errors of parameters.
  double operator()(const CutPatch::Box& box) const {
    const double width = std::max(box.width(), 0.0), height = std::max(box.height(), 0.0);
    const double whole = sum(width, height);
    return 4 * sum(width / 2, height / 2) <= 3 * whole ? whole : 0;
  }

 private:
  double sum(double width, double height) const {
    const double h = width + parameter_error, k = height + parameter_error;
    return h * h * a_ + k * k * b_;
  }
  double a_ = 0, b_ = 0;
};

/// Flips edges of the band, from triangle `first` on, that fold it. Boxes of triangles stay within the limits.
void unfold(const TrimmedPatch& limits, double sliver, const ChordBound& chord, std::size_t first, CutPatch& out) {
  const bool has_room = std::isfinite(limits.room);
  const double room = has_room ? limits.room - sliver : 0;
  constexpr double flat_share = 0x1p-10;  // flatter patches have folds far below the tolerance
  if (!(chord.pieces()[0].chord(1, 1) > (has_room ? flat_share * limits.room : 0))) return;
  const auto is_pole = [&](std::uint32_t corner) { return std::ranges::find(out.poles, corner) != out.poles.end(); };
  const auto may_flip = [&](const CutPatch::Triangle& a, const CutPatch::Triangle& b, const CutPatch::Triangle& new_a,
                            const CutPatch::Triangle& new_b) {
    if (std::ranges::any_of(a, is_pole) || std::ranges::any_of(b, is_pole)) return false;
    double width = limits.in_cells ? 1.0 / limits.segments.u.rate() : 1, distance = room;
    double height = limits.in_cells ? 1.0 / limits.segments.v.rate() : 1;
    for (const CutPatch::Box& box : {out.box_of(a), out.box_of(b)}) {
      width = std::max(width, box.width()), height = std::max(height, box.height());
      distance = std::max(distance, box.distance(chord));
    }
    return std::ranges::all_of(std::array{out.box_of(new_a), out.box_of(new_b)}, [&](const CutPatch::Box& box) {
      return box.width() <= width && box.height() <= height && (!has_room || box.distance(chord) <= distance);
    });
  };
  PatchPoints points(*limits.rounding.patch, limits.rounding.origin);
  BandFlipper(points, out.vertices).run(out.triangles, first, may_flip, limits.cancel);
}

}  // namespace

FaceSides::FaceSides(const TrimRegion& region) {
  const TrimRegion::Impl& impl = impl_of(region);
  const std::span<const double> lines_u = impl.lines.u.lines, lines_v = impl.lines.v.lines;
  u.set(impl.pieces, &ParameterPoint::u, lines_u, lines_v, impl.starts_inside);
  v.set(impl.pieces, &ParameterPoint::v, lines_v, lines_u, impl.starts_inside);
}

void CutPatchMaker::make(const TrimRegion& region, const FaceSides& sides, const PatchTrims::Cut& cut,
                         TrimmedPatch limits, const std::array<Segments, 4>& borders, SideMask collapsed,
                         const ChordBound& chord, CutPatch& out) {
  const TrimRegion::Impl& impl = impl_of(region);
  const std::size_t a = cut.place / impl.count_v(), b = cut.place % impl.count_v();
  limits.domain = {impl.lines.u.lines[a], impl.lines.u.lines[a + 1], impl.lines.v.lines[b], impl.lines.v.lines[b + 1]};
  out.vertices.clear(), out.triangles.clear(), out.on_borders.clear();
  out.loop_segments.clear(), out.side_vertices.clear();
  out.distance = out.sliver = 0;
  out.has_too_many = false;
  out.widest = {max_rate - 1, max_rate - 1};
  const auto run_with = [&, sliver = limits.sliver](double chord_share) {
    limits.chord_share = chord_share;
    limits.sliver = sliver * chord_share;
    return run(region, sides, cut.place, limits, borders, out);
  };
  constexpr double finest = 1.0 / 64;
  out.is_crossed = true;
  for (double share = 1; out.is_crossed && share >= finest; share /= 4) out.is_crossed = !run_with(share);
  // Loops that cross themselves or each other keep what an odd number of them encloses. Finer chords cross as well, so
  // the coarsest ones are divided where they do; the finest, where this makes too many crossings.
  for (const double share : {1.0, finest}) {
    if (!out.is_crossed) break;
    out.is_crossed = !run_with(share) && !cutter_.cut_crossing();
  }
  if (out.is_crossed) {
    out.open_edges = 0;
    return;
  }
  number(collapsed, limits.stations != nullptr, out);
  out.has_too_many = !refine(limits, chord, out);
  if (out.has_too_many) return;
  unfold(limits, cutter_.sliver_bound(), chord, band_, out);
  merge(limits, out);
  out.whole = band_;
  measure(limits.segments, chord, out);
  find_border_vertices(borders, limits.domain, limits.stations != nullptr, out);
}

bool CutPatchMaker::run(const TrimRegion& region, const FaceSides& sides, std::size_t place, const TrimmedPatch& limits,
                        const std::array<Segments, 4>& borders, CutPatch& out) {
  const TrimRegion::Impl& impl = impl_of(region);
  const std::size_t a = place / impl.count_v(), b = place % impl.count_v();
  cutter_.begin(limits);
  out.open_edges = 0;
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    const bool above = !is_far(side);
    const PatchSides& lines = across_side(side, sides);
    const std::size_t line = (runs_along_u(side) ? b : a) + !above;
    std::vector<SidePoint> points = lines.points(line, runs_along_u(side) ? a : b, borders[s]);
    if (limits.stations) limits.stations->put_on_side(side, points);
    const auto [from, to] = range_along(side, limits.domain);
    const auto is_even = [&, from = from, to = to](std::size_t k) {
      return points[k].at == line_at(from, to, borders[s], static_cast<int>(k));
    };
    out.is_full[s] = cutter_.add_side(points, side) == static_cast<std::size_t>(borders[s].rate());
    for (std::size_t k = 0; k < points.size() && out.is_full[s]; ++k) out.is_full[s] = is_even(k);
    out.is_shared[s] = !out.is_full[s] && lines.is_outer(line) && limits.is_shared[s];
    if (out.is_full[s] || out.is_shared[s]) continue;
    for (const SidePoint& point : points)
      out.open_edges += above ? point.above && !point.below : point.below && !point.above;
  }
  chords_ = static_cast<std::uint32_t>(cutter_.add_pieces(impl.pieces, impl.pieces_of(place)));
  out.open_edges += chords_;
  return cutter_.cut();
}

// Vertices that no triangle uses are left out, and so are triangles without an area at a collapsed border.
void CutPatchMaker::number(SideMask collapsed, bool names_edges, CutPatch& out) {
  CutCells& cells = cutter_.cells();
  const std::size_t first = cutter_.loop_vertex_count(), count = cutter_.vertex_count();
  numbers_.assign(count, no_id);
  points_.clear();
  out.poles.fill(no_id);
  const auto add = [&](std::uint32_t vertex) {
    ParameterPoint at = cutter_.local(vertex);
    for (const Side side : all_sides) {
      if (across_side(side, at) != is_far(side) || !collapsed.has(side)) continue;
      std::uint32_t& pole = out.poles[static_cast<std::size_t>(side)];
      if (pole != no_id) return pole;
      pole = static_cast<std::uint32_t>(out.vertices.size());
      along_side(side, at) = 0;
      break;
    }
    points_.push_back(cutter_.point(vertex));
    out.vertices.push_back(at);
    return static_cast<std::uint32_t>(out.vertices.size() - 1);
  };
  for (auto vertex = static_cast<std::uint32_t>(first); vertex < count; ++vertex) numbers_[vertex] = add(vertex);
  const auto put = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    CutPatch::Triangle triangle{a, b, c};
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& known = numbers_[corner];
      if (known == no_id) known = add(corner);
      corner = known;
    }
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      out.triangles.push_back(triangle);
  };
  out.triangles.reserve(2 * cells.whole_count() + cells.band().size());
  cells.for_whole([&](std::uint32_t, std::uint32_t, std::uint32_t p, std::uint32_t q, std::uint32_t r,
                      std::uint32_t s) { put(p, q, r), put(p, r, s); });
  band_ = out.triangles.size();
  for (const CutPatch::Triangle& triangle : cells.band()) put(triangle[0], triangle[1], triangle[2]);
  if (names_edges) list_loop_segments(out);
}

void CutPatchMaker::list_loop_segments(CutPatch& out) {
  if (cutter_.has_divided_chords()) {
    out.loop_segments = divided_chords(cutter_, numbers_, out.triangles);
  } else {
    out.loop_segments.reserve(chords_);
    cutter_.for_loop_chords([&](const LoopChord& chord) {
      const std::uint32_t start = numbers_[chord.start], end = numbers_[chord.end];
      if (start != no_id && end != no_id) out.loop_segments.push_back({chord.piece, start, end, chord.from, chord.to});
    });
  }
  out.open_edges -= chords_;
  for (const CutPatch::LoopSegment& segment : out.loop_segments) out.open_edges += segment.start != segment.end;
}

CutPatch::Box CutPatch::box_of(const Triangle& triangle) const {
  Box box;
  const auto is_pole = [&](std::uint32_t corner, bool along_u) {
    const auto pole = [&](Side side) { return poles[static_cast<std::size_t>(side)] == corner; };
    return along_u ? pole(Side::v0) || pole(Side::v1) : pole(Side::u0) || pole(Side::u1);
  };
  for (const std::uint32_t corner : triangle) {
    const ParameterPoint& at = vertices[corner];
    if (!is_pole(corner, true)) box.u0 = std::min(box.u0, at.u), box.u1 = std::max(box.u1, at.u);
    if (!is_pole(corner, false)) box.v0 = std::min(box.v0, at.v), box.v1 = std::max(box.v1, at.v);
  }
  return box;
}

bool CutPatch::is_cell(const Triangle& first, const Triangle& second) const {
  if (first[0] != second[0] || first[2] != second[1]) return false;
  const ParameterPoint &a = vertices[first[0]], &b = vertices[first[1]], &c = vertices[first[2]],
                       &d = vertices[second[2]];
  return (b.u == c.u && b.v == a.v && d.u == a.u && d.v == c.v) ||
         (b.u == a.u && b.v == c.v && d.u == c.u && d.v == a.v);
}

// Bounds of a half or a quarter hold for triangles within it.
double CutPatch::Box::distance(const ChordBound& chord) const {
  return chord.pieces()[piece_of(u0, u1, v0, v1)].chord(width() + parameter_error, height() + parameter_error);
}

void CutPatch::measure(const Triangle& triangle, const ChordBound& chord) {
  const Box box = box_of(triangle);
  distance = std::max(distance, box.distance(chord));
  widest = {std::min(widest.u, rate_of(box.width())), std::min(widest.v, rate_of(box.height()))};
}

bool CutPatchMaker::refine(const TrimmedPatch& limits, const ChordBound& chord, CutPatch& out) {
  // Where slivers take more than their share, halves would not help.
  const double left = limits.room - cutter_.sliver_bound();
  const double room = left > 0.25 * limits.room ? left : std::numeric_limits<double>::infinity();
  const double width = 1.0 / limits.segments.u.rate(), height = 1.0 / limits.segments.v.rate();
  const EdgeMeasure measure(chord, room, width, height, limits.in_cells);
  if (!measure.is_finite()) return true;
  constexpr double rounded = 1 + 0x1p-40;
  const auto is_large = [&](const CutPatch::Triangle& triangle) {
    const CutPatch::Box box = out.box_of(triangle);
    const bool is_wide = box.width() > rounded * width || box.height() > rounded * height;
    return (limits.in_cells && is_wide) || (std::isfinite(room) && !(box.distance(chord) <= room));
  };
  const auto length = [&](std::uint32_t a, std::uint32_t b) { return measure(out.box_of({a, b, b})); };
  const auto middle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const CutPatch::Box ends = out.box_of({a, b, b}), others = out.box_of({c, d, d});
    const CutPatch::Box &of_u = ends.width() < 0 ? others : ends, &of_v = ends.height() < 0 ? others : ends;
    return ParameterPoint{(of_u.u0 + of_u.u1) / 2, (of_v.v0 + of_v.v1) / 2};
  };
  const bool is_done =
      refiner_.run(out.vertices, out.triangles, band_, {is_large, length, middle, limits.max_triangles, limits.cancel});
  points_.resize(out.vertices.size(), {std::nan(""), std::nan("")});  // new vertices lie on no border
  return is_done;
}

// Chords may be shorter than the resolution of positions. Vertices in one place are joined by index, so each edge
// between two triangles stays one; an edge of a loop that becomes a point is no open edge any more.
void CutPatchMaker::merge(const TrimmedPatch& limits, CutPatch& out) {
  const auto band = [&] { return std::span(out.triangles).subspan(band_); };
  if (!merger_.find(limits.rounding, limits.speed, out.vertices, band())) return;
  const std::uint32_t lone = count_lone_edges(band());
  numbers_.resize(out.vertices.size());
  for (std::uint32_t vertex = 0; vertex < numbers_.size(); ++vertex) numbers_[vertex] = merger_.kept(vertex);
  compact(numbers_, out);
  const auto is_point = [](const CutPatch::Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  band_ -= static_cast<std::size_t>(std::ranges::count_if(std::span(out.triangles).first(band_), is_point));
  std::erase_if(out.triangles, is_point);
  out.open_edges -= std::min(out.open_edges, lone - std::min(lone, count_lone_edges(band())));
  mark_loop_segments(out);
}

void CutPatchMaker::mark_loop_segments(CutPatch& out) {
  if (out.loop_segments.empty()) return;
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  };
  std::vector<std::uint64_t> edges;
  for (const CutPatch::Triangle& t : out.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(key(t[k], t[(k + 1) % 3]));
  std::ranges::sort(edges);
  for (CutPatch::LoopSegment& segment : out.loop_segments)
    segment.has_triangle = std::ranges::equal_range(edges, key(segment.start, segment.end)).size() == 1;
}

void CutPatchMaker::compact(std::span<const std::uint32_t> kept, CutPatch& out) {
  std::vector<std::uint32_t> places(kept.size(), no_id);
  std::uint32_t count = 0;
  for (std::uint32_t vertex = 0; vertex < kept.size(); ++vertex) {
    if (kept[vertex] != vertex) continue;
    out.vertices[count] = out.vertices[vertex];
    points_[count] = points_[vertex];
    places[vertex] = count++;
  }
  out.vertices.resize(count);
  points_.resize(count);
  const auto moved = [&](std::uint32_t vertex) { return places[kept[vertex]]; };
  for (std::uint32_t& pole : out.poles)
    if (pole != no_id) pole = moved(pole);
  for (CutPatch::Triangle& triangle : out.triangles)
    for (std::uint32_t& corner : triangle) corner = moved(corner);
  for (CutPatch::LoopSegment& segment : out.loop_segments)
    segment.start = moved(segment.start), segment.end = moved(segment.end);
}

void CutPatchMaker::measure(PatchSegments segments, const ChordBound& chord, CutPatch& out) {
  out.sliver = cutter_.sliver_bound();
  double width = 0, height = 0;
  if (band_ > 0) {
    out.distance = chord.distance_of(segments);
    const Rates coarsest = segments.coarsest();
    width = 1.0 / coarsest.u, height = 1.0 / coarsest.v;
  }
  out.widest = {rate_of(width), rate_of(height)};
  for (std::size_t t = band_; t < out.triangles.size(); ++t) out.measure(out.triangles[t], chord);
}

void CutPatchMaker::find_border_vertices(const std::array<Segments, 4>& borders, const Domain& domain, bool all,
                                         CutPatch& out) {
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    const auto [from, to] = range_along(side, domain);
    lines_.clear();
    for (int k = 0; k <= borders[s].rate(); ++k) lines_.push_back(line_at(from, to, borders[s], k));
    for (std::uint32_t vertex = 0; vertex < out.vertices.size(); ++vertex) {
      if (across_side(side, out.vertices[vertex]) != is_far(side)) continue;
      const double at = along_side(side, points_[vertex]);
      if (all && !std::isnan(at)) out.side_vertices.push_back({vertex, side, at});
      const auto line = std::ranges::lower_bound(lines_, at);
      if (line != lines_.end() && *line == at)
        out.on_borders.push_back({vertex, static_cast<std::uint16_t>(line - lines_.begin()), side});
    }
  }
  // A pole is also the end of the sides beside it.
  for (std::size_t side = 0; all && side < 4; ++side) {
    const std::uint32_t pole = out.poles[side];
    if (pole == no_id) continue;
    const Side beside = all_sides[side];
    std::erase_if(out.side_vertices,
                  [&](const CutPatch::SideVertex& v) { return v.vertex == pole && v.side != beside; });
    for (const Side other : {all_sides[(side + 1) % 4], all_sides[(side + 3) % 4]})
      out.side_vertices.push_back({pole, other, line_of(beside, domain)});
  }
  std::ranges::sort(out.side_vertices, {}, [](const CutPatch::SideVertex& v) { return std::pair(v.side, v.along); });
}

}}  // namespace tessera::abi_0_1
