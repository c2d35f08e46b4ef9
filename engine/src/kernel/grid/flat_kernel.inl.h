#pragma once
// Positions patch by patch; lanes = neighbouring numbers of a row of a patch's grid, x y z x y z .. One vector holds
// the curves of four rows, q_j = sum_i f_i(row) c_ij. The curves of one row are spread over its vectors, r = sum_j
// g_j(column) q_j. These are the same sums in the same order as in grid_kernel.inl.h, without a transpose and without a
// block of sixteen patches. Results go to memory by whole aligned vectors.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/flat_kernels.h, kernel/isa/block_lanes.h,
// kernel/isa/lanes.h, kernel/store/stream_state.h.

#include "kernel/store/line_sink.inl.h"
#include "kernel/sample/sample_kernel.inl.h"

template <class L, int DegreeV, bool Streaming>
class FlatGrid {
 public:
  explicit FlatGrid(const FlatJob& job) : job_(job) {}

  void run() {
    LineSink<L, Streaming> sink(job_.out);  // its vectors stay in registers
    for (int patch = 0; patch < job_.patches; ++patch) {
      spread(job_.nets[patch]);
      sink.turn_to(job_.out + patch * job_.patch_step);
      rows(sink);
    }
    sink.finish();
  }

 private:
  static constexpr int capacity = capacity_of<DegreeV>;
  using Curves = typename L::Batch[capacity];

  int count_i() const { return job_.degree_u + 1; }
  int count_j() const { return DegreeV > 0 ? DegreeV + 1 : job_.degree_v + 1; }

  /// Spreads the control points, each as x y z x y z .. A block's first patch prefetches the next block.
  void spread(const float* net) {
    const std::ptrdiff_t block_values = std::ptrdiff_t{count_i()} * count_j() * 3 * block_lanes;
    if (reinterpret_cast<std::uintptr_t>(net) % 64 == 0)
      for (std::ptrdiff_t k = 0; k < block_values; k += 16) __builtin_prefetch(net + block_values + k, 0, 2);
    for (int i = 0; i < count_i(); ++i)
      for (int j = 0; j < count_j(); ++j, net += 3 * block_lanes)
        triples_[i * capacity + j] = L::triples(net, net + block_lanes, net + 2 * block_lanes);
  }

  /// Computes the curves of group g: rows flat_rows g and following.
  [[gnu::always_inline]] void row_curves(int g, Curves& curves) const {
    const float* weights = job_.u_weights + std::ptrdiff_t{g} * count_i() * L::width;
    auto weight = L::load(weights);
    for (int j = 0; j < count_j(); ++j) curves[j] = weight * triples_[j];
    for (int i = 1; i < count_i(); ++i) {
      weight = L::load(weights + i * L::width);
      for (int j = 0; j < count_j(); ++j) curves[j] = L::fma(weight, triples_[i * capacity + j], curves[j]);
    }
  }

  [[gnu::always_inline]] void rows(LineSink<L, Streaming>& sink) const {
    const int values = 3 * job_.count_v;
    Curves curves;
    for (int row = 0; row < job_.count_u; ++row) {
      if (row % flat_rows == 0) row_curves(row / flat_rows, curves);
      // A vector of 16 numbers begins with x, y or z, as its index in the row is 0, 1 or 2 modulo 3.
      typename L::Batch turned[3][capacity];
      for (int phase = 0; phase < 3; ++phase) {
        const auto place = L::load_places(row_places[row % flat_rows][phase]);
        for (int j = 0; j < count_j(); ++j) turned[phase][j] = L::picked(curves[j], place);
      }
      const float* weights = job_.v_weights;
      int left = values;
      const auto put = [&](const typename L::Batch* curve) __attribute__((always_inline)) {
        auto sum = L::load(weights) * curve[0];
        for (int j = 1; j < count_j(); ++j) sum = L::fma(L::load(weights + j * L::width), curve[j], sum);
        weights += count_j() * L::width;
        if (left >= L::width) {
          sink.put(sum);
        } else {
          sink.put(sum, left);
        }
        left -= L::width;
        return left > 0;
      };
      while (put(turned[0]) && put(turned[1]) && put(turned[2])) continue;
    }
  }

  /// The lanes to pick for row r of a group, for vectors that begin with x, y, z.
  struct RowPlaces {
    alignas(64) std::int32_t of[flat_rows][3][flat_lanes]{};
    constexpr RowPlaces() {
      for (int row = 0; row < flat_rows; ++row)
        for (int phase = 0; phase < 3; ++phase)
          for (int lane = 0; lane < flat_lanes; ++lane) of[row][phase][lane] = 3 * row + (phase + lane) % 3;
    }
    const std::int32_t (&operator[](int row) const)[3][flat_lanes] { return of[row]; }
  };
  static constexpr RowPlaces row_places{};

  const FlatJob& job_;
  typename L::Batch triples_[max_order * capacity];
};

template <class L, int DegreeV>
void choose_flat(const FlatJob& job) {
  job.streaming ? FlatGrid<L, DegreeV, true>(job).run() : FlatGrid<L, DegreeV, false>(job).run();
}

template <class L>
Isa evaluate_flat(const FlatJob& job) {
  job.degree_v == 3 ? choose_flat<L, 3>(job) : choose_flat<L, 0>(job);
  return this_isa;
}
