// Kernel 1, lanes = patches: each vector holds one coefficient of 4, 8 or 16 patches of a block. For each u the row
// curves q_j = sum_i f_i(u) c_ij stay in registers while v runs: r = sum_j g_j(v) q_j. The weights f, g are tabulated, so the
// same code evaluates Bernstein and power coefficients.
// Included by isa_*.cpp inside the ISA's namespace, after Lanes<T> and this_isa.

/// r(u,v), r_u and r_v in Cartesian coordinates, three components each.
template <class L>
struct Sample {
  typename L::Batch position[3], du[3], dv[3];
};

/// sum_j weights[j] * curve[component][j], in ascending order: one multiplication, then fused multiply-adds.
template <class L, int Components, int Capacity>
inline void combine(const typename L::Scalar* weights, int count, const typename L::Batch (&curve)[Components][Capacity],
                    typename L::Batch (&sum)[Components]) {
  const auto first = L::broadcast(weights[0]);
  for (int c = 0; c < Components; ++c) sum[c] = first * curve[c][0];
#pragma GCC unroll 4
  for (int j = 1; j < count; ++j) {
    const auto weight = L::broadcast(weights[j]);
    for (int c = 0; c < Components; ++c) sum[c] = L::fma(weight, curve[c][j], sum[c]);
  }
}

/// The row curves of one u: curve[component][j] = sum_i weights[i] net[i][j][component].
template <class L, int Components, int Capacity>
inline void row_curves(const typename L::Scalar* net, const typename L::Scalar* weights, int count_u, int count_v,
                       typename L::Batch (&curve)[Components][Capacity]) {
  const std::ptrdiff_t row = std::ptrdiff_t{count_v} * Components * block_lanes;
#pragma GCC unroll 4
  for (int j = 0; j < count_v; ++j) {
    for (int c = 0; c < Components; ++c) {
      const auto* coefficient = net + (j * Components + c) * block_lanes;
      auto sum = L::broadcast(weights[0]) * L::load(coefficient);
      for (int i = 1; i < count_u; ++i) sum = L::fma(L::broadcast(weights[i]), L::load(coefficient + i * row), sum);
      curve[c][j] = sum;
    }
  }
}

/// From homogeneous to Cartesian: r = P / w, r_u = (P_u - w_u r) / w (Piegl and Tiller, The NURBS Book, eq. 4.20).
template <class L, bool Derivatives>
inline void divide_by_weight(const typename L::Batch (&point)[4], const typename L::Batch (&point_u)[4],
                             const typename L::Batch (&point_v)[4], Sample<L>& sample) {
  const auto reciprocal = L::broadcast(1) / point[3];
  for (int c = 0; c < 3; ++c) {
    sample.position[c] = point[c] * reciprocal;
    if constexpr (Derivatives) {
      sample.du[c] = L::fnma(point_u[3], sample.position[c], point_u[c]) * reciprocal;
      sample.dv[c] = L::fnma(point_v[3], sample.position[c], point_v[c]) * reciprocal;
    }
  }
}

/// r_u x r_v / |r_u x r_v| by IEEE square root and division; zero where the cross product is zero.
template <class L>
inline void unit_normal(const Sample<L>& sample, typename L::Scalar scale, typename L::Batch (&normal)[3]) {
  using Batch = typename L::Batch;
  Batch a[3], b[3];
  for (int c = 0; c < 3; ++c) {
    a[c] = sample.du[c];
    b[c] = sample.dv[c];
  }
  if (scale != 1) {
    for (int c = 0; c < 3; ++c) {
      a[c] = a[c] * L::broadcast(scale);
      b[c] = b[c] * L::broadcast(scale);
    }
  }
  normal[0] = L::fms(a[1], b[2], a[2] * b[1]);
  normal[1] = L::fms(a[2], b[0], a[0] * b[2]);
  normal[2] = L::fms(a[0], b[1], a[1] * b[0]);
  const Batch squared = L::fma(normal[2], normal[2], L::fma(normal[1], normal[1], normal[0] * normal[0]));
  const Batch reciprocal = L::where_positive(squared, L::broadcast(1) / xsimd::sqrt(squared));
  for (int c = 0; c < 3; ++c) normal[c] = normal[c] * reciprocal;
}

template <class L, bool Streaming>
inline void store(typename L::Scalar* memory, const typename L::Batch (&vector)[3]) {
  for (int c = 0; c < 3; ++c) {
    if constexpr (Streaming) {
      L::stream(memory + c * block_lanes, vector[c]);
    } else {
      L::store(memory + c * block_lanes, vector[c]);
    }
  }
}

/// One vector of patches over the job's part of the grid. DegreeV 0 reads the degree from the job.
template <class L, int DegreeV, bool Rational, bool Derivatives, bool Streaming>
void evaluate_lanes(const GridJob<typename L::Scalar>& job, int lane) {
  using T = typename L::Scalar;
  constexpr int components = Rational ? 4 : 3;
  constexpr int capacity = DegreeV > 0 ? DegreeV + 1 : max_order;
  const int count_u = job.degree_u + 1;
  const int count_v = DegreeV > 0 ? DegreeV + 1 : job.degree_v + 1;
  const T* net = job.net + lane;
  std::ptrdiff_t out = lane;

  typename L::Batch curve[components][capacity], curve_u[components][capacity];
  typename L::Batch point[components], point_u[components], point_v[components];
  for (int iu = job.u_begin; iu < job.u_end; ++iu) {
    const T* u_weights = job.u_weights + std::ptrdiff_t{iu} * 2 * count_u;
    row_curves<L>(net, u_weights, count_u, count_v, curve);
    if constexpr (Derivatives) row_curves<L>(net, u_weights + count_u, count_u, count_v, curve_u);
    for (int iv = job.v_begin; iv < job.v_end; ++iv, out += job.sample_step) {
      const T* v_weights = job.v_weights + std::ptrdiff_t{iv} * 2 * count_v;
      Sample<L> sample;
      combine<L>(v_weights, count_v, curve, point);
      if constexpr (Derivatives) {
        combine<L>(v_weights, count_v, curve_u, point_u);
        combine<L>(v_weights + count_v, count_v, curve, point_v);
      }
      if constexpr (Rational) {
        divide_by_weight<L, Derivatives>(point, point_u, point_v, sample);
      } else {
        for (int c = 0; c < 3; ++c) {
          sample.position[c] = point[c];
          if constexpr (Derivatives) {
            sample.du[c] = point_u[c];
            sample.dv[c] = point_v[c];
          }
        }
      }
      if constexpr (sizeof(T) == 8) {
        for (int c = 0; c < 3; ++c) sample.position[c] = sample.position[c] + L::broadcast(job.offset[c]);
      }
      if constexpr (Derivatives) {
        if (job.position) store<L, Streaming>(job.position + out, sample.position);
        if (job.du) store<L, Streaming>(job.du + out, sample.du);
        if (job.dv) store<L, Streaming>(job.dv + out, sample.dv);
        if (job.normal) {
          typename L::Batch normal[3];
          unit_normal<L>(sample, job.normal_scale, normal);
          store<L, Streaming>(job.normal + out, normal);
        }
      } else {
        store<L, Streaming>(job.position + out, sample.position);
      }
    }
  }
}

template <class L, int DegreeV, bool Rational, bool Derivatives>
void evaluate_block(const GridJob<typename L::Scalar>& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    if (job.streaming) {
      evaluate_lanes<L, DegreeV, Rational, Derivatives, true>(job, lane);
    } else {
      evaluate_lanes<L, DegreeV, Rational, Derivatives, false>(job, lane);
    }
  }
}

template <class L, int DegreeV>
void choose_outputs(const GridJob<typename L::Scalar>& job) {
  const bool derivatives = job.du || job.dv || job.normal;
  if (job.rational) {
    derivatives ? evaluate_block<L, DegreeV, true, true>(job) : evaluate_block<L, DegreeV, true, false>(job);
  } else {
    derivatives ? evaluate_block<L, DegreeV, false, true>(job) : evaluate_block<L, DegreeV, false, false>(job);
  }
}

template <class L>
Isa evaluate_grid(const GridJob<typename L::Scalar>& job) {
  switch (job.degree_v) {
    case 1: choose_outputs<L, 1>(job); break;
    case 2: choose_outputs<L, 2>(job); break;
    case 3: choose_outputs<L, 3>(job); break;
    default: choose_outputs<L, 0>(job); break;
  }
  if (job.streaming) _mm_sfence();
  return this_isa;
}
