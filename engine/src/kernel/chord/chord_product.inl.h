#pragma once
// Bounds on the products of second derivatives of polynomial patches (tess/bounds/chord_bound.h), lanes = patches of a
// block. No multiply-add is fused, as in chord_kernel.inl.h.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/chord_kernel.inl.h"

/// A net of vectors `[component][i][j]`, cut at 1/2 along u, along v, both or neither; the halves share points.
template <class L, int Rows, int Columns>
class CutNet {
 public:
  using Batch = typename L::Batch;

  CutNet(const Batch* net, int rows, int columns, bool cut_u, bool cut_v)
      : rows_(Rows > 0 ? Rows : rows),
        columns_(Columns > 0 ? Columns : columns),
        width_(cut_v ? 2 * columns_ - 1 : columns_) {
    if (count() == 0) return;
    const int height = cut_u ? 2 * rows_ - 1 : rows_;
    for (int c = 0; c < 3; ++c) {
      Batch by_row[max_rows * (Columns > 0 ? Columns : order)];
      const Batch* component = net + c * rows_ * columns_;
      for (int j = 0; cut_u && j < columns_; ++j) cut_curve<L>(component + j, columns_, rows_, by_row + j, columns_);
      const Batch* row = cut_u ? by_row : component;
      for (int i = 0; i < height; ++i, row += columns_) {
        Batch* to = at_[c] + i * width_;
        if (cut_v) {
          cut_curve<L>(row, 1, columns_, to, 1);
        } else {
          for (int j = 0; j < columns_; ++j) to[j] = row[j];
        }
      }
    }
  }

  static constexpr int order = max_product_degree + 1, max_count = Rows > 0 ? Rows *Columns : order *order;

  int count() const { return Rows > 0 ? Rows * Columns : rows_ * columns_; }
  /// Copies the vectors of a half or quarter, `[component][max_count]`.
  void copy(int half_u, int half_v, Batch* to) const {
    for (int c = 0; c < 3; ++c)
      for (int i = 0, k = 0; i < rows_; ++i)
        for (int j = 0; j < columns_; ++j, ++k)
          to[c * max_count + k] = at_[c][(half_u * (rows_ - 1) + i) * width_ + half_v * (columns_ - 1) + j];
  }

 private:
  static constexpr int max_rows = Rows > 0 ? 2 * Rows - 1 : 2 * order - 1,
                       max_columns = Columns > 0 ? 2 * Columns - 1 : 2 * order - 1;
  const int rows_, columns_, width_;
  Batch at_[3][max_rows * max_columns];
};

/// Returns the largest product of a vector of one net and one of another, or with Size the largest absolute value. A
/// and B are the strides from one component to the next; each net has at most that many vectors.
template <class L, bool Size, int A, int B>
[[gnu::always_inline]] inline typename L::Batch largest_product(const typename L::Batch* a, int count_a,
                                                                const typename L::Batch* b, int count_b) {
  using Batch = typename L::Batch;
  Batch most[2] = {L::broadcast(Size ? 0 : -std::numeric_limits<float>::max()),
                   L::broadcast(Size ? 0 : -std::numeric_limits<float>::max())};
  for (int i = 0; i < count_a; ++i) {
    const Batch x = a[i], y = a[A + i], z = a[2 * A + i];
    for (int j = 0; j < count_b; ++j) {
      const Batch product = (x * b[j] + y * b[B + j]) + z * b[2 * B + j];
      most[j % 2] = xsimd::max(most[j % 2], Size ? xsimd::abs(product) : product);
    }
  }
  return xsimd::max(most[0], most[1]);
}

template <class L, int Degree>
class ChordProducts {
 public:
  ChordProducts(const ChordProductJob& job, int lane)
      : job_(job), lane_(lane), m_(Degree > 0 ? Degree : job.degree_u), n_(Degree > 0 ? Degree : job.degree_v) {
    const Batch scale = L::broadcast(1) / L::load(job.unit + lane);
    Batch net[3 * order * order];
    const int columns = n_ + 1, points = (m_ + 1) * columns;
    for (int k = 0; k < points; ++k)
      for (int c = 0; c < 3; ++c) net[c * points + k] = L::load(job.net + (k * 3 + c) * block_lanes + lane) * scale;
    Batch *to_uu = uu_, *to_uv = uv_, *to_vv = vv_;
    for (int c = 0; c < 3; ++c) {
      const auto at = [&](int i, int j) -> const Batch& { return net[c * points + i * columns + j]; };
      for (int i = 0; i <= m_; ++i)
        for (int j = 0; j <= n_; ++j) {
          if (i + 2 <= m_) *to_uu++ = (at(i + 2, j) - at(i + 1, j)) - (at(i + 1, j) - at(i, j));
          if (i < m_ && j < n_) *to_uv++ = (at(i + 1, j + 1) - at(i + 1, j)) - (at(i, j + 1) - at(i, j));
          if (j + 2 <= n_) *to_vv++ = (at(i, j + 2) - at(i, j + 1)) - (at(i, j + 1) - at(i, j));
        }
    }
  }

  void write() const {
    write_pieces(false, false, 0, 1);
    write_pieces(true, false, 1, 2);
    write_pieces(false, true, 3, 2);
    write_pieces(true, true, 5, 4);
  }

  /// Writes the bound by the products over the plain bound, in the roughest quarter, for steps with h^2 uu = k^2 vv for
  /// the whole patch.
  void write_share() const {
    const auto [h, k] = balanced_steps();
    const Nets nets(*this, true, true);
    Vectors roughest = nets.vectors(0, 0);
    Batch plain = plain_chord(5, h, k), bounds[3] = {bound(5, 0), bound(5, 1), bound(5, 2)};
    for (int q = 1; q < 4; ++q) {
      const Vectors vectors = nets.vectors(q / 2, q % 2);
      const Batch chord = plain_chord(5 + q, h, k);
      const auto rougher = chord > plain;
      plain = xsimd::max(plain, chord);
      for (int kind = 0; kind < 3; ++kind) bounds[kind] = xsimd::select(rougher, bound(5 + q, kind), bounds[kind]);
      roughest.take(vectors, rougher);
    }
    const auto products = roughest.products();
    const Batch a = h * h * bounds[0], b = (h + h) * k * bounds[1], c = k * k * bounds[2], two = L::broadcast(2);
    const Batch both = a * a + c * c + two * (h * k) * (h * k) * (of_uu() * of_vv() * products.uu_vv);
    const Batch with_mixed =
        h * h * (of_uu() * of_uv() * products.uu_uv) + k * k * (of_uv() * of_vv() * products.uv_vv);
    const Batch squared = b * b + two * two * (h * k) * with_mixed + xsimd::max(both, xsimd::max(a * a, c * c));
    L::store(job_.share + lane_, xsimd::sqrt(squared) / xsimd::max(plain, L::broadcast(static_cast<float>(0x1p-60))));
  }

 private:
  using Batch = typename L::Batch;
  static constexpr int order = Degree > 0 ? Degree + 1 : max_product_degree + 1;
  static constexpr int inner = Degree > 0 ? Degree - 1 : 0, some = Degree > 0 ? Degree : 0,
                       all = Degree > 0 ? Degree + 1 : 0;

  using Uu = CutNet<L, inner, all>;
  using Uv = CutNet<L, some, some>;
  using Vv = CutNet<L, all, inner>;

  struct Products {
    Batch uu_vv, uu_uv, uv_vv;
  };
  /// The vectors of a half or quarter.
  struct Vectors {
    int counts[3];
    Batch uu[3 * Uu::max_count], uv[3 * Uv::max_count], vv[3 * Vv::max_count];

    template <class Where>
    void take(const Vectors& other, const Where& where) {
      for (int k = 0; k < 3 * Uu::max_count; ++k) uu[k] = xsimd::select(where, other.uu[k], uu[k]);
      for (int k = 0; k < 3 * Uv::max_count; ++k) uv[k] = xsimd::select(where, other.uv[k], uv[k]);
      for (int k = 0; k < 3 * Vv::max_count; ++k) vv[k] = xsimd::select(where, other.vv[k], vv[k]);
    }
    Products products() const {
      constexpr int a = Uu::max_count, b = Uv::max_count, c = Vv::max_count;
      const int of_a = Degree > 0 ? a : counts[0], of_b = Degree > 0 ? b : counts[1], of_c = Degree > 0 ? c : counts[2];
      return {largest_product<L, false, a, c>(uu, of_a, vv, of_c), largest_product<L, true, a, b>(uu, of_a, uv, of_b),
              largest_product<L, true, b, c>(uv, of_b, vv, of_c)};
    }
  };
  struct Nets {
    Uu uu;
    Uv uv;
    Vv vv;
    Nets(const ChordProducts& of, bool cut_u, bool cut_v)
        : uu(of.uu_, of.m_ - 1, of.n_ + 1, cut_u, cut_v),
          uv(of.uv_, of.m_, of.n_, cut_u, cut_v),
          vv(of.vv_, of.m_ + 1, of.n_ - 1, cut_u, cut_v) {}
    Vectors vectors(int half_u, int half_v) const {
      Vectors of;
      of.counts[0] = uu.count(), of.counts[1] = uv.count(), of.counts[2] = vv.count();
      uu.copy(half_u, half_v, of.uu);
      uv.copy(half_u, half_v, of.uv);
      vv.copy(half_u, half_v, of.vv);
      return of;
    }
  };
  Batch of_uu() const { return L::broadcast(static_cast<float>(m_ * (m_ - 1))); }
  Batch of_uv() const { return L::broadcast(static_cast<float>(m_ * n_)); }
  Batch of_vv() const { return L::broadcast(static_cast<float>(n_ * (n_ - 1))); }

  /// Writes `count` pieces from `first` on.
  void write_pieces(bool cut_u, bool cut_v, int first, int count) const {
    const Nets nets(*this, cut_u, cut_v);
    for (int k = 0; k < count; ++k) {
      const auto products = (cut_u && cut_v ? nets.vectors(k / 2, k % 2)
                             : cut_u        ? nets.vectors(k, 0)
                                            : nets.vectors(0, k))
                                .products();
      store(first + k, 0, of_uu(), 0, of_vv(), 2, products.uu_vv);
      store(first + k, 1, of_uu(), 0, of_uv(), 1, products.uu_uv);
      store(first + k, 2, of_uv(), 1, of_vv(), 2, products.uv_vv);
    }
  }

  /// Stores a product with the rounding of both factors, as in store_pieces(), and of the sums. The vectors in the sums
  /// may exceed the bounds, which are those of the net after cutting, by a few times: a sum of three products rounds by
  /// at most 4 * 2^-24 |x| |y|, so 2^-16 serves vectors up to 8 times as long as both bounds.
  void store(int piece, int which, const Batch& factor_a, int kind_a, const Batch& factor_b, int kind_b,
             const Batch& product) const {
    const Batch rounding =
        L::broadcast(static_cast<float>(8 * 0x1p-24 * 1.7321 * (12 + 4 * (job_.degree_u + job_.degree_v))));
    const Batch a = bound(piece, kind_a), b = bound(piece, kind_b);
    const Batch error = (a * factor_b + b * factor_a) * rounding + a * b * L::broadcast(static_cast<float>(0x1p-16));
    L::store(job_.products + (piece * 3 + which) * block_lanes + lane_, product * (factor_a * factor_b) + error);
  }
  Batch bound(int piece, int kind) const { return L::load(job_.pieces + (piece * 3 + kind) * block_lanes + lane_); }

  Batch plain_chord(int quarter, const Batch& h, const Batch& k) const {
    return h * (h * bound(quarter, 0) + (k + k) * bound(quarter, 1)) + k * k * bound(quarter, 2);
  }
  struct Steps {
    Batch h, k;
  };
  /// Returns steps with h^2 uu = k^2 vv for the whole patch.
  Steps balanced_steps() const {
    const Batch least = L::broadcast(static_cast<float>(0x1p-40));
    const Batch uu = xsimd::max(bound(0, 0), least), vv = xsimd::max(bound(0, 2), least);
    return {xsimd::sqrt(xsimd::sqrt(vv / uu)), xsimd::sqrt(xsimd::sqrt(uu / vv))};
  }

  const ChordProductJob& job_;
  const int lane_, m_, n_;
  Batch uu_[3 * order * order], uv_[3 * order * order], vv_[3 * order * order];
};

template <class L, int Degree>
void bound_products(const ChordProductJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) ChordProducts<L, Degree>(job, lane).write();
}

template <class L, int Degree>
void share_of_products(const ChordProductJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) ChordProducts<L, Degree>(job, lane).write_share();
}
