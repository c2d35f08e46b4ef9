#pragma once
// One sample of a block from the row curves of its u, lanes = patches: position and derivatives up to an order,
// polynomial or rational.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/block_lanes.h, kernel/isa/lanes.h.

/// Coefficients of the highest degree that an evaluation is made for. Degree 0 is any degree.
template <int Degree>
constexpr int capacity_of = Degree > 0 ? Degree + 1 : max_order;

/// r(u,v) and its derivatives in Cartesian coordinates, three components each; those above the order are not set.
template <class L>
struct Sample {
  typename L::Batch position[3], du[3], dv[3], duu[3], duv[3], dvv[3];
  typename L::Batch reciprocal_weight;  ///< for rational patches
};

/// The row curves of one u for one vector of patches: their values, and their first and second derivatives by u.
template <class L, int Order, int Components, int Capacity>
struct RowCurves {
  typename L::Batch by_u[Order + 1][Components][Capacity];
};

/// Weights that differ from lane to lane, `[i][lane]` of a block.
template <class L>
struct LaneWeights {
  const typename L::Scalar* first;
  typename L::Batch operator[](int i) const { return L::load(first + i * block_lanes); }
  LaneWeights operator+(int count) const { return {first + count * block_lanes}; }
};
/// Returns the weights of parameter k, of `count` coefficients, for the lanes from `lane` on.
template <class L, bool ByLane>
[[gnu::always_inline]] inline auto weights_at(const typename L::Scalar* table, int k, int count, int lane) {
  const std::ptrdiff_t first = std::ptrdiff_t{k} * 3 * count;
  if constexpr (ByLane) {
    return LaneWeights<L>{table + first * block_lanes + lane};
  } else {
    return table + first;
  }
}

/// Calls use(i) from `first` to before `end`: unrolled where the capacity says that the degree is known, since there it
/// pays, and a loop elsewhere.
template <int Capacity, class Use>
[[gnu::always_inline]] inline void for_each_coefficient(int first, int end, Use use) {
  if constexpr (Capacity < max_order) {
#pragma GCC unroll 4
    for (int i = first; i < end; ++i) use(i);
  } else {
#pragma GCC unroll 1
    for (int i = first; i < end; ++i) use(i);
  }
}

/// Returns one weight for all lanes, or one per lane.
template <class L>
inline typename L::Batch in_lanes(typename L::Scalar weight) {
  return L::broadcast(weight);
}
template <class L>
inline typename L::Batch in_lanes(const typename L::Scalar (&weight)[L::width]) {
  return L::load(weight);
}
template <class L>
inline const typename L::Batch& in_lanes(const typename L::Batch& weight) {
  return weight;
}

// Rounding errors of a position. u is the unit roundoff (2^-24, or 2^-53 in double), m and n are the degrees, R is the
// largest |V - o| of the control points V and the origin o.
// 1. A coefficient is rounded once when it is packed, and the weights f_i, g_j are once each when they are tabulated
//    (computed for scattered samples: once, by kernel/point/lane_weights.inl.h).
// 2. A term f_i g_j c_ij goes through at most m + 1 roundings in the row's sum, 1 product and m fused multiply-adds,
//    and n + 1 in the column's. That is m + n + 5 with those of 1, and 6 with terms of second order.
// 3. So a sum errs by at most (m + n + 6) u sum f_i g_j |c_ij| (Higham, Accuracy and Stability of Numerical Algorithms,
//    2nd ed., sec. 3.1). Bernstein weights are not negative and add up to 1: this is (m + n + 6) u R, or d + 3 units of
//    2 u with d, the higher degree.
// 4. For rational patches numerator and denominator err so, relative to sum f_i g_j w_ij: together twice as much.
// 5. Step 2 adds up worst cases. Roundings that are independent and small where partial sums are small give 2 units,
//    which the tests hold; these are the bounds that evaluate.h states.
// vertex_rounding() (tess/plan/certified_plan.h) and all that is proven of meshes use step 3, not step 5.

/// Computes sum_j weights[j] * curve[component][j], in ascending order: one multiplication, then fused multiply-adds.
template <class L, class Weights, int Components, int Capacity>
inline void combine(const Weights weights, int count, const typename L::Batch (&curve)[Components][Capacity],
                    typename L::Batch (&sum)[Components]) {
  const auto first = in_lanes<L>(weights[0]);
  for (int c = 0; c < Components; ++c) sum[c] = first * curve[c][0];
  for_each_coefficient<Capacity>(
      1, count, [&](int j) __attribute__((always_inline)) {
        const auto weight = in_lanes<L>(weights[j]);
        for (int c = 0; c < Components; ++c) sum[c] = L::fma(weight, curve[c][j], sum[c]);
      });
}

/// Computes `Count` neighbouring row curves from index j, and their derivatives up to the order. Each coefficient is
/// read once, and the sums are independent, so that the multiply-adds overlap.
template <class L, int Count, int Order, class Weights, int Components, int Capacity>
[[gnu::always_inline]] inline void row_curves_from(int j, const typename L::Scalar* net, const Weights weights,
                                                   int count_u, std::ptrdiff_t row,
                                                   RowCurves<L, Order, Components, Capacity>& curves) {
  const auto* coefficient = net + j * Components * block_lanes;
  typename L::Batch sum[Order + 1][Count][Components], weight[Order + 1];
  for (int order = 0; order <= Order; ++order) weight[order] = in_lanes<L>((weights + order * count_u)[0]);
  for (int k = 0; k < Count; ++k)
    for (int c = 0; c < Components; ++c) {
      const auto at = L::load(coefficient + (k * Components + c) * block_lanes);
      for (int order = 0; order <= Order; ++order) sum[order][k][c] = weight[order] * at;
    }
  for (int i = 1; i < count_u; ++i) {
    for (int order = 0; order <= Order; ++order) weight[order] = in_lanes<L>((weights + order * count_u)[i]);
    coefficient += row;
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Components; ++c) {
        const auto at = L::load(coefficient + (k * Components + c) * block_lanes);
        for (int order = 0; order <= Order; ++order) sum[order][k][c] = L::fma(weight[order], at, sum[order][k][c]);
      }
  }
  for (int order = 0; order <= Order; ++order)
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Components; ++c) curves.by_u[order][c][j + k] = sum[order][k][c];
}

/// Computes the row curves of one u: by_u[order][component][j] = sum_i weights[order][i] net[i][j][component], i
/// ascending; as many at once as the registers hold sums of all orders.
template <class L, int DegreeV, int Order, class Weights, int Components, int Capacity>
[[gnu::always_inline]] inline void row_curves(const typename L::Scalar* net, const Weights weights, int count_u,
                                              int count_v, RowCurves<L, Order, Components, Capacity>& curves) {
  constexpr int fitting = (L::registers * 3 / 4) / ((Order + 1) * Components), most = fitting < 4 ? fitting : 4;
  const std::ptrdiff_t row = std::ptrdiff_t{count_v} * Components * block_lanes;
  if constexpr (DegreeV > 0 && DegreeV < most) {
    row_curves_from<L, DegreeV + 1>(0, net, weights, count_u, row, curves);
  } else if constexpr (DegreeV > 0) {
    constexpr int whole = (DegreeV + 1) / most * most;
#pragma GCC unroll 4
    for (int j = 0; j < whole; j += most) row_curves_from<L, most>(j, net, weights, count_u, row, curves);
#pragma GCC unroll 4
    for (int j = whole; j <= DegreeV; ++j) row_curves_from<L, 1>(j, net, weights, count_u, row, curves);
  } else {
    int j = 0;
    for (; j + most <= count_v; j += most) row_curves_from<L, most>(j, net, weights, count_u, row, curves);
    for (; j < count_v; ++j) row_curves_from<L, 1>(j, net, weights, count_u, row, curves);
  }
}

// From homogeneous A = (P, w) to Cartesian (Piegl and Tiller, The NURBS Book, eq. 4.20), q = 1 / w:
//   r = P q,  r_u = (P_u - w_u r) q,
//   r_uu = (P_uu - 2 w_u r_u - w_uu r) q,  r_uv = (P_uv - w_u r_v - w_v r_u - w_uv r) q.
//
// Rounding errors of derivatives, to first order. W is the largest weight, w the weight at the point, e a few
// roundings.
// 1. Sums of Bernstein weights err by e w in w and by e R in r.
// 2. The weights of a derivative add up to at most 2 d, so P_u errs by 2 d e W R and w_u by 2 d e W.
// 3. With |r| <= R, |w_u| <= d W and |r_u| <= 2 d R W / w the error of r_u is at most (2 + 2 + 1 + 2) e d R W / w: from
//    P_u, w_u, r and the division.
// 4. This order is reached midway between points V and -V, even where w (V - o) is small: the error of r remains, and
//    points of weight W near o make w_u large.
// 5. For r_uu the term 2 w_u r_u brings W / w once more: its error is at most 2 (4 + 7) e d^2 R (W / w)^2.

template <class L>
inline void divide_first(const typename L::Batch (&point_u)[4], const typename L::Batch& q,
                         const typename L::Batch (&r)[3], typename L::Batch (&r_u)[3]) {
  for (int c = 0; c < 3; ++c) r_u[c] = L::fnma(point_u[3], r[c], point_u[c]) * q;
}

template <class L>
inline void divide_mixed(const typename L::Batch (&point_uv)[4], const typename L::Batch& w_u,
                         const typename L::Batch& w_v, const Sample<L>& at, typename L::Batch (&r_uv)[3]) {
  for (int c = 0; c < 3; ++c) {
    const auto less_first = L::fnma(w_v, at.du[c], L::fnma(w_u, at.dv[c], point_uv[c]));
    r_uv[c] = L::fnma(point_uv[3], at.position[c], less_first) * at.reciprocal_weight;
  }
}

template <class L>
inline void divide_second(const typename L::Batch (&point_uu)[4], const typename L::Batch& w_u,
                          const typename L::Batch (&r_u)[3], const Sample<L>& at, typename L::Batch (&r_uu)[3]) {
  const auto twice = w_u + w_u;
  for (int c = 0; c < 3; ++c)
    r_uu[c] = L::fnma(point_uu[3], at.position[c], L::fnma(twice, r_u[c], point_uu[c])) * at.reciprocal_weight;
}

template <class L>
inline void copy(const typename L::Batch (&from)[3], typename L::Batch (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = from[c];
}

/// Evaluates one sample of order `Order` from the row curves; `weights` are those of v, `[order][j]`.
template <class L, int Order, int Components, int Capacity, class Weights>
[[gnu::always_inline]] inline void evaluate_sample(const RowCurves<L, Order, Components, Capacity>& curves,
                                                   const Weights weights, int count, Sample<L>& sample) {
  typename L::Batch p[Components], p_u[Components], p_v[Components], p_uu[Components], p_uv[Components],
      p_vv[Components];
  combine<L>(weights, count, curves.by_u[0], p);
  if constexpr (Order >= 1) {
    combine<L>(weights, count, curves.by_u[1], p_u);
    combine<L>(weights + count, count, curves.by_u[0], p_v);
  }
  if constexpr (Order >= 2) {
    combine<L>(weights, count, curves.by_u[2], p_uu);
    combine<L>(weights + count, count, curves.by_u[1], p_uv);
    combine<L>(weights + 2 * count, count, curves.by_u[0], p_vv);
  }
  if constexpr (Components == 3) {
    copy<L>(p, sample.position);
    if constexpr (Order >= 1) copy<L>(p_u, sample.du), copy<L>(p_v, sample.dv);
    if constexpr (Order >= 2) copy<L>(p_uu, sample.duu), copy<L>(p_uv, sample.duv), copy<L>(p_vv, sample.dvv);
  } else {
    const auto q = L::broadcast(1) / p[3];
    sample.reciprocal_weight = q;
    for (int c = 0; c < 3; ++c) sample.position[c] = p[c] * q;
    if constexpr (Order >= 1) {
      divide_first<L>(p_u, q, sample.position, sample.du);
      divide_first<L>(p_v, q, sample.position, sample.dv);
    }
    if constexpr (Order >= 2) {
      divide_second<L>(p_uu, p_u[3], sample.du, sample, sample.duu);
      divide_mixed<L>(p_uv, p_u[3], p_v[3], sample, sample.duv);
      divide_second<L>(p_vv, p_v[3], sample.dv, sample, sample.dvv);
    }
  }
}
