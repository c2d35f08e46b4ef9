#pragma once
// Bounds on the second derivatives of rational patches themselves, and the deviation of a patch from a scaled sweep
// (tess/bounds/chord_bound.h), lanes = patches of a block, in double. No multiply-add is fused, so that every
// instruction set finds the same bounds.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/exact_derivative.inl.h"

/// The bounds of the patches in one vector of lanes.
template <class L>
class ExactChords {
 public:
  ExactChords(const ExactChordJob& job, int lane) : job_(job), lane_(lane), m_(job.degree_u), n_(job.degree_v) {
    lightest_ = L::broadcast(std::numeric_limits<double>::infinity());
    for (int k = 0; k < (m_ + 1) * (n_ + 1); ++k) {
      weight_[k] = job.rational ? L::load(job.net + (k * 4 + 3) * block_lanes + lane) : L::broadcast(1);
      lightest_ = xsimd::min(lightest_, weight_[k]);
      heaviest_ = xsimd::max(heaviest_, weight_[k]);
      Batch squared = L::broadcast(0);
      for (int c = 0; c < 3; ++c) {
        const Batch a = L::load(job.net + (k * 4 + c) * block_lanes + lane);
        point_[c][k] = job.rational ? a / weight_[k] : a;
        largest_ = xsimd::max(largest_, xsimd::abs(a));
        squared = squared + point_[c][k] * point_[c][k];
      }
      radius_ = xsimd::max(radius_, squared);
    }
    radius_ = xsimd::sqrt(radius_);
  }

  void run() {
    const Batch infinite = L::broadcast(std::numeric_limits<double>::infinity());
    Batch deviation = infinite;
    for (Batch(&piece)[3] : quarter_)
      for (Batch& bound : piece) bound = infinite;
    for (const bool along_u : {true, false}) {
      const Batch found = find_sweep(along_u);
      const auto is_sweep = (found <= L::broadcast(sweep_tolerance) * radius_) & (found < deviation);
      if (!xsimd::any(is_sweep)) continue;
      deviation = xsimd::select(is_sweep, found, deviation);
      if (job_.pieces) bound_sweep(along_u, is_sweep);
    }
    L::store(job_.deviation + lane_, deviation);
    if (!job_.pieces) return;
    const auto is_other = !(deviation < infinite);
    if (job_.any_patch && xsimd::any(is_other) && std::max(m_, n_) <= max_exact_degree) bound_patch(is_other);
    store_pieces();
  }

 private:
  using Batch = typename L::Batch;
  using Net = ScaledNet<L>;
  static constexpr int max_points = max_order * max_order;
  /// Deviations up to this share of the patch's radius count as rounding.
  static constexpr double sweep_tolerance = 0x1p-30;

  int index(bool along_u, int i, int j) const { return along_u ? i * (n_ + 1) + j : j * (n_ + 1) + i; }

  /// Finds E, rho and T with points E_i rho_j + T_j and weights a_i b_j; i runs along u if `along_u`. Returns how far
  /// the patch may lie from that surface.
  Batch find_sweep(bool along_u) {
    const int count_i = (along_u ? m_ : n_) + 1, count_j = (along_u ? n_ : m_) + 1;
    const auto point = [&](int c, int i, int j) -> const Batch& { return point_[c][index(along_u, i, j)]; };
    const auto weight = [&](int i, int j) -> const Batch& { return weight_[index(along_u, i, j)]; };
    // E is the longest row.
    Batch longest = L::broadcast(-1);
    for (int j = 0; j < count_j; ++j) {
      Batch squared = L::broadcast(0);
      for (int c = 0; c < 3; ++c)
        for (int i = 1; i < count_i; ++i) {
          const Batch d = point(c, i, j) - point(c, 0, j);
          squared = squared + d * d;
        }
      const auto longer = squared > longest;
      longest = xsimd::select(longer, squared, longest);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < count_i; ++i)
          row_[c][i] = xsimd::select(longer, point(c, i, j) - point(c, 0, j), row_[c][i]);
    }
    const Batch zero = L::broadcast(0), inverse = L::broadcast(1) / xsimd::max(longest, L::broadcast(0x1p-1000));
    Batch squared = zero, skew = zero;
    const Batch unit = L::broadcast(1) / weight(0, 0);
    for (int j = 0; j < count_j; ++j) {
      Batch share = zero;
      for (int c = 0; c < 3; ++c)
        for (int i = 1; i < count_i; ++i) share = share + (point(c, i, j) - point(c, 0, j)) * row_[c][i];
      rho_[j] = xsimd::max(share * inverse, zero);
      for (int i = 0; i < count_i; ++i) {
        Batch off = zero;
        for (int c = 0; c < 3; ++c) {
          const Batch d = (point(c, i, j) - point(c, 0, j)) - rho_[j] * row_[c][i];
          off = off + d * d;
        }
        squared = xsimd::max(squared, off);
        if (!job_.rational) continue;
        skew = xsimd::max(skew, xsimd::abs(weight(i, 0) * weight(0, j) * unit / weight(i, j) - L::broadcast(1)));
      }
    }
    // Two means whose weights differ by a relative `skew` differ by at most 2 skew / (1 - skew) of the points' radius.
    return xsimd::sqrt(squared) + (L::broadcast(2.5) * skew + L::broadcast(0x1p-46)) * radius_;
  }

  /// Finds the halves of the sweep's curves in homogeneous numbers: E and its weights, rho and its weights.
  [[gnu::always_inline]] void cut_sweep(bool along_u, int count_i, int count_j) {
    const Batch inverse = L::broadcast(1) / weight_[0];
    for (int i = 0; i < count_i; ++i) {
      curve_[3][i] = weight_[index(along_u, i, 0)];
      for (int c = 0; c < 3; ++c) curve_[c][i] = curve_[3][i] * row_[c][i];
    }
    for (int c = 0; c < 4; ++c) halve(curve_[c], count_i, half_[c]);
    for (int j = 0; j < count_j; ++j) {
      rho_weight_[j] = weight_[index(along_u, 0, j)] * inverse;
      rho_point_[j] = rho_weight_[j] * rho_[j];
    }
    halve(rho_weight_, count_j, rho_half_[1]);
    halve(rho_point_, count_j, rho_half_[0]);
  }

  /// Finds the largest second derivative of the curves along which the points of half `a` of E move, in each half of
  /// these curves.
  [[gnu::always_inline]] void bound_across(bool along_u, int a, int count_i, int count_j, Batch (&across)[2]) {
    const int first = a * (count_i - 1);
    for (int i = 0; i < count_i; ++i) {
      for (int c = 0; c < 3; ++c) {
        const Batch e = half_[c][first + i] / half_[3][first + i];
        for (int j = 0; j < count_j; ++j)
          curve_[c][j] = rho_weight_[j] * (rho_[j] * e + point_[c][index(along_u, 0, j)]);
        halve(curve_[c], count_j, across_half_[c]);
      }
      for (int b = 0; b < 2; ++b) {
        set_curve(count_j, [&](int c, int j) {
          const int k = b * (count_j - 1) + j;
          return c < 3 ? across_half_[c][k] : rho_half_[1][k];
        });
        across[b] = xsimd::max(across[b], largest_second_derivative<L>(line_, count_j - 1));
      }
    }
  }

  /// Replaces the bounds of the lanes in `where` by those of the sweep that was found last.
  template <class Where>
  void bound_sweep(bool along_u, const Where& where) {
    const int count_i = (along_u ? m_ : n_) + 1, count_j = (along_u ? n_ : m_) + 1;
    cut_sweep(along_u, count_i, count_j);
    // In a lane whose curves across are straight, they bend nowhere, not even by a rounding.
    const Batch zero = L::broadcast(0);
    const auto is_straight = count_j == 2 ? rho_weight_[0] == rho_weight_[1] : zero < zero;
    Batch widest[2];
    for (int b = 0; b < 2; ++b) {
      widest[b] = L::broadcast(0);
      for (int j = 0; j < count_j; ++j) {
        const int k = b * (count_j - 1) + j;
        widest[b] = xsimd::max(widest[b], rho_half_[0][k] / rho_half_[1][k]);
      }
    }
    for (int a = 0; a < 2; ++a) {
      const int first = a * (count_i - 1);
      set_curve(count_i, [&](int c, int i) { return half_[c][first + i]; });
      const Batch along = largest_second_derivative<L>(line_, count_i - 1);
      Batch across[2] = {zero, zero};
      if (!xsimd::all(is_straight)) bound_across(along_u, a, count_i, count_j, across);
      for (int b = 0; b < 2; ++b) {
        const Batch bend = xsimd::select(is_straight, zero, across[b]);
        const Batch bounds[2] = {sure(along * widest[b], second(count_i - 1)), sure(bend, second(count_j - 1))};
        Batch(&piece)[3] = quarter_[along_u ? 2 * a + b : 2 * b + a];
        piece[0] = xsimd::select(where, bounds[along_u ? 0 : 1], piece[0]);
        piece[1] = xsimd::select(where, L::broadcast(0), piece[1]);
        piece[2] = xsimd::select(where, bounds[along_u ? 1 : 0], piece[2]);
      }
    }
  }

  /// Replaces the bounds of the lanes in `where` by those of any patch up to max_exact_degree, from its quarters' nets.
  template <class Where>
  void bound_patch(const Where& where) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (int c = 0; c < 4; ++c) cut_quarter(c, quarter / 2, quarter % 2);
      for (const bool along_u : {true, false}) {
        const int rows = (along_u ? m_ : n_) + 1, columns = (along_u ? n_ : m_) + 1;
        for (int c = 0; c < 4; ++c) {
          Net& to = c < 3 ? net_.point[c] : net_.weight;
          to.rows = rows, to.columns = columns;
          for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j)
              to.at[i * columns + j] =
                  L::broadcast(binomial(rows - 1, i) * binomial(columns - 1, j)) * part_[c][index(along_u, i, j)];
        }
        derivatives_.find(net_, along_u);
        const auto put = [&](int kind, const Batch& bound) {
          quarter_[quarter][kind] = xsimd::select(where, bound, quarter_[quarter][kind]);
        };
        put(along_u ? 0 : 2, sure(derivatives_.uu, second(rows - 1)));
        if (along_u) put(1, sure(derivatives_.uv, 8 * m_ * n_));
      }
    }
  }
  void cut_quarter(int component, int half_u, int half_v) {
    Batch line[max_order], cut[2 * max_order];
    for (int j = 0; j <= n_; ++j) {
      for (int i = 0; i <= m_; ++i) line[i] = homogeneous(component, i * (n_ + 1) + j);
      halve(line, m_ + 1, cut);
      for (int i = 0; i <= m_; ++i) part_[component][i * (n_ + 1) + j] = cut[half_u * m_ + i];
    }
    for (int i = 0; i <= m_; ++i) {
      halve(part_[component] + i * (n_ + 1), n_ + 1, cut);
      for (int j = 0; j <= n_; ++j) part_[component][i * (n_ + 1) + j] = cut[half_v * n_ + j];
    }
  }
  Batch homogeneous(int component, int k) const {
    return L::load(job_.net + (k * 4 + component) * block_lanes + lane_);
  }

  /// Cuts a curve at 1/2, as cut_curve().
  static void halve(const Batch* points, int count, Batch* cut) { cut_curve<L>(points, 1, count, cut, 1); }

  template <class Point>
  void set_curve(int count, const Point& point) {
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < count; ++i) (c < 3 ? line_.point[c] : line_.weight)[i] = point(c, i);
  }

  /// Bounds the rounding of N_uu / w^3 and N_uv / w^3, with s and omega the largest coordinate and weight.
  /// 1. A coefficient is a mean of products, at most F s omega^2, with F = m (8 m - 4) for N_uu and F = 8 m n for N_uv.
  /// 2. Each of two stages sums at most t = max(m (n + 1), (m + 1) n) products; cuts, differences and elevations add
  ///    fewer than 60 roundings.
  /// 3. So a coordinate is off by at most (2 t + 60) u F s omega^2 (Higham, Accuracy and Stability, 2nd ed., sec. 3.1).
  /// 4. With sqrt(3) and points up to two radii long this is less than 2^-44 F s omega^2, over w^3.
  Batch rounding(int factor) const {
    const Batch ratio = heaviest_ / lightest_, spread = ratio * ratio / lightest_;
    return L::broadcast(0x1p-44 * factor) * xsimd::max(largest_, heaviest_ * radius_) * spread;
  }
  /// Turns a bound of a quarter by its own parameters into one by the patch's, where each is twice as long, and adds
  /// the rounding.
  Batch sure(const Batch& bound, int factor) const {
    return L::broadcast(4 * (1 + 0x1p-40)) * bound + L::broadcast(4) * rounding(factor);
  }
  static int second(int degree) { return degree * (8 * degree - 4); }

  void store_pieces() const {
    for (int kind = 0; kind < 3; ++kind) {
      const Batch q[4] = {quarter_[0][kind], quarter_[1][kind], quarter_[2][kind], quarter_[3][kind]};
      const auto u0 = xsimd::max(q[0], q[1]), u1 = xsimd::max(q[2], q[3]), v0 = xsimd::max(q[0], q[2]),
                 v1 = xsimd::max(q[1], q[3]);
      const Batch pieces[9] = {xsimd::max(u0, u1), u0, u1, v0, v1, q[0], q[1], q[2], q[3]};
      for (int k = 0; k < 9; ++k) L::store(job_.pieces + (k * 3 + kind) * block_lanes + lane_, pieces[k]);
    }
  }

  const ExactChordJob& job_;
  const int lane_, m_, n_;
  Batch lightest_, heaviest_ = L::broadcast(0), largest_ = heaviest_, radius_ = heaviest_;
  Batch point_[3][max_points], weight_[max_points], part_[4][max_points];
  // The sweep: E, rho, and the homogeneous curves of both, cut.
  Batch row_[3][max_order], rho_[max_order], rho_weight_[max_order], rho_point_[max_order];
  Batch curve_[4][max_order], half_[4][2 * max_order], rho_half_[2][2 * max_order], across_half_[3][2 * max_order];
  HomogeneousCurve<L> line_;
  HomogeneousNet<L> net_;
  ExactDerivatives<L> derivatives_;
  Batch quarter_[4][3];  ///< [quarter][uu, uv, vv]
};

template <class L>
void bound_exact_chords(const ExactChordJob& job) {
  for (int lane = 0; lane < job.lanes; lane += L::width) ExactChords<L>(job, lane).run();
}
