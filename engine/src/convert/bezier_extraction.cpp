#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "base/aligned.h"
#include "base/guard.h"
#include "convert/extraction.h"
#include "convert/spline_net.h"
#include "surface/homogeneous.h"
#include "surface/patch_pieces.h"
#include "surface/spline_lines.h"
#include "tessera/spline_convert.h"

namespace tessera {
namespace {

/// values[0..width) = sum of `count` weights times `rows`, which lie `stride` apart. In one pass, which keeps sums in
/// registers.
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

/// values[0..width) = sum of the row's weights times `rows`, which lie `stride` apart. Width: std::size_t, or a constant
/// where it is small.
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

/// What brings points and weights near 1, so that products of them neither over- nor underflow: powers of two.
struct Scales {
  double point = 1, weight = 1;

  Scales(std::span<const Vec3> points, std::span<const double> weights) {
    double largest = 0;
    for (const Vec3& p : points) largest = std::max(largest, max_abs(p));
    point = power_of_two_near(largest);
    weight = power_of_two_near(*std::max_element(weights.begin(), weights.end()));
  }
};

/// The control points as numbers, `components` each: x y z, or x w, y w, z w, w scaled.
std::vector<double> numbers(std::span<const Vec3> points, std::span<const double> weights, const Scales* scales) {
  std::vector<double> values;
  values.reserve(points.size() * (scales != nullptr ? 4 : 3));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double w = scales != nullptr ? weights[k] / scales->weight : 1;
    const Vec3 p = scales != nullptr ? w * ((1 / scales->point) * points[k]) : points[k];
    values.insert(values.end(), {p.x, p.y, p.z});
    if (scales != nullptr) values.push_back(w);
  }
  return values;
}

NetPoint project(const double* values, const Scales& scales) {
  const Homogeneous h{values[0], values[1], values[2], values[3]};
  return {scales.point * h.project(), scales.weight * h.w};
}

bool all_finite(std::span<const double> values) {
  bool finite = true;
  for (const double x : values) finite &= std::abs(x) <= std::numeric_limits<double>::max();
  return finite;
}

/// The Bezier net of a surface, one strip of patches after the other: each point computed once, since neighbours share
/// it.
class NetStrips {
 public:
  explicit NetStrips(const BSplineSurface& surface)
      : surface_(surface), u_(make_extraction(line_u(surface))), v_(make_extraction(line_v(surface))) {
    if (surface.is_rational()) {
      scales_.emplace(surface.points(), surface.weights());
      extract_along_v(std::integral_constant<std::size_t, 4>{});
      homogeneous_.resize(v_.rows.size() * 4);
      weights_.resize(order_u() * v_.rows.size());
    } else {
      extract_along_v(std::integral_constant<std::size_t, 3>{});
    }
    points_.resize(order_u() * v_.rows.size() * 3);
    for (const Vec3& p : surface.points())
      may_overflow_ = may_overflow_ || max_abs(p) > std::numeric_limits<double>::max() / 2;
  }

  const Extraction& u() const { return u_; }
  const Extraction& v() const { return v_; }

  /// Computes the strip of span `a` of u. Strips come in order.
  Status compute(std::size_t a) {
    const std::size_t p = order_u() - 1;
    if (a > 0) {  // the last row of a strip is the first of the next
      std::copy(points_.end() - static_cast<std::ptrdiff_t>(v_.rows.size() * 3), points_.end(), points_.begin());
      if (scales_)
        std::copy(weights_.end() - static_cast<std::ptrdiff_t>(v_.rows.size()), weights_.end(), weights_.begin());
    }
    for (std::size_t i = a > 0 ? 1 : 0; i <= p; ++i) compute_row(u_.rows[a * p + i], i);
    if (may_overflow_ && !all_finite(points_))
      return {StatusCode::non_finite, "the control points are too large: a mean of them is not finite"};
    return {};
  }
  /// Point j of row i of the strip: x, y and z; and its weight if the surface is rational.
  const double* point(std::size_t i, std::size_t j) const { return &points_[(i * v_.rows.size() + j) * 3]; }
  const double* weight(std::size_t i, std::size_t j) const { return &weights_[i * v_.rows.size() + j]; }

 private:
  std::size_t order_u() const { return static_cast<std::size_t>(surface_.degree_u()) + 1; }

  template <class Components>
  void extract_along_v(Components c) {
    const std::vector<double> net = numbers(surface_.points(), surface_.weights(), scales_ ? &*scales_ : nullptr);
    along_v_.resize(surface_.count_u() * v_.rows.size() * c);
    double* to = along_v_.data();
    for (std::size_t i = 0; i < surface_.count_u(); ++i)
      for (const Extraction::Row& row : v_.rows) {
        apply(v_, row, &net[i * surface_.count_v() * c], c, c, to);
        to += c;
      }
  }

  void compute_row(const Extraction::Row& row, std::size_t i) {
    const std::size_t size = v_.rows.size();
    if (!scales_) return apply(u_, row, along_v_.data(), 3 * size, 3 * size, &points_[i * 3 * size]);
    apply(u_, row, along_v_.data(), 4 * size, 4 * size, homogeneous_.data());
    for (std::size_t j = 0; j < size; ++j) {
      const Extraction::Row& column = v_.rows[j];
      NetPoint at = project(&homogeneous_[4 * j], *scales_);
      if (row.count == 1 && column.count == 1)  // keeps its bits, and its weight's
        at = {surface_.point(row.first, column.first), surface_.weight(row.first, column.first)};
      const double point[] = {at.point.x, at.point.y, at.point.z};
      std::copy_n(point, 3, &points_[(i * size + j) * 3]);
      weights_[i * size + j] = at.weight;
    }
  }

  const BSplineSurface& surface_;
  const Extraction u_, v_;
  std::optional<Scales> scales_;          ///< of rational surfaces
  UnsetVector<double> along_v_;           ///< [control row][row of v_][component]
  UnsetVector<double> points_, weights_;  ///< [0 .. degree_u][row of v_], the points by their components
  UnsetVector<double> homogeneous_;       ///< one row of a rational strip
  bool may_overflow_ = false;             ///< means of points are no larger than these but for rounding
};

/// The patches of a strip from `first` on. Order: std::size_t, or a constant, with which a row of points is copied in a
/// few instructions.
template <class Order>
void write_strip(const NetStrips& net, std::size_t first, std::size_t order_u, Order order, PatchPieces& pieces) {
  for (std::size_t b = 0; b < net.v().span_count(); ++b) {
    Vec3* points = pieces.points(first + b);
    const std::size_t column = b * (order - 1);
    for (std::size_t i = 0; i < order_u; ++i)
      std::memcpy(static_cast<void*>(points + i * order), net.point(i, column), order * sizeof(Vec3));
    if (!pieces.rational()) continue;
    for (std::size_t i = 0; i < order_u; ++i)
      std::copy_n(net.weight(i, column), std::size_t{order}, pieces.weights(first + b) + i * order);
  }
}

/// write(order), order being a constant for the degrees that are met most.
template <class Write>
void with_order(int degree, Write write) {
  if (degree == 1) return write(std::integral_constant<std::size_t, 2>{});
  if (degree == 2) return write(std::integral_constant<std::size_t, 3>{});
  if (degree == 3) return write(std::integral_constant<std::size_t, 4>{});
  write(static_cast<std::size_t>(degree) + 1);
}

Status write_patches(NetStrips& net, int degree_u, int degree_v, PatchPieces& pieces) {
  for (std::size_t a = 0; a < net.u().span_count(); ++a) {
    if (Status status = net.compute(a); !status.ok()) return status;
    with_order(degree_v, [&](auto order) {
      write_strip(net, a * net.v().span_count(), static_cast<std::size_t>(degree_u) + 1, order, pieces);
    });
  }
  return {};
}

/// The patches, of those between `breaks`, whose spans point i acts on: [u_i, u_{i+p+1}].
std::pair<std::size_t, std::size_t> touched(const KnotLine& line, std::size_t i) {
  const std::vector<std::size_t> spans = distinct_spans(line);
  const auto first = std::lower_bound(spans.begin(), spans.end(), i);
  const auto last = std::upper_bound(spans.begin(), spans.end(), i + static_cast<std::size_t>(line.degree));
  return {static_cast<std::size_t>(first - spans.begin()), static_cast<std::size_t>(last - spans.begin())};
}

}  // namespace

Result<PatchGrid> to_bezier(const BSplineSurface& surface) {
  return guarded([&]() -> Result<PatchGrid> {
    NetStrips net(surface);
    PatchPieces pieces(surface.degree_u(), surface.degree_v(), net.u().span_count() * net.v().span_count(),
                       surface.is_rational());
    if (Status status = write_patches(net, surface.degree_u(), surface.degree_v(), pieces); !status.ok()) return status;
    return PatchGrid::make(net.u().breaks, net.v().breaks, pieces.take());
  });
}

Result<BezierPieces> to_bezier(const Curve& curve) {
  return guarded([&]() -> Result<BezierPieces> {
    const Extraction extraction = make_extraction(line_of(curve));
    BezierPieces pieces{curve.degree(), extraction.breaks, {}, {}};
    std::optional<Scales> scales;
    if (curve.is_rational()) scales.emplace(curve.points(), curve.weights());
    const std::vector<double> net = numbers(curve.points(), curve.weights(), scales ? &*scales : nullptr);
    const std::size_t width = scales ? 4 : 3;
    for (const Extraction::Row& row : extraction.rows) {
      std::array<double, 4> values{};
      apply(extraction, row, net.data(), width, width, values.data());
      NetPoint at{{values[0], values[1], values[2]}, 1};
      if (scales) at = project(values.data(), *scales);
      if (row.count == 1) at = {curve.points()[row.first], curve.weight(row.first)};  // keeps its bits
      pieces.points.push_back(at.point);
      if (scales) pieces.weights.push_back(at.weight);
    }
    return pieces;
  });
}

Result<PatchRange> touched_patches(const BSplineSurface& surface, std::size_t i, std::size_t j) {
  return guarded([&]() -> Result<PatchRange> {
    if (i >= surface.count_u() || j >= surface.count_v())
      return Status(StatusCode::invalid_argument, "there is no control point [" + std::to_string(i) + "][" +
                                                      std::to_string(j) + "] in " + std::to_string(surface.count_u()) +
                                                      " x " + std::to_string(surface.count_v()));
    const auto [a0, a1] = touched(line_u(surface), i);
    const auto [b0, b1] = touched(line_v(surface), j);
    return PatchRange{a0, a1, b0, b1};
  });
}

}  // namespace tessera
