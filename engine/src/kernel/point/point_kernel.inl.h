#pragma once
// Scattered samples; lanes = samples. The values of a patch are contiguous, rows `[component][j]` one after the other.
// 1. For each sample, whole vectors of its patch's rows are summed: q = sum_i f_i(u) row_i.
// 2. A transpose of `width` samples gives the row curves with lanes = samples.
// 3. The rest is evaluated as in a grid.
//
// If all samples of a slot lie on one patch, its coefficients are broadcast instead. The sums and their order are the
// same, so the choice does not change a bit.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/point/point_kernels.h.

#include "kernel/grid/grid_kernel.inl.h"
#include "kernel/point/lane_weights.inl.h"
#include "kernel/point/locate_kernel.inl.h"
#include "kernel/point/point_slots.inl.h"

/// The Bernstein weights of one parameter of a slot's samples: `[vector][order * (degree + 1) + i][lane]`.
template <class L, int Degree, int Order>
struct SlotWeights {
  static constexpr int count = (Order + 1) * capacity_of<Degree>;
  alignas(64) typename L::Scalar of[block_lanes / L::width][count][L::width];

  /// Fills the weights of the first `samples`, and of those that share their vectors.
  [[gnu::always_inline]] void fill(const typename L::Scalar* parameters, int samples, int degree) {
    for (int lane = 0; lane < samples; lane += L::width) {
      typename L::Batch weights[count];
      bernstein_weights<L, Order, capacity_of<Degree>>(L::Batch::load_unaligned(parameters + lane), degree, weights);
      for (int i = 0; i < (Order + 1) * (degree + 1); ++i) L::store(of[lane / L::width][i], weights[i]);
    }
  }
};

/// Computes sums[order] = sum_i weights[order][i] net[i * length] for one vector of a row's `rest` last values;
/// `weights` are `[order][i][lane]` from one lane on. Reads no value behind the last row, which may lie on another
/// cache line.
template <class L, int Order>
[[gnu::always_inline]] inline void row_sums(const typename L::Scalar* net, const typename L::Scalar* weights,
                                            int count_u, std::ptrdiff_t length, int rest,
                                            typename L::Batch (&sums)[Order + 1]) {
  using Batch = typename L::Batch;
  const auto weight = [&](int order, int i) { return L::broadcast(weights[(order * count_u + i) * L::width]); };
  const Batch first = Batch::load_unaligned(net);
  for (int order = 0; order <= Order; ++order) sums[order] = weight(order, 0) * first;
#pragma GCC unroll 4
  for (int i = 1; i < count_u; ++i) {
    const auto* row = net + i * length;
    const Batch values = i + 1 < count_u || rest >= L::width ? Batch::load_unaligned(row) : L::load_first(row, rest);
    for (int order = 0; order <= Order; ++order) sums[order] = L::fma(weight(order, i), values, sums[order]);
  }
}

/// Computes sums[order] = sum_i weight(order, i) row(i) for four rows.
template <class L, int Order, class Weight, class Row>
[[gnu::always_inline]] inline void four_row_sums(const Weight& weight, const Row& row,
                                                 typename L::Batch (&sums)[Order + 1]) {
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    const typename L::Batch values = row(i);
    for (int order = 0; order <= Order; ++order)
      sums[order] = i == 0 ? weight(order, i) * values : L::fma(weight(order, i), values, sums[order]);
  }
}

template <class T>
[[gnu::always_inline]] inline const T* net_of(const PointJob<T>& job, std::uint32_t patch) {
  return job.points + patch * job.patch_values;
}

/// Prefetches the patches of samples behind the one at `patch` into the near caches.
template <int Degree, int Components, class T>
[[gnu::always_inline]] inline void fetch_ahead(const PointJob<T>& job, const std::uint32_t* patch) {
  constexpr std::size_t known = std::size_t{(Degree + 1) * (Degree + 1) * Components} * sizeof(T);
  const std::size_t bytes = Degree > 0 ? known : job.prefetched;
  const auto* near = reinterpret_cast<const char*>(net_of(job, patch[near_distance<T>]));
  for (std::size_t b = 0; b < bytes; b += 64) __builtin_prefetch(near + b, 0, 3);
  if (!job.far) return;
  const auto* far = reinterpret_cast<const char*>(net_of(job, patch[far_distance]));
  for (std::size_t b = 0; b < bytes; b += 64) __builtin_prefetch(far + b, 0, 2);
}

/// Makes column l of the sums row curve k + l, counted over all components.
template <class L, int Components, int Capacity>
[[gnu::always_inline]] inline void put_columns(typename L::Batch (&tile)[L::width], int k, int count_v,
                                               typename L::Batch (&curve)[Components][Capacity]) {
  L::transpose(tile);
  const int rest = Components * count_v - k, columns = rest < L::width ? rest : int{L::width};
  int c = k / count_v, j = k % count_v;
  const auto put_column = [&](int l) __attribute__((always_inline)) {
    curve[c][j] = tile[l];
    if (++j == count_v) j = 0, ++c;
  };
  if constexpr (Capacity < max_order) {
#pragma GCC unroll 16
    for (int l = 0; l < columns; ++l) put_column(l);
  } else {
    for (int l = 0; l < columns; ++l) put_column(l);
  }
}

/// Computes the row curves of eight samples of bicubic patches, whose rows are x and y, a whole vector, and z, half of
/// one. Samples s and 4 + s share the vectors of z.
template <class L, int Order>
[[gnu::always_inline]] inline void curves_of_eight(const PointJob<typename L::Scalar>& job, int first,
                                                   const typename L::Scalar* weights,
                                                   RowCurves<L, Order, 3, 4>& curves) {
  using Batch = typename L::Batch;
  const std::uint32_t* const patch = job.patch + first;
  Batch xy[Order + 1][8], z[Order + 1][4];
#pragma GCC unroll 4
  for (int s = 0; s < 4; ++s) {
    const typename L::Scalar* nets[2];
    Batch sums[Order + 1];
#pragma GCC unroll 2
    for (int h = 0; h < 2; ++h) {
      const int k = 4 * h + s;
      if (job.prefetched > 0) fetch_ahead<3, 3>(job, patch + k);
      nets[h] = net_of(job, patch[k]);
      four_row_sums<L, Order>([&](int order, int i) { return L::broadcast(weights[(4 * order + i) * L::width + k]); },
                              [&](int i) { return Batch::load_unaligned(nets[h] + 12 * i); }, sums);
      for (int order = 0; order <= Order; ++order) xy[order][k] = sums[order];
    }
    four_row_sums<L, Order>(
        [&](int order, int i) { return L::lane_of_fours(L::load(weights + (4 * order + i) * L::width), s); },
        [&](int i) { return L::load_fours(nets[0] + 12 * i + 8, nets[1] + 12 * i + 8); }, sums);
    for (int order = 0; order <= Order; ++order) z[order][s] = sums[order];
  }
  for (int order = 0; order <= Order; ++order) {
    L::transpose(xy[order]);
    L::transpose_fours(z[order]);
    for (int j = 0; j < 4; ++j) {
      curves.by_u[order][0][j] = xy[order][j];
      curves.by_u[order][1][j] = xy[order][4 + j];
      curves.by_u[order][2][j] = z[order][j];
    }
  }
}

/// Computes the row curves of `width` samples from their patches' rows. `weights`: `[order][i][lane]`.
template <class L, int Degree, int Order, int Components, int Capacity>
[[gnu::always_inline]] inline void curves_by_rows(const PointJob<typename L::Scalar>& job, int first,
                                                  const typename L::Scalar* weights, int count_u, int count_v,
                                                  RowCurves<L, Order, Components, Capacity>& curves) {
  if constexpr (Degree == 3 && Components == 3 && Order < 2 && requires { L::load_fours; }) {
    return curves_of_eight<L, Order>(job, first, weights, curves);
  }
  constexpr bool three_vectors = Degree == 3 && Components == 3 && L::width == 16;
  const int length = Components * count_v;
  const std::uint32_t* const patch = job.patch + first;
#pragma GCC unroll 4
  for (int k = 0; k < length; k += L::width) {
    typename L::Batch tiles[Order + 1][L::width];
    const auto sum_sample = [&](int s) __attribute__((always_inline)) {
      if (k == 0 && job.prefetched > 0) fetch_ahead<Degree, Components>(job, patch + s);
      const auto* net = net_of(job, patch[s]);
      typename L::Batch sums[Order + 1];
      if constexpr (three_vectors) {
        typename L::Batch rows[4];
        L::load_twelves(net, rows);
        four_row_sums<L, Order>([&](int order, int i) { return L::broadcast(weights[(4 * order + i) * L::width + s]); },
                                [&](int i) { return rows[i]; }, sums);
      } else {
        row_sums<L, Order>(net + k, weights + s, count_u, length, length - k, sums);
      }
      for (int order = 0; order <= Order; ++order) tiles[order][s] = sums[order];
    };
    if constexpr (Order < 2 && Degree > 0) {
#pragma GCC unroll 16
      for (int s = 0; s < L::width; ++s) sum_sample(s);
    } else {
#pragma GCC unroll 1
      for (int s = 0; s < L::width; ++s) sum_sample(s);
    }
    for (int order = 0; order <= Order; ++order) put_columns<L>(tiles[order], k, count_v, curves.by_u[order]);
  }
}

/// Computes `Count` neighbouring row curves of samples of one patch.
template <class L, int Count>
[[gnu::always_inline]] inline void run_sums(const typename L::Scalar* net, const typename L::Scalar* weights,
                                            int count_u, std::ptrdiff_t length, typename L::Batch* sums) {
  typename L::Batch sum[Count];
  for (int k = 0; k < Count; ++k) sum[k] = L::load(weights) * L::broadcast(net[k]);
  for (int i = 1; i < count_u; ++i) {
    const auto weight = L::load(weights + i * L::width);
    for (int k = 0; k < Count; ++k) sum[k] = L::fma(weight, L::broadcast(net[i * length + k]), sum[k]);
  }
  for (int k = 0; k < Count; ++k) sums[k] = sum[k];
}

/// Computes the row curves of `width` samples of one patch.
template <class L, int Degree, int Components, int Capacity>
[[gnu::always_inline]] inline void curves_by_run(const typename L::Scalar* net, const typename L::Scalar* weights,
                                                 int count_u, int count_v,
                                                 typename L::Batch (&curve)[Components][Capacity]) {
  constexpr int step = Degree > 0 && Degree < 3 ? Degree + 1 : 4;
  const std::ptrdiff_t length = Components * count_v;
  for (int c = 0; c < Components; ++c) {
    const auto* row = net + c * count_v;
    int j = 0;
    for (; j + step <= count_v; j += step) run_sums<L, step>(row + j, weights, count_u, length, curve[c] + j);
    for (; j < count_v; ++j) run_sums<L, 1>(row + j, weights, count_u, length, curve[c] + j);
  }
}

/// Computes the row curves of all orders for `width` samples from `first` on.
template <class L, int Degree, int Order, int Components, int Capacity>
[[gnu::always_inline]] inline void sample_curves(const PointJob<typename L::Scalar>& job, int first, bool run,
                                                 const typename L::Scalar* weights, int count_u, int count_v,
                                                 RowCurves<L, Order, Components, Capacity>& curves) {
  if (run) {
    const auto* net = net_of(job, job.patch[first]);
    for (int order = 0; order <= Order; ++order)
      curves_by_run<L, Degree>(net, weights + order * count_u * L::width, count_u, count_v, curves.by_u[order]);
  } else {
    curves_by_rows<L, Degree>(job, first, weights, count_u, count_v, curves);
  }
}

// Any degree, out of line: loops over the degree are long enough for a call, and their code is large.
template <class L, int Order, int Components>
__attribute__((noinline)) void any_curves(const PointJob<typename L::Scalar>& job, int first, bool run,
                                          const typename L::Scalar* weights, int count_u, int count_v,
                                          RowCurves<L, Order, Components, max_order>& curves) {
  sample_curves<L, 0>(job, first, run, weights, count_u, count_v, curves);
}
template <class L, int Order>
__attribute__((noinline)) void fill_any(SlotWeights<L, 0, Order>& weights, const typename L::Scalar* parameters,
                                        int samples, int degree) {
  weights.fill(parameters, samples, degree);
}

/// The weights of a slot's samples.
template <class L, int Degree, int Order>
struct BothWeights {
  SlotWeights<L, Degree, Order> u, v;

  [[gnu::always_inline]] void fill(const PointJob<typename L::Scalar>& job, const PointSlot& slot) {
    if constexpr (Degree > 0) {
      u.fill(job.u + slot.first, slot.count, Degree);
      v.fill(job.v + slot.first, slot.count, Degree);
    } else {
      fill_any(u, job.u + slot.first, slot.count, job.grid.degree_u);
      fill_any(v, job.v + slot.first, slot.count, job.grid.degree_v);
    }
  }
};

/// Evaluates the samples of slot k.
template <class L, int Degree, bool Rational, int Order>
inline void evaluate_slot(const PointJob<typename L::Scalar>& job, int k,
                          const BothWeights<L, Degree, Order>& slot_weights) {
  constexpr int components = Rational ? 4 : 3, capacity = capacity_of<Degree>;
  const int count_u = Degree > 0 ? Degree + 1 : job.grid.degree_u + 1;
  const int count_v = Degree > 0 ? Degree + 1 : job.grid.degree_v + 1;
  const PointSlot slot = job.slots[k];
  for (int lane = 0; lane < slot.count; lane += L::width) {
    RowCurves<L, Order, components, capacity> curves;
    const auto* weights = slot_weights.u.of[lane / L::width][0];
    if constexpr (Degree > 0) {
      sample_curves<L, Degree>(job, slot.first + lane, slot.run, weights, count_u, count_v, curves);
    } else {
      any_curves<L>(job, slot.first + lane, slot.run, weights, count_u, count_v, curves);
    }
    Sample<L> sample;
    evaluate_sample<L, Order>(curves, slot_weights.v.of[lane / L::width], count_v, sample);
    const std::ptrdiff_t at = std::ptrdiff_t{k} * block_lanes + lane, vector = at + std::ptrdiff_t{2} * k * block_lanes;
    const LineStores<L, Way::plain, int> stores(false, nullptr, 0);
    store_sample<L, Rational, Order>(job.grid, sample, {k, 0, lane}, {vector, at, at}, stores);
  }
}

/// Each slot's weights come right before the rows of the slot before it: their long chain of operations runs beside
/// these rows, which keep the memory busy. More weights at once would leave it idle for longer than instructions
/// overlap.
template <class L, int Degree, bool Rational, int Order>
void evaluate_slots(const PointJob<typename L::Scalar>& job) {
  BothWeights<L, Degree, Order> weights[2];
  weights[0].fill(job, job.slots[0]);
  for (int k = 0; k < job.slot_count; ++k) {
    if (k + 1 < job.slot_count) weights[(k + 1) % 2].fill(job, job.slots[k + 1]);
    evaluate_slot<L, Degree, Rational, Order>(job, k, weights[k % 2]);
  }
}

/// Fixes the degrees where it pays, for doubles only the cubic; other degrees share one loop.
template <class L, int Order>
void choose_degree(const PointJob<typename L::Scalar>& job) {
  const int degree = job.grid.degree_u == job.grid.degree_v ? job.grid.degree_u : 0;
  if (job.grid.rational) return evaluate_slots<L, 0, true, Order>(job);
  if (degree == 3) return evaluate_slots<L, 3, false, Order>(job);
  if constexpr (Order < 2 && sizeof(typename L::Scalar) == 4) {
    if (degree == 2) return evaluate_slots<L, 2, false, Order>(job);
    if (degree == 1) return evaluate_slots<L, 1, false, Order>(job);
  }
  evaluate_slots<L, 0, false, Order>(job);
}

template <class L>
Isa evaluate_points(PointJob<typename L::Scalar>& job) {
  cut_slots<L>(job);
  const auto& grid = job.grid;
  if (grid.duu || grid.duv || grid.dvv || wants_curvatures(grid)) {
    choose_degree<L, 2>(job);
  } else if (grid.du || grid.dv || grid.normal || grid.normal_kind) {
    choose_degree<L, 1>(job);
  } else {
    choose_degree<L, 0>(job);
  }
  return this_isa;
}
