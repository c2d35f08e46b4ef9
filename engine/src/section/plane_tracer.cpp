#include "section/plane_tracer.h"

#include <algorithm>
#include <utility>

namespace tessera { inline namespace abi_0_1 {

void PlaneTracer::trace(std::size_t level, TracedPlane& traced) {
  const Levels& levels = *task_.levels;
  traced = {};
  const PlaneLimit first = task_.limit == PlaneLimit::above ? PlaneLimit::above : PlaneLimit::below;
  const bool is_special = trace_limit(level, first, traced);
  if (is_special) {
    TracedPlane other;
    trace_limit(level, first == PlaneLimit::below ? PlaneLimit::above : PlaneLimit::below, other);
    const bool is_better = task_.limit == PlaneLimit::automatic && traced.polylines.empty() && !other.polylines.empty();
    if (is_better) std::swap(traced, other);
    traced.contacts.insert(traced.contacts.end(), other.contacts.begin(), other.contacts.end());
  }
  const double at = levels.heights[level];
  for (const std::uint32_t k : task_.set->of_level(level)) {
    const PreparedPatch& patch = task_.set->patch(k);
    if (patch.low >= at - levels.contact && patch.high <= at + levels.contact) traced.coplanar.push_back(patch.patch);
  }
  // Both limits, and all patches at a point, find the same contact.
  std::vector<SectionContact> distinct;
  for (const SectionContact& contact : traced.contacts)
    if (std::ranges::none_of(distinct, [&](const SectionContact& of) {
          return of.kind == contact.kind && length(of.position - contact.position) <= 4 * levels.point_size;
        }))
      distinct.push_back(contact);
  traced.contacts = std::move(distinct);
}

bool PlaneTracer::trace_limit(std::size_t level, PlaneLimit limit, TracedPlane& traced) {
  const Levels& levels = *task_.levels;
  const double at = levels.heights[level];
  const double side = limit == PlaneLimit::below ? at - levels.contact : at + levels.contact;
  bool is_special = false;
  strands_.clear();
  points_.clear();
  for (const std::uint32_t k : task_.set->of_level(level)) {
    const PreparedPatch& patch = task_.set->patch(k);
    strand_tracer_.trace(patch, {at, side}, points_, strands_);
    const PatchArcs& arcs = strand_tracer_.arcs();
    is_special = is_special || arcs.is_special();
    const auto add = [&](std::span<const std::uint32_t> cells, SectionContact::Kind kind) {
      for (const std::uint32_t cell : cells) {
        const Domain& domain = patch.cells.nodes()[cell].domain;
        const ParameterPoint middle{0.5 * (domain.u0 + domain.u1), 0.5 * (domain.v0 + domain.v1)};
        if (patch.loops && patch.loops->locate(middle) == TrimSide::outside) continue;
        traced.contacts.push_back({kind, patch.patch, patch.points.position(middle)});
      }
    };
    add(arcs.saddles(), SectionContact::Kind::saddle);
    add(arcs.touched(), SectionContact::Kind::point);
  }
  links_.join(strands_, points_, task_.links);
  traced.plane.limit = limit;
  traced.plane.largest_gap = links_.largest_gap();
  assemble(traced);
  return is_special;
}

/// Chains strands: first from open ends, then around.
void PlaneTracer::assemble(TracedPlane& traced) {
  is_used_.assign(strands_.size(), 0);
  merged_ = 0;
  for (std::uint32_t end = 0; end < 2 * strands_.size(); ++end) {
    const std::uint32_t strand = end / 2;
    if (!is_used_[strand] && !strands_[strand].closed && links_.other(end) == no_id)
      append_chain(strand, end % 2 == 1, traced);
  }
  for (std::uint32_t strand = 0; strand < strands_.size(); ++strand)
    if (!is_used_[strand]) append_chain(strand, false, traced);
  double bound = 0;
  for (const Strand& strand : strands_) bound = std::max(bound, strand.bound);
  traced.plane.bound = bound + merged_;
  traced.plane.polyline_count = traced.polylines.size();
  for (const SectionPolyline& polyline : traced.polylines) {
    traced.plane.length += polyline.length;
    if (!polyline.closed) ++traced.plane.open_count;
  }
}

void PlaneTracer::append_chain(std::uint32_t strand, bool backward, TracedPlane& traced) {
  const std::size_t first = traced.points.size();
  const std::uint32_t start = 2 * strand + (backward ? 1 : 0);
  bool closed = strands_[strand].closed;
  for (std::uint32_t end = start; !is_used_[end / 2];) {
    is_used_[end / 2] = 1;
    append_strand(strands_[end / 2], end % 2 == 1, traced);
    if (closed) break;
    end = links_.other(end ^ 1);
    if (end == no_id) break;
    closed = end == start;
  }
  finish_polyline(first, closed, traced);
}

void PlaneTracer::append_strand(const Strand& strand, bool backward, TracedPlane& traced) {
  const std::span<const SectionPoint> of = std::span(points_).subspan(strand.first, strand.count);
  join_last(backward ? of.back() : of.front(), traced);
  if (backward) {
    traced.points.insert(traced.points.end(), of.rbegin(), of.rend());
  } else {
    traced.points.insert(traced.points.end(), of.begin(), of.end());
  }
}

/// Drops the last point if the next one is about the same; otherwise a segment bridges the gap.
void PlaneTracer::join_last(const SectionPoint& next, TracedPlane& traced) {
  if (traced.points.empty()) return;
  SectionPoint& last = traced.points.back();
  const double distance = length(last.position - next.position);
  if (distance > task_.merge) {
    last.bridges_gap = true;
    return;
  }
  merged_ = std::max(merged_, distance);
  traced.points.pop_back();
}

/// Completes the polyline of the points from `first` on, or makes it a contact if it is one.
void PlaneTracer::finish_polyline(std::size_t first, bool closed, TracedPlane& traced) {
  std::vector<SectionPoint>& points = traced.points;
  if (closed) join_last(points[first], traced);
  const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
  const auto is_same = [](const SectionPoint& a, const SectionPoint& b) { return a.position == b.position; };
  points.erase(std::unique(begin, points.end(), is_same), points.end());
  if (closed && points.size() > first + 1 && is_same(points.back(), points[first])) points.pop_back();
  Box3 box;
  for (std::size_t k = first; k < points.size(); ++k) box.extend(points[k].position);
  if (points.size() < first + 2 || box.diagonal() <= task_.levels->point_size) {
    if (points.size() > first)
      traced.contacts.push_back({SectionContact::Kind::point, points[first].patch, points[first].position});
    points.resize(first);
    return;
  }
  SectionPolyline polyline{.first = first, .count = points.size() - first, .closed = closed};
  for (std::size_t k = first; k + 1 < points.size(); ++k)
    polyline.length += length(points[k + 1].position - points[k].position);
  if (closed) polyline.length += length(points.back().position - points[first].position);
  traced.polylines.push_back(polyline);
}

}}  // namespace tessera::abi_0_1
