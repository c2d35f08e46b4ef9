#pragma once
// A sum for border curves, lanes = patches, whose bits do not depend on the parameter's direction. It pairs the control
// points i and n - i, (w_0 c_0 + w_n c_n) + (w_1 c_1 + w_{n-1} c_{n-1}) + ..., by separate multiplications and
// additions, which commute. With weights that are themselves symmetric, the other direction gives the same bits.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/block_lanes.h, kernel/isa/lanes.h.

template <class L>
inline typename L::Batch symmetric_sum(const typename L::Scalar* control, std::ptrdiff_t step, int degree,
                                       const typename L::Scalar* weights) {
  const auto term = [&](int i) { return L::broadcast(weights[i]) * L::load(control + i * step); };
  auto sum = term(0) + term(degree);
  for (int i = 1; 2 * i < degree; ++i) sum = sum + (term(i) + term(degree - i));
  if (degree % 2 == 0) sum = sum + term(degree / 2);
  return sum;
}
