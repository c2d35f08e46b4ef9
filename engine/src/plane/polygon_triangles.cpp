#include "plane/polygon_triangles.h"

#include <algorithm>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {

void PolygonTriangles::begin(std::span<const ParameterPoint> points, std::size_t segments) {
  points_.sort(points);
  line_.clear();
  funnels_.clear();
  has_divided_borders_ = false;
  funnels_.reserve(3 * points.size() + segments, 2 * points.size());
  edges_.clear();
  edges_.reserve(segments);
  starting_.assign(points_.count(), no_id);
  ending_.assign(points_.count(), no_id);
}

void PolygonTriangles::add_edge(std::uint32_t start, std::uint32_t end, std::uint8_t kinds) {
  std::uint32_t first = points_.rank_of(start), last = points_.rank_of(end);
  if (first == last) return;
  if (first > last) std::swap(first, last);
  edges_.push_back({first, last, starting_[first], ending_[last], no_id, kinds});
  starting_[first] = ending_[last] = static_cast<std::uint32_t>(edges_.size() - 1);
}

bool PolygonTriangles::run(std::span<const ParameterPoint> points, std::span<const PlaneSegment> borders,
                           std::span<const PlaneSegment> cuts) {
  begin(points, borders.size() + cuts.size());
  for (const PlaneSegment& segment : borders) add_edge(segment.start, segment.end, border);
  for (const PlaneSegment& segment : cuts) add_edge(segment.start, segment.end, cut);
  return sweep();
}

bool PolygonTriangles::run_rings(std::span<const ParameterPoint> points, std::span<const std::uint32_t> ends) {
  begin(points, points.size());
  std::uint32_t first = 0;
  for (const std::uint32_t end : ends) {
    for (std::uint32_t k = first; k < end; ++k) add_edge(k, k + 1 < end ? k + 1 : first, border);
    first = end;
  }
  return sweep();
}

bool PolygonTriangles::sweep() {
  for (std::uint32_t rank = 0; rank < points_.count(); ++rank) {
    if (visit(rank)) continue;
    funnels_.clear();
    return false;
  }
  for (Triangle& triangle : funnels_.triangles())
    for (std::uint32_t& corner : triangle) corner = points_.index_of(corner);
  return true;
}

// The usual point: one edge ends and one starts. Every point is compared with the edges beside it. Edges that cross are
// neighbours before they do, so the first point after a crossing finds itself on the wrong side of one of them (Shamos
// and Hoey 1976, Geometric intersection problems).
bool PolygonTriangles::visit(std::uint32_t rank) {
  const std::uint32_t ending = ending_[rank], starting = starting_[rank];
  if (ending == no_id || starting == no_id) return visit_any(rank);
  const Edge& last = edges_[ending];
  Edge& next = edges_[starting];
  if (last.next_end != no_id || next.next_start != no_id || (last.kinds ^ next.kinds) & border) return visit_any(rank);
  SweepLine::Place& place = line_.at(last.place);
  if (place.below != SweepLine::bottom && line_.side(points_, place.below, rank) <= 0) return visit_any(rank);
  if (place.above != no_id && line_.side(points_, place.above, rank) >= 0) return visit_any(rank);
  Gap& below = line_.at(place.below).gap;
  if (below.is_inside) funnels_.add(points_, below, rank, Bank::upper);
  if (place.gap.is_inside) funnels_.add(points_, place.gap, rank, Bank::lower);
  next.place = last.place;
  place.start = rank;
  place.end = next.end;
  place.edge = starting;
  return true;
}

bool PolygonTriangles::visit_any(std::uint32_t rank) {
  Ending ending{};
  if (!find_ending(rank, ending)) return false;
  sort_starting(rank);
  const bool is_inside_below = line_.at(ending.below).gap.is_inside;
  const bool is_inside_above = ending.any() ? line_.at(ending.highest).gap.is_inside : is_inside_below;
  if ((borders_starting() % 2 != 0) != (is_inside_below != is_inside_above)) return false;
  replace(rank, ending, advance_gaps(rank, ending));
  return true;
}

// All edges that end in the point, or run through it, must be neighbours.
bool PolygonTriangles::find_ending(std::uint32_t rank, Ending& ending) {
  std::size_t missing = 0;
  for (std::uint32_t edge = ending_[rank]; edge != no_id; edge = edges_[edge].next_end) ++missing;
  if (missing == 0) {
    const auto [place, is_on_edge] = line_.find(points_, rank);
    ending.below = place;
    if (!is_on_edge) return true;
    ending.lowest = ending.highest = place;
    divide(place, rank);
  } else {
    ending.lowest = ending.highest = edges_[ending_[rank]].place;
    --missing;
  }
  const auto joins = [&](std::uint32_t place, int side) {
    if (line_.at(place).end == rank) {
      --missing;
      return true;
    }
    if (side == 0) divide(place, rank);
    return side == 0;
  };
  for (;;) {
    ending.below = line_.at(ending.lowest).below;
    if (ending.below == SweepLine::bottom) break;
    const int side = line_.side(points_, ending.below, rank);
    if (!joins(ending.below, side)) {
      if (side < 0) return false;
      break;
    }
    ending.lowest = ending.below;
  }
  for (std::uint32_t above = line_.at(ending.highest).above; above != no_id; above = line_.at(above).above) {
    const int side = line_.side(points_, above, rank);
    if (!joins(above, side)) {
      if (side > 0) return false;
      break;
    }
    ending.highest = above;
  }
  return missing == 0;
}

// The edge ends in the point, and starts there anew.
void PolygonTriangles::divide(std::uint32_t place, std::uint32_t rank) {
  const std::uint32_t edge = line_.at(place).edge;
  has_divided_borders_ |= (edges_[edge].kinds & border) != 0;
  edges_[edge].start = rank;
  edges_[edge].next_start = starting_[rank];
  starting_[rank] = edge;
}

void PolygonTriangles::sort_starting(std::uint32_t rank) {
  fan_.clear();
  for (std::uint32_t edge = starting_[rank], next; edge != no_id; edge = next) {
    next = edges_[edge].next_start;
    std::size_t k = fan_.size();
    int turn = 1;
    for (; k > 0; --k) {
      turn = orientation(points_.at(rank), points_.at(edges_[fan_[k - 1]].end), points_.at(edges_[edge].end));
      if (turn >= 0) break;
    }
    if (k > 0 && turn == 0)
      overlap(k - 1, edge);
    else
      fan_.insert(fan_.begin() + static_cast<std::ptrdiff_t>(k), edge);
  }
}

// Two edges start in one direction. Up to the nearer end they are one edge, or none; the rest starts there.
void PolygonTriangles::overlap(std::size_t k, std::uint32_t edge) {
  std::uint32_t nearer = fan_[k], farther = edge;
  if (edges_[nearer].end > edges_[farther].end) std::swap(nearer, farther);
  fan_[k] = nearer;
  Edge &one = edges_[nearer], &other = edges_[farther];
  has_divided_borders_ |= (one.kinds & other.kinds & border) != 0 || (other.kinds & border && one.end != other.end);
  const std::uint8_t kinds = ((one.kinds ^ other.kinds) & border) | ((one.kinds | other.kinds) & cut);
  if (one.end == other.end) {
    forget_end(farther);
  } else {
    other.start = one.end;
    other.next_start = starting_[one.end];
    starting_[one.end] = farther;
  }
  one.kinds = kinds;
  if (kinds == 0) {
    forget_end(nearer);
    fan_.erase(fan_.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

void PolygonTriangles::forget_end(std::uint32_t edge) {
  std::uint32_t* link = &ending_[edges_[edge].end];
  while (*link != edge) link = &edges_[*link].next_end;
  *link = edges_[edge].next_end;
}

std::uint32_t PolygonTriangles::borders_starting() const {
  std::uint32_t count = 0;
  for (const std::uint32_t edge : fan_) count += edges_[edge].kinds & border;
  return count;
}

// Ends the gaps between edges that end, and adds the point to those below and above. Returns the latter, unless no edge
// starts: then it is a part of the gap below.
Gap PolygonTriangles::advance_gaps(std::uint32_t rank, const Ending& ending) {
  Gap& below = line_.at(ending.below).gap;
  if (!ending.any()) {
    if (!below.is_inside) return {};
    const Gap above = funnels_.split(points_, below, rank);
    if (fan_.empty()) below.upper = above.lower;
    return above;
  }
  for (std::uint32_t place = ending.lowest; place != ending.highest; place = line_.at(place).above)
    if (line_.at(place).gap.is_inside) funnels_.end(line_.at(place).gap, rank);
  Gap above = line_.at(ending.highest).gap;
  if (fan_.empty()) {
    if (below.is_inside) funnels_.join(points_, below, above, rank);
    return above;
  }
  if (below.is_inside) funnels_.add(points_, below, rank, Bank::upper);
  if (above.is_inside) funnels_.add(points_, above, rank, Bank::lower);
  return above;
}

// Puts the edges that start in the places of those that end.
void PolygonTriangles::replace(std::uint32_t rank, const Ending& ending, const Gap& above) {
  bool is_inside = line_.at(ending.below).gap.is_inside;
  std::uint32_t last = ending.below, old = ending.lowest;
  const std::uint32_t end = ending.any() ? line_.at(ending.highest).above : no_id;
  for (const std::uint32_t edge : fan_) {
    std::uint32_t place = old;
    if (old != no_id && old != end)
      old = line_.at(old).above;
    else
      place = line_.insert_above(last);
    if (edges_[edge].kinds & border) is_inside = !is_inside;
    const bool is_last = edge == fan_.back();
    start(place, edge, is_last ? above : is_inside ? funnels_.begin(rank) : Gap{});
    last = place;
  }
  while (old != no_id && old != end) {
    const std::uint32_t next = line_.at(old).above;
    line_.erase(old);
    old = next;
  }
}

void PolygonTriangles::start(std::uint32_t place, std::uint32_t edge, const Gap& gap) {
  edges_[edge].place = place;
  SweepLine::Place& at = line_.at(place);
  at.start = edges_[edge].start;
  at.end = edges_[edge].end;
  at.edge = edge;
  at.gap = gap;
}

}}  // namespace tessera::abi_0_1
