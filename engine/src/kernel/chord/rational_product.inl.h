#pragma once
// Bounds on the products of second derivatives of rational patches, lanes = patches of a block: for vectors in two
// balls around p and q of radii r and s, at most p q + |p| s + |q| r + r s.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/rational_nets.inl.h"
#include "kernel/chord/chord_product.inl.h"

template <class L>
class RationalProducts {
 public:
  RationalProducts(const ChordProductJob& job, int lane)
      : job_(job), lane_(lane), nets_(job.net, job.degree_u, job.degree_v, lane) {
    nets_.place(L::broadcast(1) / L::load(job.unit + lane));
    for (int kind = 0; kind < 3; ++kind) shape_[kind] = nets_.second_differences(kind, d_[kind][0], most);
  }

  void write() {
    write_pieces(false, false, 0, 1);
    write_pieces(true, false, 1, 2);
    write_pieces(false, true, 3, 2);
    write_pieces(true, true, 5, 4);
  }

 private:
  using Nets = RationalNets<L>;
  using Batch = typename L::Batch;
  static constexpr int most = (max_product_degree + 1) * (max_product_degree + 1);

  struct Balls {
    int count;
    Batch x[most], y[most], z[most], size[most], radius[most];
  };

  /// Writes `count` pieces from `first` on.
  void write_pieces(bool cut_u, bool cut_v, int first, int count) {
    for (int kind = 0; kind < 3; ++kind)
      for (int c = 0; c < 4; ++c)
        if (shape_[kind].count() > 0) Nets::cut(d_[kind][c], shape_[kind], cut_u, cut_v, cut_[kind][c]);
    for (int k = 0; k < count; ++k) {
      const int half_u = !cut_u ? 0 : cut_v ? k / 2 : k, half_v = !cut_v ? 0 : cut_u ? k % 2 : k;
      for (int kind = 0; kind < 3; ++kind) find_balls(kind, half_u, half_v, nets_.parts[first + k]);
      const int m = nets_.m, n = nets_.n, factor[3] = {m * (m - 1), m * n, n * (n - 1)};
      store(first + k, 0, 0, 2, factor[0] * factor[2], largest_product<false>(balls_[0], balls_[2]));
      store(first + k, 1, 0, 1, factor[0] * factor[1], largest_product<true>(balls_[0], balls_[1]));
      store(first + k, 2, 1, 2, factor[1] * factor[2], largest_product<true>(balls_[1], balls_[2]));
    }
  }

  void find_balls(int kind, int half_u, int half_v, const typename Nets::Part& part) {
    const auto shape = shape_[kind];
    Balls& balls = balls_[kind];
    balls.count = 0;
    for (int i = 0; i < shape.rows; ++i)
      for (int j = 0; j < shape.columns; ++j) {
        const int at = (half_u * (shape.rows - 1) + i) * Nets::max_cut + half_v * (shape.columns - 1) + j;
        const int k = balls.count++;
        const Batch w = cut_[kind][3][at];
        balls.x[k] = (cut_[kind][0][at] - part.centre[0] * w) * part.inverse;
        balls.y[k] = (cut_[kind][1][at] - part.centre[1] * w) * part.inverse;
        balls.z[k] = (cut_[kind][2][at] - part.centre[2] * w) * part.inverse;
        balls.size[k] = Nets::root(balls.x[k] * balls.x[k] + balls.y[k] * balls.y[k] + balls.z[k] * balls.z[k]);
        balls.radius[k] =
            (part.radius * (xsimd::abs(w) + L::broadcast(nets_.slope)) + L::broadcast(nets_.slack)) * part.inverse;
      }
  }

  /// Returns the largest product of vectors in balls of both, or with Size its largest absolute value.
  template <bool Size>
  Batch largest_product(const Balls& a, const Balls& b) const {
    Batch found = L::broadcast(a.count > 0 && b.count > 0 ? -std::numeric_limits<float>::max() : 0);
    for (int i = 0; i < a.count; ++i) {
      const Batch x = a.x[i], y = a.y[i], z = a.z[i], size = a.size[i], radius = a.radius[i];
      for (int j = 0; j < b.count; ++j) {
        const Batch product = (x * b.x[j] + y * b.y[j]) + z * b.z[j];
        const Batch reach = size * b.radius[j] + radius * (b.size[j] + b.radius[j]);
        found = xsimd::max(found, (Size ? xsimd::abs(product) : product) + reach);
      }
    }
    return found;
  }

  /// Stores a product with its rounding. The factors exceed the bounds, which are those of the net after cutting, by a
  /// few times at most: a product and its reach take ten roundings of 2^-24 |p| |q|, so 2^-16 serves factors up to 5
  /// times as large as both bounds.
  void store(int piece, int which, int kind_a, int kind_b, int factor, const Batch& product) const {
    const auto bound = [&](int kind) { return L::load(job_.pieces + (piece * 3 + kind) * block_lanes + lane_); };
    L::store(job_.products + (piece * 3 + which) * block_lanes + lane_,
             product * L::broadcast(static_cast<float>(factor)) +
                 bound(kind_a) * bound(kind_b) * L::broadcast(static_cast<float>(0x1p-16)));
  }

  const ChordProductJob& job_;
  const int lane_;
  Nets nets_;
  typename Nets::Shape shape_[3];
  Batch d_[3][4][most], cut_[3][4][Nets::max_cut * Nets::max_cut];
  Balls balls_[3];
};

template <class L>
void bound_rational_products(const ChordProductJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) RationalProducts<L>(job, lane).write();
}
