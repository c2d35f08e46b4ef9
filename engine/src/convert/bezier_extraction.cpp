#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/guard.h"
#include "convert/extraction.h"
#include "convert/spline_net.h"
#include "surface/homogeneous.h"
#include "surface/patch_pieces.h"
#include "surface/spline_lines.h"
#include "tessera/spline_convert.h"

namespace tessera {
namespace {

/// values[0..width) = sum of the row's weights times `rows`, which lie `stride` apart.
void apply(const Extraction& extraction, const Extraction::Row& row, const double* rows, std::size_t stride,
           std::size_t width, double* values) {
  const double* from = rows + row.first * stride;
  if (row.count == 1) {
    std::copy_n(from, width, values);
    return;
  }
  const double* weights = extraction.weights_of(row);
  const double first = weights[0], second = weights[1];
  for (std::size_t x = 0; x < width; ++x) values[x] = first * from[x] + second * from[stride + x];
  for (std::size_t k = 2; k < row.count; ++k) {
    const double weight = weights[k];
    const double* next = from + k * stride;
    for (std::size_t x = 0; x < width; ++x) values[x] += weight * next[x];
  }
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

/// The Bezier points of a surface, one strip of patches after the other, each point computed once: neighbours share it.
class Strips {
 public:
  explicit Strips(const BSplineSurface& surface)
      : surface_(surface), u_(make_extraction(line_u(surface))), v_(make_extraction(line_v(surface))) {
    if (surface.is_rational()) scales_.emplace(surface.points(), surface.weights());
    const std::size_t c = components();
    const std::vector<double> net = numbers(surface.points(), surface.weights(), scales_ ? &*scales_ : nullptr);
    along_v_.resize(surface.count_u() * row_size());
    for (std::size_t i = 0; i < surface.count_u(); ++i)
      for (std::size_t r = 0; r < v_.rows.size(); ++r)
        apply(v_, v_.rows[r], &net[i * surface.count_v() * c], c, c, &along_v_[i * row_size() + r * c]);
    strip_.resize(order_u() * row_size());
    for (const Vec3& p : surface.points())
      may_overflow_ = may_overflow_ || max_abs(p) > std::numeric_limits<double>::max() / 2;
    if (!scales_) return;
    projected_.resize(order_u() * v_.rows.size() * 3);
    projected_weights_.resize(order_u() * v_.rows.size());
  }

  const Extraction& u() const { return u_; }
  const Extraction& v() const { return v_; }

  /// Writes the patches of span `a` of u. Spans come in order.
  Status write(std::size_t a, PatchPieces& pieces) {
    const std::size_t p = order_u() - 1, size = row_size(), first = a > 0 ? 1 : 0;
    if (a > 0) std::copy_n(strip_.end() - static_cast<std::ptrdiff_t>(size), size, strip_.begin());
    for (std::size_t i = first; i <= p; ++i)
      apply(u_, u_.rows[a * p + i], along_v_.data(), size, size, &strip_[i * size]);
    if (scales_) project_strip(a);
    if (may_overflow_ && !all_finite(scales_ ? projected_ : strip_))
      return {StatusCode::non_finite, "the control points are too large: a mean of them is not finite"};
    for (std::size_t b = 0; b < v_.span_count(); ++b) write_patch(a * v_.span_count() + b, b, pieces);
    return {};
  }

 private:
  std::size_t components() const { return scales_ ? 4 : 3; }
  std::size_t row_size() const { return v_.rows.size() * components(); }
  std::size_t order_u() const { return static_cast<std::size_t>(surface_.degree_u()) + 1; }
  std::size_t order_v() const { return static_cast<std::size_t>(surface_.degree_v()) + 1; }

  void project_strip(std::size_t a) {
    const std::size_t p = order_u() - 1;
    for (std::size_t i = 0; i <= p; ++i)
      for (std::size_t r = 0; r < v_.rows.size(); ++r) {
        const Extraction::Row &row = u_.rows[a * p + i], &column = v_.rows[r];
        NetPoint at = project(&strip_[i * row_size() + r * 4], *scales_);
        if (row.count == 1 && column.count == 1)  // keeps its bits, and its weight's
          at = {surface_.point(row.first, column.first), surface_.weight(row.first, column.first)};
        const std::size_t k = i * v_.rows.size() + r;
        projected_[3 * k] = at.point.x;
        projected_[3 * k + 1] = at.point.y;
        projected_[3 * k + 2] = at.point.z;
        projected_weights_[k] = at.weight;
      }
  }

  void write_patch(std::size_t patch, std::size_t b, PatchPieces& pieces) const {
    const std::size_t order = order_v(), rows = v_.rows.size();
    const std::vector<double>& points = scales_ ? projected_ : strip_;
    for (std::size_t i = 0; i < order_u(); ++i) {
      const std::size_t k = i * rows + b * (order - 1);
      const double* from = &points[3 * k];
      Vec3* to = pieces.points(patch) + i * order;
      std::memcpy(static_cast<void*>(to), from, order * sizeof(Vec3));
      if (scales_) std::copy_n(&projected_weights_[k], order, pieces.weights(patch) + i * order);
    }
  }

  const BSplineSurface& surface_;
  const Extraction u_, v_;
  std::optional<Scales> scales_;                       ///< of rational surfaces
  std::vector<double> along_v_;                        ///< [control row][row of v_][component]
  std::vector<double> strip_;                          ///< [0 .. degree_u][row of v_][component]
  bool may_overflow_ = false;                          ///< means of points are no larger than these but for rounding
  std::vector<double> projected_, projected_weights_;  ///< of rational surfaces: the strip as points and weights
};

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
    Strips strips(surface);
    PatchPieces pieces(surface.degree_u(), surface.degree_v(), strips.u().span_count() * strips.v().span_count(),
                       surface.is_rational());
    for (std::size_t a = 0; a < strips.u().span_count(); ++a)
      if (Status status = strips.write(a, pieces); !status.ok()) return status;
    return PatchGrid::make(strips.u().breaks, strips.v().breaks, pieces.take());
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
