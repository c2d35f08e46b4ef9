#include "section/strands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

double along(bool over_u, const ParameterPoint& at) { return over_u ? at.u : at.v; }
double across(bool over_u, const ParameterPoint& at) { return over_u ? at.v : at.u; }

}  // namespace

/// Whether the points of an arc are found by their u. Arcs of points have the parameter that they run along most.
bool StrandTracer::is_over_u(const CellNode& cell, const CellArc& arc) const {
  if (cell.kind != CellKind::tiny) return runs_over_u(cell.kind);
  const ParameterPoint &a = arcs_.crossings()[arc.ends[0]].at, &b = arcs_.crossings()[arc.ends[1]].at;
  return std::abs(a.u - b.u) > std::abs(a.v - b.v);
}

void StrandTracer::trace(const PreparedPatch& patch, const Level& level, std::vector<SectionPoint>& points,
                         std::vector<Strand>& strands) {
  patch_ = &patch;
  level_ = level;
  points_ = &points;
  strands_ = &strands;
  arcs_.find(patch.cells, level, levels_.contact);
  arc_hits_.clear();
  hits_.clear();
  is_special_ = patch.loops && patch.loops->find(level, 2 * levels_.contact, hits_);
  is_special_ = is_special_ || !arcs_.special().empty();
  if (arcs_.arcs().empty()) return;
  attach_hits();
  is_done_.assign(arcs_.arcs().size(), 0);
  const std::span<const LineCrossing> crossings = arcs_.crossings();
  for (std::uint32_t k = 0; k < crossings.size(); ++k)
    if (crossings[k].arcs[1] == no_id && crossings[k].arcs[0] != no_id && !is_done_[crossings[k].arcs[0]])
      follow(k, crossings[k].arcs[0]);
  for (std::uint32_t arc = 0; arc < is_done_.size(); ++arc)
    if (!is_done_[arc]) follow(arcs_.arcs()[arc].ends[0], arc);
}

/// Returns how far a point is from an arc, in parameters, and its place along the arc's parameter.
double StrandTracer::distance_to(std::uint32_t index, const ParameterPoint& at, double& place) const {
  const CellArc& arc = arcs_.arcs()[index];
  const CellNode& cell = cell_of(index);
  const bool over_u = is_over_u(cell, arc);
  const ParameterPoint &a = arcs_.crossings()[arc.ends[0]].at, &b = arcs_.crossings()[arc.ends[1]].at;
  const auto [low, high] = std::minmax({along(over_u, a), along(over_u, b)});
  place = std::clamp(along(over_u, at), low, high);
  const double beyond = std::abs(place - along(over_u, at));
  const double from = along(over_u, a), to = along(over_u, b);
  double other = from == to
                     ? across(over_u, a)
                     : across(over_u, a) + (across(over_u, b) - across(over_u, a)) * ((place - from) / (to - from));
  if (cell.kind == CellKind::over_u || cell.kind == CellKind::over_v) {
    const double least = over_u ? cell.domain.v0 : cell.domain.u0, most = over_u ? cell.domain.v1 : cell.domain.u1;
    other = across(over_u, patch_->points.point(over_u, place, level_.at, least, most, other).at);
  }
  return beyond + std::abs(other - across(over_u, at));
}

/// Finds the arc of each point where the plane meets a loop.
void StrandTracer::attach_hits() {
  const auto count = static_cast<std::uint32_t>(arcs_.arcs().size());
  for (std::uint32_t hit = 0; hit < hits_.size(); ++hit) {
    ArcHit best{0, hit, 0};
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t arc = 0; arc < count && least > 0; ++arc) {
      const Domain& domain = cell_of(arc).domain;
      const ParameterPoint& at = hits_[hit].at;
      const double outside = std::max({domain.u0 - at.u, at.u - domain.u1, domain.v0 - at.v, at.v - domain.v1, 0.0});
      if (outside >= least) continue;
      double place = 0;
      const double distance = count == 1 ? (distance_to(arc, at, place), 0) : distance_to(arc, at, place);
      if (distance < least) least = distance, best = {arc, hit, place};
    }
    arc_hits_.push_back(best);
  }
  std::ranges::sort(arc_hits_, {}, [](const ArcHit& of) { return std::tuple(of.arc, of.along, of.hit); });
}

/// Appends a crossing, and the hits of the arc that begins there, in the arc's direction.
void StrandTracer::append_stops(std::uint32_t from, std::uint32_t index) {
  const CellArc& arc = arcs_.arcs()[index];
  const bool over_u = is_over_u(cell_of(index), arc);
  const std::uint32_t to = arc.ends[arc.ends[0] == from ? 1 : 0];
  const std::span<const LineCrossing> crossings = arcs_.crossings();
  stops_.push_back({crossings[from].at, index, from, no_id});
  const auto hits = std::ranges::equal_range(arc_hits_, index, {}, &ArcHit::arc);
  const auto add = [&](const ArcHit& of) { stops_.push_back({hits_[of.hit].at, index, no_id, of.hit}); };
  if (along(over_u, crossings[from].at) <= along(over_u, crossings[to].at)) {
    for (const ArcHit& of : hits) add(of);
  } else {
    for (auto of = hits.end(); of != hits.begin();) add(*--of);
  }
}

/// Follows a chain of arcs from a crossing to its end, and emits what is kept of it.
void StrandTracer::follow(std::uint32_t crossing, std::uint32_t arc) {
  stops_.clear();
  const std::uint32_t start = crossing;
  while (arc != no_id && !is_done_[arc]) {
    is_done_[arc] = 1;
    append_stops(crossing, arc);
    const CellArc& of = arcs_.arcs()[arc];
    crossing = of.ends[of.ends[0] == crossing ? 1 : 0];
    const auto& next = arcs_.crossings()[crossing].arcs;
    arc = next[next[0] == arc ? 1 : 0];
  }
  stops_.push_back({arcs_.crossings()[crossing].at, no_id, crossing, no_id});
  split_chain(crossing == start);
}

void StrandTracer::split_chain(bool closed) {
  if (!patch_->loops) return emit(0, stops_.size() - 1, closed);
  const auto is_hit = [](const Stop& of) { return of.hit != no_id; };
  if (closed) {
    stops_.pop_back();
    const auto first = std::ranges::find_if(stops_, is_hit);
    if (first != stops_.end()) std::rotate(stops_.begin(), first, stops_.end());
    stops_.push_back(stops_.front());
    stops_.back().arc = no_id;
  }
  marks_.assign(1, 0);
  for (std::size_t k = 1; k + 1 < stops_.size(); ++k)
    if (is_hit(stops_[k])) marks_.push_back(k);
  marks_.push_back(stops_.size() - 1);
  find_kept(marks_);
  const std::size_t count = kept_.size();
  if (closed && count == 1) {
    if (kept_[0] == TrimSide::inside) emit(0, stops_.size() - 1, true);
    return;
  }
  for (std::size_t k = 0; k < count;) {
    if (kept_[k] != TrimSide::inside) {
      ++k;
      continue;
    }
    std::size_t end = k;
    while (end < count && kept_[end] == TrimSide::inside) ++end;
    emit(marks_[k], marks_[end], closed && k == 0 && end == count);
    k = end;
  }
}

/// Finds which intervals between marks are kept: by a point of each, and where that is on a loop, by the parity of the
/// loops that the chain crosses.
void StrandTracer::find_kept(std::span<const std::size_t> marks) {
  const std::size_t count = marks.size() - 1;
  kept_.assign(count, TrimSide::border);
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t widest = marks[k];
    double width = -1;
    for (std::size_t stop = marks[k]; stop < marks[k + 1]; ++stop) {
      const ParameterPoint &a = stops_[stop].at, &b = stops_[stop + 1].at;
      if (const double of = std::abs(a.u - b.u) + std::abs(a.v - b.v); of > width) width = of, widest = stop;
    }
    if (width > 0x1p-40 || count == 1) kept_[k] = side_of(widest);
  }
  const auto other = [](TrimSide side) { return side == TrimSide::inside ? TrimSide::outside : TrimSide::inside; };
  for (std::size_t k = 1; k < count; ++k)
    if (kept_[k] == TrimSide::border && kept_[k - 1] != TrimSide::border) kept_[k] = other(kept_[k - 1]);
  for (std::size_t k = count - 1; k-- > 0;)
    if (kept_[k] == TrimSide::border && kept_[k + 1] != TrimSide::border) kept_[k] = other(kept_[k + 1]);
  for (TrimSide& side : kept_)
    if (side == TrimSide::border) side = TrimSide::outside;
}

TrimSide StrandTracer::side_of(std::size_t stop) const {
  // Where the plane runs along a loop, rounding would decide.
  if (is_special_)
    if (const TrimSide side = side_beside(between(stop, 0.5, -1).at); side != TrimSide::border) return side;
  for (const double share : {0.5, 0.3125, 0.6875}) {
    const TrimSide side = patch_->loops->locate(between(stop, share, -1).at);
    if (side != TrimSide::border) return side;
  }
  return side_beside(between(stop, 0.5, -1).at);
}

/// Returns the side of a point beside one of the section, towards the planes whose limit counts, and far enough to be
/// beside a loop that runs along the plane.
TrimSide StrandTracer::side_beside(const ParameterPoint& at) const {
  const double sign = level_.side < level_.at ? -1 : 1;
  for (const double step : {1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    ParameterPoint best = at;
    double farthest = 16 * levels_.contact;
    for (const ParameterPoint& to : {ParameterPoint{at.u - step, at.v}, ParameterPoint{at.u + step, at.v},
                                     ParameterPoint{at.u, at.v - step}, ParameterPoint{at.u, at.v + step}}) {
      const ParameterPoint inside{std::clamp(to.u, 0.0, 1.0), std::clamp(to.v, 0.0, 1.0)};
      const double height = sign * (levels_.height(patch_->points.position(inside)) - level_.at);
      if (height > farthest) farthest = height, best = inside;
    }
    if (best == at) continue;
    if (const TrimSide side = patch_->loops->locate(best); side != TrimSide::border) return side;
  }
  return TrimSide::border;
}

/// Returns a point of the part after a stop, at a share of it. `guess`: of its other parameter.
HeightPoint StrandTracer::between(std::size_t stop, double share, double guess) const {
  const std::uint32_t arc = stops_[stop].arc;
  const CellNode& cell = cell_of(arc);
  const bool over_u = is_over_u(cell, arcs_.arcs()[arc]);
  const ParameterPoint &a = stops_[stop].at, &b = stops_[stop + 1].at;
  const double place = along(over_u, a) + share * (along(over_u, b) - along(over_u, a));
  double low = across(over_u, a) + share * (across(over_u, b) - across(over_u, a)), high = low;
  const double near = guess >= 0 ? guess : low;
  if (cell.kind == CellKind::over_u || cell.kind == CellKind::over_v) {
    low = over_u ? cell.domain.v0 : cell.domain.u0;
    high = over_u ? cell.domain.v1 : cell.domain.u1;
  }
  return patch_->points.point(over_u, place, level_.at, low, high, near);
}

StrandEnd StrandTracer::end_at(const Stop& stop) const {
  if (stop.hit != no_id) {
    const LoopHit& hit = hits_[stop.hit];
    return {StrandEnd::On::loop, Side{}, hit.piece, hit.interval, hit.place};
  }
  const LineCrossing& crossing = arcs_.crossings()[stop.crossing];
  if (crossing.line >= 4) return {};
  const auto side = static_cast<Side>(crossing.line);
  return {StrandEnd::On::border, side, patch_->borders[crossing.line], crossing.interval,
          along_side(side, crossing.at)};
}

void StrandTracer::append_point(const Vec3& position, const ParameterPoint& at) {
  points_->push_back({position, patch_->domain.u_at(at.u), patch_->domain.v_at(at.v), patch_->patch, false});
}

/// Appends the points after a stop up to the next one, which is left out. Returns the largest distance of a chord.
double StrandTracer::append_part(std::size_t stop) {
  const std::uint32_t arc = stops_[stop].arc;
  const CellNode& cell = cell_of(arc);
  const bool over_u = is_over_u(cell, arcs_.arcs()[arc]);
  const ParameterPoint &a = stops_[stop].at, &b = stops_[stop + 1].at;
  append_point(patch_->points.position(a), a);
  const double size = over_u ? cell.domain.u1 - cell.domain.u0 : cell.domain.v1 - cell.domain.v0;
  const double share = std::abs(along(over_u, b) - along(over_u, a)) / size;
  const double sagitta = share * share * cell.bending / 8;
  if (cell.kind == CellKind::tiny || !(sagitta < std::numeric_limits<double>::infinity())) return cell.diameter;
  if (sagitta <= levels_.chord) return std::min(sagitta, cell.diameter) + cell.slack;
  if (cell.diameter <= levels_.chord) return cell.diameter + cell.slack;
  const double count = std::ceil(std::sqrt(sagitta / levels_.chord));
  if (static_cast<double>(points_->size()) + count > static_cast<double>(levels_.max_points)) return is_full_ = true, 0;
  double last = across(over_u, a), guess = -1;
  for (double k = 1; k < count; ++k) {
    const HeightPoint point = between(stop, k / count, guess);
    const double here = across(over_u, point.at);
    guess = 2 * here - last;
    last = here;
    append_point(point.position, point.at);
  }
  return sagitta / (count * count) + cell.slack;
}

void StrandTracer::emit(std::size_t first, std::size_t last, bool closed) {
  Strand strand{.patch = patch_->patch, .closed = closed, .first = points_->size()};
  for (std::size_t stop = first; stop < last; ++stop) strand.bound = std::max(strand.bound, append_part(stop));
  append_point(patch_->points.position(stops_[last].at), stops_[last].at);
  strand.count = points_->size() - strand.first;
  if (!closed) strand.ends = {end_at(stops_[first]), end_at(stops_[last])};
  strands_->push_back(strand);
}

}}  // namespace tessera::abi_0_1
