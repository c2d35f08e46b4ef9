#pragma once
// Smooth curves followed by polynomials of a high degree.

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "base/internal_export.h"
#include "basis/bernstein.h"
#include "basis/chebyshev_lobatto.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Tables of interpolation at Chebyshev-Lobatto parameters.
struct LobattoTables {
  explicit LobattoTables(int degree);
  TESSERA_INTERNAL_EXPORT static const LobattoTables& of_degree_7();

  int degree;
  std::vector<double> nodes;      ///< in [0,1], with both ends
  std::vector<double> bernstein;  ///< `[point][node]`: control points of values at the nodes
  std::vector<double> checks;     ///< parameters between nodes, where interpolants err most
  std::vector<double> at_checks;  ///< `[check][point]`: Bernstein polynomials there
};

/// Polynomials in Bezier form, each of which begins where the one before it ends, at the parameters of the curve that
/// they follow.
class LobattoFit {
 public:
  static constexpr int degree = 7;

  /// Follows a curve along an interval, where the polynomials before it end.
  ///
  /// - `at(t)`: the point at a parameter.
  /// - `is_near(a, b)`: whether two points are near enough.
  /// - `breaks`: the ends of the interval and the parameters between them where the curve is less smooth, in order. An
  ///   interval is divided at the middle one, or else halved at most 10 times, until the polynomial is near. After
  ///   2000 points no interval is halved.
  template <class At, class IsNear>
  void follow(const At& at, const IsNear& is_near, std::span<const double> breaks) {
    const double from = breaks.front(), to = breaks.back();
    if (points_.empty()) {
      points_.push_back(at(from));
      knots_.assign(degree + 1, from);
    }
    append(at, is_near, breaks, {points_.back(), at(to)}, 0);
  }

  /// Returns the polynomials as a spline. Errors: non_finite (points).
  Result<Curve> curve() && {
    knots_.push_back(knots_.back());
    return Curve::b_spline(degree, points_, knots_);
  }
  bool is_exact_enough() const { return fits_; }  ///< whether all intervals became near

 private:
  static constexpr int max_depth = 10;
  static constexpr std::size_t max_points = 2000;
  struct Ends {
    Vec3 first, last;
  };

  template <class At, class IsNear>
  void append(const At& at, const IsNear& is_near, std::span<const double> breaks, const Ends& ends, int depth) {
    const LobattoTables& tables = LobattoTables::of_degree_7();
    const double from = breaks.front(), to = breaks.back();
    const auto place = [&](double x) { return from + x * (to - from); };
    std::vector<Vec3> values(degree + 1), points(degree + 1);
    values.front() = ends.first, values.back() = ends.last;
    for (std::size_t k = 1; k < degree; ++k) values[k] = at(place(tables.nodes[k]));
    for (std::size_t i = 0; i <= degree; ++i)
      for (std::size_t k = 0; k <= degree; ++k) points[i] += tables.bernstein[i * (degree + 1) + k] * values[k];
    points.front() = ends.first, points.back() = ends.last;
    bool fits = true;
    for (std::size_t c = 0; c < tables.checks.size() && fits; ++c) {
      Vec3 there;
      for (std::size_t i = 0; i <= degree; ++i) there += tables.at_checks[c * (degree + 1) + i] * points[i];
      fits = is_near(there, at(place(tables.checks[c])));
    }
    const bool has_break = breaks.size() > 2;
    if (fits || (!has_break && (depth == max_depth || points_.size() > max_points))) {
      fits_ = fits_ && fits;
      points_.insert(points_.end(), points.begin() + 1, points.end());
      knots_.insert(knots_.end(), degree, to);
      return;
    }
    const std::size_t middle = breaks.size() / 2;
    const double cut = has_break ? breaks[middle] : 0.5 * (from + to);
    const std::vector<double> halves{from, cut, to};
    const std::span<const double> first = has_break ? breaks.first(middle + 1) : std::span(halves).first(2);
    const std::span<const double> second = has_break ? breaks.subspan(middle) : std::span(halves).last(2);
    const int deeper = has_break ? depth : depth + 1;
    const Vec3 between = at(cut);
    append(at, is_near, first, {ends.first, between}, deeper);
    append(at, is_near, second, {between, ends.last}, deeper);
  }

  std::vector<Vec3> points_;
  std::vector<double> knots_;
  bool fits_ = true;
};

}}  // namespace tessera::abi_0_1
