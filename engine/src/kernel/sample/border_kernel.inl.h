#pragma once
// Border curves of a block, lanes = patches, whose bits do not depend on the parameter's direction: by symmetric_sum.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/line_kernels.h, kernel/isa/lanes.h.

#include "kernel/sample/symmetric_sum.inl.h"

template <class L>
void evaluate_border(const BorderJob<typename L::Scalar>& job) {
  for (int k = 0; k < job.count; ++k) {
    const auto* weights = job.weights + std::ptrdiff_t{k} * (job.degree + 1);
    auto* out = job.position + std::ptrdiff_t{k} * 3 * block_lanes;
    for (int lane = 0; lane < block_lanes; lane += L::width) {
      typename L::Batch point[3];
      for (int c = 0; c < 3; ++c)
        point[c] = symmetric_sum<L>(job.control + c * block_lanes + lane, job.control_step, job.degree, weights);
      if (job.rational) {
        const auto w = symmetric_sum<L>(job.control + 3 * block_lanes + lane, job.control_step, job.degree, weights);
        const auto reciprocal = L::broadcast(1) / w;
        for (int c = 0; c < 3; ++c) point[c] = point[c] * reciprocal;
      }
      store<L, false>(out + lane, point);
    }
  }
}
