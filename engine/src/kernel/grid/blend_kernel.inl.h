#pragma once
// Transfinite blending of four border curves; lanes = parameters v. The border curves' values for one u are broadcast,
// and those for v stream through, as many columns at a time as stay in the second-level cache. (A first-level tile
// would shorten the runs of stores, which cost more than the loads.)
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/line_kernels.h, kernel/isa/lanes.h.

#include "kernel/store/store.inl.h"

/// Blends columns begin .. end of one row: ((g1 C1 + g2 C2) + f1 K1) + f2 K2 in this order, all but the first product
/// fused.
template <class L, Records Layout>
inline void blend_row(const BlendJob<typename L::Scalar>& job, std::ptrdiff_t row, std::ptrdiff_t begin,
                      std::ptrdiff_t end) {
  const auto* values = job.rows + row * 8;
  typename L::Batch first[3], second[3];
  for (int c = 0; c < 3; ++c) {
    first[c] = L::broadcast(values[c]);
    second[c] = L::broadcast(values[3 + c]);
  }
  const auto f1 = L::broadcast(values[6]), f2 = L::broadcast(values[7]);
  for (std::ptrdiff_t j = begin; j < end; j += L::width) {
    const auto column = [&](int k) { return L::load(job.columns + k * job.column_step + j); };
    const auto g1 = column(0), g2 = column(1);
    typename L::Batch p[3];
    for (int c = 0; c < 3; ++c) {
      p[c] = L::fma(g2, second[c], g1 * first[c]);
      p[c] = L::fma(f2, column(5 + c), L::fma(f1, column(2 + c), p[c]));
    }
    const int count = end - j < L::width ? static_cast<int>(end - j) : int{L::width};
    store_records<L, Layout>(job, row * job.column_count + j, p, count);
  }
}

template <class L, Records Layout>
void blend_rows(const BlendJob<typename L::Scalar>& job) {
  constexpr std::ptrdiff_t tile = 16384 / sizeof(typename L::Scalar);  // 8 arrays: 128 KiB
  for (std::ptrdiff_t begin = 0; begin < job.column_count; begin += tile) {
    const std::ptrdiff_t end = job.column_count - begin < tile ? job.column_count : begin + tile;
    for (std::ptrdiff_t row = 0; row < job.row_count; ++row) blend_row<L, Layout>(job, row, begin, end);
  }
}

template <class L>
Isa blend(const BlendJob<typename L::Scalar>& job) {
  if (job.stride == 1) {
    blend_rows<L, Records::arrays>(job);
  } else if (job.stride == 3 && job.out[1] == job.out[0] + 1 && job.out[2] == job.out[0] + 2) {
    blend_rows<L, Records::packed>(job);
  } else {
    blend_rows<L, Records::strided>(job);
  }
  return this_isa;
}
