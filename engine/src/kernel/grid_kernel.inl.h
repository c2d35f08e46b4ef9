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

/// `Count` neighbouring row curves from index j: independent sums, so that the multiply-adds overlap.
template <class L, int Count, int Components, int Capacity>
inline void row_curves_from(int j, const typename L::Scalar* net, const typename L::Scalar* weights, int count_u,
                            std::ptrdiff_t row, typename L::Batch (&curve)[Components][Capacity]) {
  const auto* coefficient = net + j * Components * block_lanes;
  typename L::Batch sum[Count][Components];
  const auto first = L::broadcast(weights[0]);
  for (int k = 0; k < Count; ++k)
    for (int c = 0; c < Components; ++c) sum[k][c] = first * L::load(coefficient + (k * Components + c) * block_lanes);
  for (int i = 1; i < count_u; ++i) {
    const auto weight = L::broadcast(weights[i]);
    coefficient += row;
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Components; ++c)
        sum[k][c] = L::fma(weight, L::load(coefficient + (k * Components + c) * block_lanes), sum[k][c]);
  }
  for (int k = 0; k < Count; ++k)
    for (int c = 0; c < Components; ++c) curve[c][j + k] = sum[k][c];
}

/// The row curves of one u: curve[component][j] = sum_i weights[i] net[i][j][component], i ascending.
template <class L, int DegreeV, int Components, int Capacity>
inline void row_curves(const typename L::Scalar* net, const typename L::Scalar* weights, int count_u, int count_v,
                       typename L::Batch (&curve)[Components][Capacity]) {
  const std::ptrdiff_t row = std::ptrdiff_t{count_v} * Components * block_lanes;
  if constexpr (DegreeV > 0) {
    row_curves_from<L, DegreeV + 1>(0, net, weights, count_u, row, curve);
  } else {
    int j = 0;
    for (; j + 4 <= count_v; j += 4) row_curves_from<L, 4>(j, net, weights, count_u, row, curve);
    for (; j < count_v; ++j) row_curves_from<L, 1>(j, net, weights, count_u, row, curve);
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

template <class L>
inline typename L::Batch largest_component(const typename L::Batch (&a)[3]) {
  return xsimd::max(xsimd::max(xsimd::abs(a[0]), xsimd::abs(a[1])), xsimd::abs(a[2]));
}

/// a x b, and its squared length.
template <class L>
inline typename L::Batch cross(const typename L::Batch (&a)[3], const typename L::Batch (&b)[3], typename L::Batch (&n)[3]) {
  n[0] = L::fms(a[1], b[2], a[2] * b[1]);
  n[1] = L::fms(a[2], b[0], a[0] * b[2]);
  n[2] = L::fms(a[0], b[1], a[1] * b[0]);
  return L::fma(n[2], n[2], L::fma(n[1], n[1], n[0] * n[0]));
}

/// Normals of lanes whose squared length left the range of the numbers: both tangents are divided by their largest component
/// first. Zero where a tangent is zero, subnormal or infinite, or both are parallel. Other lanes keep what they have, so that
/// a lane's bits don't depend on its neighbours.
template <class L>
void rescaled_normal(const Sample<L>& sample, const typename L::Batch& in_range, typename L::Batch (&normal)[3]) {
  using Limits = std::numeric_limits<typename L::Scalar>;
  const auto zero = L::broadcast(0), one = L::broadcast(1);
  const auto lengths_u = largest_component<L>(sample.du), lengths_v = largest_component<L>(sample.dv);
  const auto shorter = xsimd::min(lengths_u, lengths_v), longer = xsimd::max(lengths_u, lengths_v);
  const auto defined = (shorter >= L::broadcast(Limits::min())) & (longer <= L::broadcast(Limits::max()));
  typename L::Batch a[3], b[3], n[3];
  for (int c = 0; c < 3; ++c) {
    a[c] = sample.du[c] / lengths_u;
    b[c] = sample.dv[c] / lengths_v;
  }
  const auto squared = cross<L>(a, b, n);
  const auto reciprocal = one / xsimd::sqrt(squared);
  for (int c = 0; c < 3; ++c) {
    const auto rescaled = xsimd::select(defined & (squared > zero), n[c] * reciprocal, zero);
    normal[c] = xsimd::select(in_range > zero, normal[c], rescaled);
  }
}

/// r_u x r_v / |r_u x r_v| by IEEE square root and division; zero where it is not defined.
template <class L>
inline void unit_normal(const Sample<L>& sample, typename L::Batch (&normal)[3]) {
  constexpr bool is_float = sizeof(typename L::Scalar) == 4;
  const auto lowest = L::broadcast(is_float ? 0x1p-80f : static_cast<typename L::Scalar>(0x1p-600));
  const auto highest = L::broadcast(is_float ? 0x1p100f : static_cast<typename L::Scalar>(0x1p600));
  const auto squared = cross<L>(sample.du, sample.dv, normal);
  const auto reciprocal = L::broadcast(1) / xsimd::sqrt(squared);
  for (int c = 0; c < 3; ++c) normal[c] = normal[c] * reciprocal;
  const auto in_range = (squared >= lowest) & (squared <= highest);
  if (!xsimd::all(in_range)) rescaled_normal<L>(sample, xsimd::select(in_range, L::broadcast(1), L::broadcast(0)), normal);
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

/// The row curves of one u for one vector of patches.
template <class L, int Components, int Capacity>
struct RowCurves {
  typename L::Batch value[Components][Capacity], du[Components][Capacity];
};

/// One sample from the row curves.
template <class L, int DegreeV, bool Derivatives, int Components, int Capacity>
inline Sample<L> evaluate_sample(const RowCurves<L, Components, Capacity>& curves, const typename L::Scalar* weights, int count_v,
                                 const typename L::Scalar (&offset)[3]) {
  typename L::Batch point[Components], point_u[Components], point_v[Components];
  Sample<L> sample;
  combine<L>(weights, count_v, curves.value, point);
  if constexpr (Derivatives) {
    combine<L>(weights, count_v, curves.du, point_u);
    combine<L>(weights + count_v, count_v, curves.value, point_v);
  }
  if constexpr (Components == 4) {
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
  if constexpr (sizeof(typename L::Scalar) == 8) {
    for (int c = 0; c < 3; ++c) sample.position[c] = sample.position[c] + L::broadcast(offset[c]);
  }
  return sample;
}

template <class L, bool Derivatives, bool Streaming>
inline void store_sample(const GridJob<typename L::Scalar>& job, std::ptrdiff_t out, const Sample<L>& sample) {
  if constexpr (!Derivatives) {
    store<L, Streaming>(job.position + out, sample.position);
  } else {
    if (job.position) store<L, Streaming>(job.position + out, sample.position);
    if (job.du) store<L, Streaming>(job.du + out, sample.du);
    if (job.dv) store<L, Streaming>(job.dv + out, sample.dv);
    if (job.normal) {
      typename L::Batch normal[3];
      unit_normal<L>(sample, normal);
      store<L, Streaming>(job.normal + out, normal);
    }
  }
}

/// `Groups` neighbouring vectors of patches, from `lane`, over the job's part of the grid. DegreeV 0 reads the degree from the job.
template <class L, int DegreeV, bool Rational, bool Derivatives, bool Streaming, int Groups>
void evaluate_lanes(const GridJob<typename L::Scalar>& job, int lane) {
  using T = typename L::Scalar;
  constexpr int components = Rational ? 4 : 3;
  constexpr int capacity = DegreeV > 0 ? DegreeV + 1 : max_order;
  const int count_u = job.degree_u + 1;
  const int count_v = DegreeV > 0 ? DegreeV + 1 : job.degree_v + 1;
  std::ptrdiff_t out = lane;

  RowCurves<L, components, capacity> curves[Groups];
  for (int iu = job.u_begin; iu < job.u_end; ++iu) {
    const T* u_weights = job.u_weights + std::ptrdiff_t{iu} * 2 * count_u;
    for (int group = 0; group < Groups; ++group) {
      const T* net = job.net + lane + group * L::width;
      row_curves<L, DegreeV>(net, u_weights, count_u, count_v, curves[group].value);
      if constexpr (Derivatives) row_curves<L, DegreeV>(net, u_weights + count_u, count_u, count_v, curves[group].du);
    }
    for (int iv = job.v_begin; iv < job.v_end; ++iv, out += job.sample_step) {
      const T* v_weights = job.v_weights + std::ptrdiff_t{iv} * 2 * count_v;
      for (int group = 0; group < Groups; ++group) {
        const Sample<L> sample = evaluate_sample<L, DegreeV, Derivatives>(curves[group], v_weights, count_v, job.offset);
        store_sample<L, Derivatives, Streaming>(job, out + group * L::width, sample);
      }
    }
  }
}

/// Plain stores take one vector of patches after the other; streaming stores take whole cache lines, since a line that is streamed
/// in parts goes to memory in parts.
template <class L, int DegreeV, bool Rational, bool Derivatives>
void evaluate_block(const GridJob<typename L::Scalar>& job) {
  constexpr int line = 64 / static_cast<int>(sizeof(typename L::Scalar));
  if (job.streaming) {
    for (int lane = 0; lane < block_lanes; lane += line)
      evaluate_lanes<L, DegreeV, Rational, Derivatives, true, line / L::width>(job, lane);
  } else {
    for (int lane = 0; lane < block_lanes; lane += L::width)
      evaluate_lanes<L, DegreeV, Rational, Derivatives, false, 1>(job, lane);
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
