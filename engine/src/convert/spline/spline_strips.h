#pragma once
// The Bezier points of a spline surface: its control net extracted along v, then strip by strip along u.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "base/aligned.h"
#include "convert/spline/extraction.h"
#include "convert/spline/spline_net.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "surface/net/homogeneous.h"
#include "surface/net/patch_pieces.h"
#include "surface/spline/spline_lines.h"
#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes values[0..width) = the sum of `count` weights times `rows`, which lie `stride` apart. One pass keeps the sums
/// in registers.
template <std::size_t count, class Width>
void combine(const double* weights, const double* rows, std::size_t stride, Width width, double* values) {
  std::array<double, count> w;
  std::copy_n(weights, count, w.begin());
  for (std::size_t x = 0; x < width; ++x) {
    double sum = w[0] * rows[x];
    for (std::size_t k = 1; k < count; ++k) sum += w[k] * rows[k * stride + x];
    values[x] = sum;
  }
}

/// Writes values[0..width) = the sum of the row's weights times `rows`, which lie `stride` apart. Width is std::size_t
/// or a constant.
template <class Width>
void apply(const Extraction& extraction, const Extraction::Row& row, const double* rows, std::size_t stride,
           Width width, double* values) {
  const double* from = rows + row.first * stride;
  const double* weights = extraction.weights_of(row);
  if (row.count == 1) return static_cast<void>(std::copy_n(from, std::size_t{width}, values));
  if (row.count == 2) return combine<2>(weights, from, stride, width, values);
  if (row.count == 3) return combine<3>(weights, from, stride, width, values);
  combine<4>(weights, from, stride, width, values);
  for (std::size_t k = 4; k < row.count; ++k)
    for (std::size_t x = 0; x < width; ++x) values[x] += weights[k] * from[k * stride + x];
}

/// Powers of two that bring points and weights near 1, so that their products neither overflow nor underflow.
struct Scales {
  double point = 1, weight = 1;

  Scales(std::span<const Vec3> points, std::span<const double> weights) {
    double largest = 0;
    for (const Vec3& p : points) largest = std::max(largest, max_abs(p));
    point = power_of_two_near(largest);
    weight = power_of_two_near(*std::max_element(weights.begin(), weights.end()));
  }
};

/// Writes each control point as numbers: x y z, or x w, y w, z w, w, both scaled.
inline void write_numbers(std::span<const Vec3> points, std::span<const double> weights, const Scales* scales,
                          double* to) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double w = scales != nullptr ? weights[k] / scales->weight : 1;
    const Vec3 p = scales != nullptr ? w * ((1 / scales->point) * points[k]) : points[k];
    for (const double value : {p.x, p.y, p.z}) *to++ = value;
    if (scales != nullptr) *to++ = w;
  }
}

inline NetPoint project(const double* values, const Scales& scales) {
  const Homogeneous h{values[0], values[1], values[2], values[3]};
  return {scales.point * h.project(), scales.weight * h.w};
}

inline bool all_finite(std::span<const double> values) {
  bool finite = true;
  for (const double x : values) finite &= std::abs(x) <= std::numeric_limits<double>::max();
  return finite;
}

/// Rounds up to the numbers of whole cache lines, so that each row begins on a line and vector loads do not split.
constexpr std::size_t whole_lines(std::size_t numbers) {
  constexpr std::size_t line = cache_line / sizeof(double);
  return (numbers + line - 1) / line * line;
}

/// A surface's control net extracted along v, the input of all strips of patches.
class ExtractedRows {
 public:
  /// The surface's points and weights are used until set_points().
  explicit ExtractedRows(const BSplineSurface& surface)
      : surface_(surface),
        points_(surface.points()),
        u_(make_extraction(line_u(surface))),
        v_(make_extraction(line_v(surface))) {
    if (surface.is_rational()) scales_.emplace(points_, surface.weights());
    values_.resize(surface.count_u() * row_size());
  }

  /// Takes other control points, as many as the surface has, which must live as long as they are used. `all`: each row
  /// is computed anew; if false, the others keep the scale that they were computed with.
  void set_points(std::span<const Vec3> points, bool all) {
    points_ = points;
    if (scales_ && all) scales_.emplace(points, surface_.weights());
  }
  /// Computes all rows.
  Status compute() {
    constexpr std::size_t points_in_piece = 4096;
    return parallel_for(surface_.count_u(), points_in_piece / v_.rows.size(), {},
                        [&](std::size_t begin, std::size_t end) {
                          UnsetVector<double> numbers(surface_.count_v() * components());
                          for (std::size_t i = begin; i < end; ++i) compute(i, numbers.data());
                        });
  }
  /// Computes the row of the control points [i][..]; different rows on any threads. `numbers`: memory for its
  /// components.
  void compute(std::size_t i, double* numbers) {
    if (scales_) return compute(i, numbers, std::integral_constant<std::size_t, 4>{});
    compute(i, numbers, std::integral_constant<std::size_t, 3>{});
  }

  const BSplineSurface& surface() const { return surface_; }
  std::span<const Vec3> points() const { return points_; }
  const Extraction& u() const { return u_; }
  const Extraction& v() const { return v_; }
  const std::optional<Scales>& scales() const { return scales_; }
  bool may_overflow() const { return may_overflow_; }
  std::size_t order_u() const { return static_cast<std::size_t>(surface_.degree_u()) + 1; }
  std::size_t components() const { return scales_ ? 4 : 3; }
  std::size_t row_size() const { return whole_lines(v_.rows.size() * components()); }
  const double* values() const { return values_.data(); }

 private:
  static constexpr double half_range = std::numeric_limits<double>::max() / 2;

  template <class Components>
  void compute(std::size_t i, double* numbers, Components c) {
    const std::size_t count = surface_.count_v();
    const std::span<const Vec3> points = points_.subspan(i * count, count);
    int large = 0;
    for (const Vec3& p : points)  // without a branch
      for (const double x : {p.x, p.y, p.z}) large |= std::abs(x) > half_range;
    if (large) may_overflow_ = true;
    const auto weights = scales_ ? surface_.weights().subspan(i * count, count) : std::span<const double>{};
    write_numbers(points, weights, scales_ ? &*scales_ : nullptr, numbers);
    double* to = values_.data() + i * row_size();
    for (const Extraction::Row& row : v_.rows) {
      apply(v_, row, numbers, c, c, to);
      to += c;
    }
  }

  const BSplineSurface& surface_;
  std::span<const Vec3> points_;  ///< `[i][j]`
  const Extraction u_, v_;
  std::optional<Scales> scales_;            ///< only for rational surfaces
  UnsetVector<double> values_;              ///< [control row][row of v_][component], rows row_size() apart
  std::atomic<bool> may_overflow_ = false;  ///< true if a mean may overflow: means exceed the points at most by
                                            ///< rounding
};

/// The Bezier net of up to max_patches patches along v, computed for one strip after the other along u. Each point is
/// computed once, since neighbours share it, and is written while it is in the nearest cache.
class Strip {
 public:
  static constexpr std::size_t max_patches = 64;
  /// Returns how many numbers of memory a strip of up to max_patches patches needs.
  static std::size_t memory_size(const ExtractedRows& rows, std::size_t patches) {
    const std::size_t columns = max_columns(rows, patches);
    return rows.order_u() * (whole_lines(columns * 3) + columns) + 4 * columns;
  }

  /// `memory`: of memory_size(), from the beginning of a cache line on, which must outlive the strip.
  Strip(const ExtractedRows& rows, std::size_t patches, double* memory) : from_(rows) {
    const std::size_t columns = max_columns(rows, patches);
    row_size_ = whole_lines(columns * 3);
    points_ = memory;
    weights_ = points_ + rows.order_u() * row_size_;
    homogeneous_ = weights_ + rows.order_u() * columns;
    std::ranges::fill(bounds_.lower, std::numeric_limits<double>::infinity());
    std::ranges::fill(bounds_.upper, -std::numeric_limits<double>::infinity());
  }

  /// Selects the spans from b_begin to b_end of v, at most max_patches.
  void select(std::size_t b_begin, std::size_t b_end) {
    b_begin_ = b_begin;
    b_end_ = b_end;
    columns_ = (b_end - b_begin) * degree_v() + 1;
  }
  /// Computes the strip of span `a` of u. `next` says that it follows the strip computed before.
  void compute(std::size_t a, bool next) {
    const std::size_t p = from_.order_u() - 1;
    if (next) {  // the last row of a strip is the first of the next
      std::copy_n(&points_[p * row_size_], columns_ * 3, points_);
      if (from_.scales()) std::copy_n(&weights_[p * columns_], columns_, weights_);
    }
    for (std::size_t i = next ? 1 : 0; i <= p; ++i) compute_row(from_.u().rows[a * p + i], i);
  }
  /// Returns the box of the points computed so far.
  Box3 box() const {
    Box3 box;
    for (std::size_t k = 0; k < kernel::PointBounds::run; k += 3) {
      const auto corner = [k](const auto& of) { return Vec3{of[k], of[k + 1], of[k + 2]}; };
      box.extend(Box3{corner(bounds_.lower), corner(bounds_.upper)});
    }
    return box;
  }
  bool is_finite() const { return finite_; }

  /// Writes the strip's patches; `first` is the index of the patch of the first span of v. Order is std::size_t, or a
  /// constant for which a row of points is copied in a few instructions.
  template <class Order>
  void write(std::size_t first, Order order, PatchPieces& pieces) const {
    for (std::size_t b = b_begin_; b < b_end_; ++b) {
      write(b, order, pieces.points(first + b));
      if (!pieces.rational()) continue;
      const std::size_t column = (b - b_begin_) * (order - 1);
      for (std::size_t i = 0; i < from_.order_u(); ++i)
        std::copy_n(&weights_[i * columns_ + column], std::size_t{order}, pieces.weights(first + b) + i * order);
    }
  }
  /// Writes the points of one patch, of span `b` of v.
  template <class Order>
  void write(std::size_t b, Order order, Vec3* points) const {
    const std::size_t column = (b - b_begin_) * (order - 1);
    for (std::size_t i = 0; i < from_.order_u(); ++i)
      std::memcpy(static_cast<void*>(points + i * order), &points_[i * row_size_ + column * 3], order * sizeof(Vec3));
  }

 private:
  static std::size_t max_columns(const ExtractedRows& rows, std::size_t patches) {
    return std::min(patches, rows.v().span_count()) * static_cast<std::size_t>(rows.surface().degree_v()) + 1;
  }
  std::size_t degree_v() const { return static_cast<std::size_t>(from_.surface().degree_v()); }

  void compute_row(const Extraction::Row& row, std::size_t i) {
    double* points = &points_[i * row_size_];
    combine(row, from_.scales() ? homogeneous_ : points);
    if (from_.scales()) project_row(row, points, &weights_[i * columns_]);
    kernels_.bound_points(points, columns_ * 3, bounds_);
    if (from_.may_overflow()) finite_ = finite_ && all_finite({points, columns_ * 3});
  }

  void combine(const Extraction::Row& row, double* to) const {
    const std::size_t components = from_.components(), width = columns_ * components;
    const double* rows = from_.values() + row.first * from_.row_size() + b_begin_ * degree_v() * components;
    if (row.count == 1) return static_cast<void>(std::copy_n(rows, width, to));
    kernels_.combine({from_.u().weights_of(row), row.count, rows, from_.row_size(), width, to});
  }

  void project_row(const Extraction::Row& row, double* points, double* weights) const {
    const BSplineSurface& surface = from_.surface();
    for (std::size_t j = 0; j < columns_; ++j) {
      const Extraction::Row& column = from_.v().rows[b_begin_ * degree_v() + j];
      NetPoint at = project(&homogeneous_[4 * j], *from_.scales());
      if (row.count == 1 && column.count == 1)  // keep the bits of the point and of its weight
        at = {from_.points()[row.first * surface.count_v() + column.first], surface.weight(row.first, column.first)};
      const double point[] = {at.point.x, at.point.y, at.point.z};
      std::copy_n(point, 3, points + 3 * j);
      weights[j] = at.weight;
    }
  }

  const ExtractedRows& from_;
  const kernel::KernelTable& kernels_ = kernel::default_kernels();
  std::size_t b_begin_ = 0, b_end_ = 0;
  std::size_t columns_ = 0, row_size_ = 0;
  double* points_;       ///< [0 .. degree_u][column][component], rows row_size_ apart
  double* weights_;      ///< [0 .. degree_u][column]
  double* homogeneous_;  ///< one row of a rational strip
  kernel::PointBounds bounds_;
  bool finite_ = true;
};

/// Returns the range of a direction's patches, by its distinct spans, that point i acts on: [u_i, u_{i+p+1}].
inline std::pair<std::size_t, std::size_t> touched_spans(std::span<const std::size_t> spans, int degree,
                                                         std::size_t i) {
  const auto first = std::lower_bound(spans.begin(), spans.end(), i);
  const auto last = std::upper_bound(spans.begin(), spans.end(), i + static_cast<std::size_t>(degree));
  return {static_cast<std::size_t>(first - spans.begin()), static_cast<std::size_t>(last - spans.begin())};
}

/// Calls write(order), with a constant order for the most frequent degrees.
template <class Write>
void with_order(int degree, Write write) {
  if (degree == 1) return write(std::integral_constant<std::size_t, 2>{});
  if (degree == 2) return write(std::integral_constant<std::size_t, 3>{});
  if (degree == 3) return write(std::integral_constant<std::size_t, 4>{});
  write(static_cast<std::size_t>(degree) + 1);
}

}}  // namespace tessera::abi_0_1
