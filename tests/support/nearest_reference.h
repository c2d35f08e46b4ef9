#pragma once
// The distance of a point from patches by branch and bound on the squared distance as a Bernstein polynomial: slow, and
// without any of the engine's code for it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/bezier_patch.h"

namespace tessera::test {

/// The numerator and the denominator of the squared distance over a part of a patch, `[i][j]`, of twice its degrees.
struct SquaredDistance {
  int m = 0, n = 0;
  std::vector<long double> numerator, denominator;

  SquaredDistance(const BezierPatch& patch, const Vec3& point) : m(2 * patch.degree_u()), n(2 * patch.degree_v()) {
    const int p = patch.degree_u(), q = patch.degree_v();
    const auto choose = [](int of, int k) {
      long double value = 1;
      for (int i = 1; i <= k; ++i) value = value * (of - k + i) / i;
      return value;
    };
    numerator.assign(std::size_t(m + 1) * std::size_t(n + 1), 0), denominator = numerator;
    for (int i = 0; i <= p; ++i)
      for (int j = 0; j <= q; ++j)
        for (int k = 0; k <= p; ++k)
          for (int l = 0; l <= q; ++l) {
            const long double share = choose(p, i) * choose(p, k) / choose(m, i + k) * choose(q, j) * choose(q, l) /
                                      choose(n, j + l) * patch.weight(i, j) * patch.weight(k, l);
            const Vec3 a = patch.point(i, j) - point, b = patch.point(k, l) - point;
            const long double ax = a.x, ay = a.y, az = a.z;
            const long double product = ax * b.x + ay * b.y + az * b.z;
            numerator[at(i + k, j + l)] += share * product;
            denominator[at(i + k, j + l)] += share;
          }
  }
  std::size_t at(int i, int j) const { return std::size_t(i) * std::size_t(n + 1) + std::size_t(j); }
  long double corner(int i, int j) const { return numerator[at(i, j)] / denominator[at(i, j)]; }
  long double least_corner() const { return std::min({corner(0, 0), corner(m, 0), corner(0, n), corner(m, n)}); }
  /// Whether the square is nowhere below a value.
  bool is_above(long double square) const {
    for (std::size_t k = 0; k < numerator.size(); ++k)
      if (numerator[k] < square * denominator[k]) return false;
    return true;
  }
  /// Cuts at 1/2 along u or v; this becomes the first half.
  SquaredDistance halve(bool along_u) {
    SquaredDistance other = *this;
    const int last = along_u ? m : n, lines = along_u ? n : m;
    const auto cut = [&](std::vector<long double>& lower, std::vector<long double>& upper) {
      std::vector<long double> row(std::size_t(last) + 1);
      for (int line = 0; line <= lines; ++line) {
        const auto place = [&](int k) { return along_u ? at(k, line) : at(line, k); };
        for (int k = 0; k <= last; ++k) row[std::size_t(k)] = upper[place(k)];
        for (int level = 0; level <= last; ++level) {
          lower[place(level)] = row[0];
          upper[place(last - level)] = row[std::size_t(last - level)];
          for (int k = 0; k < last - level; ++k)
            row[std::size_t(k)] = (row[std::size_t(k)] + row[std::size_t(k) + 1]) / 2;
        }
      }
    };
    cut(numerator, other.numerator), cut(denominator, other.denominator);
    return other;
  }
};

/// A part of a patch, from (u0, v0) to (u1, v1).
struct ReferencePart {
  SquaredDistance square;
  const BezierPatch* patch;  ///< relative to the point
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  int depth = 0;

  /// Cuts it in half; this becomes the first half.
  ReferencePart halve() {
    const bool along_u = depth % 2 == 0;
    ReferencePart other{square.halve(along_u), patch, u0, u1, v0, v1, ++depth};
    if (along_u)
      u1 = other.u0 = 0.5 * (u0 + u1);
    else
      v1 = other.v0 = 0.5 * (v0 + v1);
    return other;
  }
};

/// Returns a patch relative to a point.
inline BezierPatch relative_to(const BezierPatch& patch, const Vec3& point) {
  std::vector<Vec3> points;
  for (const Vec3& p : patch.points()) points.push_back(p - point);
  const int m = patch.degree_u(), n = patch.degree_v();
  return patch.is_rational() ? value_of(BezierPatch::rational(m, n, points, patch.weights()))
                             : value_of(BezierPatch::polynomial(m, n, points));
}

/// Returns the distance of the nearest of all points that the search meets. None is nearer whose square is smaller by
/// more than `gap`, or by the rounding of squares, unless parts have become too many.
inline double reference_distance(const std::vector<BezierPatch>& patches, const Vec3& point, double gap,
                                 std::size_t max_parts = 100000) {
  std::vector<BezierPatch> from_point;
  for (const BezierPatch& patch : patches) from_point.push_back(relative_to(patch, point));
  std::vector<ReferencePart> left;
  long double best = std::numeric_limits<long double>::infinity();
  double distance = std::numeric_limits<double>::infinity();
  // The distance is taken from the patch itself: a square is rounded to 1e-19, its root to 3e-10.
  const auto look_at_corners = [&](const ReferencePart& part) {
    const SquaredDistance& s = part.square;
    const auto look = [&](int i, int j, double u, double v) {
      if (!(s.corner(i, j) < best)) return;
      best = s.corner(i, j);
      distance = length(de_casteljau(*part.patch, u, v));
    };
    look(0, 0, part.u0, part.v0), look(s.m, 0, part.u1, part.v0);
    look(0, s.n, part.u0, part.v1), look(s.m, s.n, part.u1, part.v1);
  };
  for (std::size_t k = 0; k < patches.size(); ++k) {
    left.push_back({SquaredDistance(patches[k], point), &from_point[k]});
    look_at_corners(left.back());
  }
  std::ranges::sort(left, {}, [](const ReferencePart& part) { return -part.square.least_corner(); });
  for (std::size_t parts = 0; !left.empty() && parts < max_parts; ++parts) {
    ReferencePart part = std::move(left.back());
    left.pop_back();
    look_at_corners(part);
    if (part.depth > 110 || part.square.is_above(std::max(best - gap, 0.0L))) continue;
    ReferencePart other = part.halve();
    if (part.square.least_corner() < other.square.least_corner()) std::swap(part, other);
    left.push_back(std::move(part)), left.push_back(std::move(other));
  }
  return distance;
}

}  // namespace tessera::test
