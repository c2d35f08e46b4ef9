#include "convert/spline/edited_spline.h"

#include <string>

#include "base/text.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

EditedSpline::EditedSpline(const BSplineSurface& surface)
    : surface_(surface),
      rows_(surface_),
      runs_u_(runs_of(line_u(surface_))),
      runs_v_(runs_of(line_v(surface_))),
      strip_patches_(Strip::max_patches),
      is_touched_(patch_count(), 0),
      first_touched_(rows_.u().span_count() + 1, 0),
      is_row_moved_(surface_.count_u(), 0),
      numbers_(surface_.points().size() * rows_.components()) {
  while (strip_patches_ > 1 && Strip::memory_size(rows_, strip_patches_) > stack_numbers) --strip_patches_;
}

std::vector<EditedSpline::Run> EditedSpline::runs_of(const KnotLine& line) {
  std::vector<Run> runs;
  const std::vector<std::size_t> spans = distinct_spans(line);
  for (std::size_t i = 0; i < line.point_count(); ++i) {
    const auto [first, last] = touched_spans(spans, line.degree, i);
    runs.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)});
  }
  return runs;
}

Status EditedSpline::move(std::span<const Vec3> points, std::span<const std::uint32_t> moved) {
  const std::size_t count = runs_u_.size() * runs_v_.size(), in_row = runs_v_.size(), columns = rows_.v().span_count();
  if (points.size() != count)
    return {StatusCode::count_mismatch,
            "the spline has " + counted(count, "control point") + ", found " + std::to_string(points.size())};
  for (const std::uint32_t point : moved)
    if (point >= count)
      return {StatusCode::invalid_argument,
              "there is no control point " + std::to_string(point) + " in a spline of " + std::to_string(count)};
  const bool any = moved.empty();
  rows_.set_points(points, any || !is_known_);
  std::ranges::fill(is_touched_, std::uint8_t{any});
  std::ranges::fill(is_row_moved_, std::uint8_t{any || !is_known_});
  for (const std::uint32_t point : moved) {
    const Run u = runs_u_[point / in_row], v = runs_v_[point % in_row];
    is_row_moved_[point / in_row] = 1;
    for (std::size_t a = u.first; a < u.last; ++a)
      std::fill_n(is_touched_.begin() + static_cast<std::ptrdiff_t>(a * columns + v.first), v.last - v.first, 1);
  }
  for (std::size_t a = 0; a + 1 < first_touched_.size(); ++a) {
    const auto row = is_touched_.begin() + static_cast<std::ptrdiff_t>(a * columns);
    const auto touched = std::count(row, row + static_cast<std::ptrdiff_t>(columns), 1);
    first_touched_[a + 1] = first_touched_[a] + static_cast<std::size_t>(touched);
  }
  is_known_ = true;
  return {};
}

Status EditedSpline::convert(std::uint32_t* patches, Vec3* points, const Execution& execution) {
  constexpr std::size_t points_per_task = 4096, patches_per_task = 256;
  const std::size_t columns = rows_.v().span_count();
  const Execution quiet{.cancel = execution.cancel};
  const auto extract = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_row_moved_[i]) rows_.compute(i, numbers_.data() + i * runs_v_.size() * rows_.components());
  };
  Status status = parallel_for(is_row_moved_.size(), 1 + points_per_task / runs_v_.size(), quiet, extract);
  if (!status.ok()) return status;
  return parallel_for(rows_.u().span_count(), 1 + patches_per_task / columns, quiet,
                      [&](std::size_t begin, std::size_t end) {
                        alignas(cache_line) std::array<double, stack_numbers> memory;
                        Strip strip(rows_, strip_patches_, memory.data());
                        for (std::size_t a = begin; a < end; ++a) convert_row(a, strip, patches, points);
                      });
}

void EditedSpline::convert_row(std::size_t a, Strip& strip, std::uint32_t* patches, Vec3* points) const {
  const std::size_t columns = rows_.v().span_count();
  const std::uint8_t* const touched = is_touched_.data() + a * columns;
  std::size_t next = first_touched_[a];
  for (std::size_t b = 0; b < columns; ++b) {
    if (!touched[b]) continue;
    std::size_t end = b + 1;
    while (end < columns && touched[end] && end - b < strip_patches_) ++end;
    strip.select(b, end);
    strip.compute(a, false);
    with_order(surface_.degree_v(), [&](auto order) {
      for (std::size_t k = b; k < end; ++k, ++next) {
        patches[next] = static_cast<std::uint32_t>(a * columns + k);
        strip.write(k, order, points + next * patch_points());
      }
    });
    b = end - 1;
  }
}

}}  // namespace tessera::abi_0_1
