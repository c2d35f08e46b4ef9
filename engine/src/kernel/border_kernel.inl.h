// Border curves whose bits do not depend on the direction of the parameter: the sum pairs the control points i and n - i,
// (w_0 c_0 + w_n c_n) + (w_1 c_1 + w_{n-1} c_{n-1}) + ..., by separate multiplications and additions, which commute. With weights
// that are themselves symmetric, running the other way gives the same bits. Included by isa_*.cpp as grid_kernel.inl.h is.

template <class L>
inline typename L::Batch symmetric_sum(const typename L::Scalar* control, std::ptrdiff_t step, int degree,
                                       const typename L::Scalar* weights) {
  const auto term = [&](int i) { return L::broadcast(weights[i]) * L::load(control + i * step); };
  auto sum = term(0) + term(degree);
  for (int i = 1; 2 * i < degree; ++i) sum = sum + (term(i) + term(degree - i));
  if (degree % 2 == 0) sum = sum + term(degree / 2);
  return sum;
}

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
