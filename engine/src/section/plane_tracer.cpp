#include "section/plane_tracer.h"

#include <algorithm>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The contacts of a plane that are listed. A curve of contact that no parameter follows would have thousands.
constexpr std::size_t max_contacts = 1000;

}  // namespace

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
  std::ranges::stable_sort(traced.contacts, {}, &SectionContact::kind);
  std::vector<SectionContact> distinct;
  for (const SectionContact& contact : traced.contacts)
    if (distinct.size() < max_contacts && std::ranges::none_of(distinct, [&](const SectionContact& of) {
          return length(of.position - contact.position) <= 4 * levels.point_size;
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
    is_special = is_special || strand_tracer_.is_special();
    add_contacts(patch, traced);
  }
  links_.join(strands_, points_, task_.links);
  traced.plane.limit = limit;
  traced.plane.largest_gap = links_.largest_gap();
  assemble(traced);
  return is_special;
}

/// Adds the places of the patch that was traced last where the plane touches it.
void PlaneTracer::add_contacts(const PreparedPatch& patch, TracedPlane& traced) {
  const PatchArcs& arcs = strand_tracer_.arcs();
  const auto middle = [&](std::uint32_t cell) {
    const Domain& domain = patch.cells.nodes()[cell].domain;
    return ParameterPoint{0.5 * (domain.u0 + domain.u1), 0.5 * (domain.v0 + domain.v1)};
  };
  for (const std::uint32_t cell : arcs.touched())
    if (!patch.loops || patch.loops->locate(middle(cell)) != TrimSide::outside)
      traced.contacts.push_back({SectionContact::Kind::point, patch.patch, patch.points.position(middle(cell))});
  for (const std::uint32_t cell : arcs.points()) add_tangent(patch, middle(cell), traced);
  const Levels& levels = *task_.levels;
  if (patch.high - patch.low <= 2 * levels.contact) return;  // it lies in the plane
  for (const ParameterPoint& at : arcs.special()) add_tangent(patch, at, traced);
}

/// Adds a point of the plane if the patch is tangent to the plane there.
void PlaneTracer::add_tangent(const PreparedPatch& patch, const ParameterPoint& at, TracedPlane& traced) {
  constexpr double max_sine = 1e-3;
  const Vec3 normal = task_.set->normal(patch, at);
  if (normal == Vec3{} || length(cross(normal, task_.levels->normal)) > max_sine) return;
  if (patch.loops && patch.loops->locate(at) == TrimSide::outside) return;
  traced.contacts.push_back({SectionContact::Kind::tangent, patch.patch, patch.points.position(at)});
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
