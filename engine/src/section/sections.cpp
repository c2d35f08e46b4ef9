#include "tessera/sections.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "base/impl_access.h"
#include "base/text.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "parallel/workspaces.h"
#include "section/plane_tracer.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check(const Vec3& normal, std::span<const double> offsets, const SectionOptions& options) {
  const auto failure = [](const std::string& text, std::ptrdiff_t index = Status::no_index) {
    return Status(StatusCode::invalid_argument, text, index);
  };
  if (!is_finite(normal) || normal == Vec3{})
    return failure("the normal of a plane must be finite and not zero, found " + text(normal));
  for (std::size_t k = 0; k < offsets.size(); ++k)
    if (!std::isfinite(offsets[k]))
      return failure("offset " + std::to_string(k) + " must be finite, found " + text(offsets[k]),
                     static_cast<std::ptrdiff_t>(k));
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance)))
    return failure("the tolerance must be above 0, found " + text(*options.tolerance));
  if (options.contact && !(*options.contact >= 0 && std::isfinite(*options.contact)))
    return failure("the contact height must be at least 0, found " + text(*options.contact));
  if (options.max_gap && !(*options.max_gap >= 0 && std::isfinite(*options.max_gap)))
    return failure("the largest gap must be at least 0, found " + text(*options.max_gap));
  return {};
}

/// The planes of a call, and where each stands in the caller's order.
struct SortedLevels {
  Levels levels;
  std::vector<std::size_t> order;  ///< `[level]`: index of the offset
  double tolerance = 0, max_gap = 0;
};

SortedLevels sorted_levels(const PatchSet::Impl& set, const Vec3& normal, std::span<const double> offsets,
                           const SectionOptions& options) {
  SortedLevels sorted;
  Levels& levels = sorted.levels;
  const Box3 box = set.model_box();
  const double size = box.diagonal(), reach = size + max_abs(box.lower) + max_abs(box.upper);
  const double scale = max_abs(normal);
  const Vec3 direction{normal.x / scale, normal.y / scale, normal.z / scale};
  levels.normal = normalized(normal);
  levels.origin = set.origin;
  sorted.tolerance = options.tolerance.value_or(size > 0 ? 1e-4 * size : 1);
  sorted.max_gap = options.max_gap.value_or(5e-3 * size);
  // A quarter is left for points that are joined.
  levels.chord = 0.74 * sorted.tolerance;
  // A plane that is tangent to a surface as curved as the model is large, and one as far beside it as `contact`, have
  // sections that are apart by about the square root of contact times the size. Let it be a part of the tolerance.
  const double coarsest = reach > 0 ? sorted.tolerance / (64 * reach) * sorted.tolerance : 0;
  levels.contact = options.contact.value_or(std::min(1e-10 * reach, coarsest));
  levels.rounding = 0x1p-50 * reach;
  levels.contact = std::max(levels.contact, 4 * levels.rounding);
  levels.point_size = std::min(sorted.tolerance, 4 * std::sqrt(levels.contact * reach));
  levels.max_points = options.max_points;
  std::vector<double> heights;
  for (const double offset : offsets)
    heights.push_back((offset / scale) / length(direction) - dot(levels.normal, levels.origin));
  sorted.order.resize(offsets.size());
  std::iota(sorted.order.begin(), sorted.order.end(), std::size_t{0});
  std::ranges::stable_sort(sorted.order, {}, [&](std::size_t k) { return heights[k]; });
  for (const std::size_t k : sorted.order) levels.heights.push_back(heights[k]);
  return sorted;
}

template <class T>
std::pair<std::size_t, std::size_t> append(std::vector<T>& all, const std::vector<T>& more) {
  const std::size_t first = all.size();
  all.insert(all.end(), more.begin(), more.end());
  return {first, more.size()};
}

/// Puts the planes one after the other, in the caller's order.
void gather(std::vector<TracedPlane>& planes, Sections& sections) {
  for (TracedPlane& of : planes) {
    PlaneSection& plane = of.plane;
    for (SectionPolyline& polyline : of.polylines) polyline.first += sections.points.size();
    append(sections.points, of.points);
    std::tie(plane.first_polyline, plane.polyline_count) = append(sections.polylines, of.polylines);
    std::tie(plane.first_contact, plane.contact_count) = append(sections.contacts, of.contacts);
    std::tie(plane.first_coplanar, plane.coplanar_count) = append(sections.coplanar, of.coplanar);
    sections.planes.push_back(plane);
    of = {};
  }
}

Status too_many(const SectionOptions& options) {
  return Status(StatusCode::invalid_argument, "the sections have more than " + counted(options.max_points, "point") +
                                                  ", the value of max_points; use a larger tolerance");
}

Result<Sections> make(const PatchSet& set, const Vec3& normal, std::span<const double> offsets,
                      const SectionOptions& options, const Execution& execution) {
  if (Status status = check(normal, offsets, options); !status.ok()) return status;
  const PatchSet::Impl& impl = impl_of(set);
  const SortedLevels sorted = sorted_levels(impl, normal, offsets, options);
  PreparedSet prepared;
  if (Status status = prepared.prepare(impl, sorted.levels, execution); !status.ok()) return status;
  std::optional<EdgeRuns> runs;
  if (impl.edges) runs.emplace(impl);
  const PlaneTask task{.set = &prepared,
                       .levels = &sorted.levels,
                       .limit = options.limit,
                       .links = {runs ? &*runs : nullptr, sorted.max_gap, sorted.tolerance},
                       .merge = 0.25 * sorted.tolerance};
  std::vector<TracedPlane> planes(offsets.size());
  Workspaces<PlaneTracer> workspaces;
  std::atomic<std::size_t> points = 0;
  std::atomic<bool> is_full = false;
  const Status status = parallel_for(offsets.size(), 4, execution, [&](std::size_t first, std::size_t end) {
    const auto tracer = workspaces.take(task);
    for (std::size_t level = first; level < end && !is_full; ++level) {
      TracedPlane& traced = planes[sorted.order[level]];
      (*tracer).trace(level, traced);
      traced.plane.offset = offsets[sorted.order[level]];
      if ((points += traced.points.size()) > options.max_points || (*tracer).is_full()) is_full = true;
    }
  });
  if (!status.ok()) return status;
  if (is_full) return too_many(options);
  Sections sections{.normal = sorted.levels.normal,
                    .planes = {},
                    .polylines = {},
                    .points = {},
                    .contacts = {},
                    .coplanar = {},
                    .tolerance = sorted.tolerance,
                    .contact_size = sorted.levels.point_size,
                    .unproven = prepared.unproven()};
  sections.points.reserve(points);
  gather(planes, sections);
  return sections;
}

}  // namespace

Result<Sections> make_sections(const PatchSet& set, const Vec3& normal, std::span<const double> offsets,
                               const SectionOptions& options, const Execution& execution) {
  return guarded([&] { return make(set, normal, offsets, options, execution); });
}

Result<Sections> make_section(const PatchSet& set, const Plane& plane, const SectionOptions& options,
                              const Execution& execution) {
  return make_sections(set, plane.normal, std::span(&plane.offset, 1), options, execution);
}

}}  // namespace tessera::abi_0_1
