#pragma once
// Bounds on the second derivatives of rational patches, lanes = patches of a block: the largest
// (|A'' - c w''| + R |w''|) / w_min at the control points of a piece's quarters (see rational_nets.inl.h).
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/rational_nets.inl.h"

template <class L>
class RationalChords {
 public:
  RationalChords(const ChordJob& job, int lane)
      : job_(job), lane_(lane), nets_(job.net, job.degree_u, job.degree_v, lane, job.is_plane ? 2 : 3) {}

  void run() {
    nets_.place(inverse_unit<L>(job_, lane_, nets_.largest()));
    const int m = nets_.m, n = nets_.n;
    bound(0, m * (m - 1));
    bound(1, m * n);
    bound(2, n * (n - 1));
    const auto is_sure =
        (L::broadcast(8) * unsure_ <= sum_) & (nets_.parts[0].lightest > L::broadcast(static_cast<float>(1.0 / 64)));
    L::store(job_.size + lane_, xsimd::select(is_sure, nets_.size, L::broadcast(-1)));
    if (!job_.hints) return;
    Batch corner[4][3];
    nets_.corners(corner);
    store_hints<L, true>(job_, lane_, corner);
    add_gain();
  }

 private:
  using Nets = RationalNets<L>;
  using Batch = typename L::Batch;
  using Part = typename Nets::Part;

  /// Adds the hints that exact numerators would save cells: the second derivatives at the corners, below which no bound
  /// can be, ask for far fewer cells than the bounds of quarters.
  void add_gain() {
    Batch most[3], least[3];
    for (int kind = 0; kind < 3; ++kind) {
      most[kind] = L::broadcast(0);
      for (int quarter = 5; quarter < 9; ++quarter)
        most[kind] = xsimd::max(most[kind], L::load(job_.pieces + (quarter * 3 + kind) * block_lanes + lane_));
    }
    nets_.corner_derivatives(least);
    const Batch one = xsimd::sqrt(L::broadcast(static_cast<float>(0x1p-6)) * nets_.parts[0].radius);
    const auto cells = [&](const Batch(&d)[3]) { return (xsimd::sqrt(d[0]) + one) * (xsimd::sqrt(d[2]) + one) + d[1]; };
    const Batch share = cells(least) / cells(most), zero = L::broadcast(0);
    const auto gains = share < L::broadcast(static_cast<float>(likely_gain));
    L::store(job_.hints + lane_, L::load(job_.hints + lane_) + xsimd::select(gains, L::broadcast(may_gain), zero));
  }

  void bound(int kind, int factor) {
    const auto shape = nets_.second_differences(kind, d_[0], Nets::capacity * Nets::capacity);
    Batch pieces[9];
    for (Batch& piece : pieces) piece = L::broadcast(0);
    if (shape.count() > 0) job_.is_plane ? largest<true>(shape, pieces) : largest<false>(shape, pieces);
    const Batch by = L::broadcast(static_cast<float>(factor));
    for (int k = 0; k < 9; ++k) L::store(job_.pieces + (k * 3 + kind) * block_lanes + lane_, pieces[k] * by);
    sum_ = sum_ + pieces[0] * by;
    unsure_ = unsure_ + unsure(nets_.parts[0]) * nets_.parts[0].inverse * by;
  }
  Batch unsure(const Part& part) const { return L::broadcast(nets_.slack) + part.radius * L::broadcast(nets_.slope); }

  template <bool IsPlane>
  void largest(typename Nets::Shape shape, Batch (&pieces)[9]) {
    for (const int c : {0, 1, 2, 3})
      if (c != 2 || !IsPlane) Nets::cut(d_[c], shape, true, true, cut_[c]);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int half_u = quarter / 2, half_v = quarter % 2;
      const int first = half_u * (shape.rows - 1) * Nets::max_cut + half_v * (shape.columns - 1);
      for (const int k : {0, 1 + half_u, 3 + half_v, 5 + quarter}) {  // pieces that contain it
        const Part& part = nets_.parts[k];
        Batch most = L::broadcast(0);
        for (int i = 0; i < shape.rows; ++i)
          for (int j = 0; j < shape.columns; ++j) {
            const int at = first + i * Nets::max_cut + j;
            const Batch w = cut_[3][at], x = cut_[0][at] - part.centre[0] * w, y = cut_[1][at] - part.centre[1] * w;
            Batch squared = x * x + y * y;
            if constexpr (!IsPlane) {
              const Batch z = cut_[2][at] - part.centre[2] * w;
              squared = squared + z * z;
            }
            most = xsimd::max(most, Nets::root(squared) + part.radius * xsimd::abs(w));
          }
        pieces[k] = xsimd::max(pieces[k], L::broadcast(Nets::more) * (most + unsure(part)) * part.inverse);
      }
    }
  }

  const ChordJob& job_;
  const int lane_;
  Nets nets_;
  Batch sum_ = L::broadcast(0), unsure_ = sum_;  // the sum of the bounds of the whole, and the part of it that is
                                                 // rounding
  Batch d_[4][Nets::capacity * Nets::capacity], cut_[4][Nets::max_cut * Nets::max_cut];
};

template <class L>
void bound_rational_chords(const ChordJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) RationalChords<L>(job, lane).run();
}
