#pragma once
// Rational patches of a block and the balls that hold their pieces, lanes = patches, for bounds on their second
// derivatives (tess/bounds/chord_bound.h). No multiply-add is fused, so that every instruction set finds the same
// bounds.
//
// Over a piece whose points lie within R of c and whose weights are at least w_min, second derivatives count as balls
// around (A'' - c w'') / w_min of radius R |w''| / w_min. A is the points times their weights, relative to the patch's
// centre.
//
// Rounding errors, in units of u = 2^-24 and of the block's unit, in which coefficients, points and weights are below
// 1; k = m + n:
// 1. A, packed and made relative: at most 5; its second differences, cut: 36 + 8 k.
// 2. Second differences of w, cut: 8 + 2 k.
// 3. A'' - c w'' with c below 2: (36 + 8 k) + 2 (8 + 2 k) + 16.
// 4. Cut weights: 1 + k; cut points: (13 + 4 k) / w_min.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/chord_kernel.inl.h"

template <class L>
class RationalNets {
 public:
  using Batch = typename L::Batch;
  static constexpr int capacity = max_rational_degree + 1, max_cut = 2 * capacity - 1;
  static constexpr float half = static_cast<float>(0.5), more = static_cast<float>(1 + 0x1p-20);

  /// A piece: its points are within `radius` of `centre`, relative to the patch's centre.
  struct Part {
    Batch lower[3], upper[3], centre[3], radius, lightest, inverse;
  };

  const int m, n, dimensions;
  const float slack, slope;  ///< errors of A'' - c w'' and of w''
  Batch size;                ///< the largest coordinate of a point, at least 2^-120
  Part parts[9];             ///< the whole, the halves of u, the halves of v, the quarters

  /// `space`: 3, or 2 where all z are 0; parts have none then.
  RationalNets(const float* block, int degree_u, int degree_v, int lane, int space = 3)
      : m(degree_u),
        n(degree_v),
        dimensions(space),
        slack(static_cast<float>(1.7321 * 0x1p-24) * static_cast<float>(68 + 12 * (m + n))),
        slope(static_cast<float>(0x1p-24) * static_cast<float>(8 + 2 * (m + n))) {
    coefficient_ = L::broadcast(static_cast<float>(0x1p-120));
    for (int k = 0; k < (m + 1) * (n + 1); ++k) {
      const float* const from = block + k * 4 * block_lanes + lane;
      net_[3][k] = L::load(from + 3 * block_lanes);
      const Batch inverse = L::broadcast(1) / net_[3][k];
      for (int c = 0; c < dimensions; ++c) {
        net_[c][k] = L::load(from + c * block_lanes);
        const Batch point = net_[c][k] * inverse;
        lower_[c] = k == 0 ? point : xsimd::min(lower_[c], point);
        upper_[c] = k == 0 ? point : xsimd::max(upper_[c], point);
        coefficient_ = xsimd::max(coefficient_, xsimd::abs(net_[c][k]));
      }
    }
    size = L::broadcast(static_cast<float>(0x1p-120));
    for (int c = 0; c < dimensions; ++c)
      size = xsimd::max(size, xsimd::max(xsimd::abs(lower_[c]), xsimd::abs(upper_[c])));
  }
  RationalNets(const RationalNets&) = delete;
  RationalNets& operator=(const RationalNets&) = delete;

  /// Returns the largest coordinate of points and coefficients.
  Batch largest() const { return xsimd::max(size, coefficient_); }
  /// Makes coefficients relative to the middle of the points' box and finds the parts. Call it once, with the inverse
  /// of the unit, a power of two above largest().
  void place(const Batch& scale) {
    for (int c = 0; c < dimensions; ++c) {
      const Batch middle = L::broadcast(half) * (scale * lower_[c]) + L::broadcast(half) * (scale * upper_[c]);
      for (int k = 0; k < (m + 1) * (n + 1); ++k) net_[c][k] = scale * net_[c][k] - net_[3][k] * middle;
    }
    find_parts();
  }

  /// Returns the points (0, 0), (1, 0), (1, 1), (0, 1), relative to the patch's middle.
  void corners(Batch (&corner)[4][3]) const {
    const int at[4] = {0, m * (n + 1), m * (n + 1) + n, n};
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c) corner[k][c] = net_[c][at[k]] / net_[3][at[k]];
  }

  /// Finds the largest |r_uu|, |r_uv|, |r_vv| at the corners, by the quotient rule.
  void corner_derivatives(Batch (&most)[3]) const {
    for (Batch& of_kind : most) of_kind = L::broadcast(0);
    for (int corner = 0; corner < 4; ++corner) {
      const bool high_u = corner / 2 != 0, high_v = corner % 2 != 0;
      const auto at = [&](int i, int j) { return (high_u ? m - i : i) * (n + 1) + (high_v ? n - j : j); };
      const Batch inverse = L::broadcast(1) / net_[3][at(0, 0)];
      const auto weight = [&](int i, int j) { return net_[3][at(i, j)] * inverse; };
      /// Returns the weight over that of the corner, times the step from the corner.
      const auto step = [&](int i, int j, int c) {
        return net_[c][at(i, j)] * inverse - weight(i, j) * (net_[c][at(0, 0)] * inverse);
      };
      const auto number = [](int k) { return L::broadcast(static_cast<float>(k)); };
      // n (n - 1) w2 (P2 - P0) - 2 n (n w1 - 1) w1 (P1 - P0) with w0 = 1.
      const auto second = [&](int degree, int i, int j, int c) {
        const Batch along = number(2 * degree) * (number(degree) * weight(i, j) - number(1)) * step(i, j, c);
        if (degree < 2) return number(0) - along;
        return number(degree * (degree - 1)) * step(2 * i, 2 * j, c) - along;
      };
      Batch squared[3] = {number(0), number(0), number(0)};
      for (int c = 0; c < 3; ++c) {
        const Batch mixed =
            number(m * n) * (step(1, 1, c) - weight(0, 1) * step(1, 0, c) - weight(1, 0) * step(0, 1, c));
        const Batch derivatives[3] = {second(m, 1, 0, c), mixed, second(n, 0, 1, c)};
        for (int kind = 0; kind < 3; ++kind) squared[kind] = squared[kind] + derivatives[kind] * derivatives[kind];
      }
      for (int kind = 0; kind < 3; ++kind) most[kind] = xsimd::max(most[kind], squared[kind]);
    }
    for (Batch& of_kind : most) of_kind = xsimd::sqrt(of_kind);
  }

  struct Shape {
    int rows, columns;
    int count() const { return rows * columns; }
  };
  /// Writes the second differences uu, uv or vv, `[component of 4][i][j]`, components `step` apart.
  Shape second_differences(int kind, Batch* to, int step) const {
    const int along_u = kind == 0 ? 2 : kind == 1 ? 1 : 0, along_v = 2 - along_u;
    const Shape shape{m + 1 - along_u, n + 1 - along_v};
    for (int c = 0; c < 4; ++c) {
      if (c == 2 && dimensions == 2) continue;
      const auto at = [&](int i, int j) -> const Batch& { return net_[c][i * (n + 1) + j]; };
      for (int i = 0, next = c * step; i < shape.rows; ++i)
        for (int j = 0; j < shape.columns; ++j, ++next)
          to[next] = kind == 0   ? (at(i + 2, j) - at(i + 1, j)) - (at(i + 1, j) - at(i, j))
                     : kind == 1 ? (at(i + 1, j + 1) - at(i + 1, j)) - (at(i, j + 1) - at(i, j))
                                 : (at(i, j + 2) - at(i, j + 1)) - (at(i, j + 1) - at(i, j));
    }
    return shape;
  }

  /// Cuts one component of a net at 1/2 along u, along v, both or neither; halves share a row or column. Rows of `to`
  /// are max_cut apart.
  [[gnu::noinline]] static void cut(const Batch* net, Shape shape, bool cut_u, bool cut_v, Batch* to) {
    Batch by_row[max_cut * capacity];
    const Batch* rows = net;
    if (cut_u) {
      rows = by_row;
      for (int j = 0; j < shape.columns; ++j)
        cut_curve<L>(net + j, shape.columns, shape.rows, by_row + j, shape.columns);
    }
    for (int i = 0; i < (cut_u ? 2 * shape.rows - 1 : shape.rows); ++i) {
      const Batch* const row = rows + i * shape.columns;
      if (cut_v) cut_curve<L>(row, 1, shape.columns, to + i * max_cut, 1);
      for (int j = 0; !cut_v && j < shape.columns; ++j) to[i * max_cut + j] = row[j];
    }
  }

  /// Returns the square root, or up to 0.36% more: a Newton step from the guess by its exponent is at most 0.1753% too
  /// small (Lomont 2003, Fast inverse square root).
  [[gnu::always_inline]] static Batch root(const Batch& squared) {
    const Batch guess = L::inverse_root_guess(squared);
    const Batch inverse =
        guess * (L::broadcast(static_cast<float>(1.5)) - L::broadcast(half) * squared * guess * guess);
    return L::broadcast(static_cast<float>(1.0018)) * (squared * inverse);
  }

 private:
  void find_parts() {
    Batch cuts[4][max_cut * max_cut];
    for (const int c : {0, 1, 2, 3})
      if (c != 2 || dimensions == 3) cut(net_[c], {m + 1, n + 1}, true, true, cuts[c]);
    for (int i = 0; i <= 2 * m; ++i)
      for (int j = 0; j <= 2 * n; ++j) {
        const int k = i * max_cut + j;
        const Batch inverse = L::broadcast(1) / cuts[3][k];
        for (int c = 0; c < dimensions; ++c) cuts[c][k] = cuts[c][k] * inverse;
      }
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int first = quarter / 2 * m * max_cut + quarter % 2 * n;
      Part& part = parts[5 + quarter];
      part.lightest = cuts[3][first];
      for (int c = 0; c < dimensions; ++c) part.lower[c] = part.upper[c] = cuts[c][first];
      for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) {
          const int k = first + i * max_cut + j;
          part.lightest = xsimd::min(part.lightest, cuts[3][k]);
          for (int c = 0; c < dimensions; ++c) {
            part.lower[c] = xsimd::min(part.lower[c], cuts[c][k]);
            part.upper[c] = xsimd::max(part.upper[c], cuts[c][k]);
          }
        }
    }
    join(1, 5, 6);
    join(2, 7, 8);
    join(3, 5, 7);
    join(4, 6, 8);
    join(0, 1, 2);
    for (Part& part : parts) {
      const float weight = static_cast<float>(0x1p-24) * static_cast<float>(2 + m + n),
                  place = static_cast<float>(1.7321 * 0x1p-24) * static_cast<float>(13 + 4 * (m + n));
      part.lightest = part.lightest - L::broadcast(weight);
      part.inverse = L::broadcast(more) / part.lightest;
      Batch squared = L::broadcast(0);
      for (int c = 0; c < dimensions; ++c) {
        part.centre[c] = L::broadcast(half) * (part.lower[c] + part.upper[c]);
        const Batch reach = xsimd::max(part.upper[c] - part.centre[c], part.centre[c] - part.lower[c]);
        squared = squared + reach * reach;
      }
      part.radius = L::broadcast(more) * xsimd::sqrt(squared) + L::broadcast(place) * part.inverse;
    }
  }
  void join(int to, int a, int b) {
    for (int c = 0; c < dimensions; ++c) {
      parts[to].lower[c] = xsimd::min(parts[a].lower[c], parts[b].lower[c]);
      parts[to].upper[c] = xsimd::max(parts[a].upper[c], parts[b].upper[c]);
    }
    parts[to].lightest = xsimd::min(parts[a].lightest, parts[b].lightest);
  }

  Batch net_[4][capacity * capacity], lower_[3], upper_[3], coefficient_;
};
