#pragma once
// Unit normals, lanes = patches. Where r_u x r_v is safely above the tangents' rounding errors, it is the normal. For
// other lanes:
// 1. On a collapsed edge the limit comes from r_uv.
// 2. Elsewhere the tangents are compared at their own scale.
// 3. Lanes that are still within rounding errors go to the caller's exact arithmetic.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/isa/lanes.h.

#include "kernel/sample/sample_kernel.inl.h"

/// A unit normal, how it was found, and the values that curvatures need.
template <class L>
struct Normal {
  typename L::Batch direction[3];
  typename L::Batch squared, reciprocal;  ///< |r_u x r_v|^2 and 1 / |r_u x r_v|, unless they are out of range
  typename L::Batch kind;                 ///< a NormalKind
  typename L::Batch uncertain;            ///< 1 where the tangents' own errors left it open, whatever was found later
};
constexpr int regular_normal = 0, limit_normal = 1, undefined_normal = 2;

/// Squared lengths of r_u x r_v within these limits lose nothing to overflow and underflow.
template <class T>
struct SafeRange {
  static constexpr T lowest = static_cast<T>(sizeof(T) == 4 ? 0x1p-80 : 0x1p-600);
  static constexpr T highest = static_cast<T>(sizeof(T) == 4 ? 0x1p100 : 0x1p600);
};

/// Tangents, and the largest error of their components.
template <class L>
struct Tangents {
  typename L::Batch du[3], dv[3], noise;
};

/// The sample and lanes being evaluated.
struct Place {
  int iu, iv, lane;
};

template <class L>
inline typename L::Batch dot(const typename L::Batch (&a)[3], const typename L::Batch (&b)[3]) {
  return L::fma(a[2], b[2], L::fma(a[1], b[1], a[0] * b[0]));
}

/// Computes n = a x b and returns its squared length.
template <class L>
inline typename L::Batch cross(const typename L::Batch (&a)[3], const typename L::Batch (&b)[3],
                               typename L::Batch (&n)[3]) {
  n[0] = L::fms(a[1], b[2], a[2] * b[1]);
  n[1] = L::fms(a[2], b[0], a[0] * b[2]);
  n[2] = L::fms(a[0], b[1], a[1] * b[0]);
  return L::fma(n[2], n[2], L::fma(n[1], n[1], n[0] * n[0]));
}

template <class L>
inline typename L::Batch largest_component(const typename L::Batch (&a)[3]) {
  return xsimd::max(xsimd::max(xsimd::abs(a[0]), xsimd::abs(a[1])), xsimd::abs(a[2]));
}

/// Returns 1 / sqrt(x) within 3 units in the last place for x in SafeRange.
/// 1. Half the exponent gives y, 3.5% off.
/// 2. With e = 1 - x y^2 the result is y (1 - e)^(-1/2), a polynomial in e (interpolated at Chebyshev nodes, 2.6e-8 off
///    where |e| <= 0.07).
/// 3. For doubles a step of Halley follows, y (1 + e/2 + 3 e^2/8).
///
/// Root and division would take longer than the rest of a normal. These multiply-adds also give the same bits on every
/// instruction set that fuses them.
template <class L>
[[gnu::always_inline]] inline typename L::Batch inverse_root(const typename L::Batch& x) {
  const auto constant = [](double value) { return L::broadcast(static_cast<typename L::Scalar>(value)); };
  const auto one = constant(1), y = L::inverse_root_guess(x), e = L::fnma(x * y, y, one);
  const auto cubic = L::fma(e, constant(0.274821153383), constant(0.314009297060));
  const auto root = L::fma(y * e, L::fma(e, L::fma(e, cubic, constant(0.374998308064)), constant(0.499998154470)), y);
  if constexpr (sizeof(typename L::Scalar) == 4) return root;
  const auto rest = L::fnma(x * root, root, one);
  return L::fma(root * rest, L::fma(rest, constant(0.375), constant(0.5)), root);
}

/// Computes n = a x b / |a x b|, with each vector first divided by its largest component. Returns 1 in the lanes where
/// the product exceeds what errors of `noise_a` and `noise_b` in the components of a and b can make of it:
/// 3 (noise_a / max|a| + noise_b / max|b|).
template <class L>
inline typename L::Batch certain_direction(const typename L::Batch (&a)[3], const typename L::Batch (&b)[3],
                                           const typename L::Batch& noise_a, const typename L::Batch& noise_b,
                                           typename L::Batch (&n)[3]) {
  using Limits = std::numeric_limits<typename L::Scalar>;
  const auto zero = L::broadcast(0), one = L::broadcast(1), three = L::broadcast(3);
  const auto largest_a = largest_component<L>(a), largest_b = largest_component<L>(b);
  const auto shorter = xsimd::min(largest_a, largest_b), longer = xsimd::max(largest_a, largest_b);
  const auto scale_a = one / largest_a, scale_b = one / largest_b;
  typename L::Batch unit_a[3], unit_b[3];
  for (int c = 0; c < 3; ++c) {
    unit_a[c] = a[c] * scale_a;
    unit_b[c] = b[c] * scale_b;
  }
  const auto squared = cross<L>(unit_a, unit_b, n);
  const auto error = three * (noise_a * scale_a + noise_b * scale_b);
  const auto certain =
      (shorter >= L::broadcast(Limits::min())) & (longer <= L::broadcast(Limits::max())) & (squared > error * error);
  const auto reciprocal = inverse_root<L>(squared);
  for (int c = 0; c < 3; ++c) n[c] = n[c] * reciprocal;
  return xsimd::select(certain, one, zero);
}

/// Lanes whose patch is one point along the edge on which their parameter lies.
template <class L>
struct OnCollapsed {
  typename L::Batch on;       ///< 1 there, 0 elsewhere
  typename L::Batch inwards;  ///< -1 where the parameter is 1, 1 elsewhere
};
/// Looks up `edges` of parameter k; `first_edge` is 0 for u, 2 for v.
template <class L>
inline OnCollapsed<L> on_collapsed(const GridJob<typename L::Scalar>& job, const std::uint8_t* edges, int k,
                                   int first_edge, int lane) {
  alignas(64) typename L::Scalar on[L::width], inwards[L::width];
  for (int l = 0; l < L::width; ++l) {
    const int edge = edges[job.by_lane ? k * block_lanes + lane + l : k];
    on[l] = edge == edge_inside ? 0 : job.collapsed[(first_edge + edge - edge_start) * block_lanes + lane + l];
    inwards[l] = edge == edge_end ? -1 : 1;
  }
  return {L::load(on), L::load(inwards)};
}

/// Returns weight i of parameter k, from its derivatives of an order on; by lane if the job is.
template <class L>
inline typename L::Batch weight_at(const GridJob<typename L::Scalar>& job, const typename L::Scalar* table, int k,
                                   int count, int i, int lane) {
  const std::ptrdiff_t at = std::ptrdiff_t{k} * 3 * count + i;
  return job.by_lane ? L::load(table + at * block_lanes + lane) : L::broadcast(table[at]);
}

/// Sets sum = weight * value for the first, and sum + weight * value after that.
template <class L, int Components>
inline void add_product(bool first, const typename L::Batch& weight, const typename L::Batch (&value)[Components],
                        typename L::Batch (&sum)[Components]) {
  for (int c = 0; c < Components; ++c) sum[c] = first ? weight * value[c] : L::fma(weight, value[c], sum[c]);
}

/// Turns sums over the net into Cartesian derivatives.
template <class L>
inline void derivatives_of(const typename L::Batch (&)[3], const typename L::Batch (&p_u)[3],
                           const typename L::Batch (&p_v)[3], const typename L::Batch (&p_uv)[3], Sample<L>& sample) {
  copy<L>(p_u, sample.du);
  copy<L>(p_v, sample.dv);
  copy<L>(p_uv, sample.duv);
}
template <class L>
inline void derivatives_of(const typename L::Batch (&p)[4], const typename L::Batch (&p_u)[4],
                           const typename L::Batch (&p_v)[4], const typename L::Batch (&p_uv)[4], Sample<L>& sample) {
  const auto q = L::broadcast(1) / p[3];
  sample.reciprocal_weight = q;
  for (int c = 0; c < 3; ++c) sample.position[c] = p[c] * q;
  divide_first<L>(p_u, q, sample.position, sample.du);
  divide_first<L>(p_v, q, sample.position, sample.dv);
  divide_mixed<L>(p_uv, p_u[3], p_v[3], sample, sample.duv);
}

/// Computes the first derivatives of a sample, and r_uv, again from the block with the same bits. So few points need
/// them that the others do not keep them.
template <class L, bool Rational>
[[gnu::noinline, gnu::cold]] void derive_again(const GridJob<typename L::Scalar>& job, const Place& place,
                                               Sample<L>& sample) {
  constexpr int components = Rational ? 4 : 3;
  const int count_u = job.degree_u + 1, count_v = job.degree_v + 1, lane = place.lane;
  typename L::Batch p[components], p_u[components], p_v[components], p_uv[components];
#pragma GCC unroll 1
  for (int j = 0; j < count_v; ++j) {
    typename L::Batch row[components], row_u[components];
#pragma GCC unroll 1
    for (int i = 0; i < count_u; ++i) {
      typename L::Batch point[components];
      for (int c = 0; c < components; ++c)
        point[c] = L::load(job.net + ((std::ptrdiff_t{i} * count_v + j) * components + c) * block_lanes + lane);
      add_product<L>(i == 0, weight_at<L>(job, job.u_weights, place.iu, count_u, i, lane), point, row);
      add_product<L>(i == 0, weight_at<L>(job, job.u_weights, place.iu, count_u, count_u + i, lane), point, row_u);
    }
    const auto weight = weight_at<L>(job, job.v_weights, place.iv, count_v, j, lane);
    const auto weight_v = weight_at<L>(job, job.v_weights, place.iv, count_v, count_v + j, lane);
    if (Rational) add_product<L>(j == 0, weight, row, p);
    add_product<L>(j == 0, weight, row_u, p_u);
    add_product<L>(j == 0, weight_v, row, p_v);
    add_product<L>(j == 0, weight_v, row_u, p_uv);
  }
  derivatives_of<L>(p, p_u, p_v, p_uv, sample);
}
template <class L>
inline void derive_again(const GridJob<typename L::Scalar>& job, const Place& place, Sample<L>& sample) {
  job.rational ? derive_again<L, true>(job, place, sample) : derive_again<L, false>(job, place, sample);
}

/// Finds the limit normals of lanes on a collapsed edge by one more derivative. Where r_u vanishes along v = 0, r_u(u,
/// k) = k r_uv + ..., so r_uv x r_v decides, and -r_uv x r_v at v = 1; likewise r_u x r_uv along u = 0. A corner of two
/// collapsed sides has no limit. The error of r_uv is taken as 4 max(m, n) times that of the tangents.
template <class L>
[[gnu::noinline, gnu::cold]] void limit_normals(const GridJob<typename L::Scalar>& job, const Tangents<L>& tangents,
                                                const Place& place, typename L::Batch& doubtful, Normal<L>& normal) {
  const auto zero = L::broadcast(0), one = L::broadcast(1);
  const auto u_edge = on_collapsed<L>(job, job.u_edges, place.iu, 0, place.lane);
  const auto v_edge = on_collapsed<L>(job, job.v_edges, place.iv, 2, place.lane);
  const auto on_u = u_edge.on, on_v = v_edge.on;
  if (!xsimd::any((on_u + on_v) > zero)) return;
  Sample<L> sample;
  derive_again<L>(job, place, sample);
  typename L::Batch a[3], b[3], n[3];
  const auto along_v = on_v > zero;
  for (int c = 0; c < 3; ++c) {
    a[c] = xsimd::select(along_v, sample.duv[c], tangents.du[c]);
    b[c] = xsimd::select(along_v, tangents.dv[c], sample.duv[c]);
  }
  const int degree = job.degree_u > job.degree_v ? job.degree_u : job.degree_v;
  const auto noise = tangents.noise, noise_uv = noise * L::broadcast(static_cast<typename L::Scalar>(4 * degree));
  const auto certain =
      certain_direction<L>(a, b, xsimd::select(along_v, noise_uv, noise), xsimd::select(along_v, noise, noise_uv), n);
  const auto sign = xsimd::select(along_v, v_edge.inwards, u_edge.inwards);
  const auto found = (doubtful > zero) & ((on_u + on_v) == one) & (certain > zero);
  for (int c = 0; c < 3; ++c) normal.direction[c] = xsimd::select(found, sign * n[c], normal.direction[c]);
  normal.kind = xsimd::select(found, L::broadcast(limit_normal), normal.kind);
  doubtful = xsimd::select(found | ((on_u + on_v) > one), zero, doubtful);
}

/// Finds the normals of doubtful lanes whose tangents, at their own scale, are safely independent.
template <class L>
[[gnu::noinline, gnu::cold]] void certain_normals(const Tangents<L>& tangents, typename L::Batch& doubtful,
                                                  Normal<L>& normal) {
  const auto zero = L::broadcast(0);
  typename L::Batch n[3];
  const auto certain = certain_direction<L>(tangents.du, tangents.dv, tangents.noise, tangents.noise, n);
  const auto found = (doubtful > zero) & (certain > zero);
  for (int c = 0; c < 3; ++c) normal.direction[c] = xsimd::select(found, n[c], normal.direction[c]);
  normal.kind = xsimd::select(found, zero, normal.kind);
  doubtful = xsimd::select(found, zero, doubtful);
}

/// Finds the normals of doubtful lanes one by one, in the caller's arithmetic.
template <class L>
[[gnu::noinline, gnu::cold]] void exact_normals(const GridJob<typename L::Scalar>& job, const Place& place,
                                                const typename L::Batch& doubtful, Normal<L>& normal) {
  using T = typename L::Scalar;
  alignas(64) T asked[L::width], kind[L::width], direction[3][L::width];
  L::store(asked, doubtful);
  L::store(kind, normal.kind);
  for (int c = 0; c < 3; ++c) L::store(direction[c], normal.direction[c]);
  for (int lane = 0; lane < L::width; ++lane) {
    if (!(asked[lane] > 0)) continue;
    T exact[3];
    kind[lane] = static_cast<T>(job.exact_normal(job.exact_context, place.iu, place.iv, place.lane + lane, exact));
    for (int c = 0; c < 3; ++c) direction[c][lane] = exact[c];
  }
  normal.kind = L::load(kind);
  for (int c = 0; c < 3; ++c) normal.direction[c] = L::load(direction[c]);
}

/// The inputs and outputs of a call for degenerate lanes, through memory, so that the main loop's vectors stay in
/// registers.
template <class L>
struct NormalExchange {
  using Vector = typename L::Scalar[L::width];
  alignas(64) Vector du[3];
  alignas(64) Vector dv[3];
  alignas(64) Vector reciprocal_weight;  ///< for rational patches
  alignas(64) Vector direction[3];       ///< in and out
  alignas(64) Vector kind;               ///< out
  alignas(64) Vector uncertain;          ///< out
};

/// For lanes that are samples of many patches: returns the lanes that are safe by their own patch's threshold, and the
/// patches' noise.
template <class L>
inline typename L::Batch own_thresholds(const GridJob<typename L::Scalar>& job, const Place& place,
                                        const typename L::Batch& safe, const NormalExchange<L>& exchange,
                                        typename L::Batch& noise) {
  using T = typename L::Scalar;
  const auto zero = L::broadcast(0), one = L::broadcast(1);
  alignas(64) T trusted[L::width], thresholds[L::width], noises[L::width];
  L::store(trusted, safe);
  L::store(thresholds, zero);
  L::store(noises, zero);
  for (int lane = 0; lane < L::width; ++lane)
    if (!(trusted[lane] > 0))
      job.lane_threshold(job.exact_context, place.iu, place.lane + lane, thresholds + lane, noises + lane);
  noise = L::load(noises);
  typename L::Batch du[3], dv[3], n[3];
  for (int c = 0; c < 3; ++c) {
    du[c] = L::load(exchange.du[c]);
    dv[c] = L::load(exchange.dv[c]);
  }
  const auto squared = cross<L>(du, dv, n);
  const auto own = (squared > L::load(thresholds)) & (squared <= L::broadcast(SafeRange<T>::highest));
  return xsimd::select((safe > zero) | own, one, zero);
}

/// Finds the normals of lanes whose |r_u x r_v|^2 is out of range or in doubt. `assumed_safe` is 1 in the other lanes,
/// which are unchanged, so that a lane's bits do not depend on its neighbours.
template <class L>
[[gnu::noinline, gnu::cold]] void degenerate_normals(const GridJob<typename L::Scalar>& job, const Place& place,
                                                     const typename L::Batch& assumed_safe,
                                                     NormalExchange<L>& exchange) {
  const auto zero = L::broadcast(0), one = L::broadcast(1);
  typename L::Batch safe = assumed_safe, noise;
  if (job.lane_threshold) {
    safe = own_thresholds<L>(job, place, safe, exchange, noise);
  } else {
    noise = L::load(job.noise + place.lane);
  }
  Tangents<L> tangents;
  tangents.noise = job.rational ? noise * L::load(exchange.reciprocal_weight) : noise;
  Normal<L> normal;
  for (int c = 0; c < 3; ++c) {
    tangents.du[c] = L::load(exchange.du[c]);
    tangents.dv[c] = L::load(exchange.dv[c]);
    normal.direction[c] = xsimd::select(safe > zero, L::load(exchange.direction[c]), zero);
  }
  normal.kind = xsimd::select(safe > zero, zero, L::broadcast(undefined_normal));
  auto doubtful = xsimd::select((safe > zero) | (noise < zero), zero, one);
  if (job.collapsed) limit_normals<L>(job, tangents, place, doubtful, normal);
  if (xsimd::any(doubtful > zero)) certain_normals<L>(tangents, doubtful, normal);
  L::store(exchange.uncertain, doubtful);
  if (xsimd::any(doubtful > zero)) exact_normals<L>(job, place, doubtful, normal);
  for (int c = 0; c < 3; ++c) L::store(exchange.direction[c], normal.direction[c]);
  L::store(exchange.kind, normal.kind);
}

/// Turns r_u x r_v in `direction` and its square in `squared` into the unit normal. Returns the lanes where that is
/// valid.
template <class L>
[[gnu::always_inline]] inline auto regular_normals(const GridJob<typename L::Scalar>& job, int lane,
                                                   Normal<L>& normal) {
  normal.reciprocal = inverse_root<L>(normal.squared);
  normal.kind = L::broadcast(regular_normal);
  normal.uncertain = L::broadcast(0);
  for (int c = 0; c < 3; ++c) normal.direction[c] = normal.direction[c] * normal.reciprocal;
  return (normal.squared > L::load(job.threshold + lane)) &
         (normal.squared <= L::broadcast(SafeRange<typename L::Scalar>::highest));
}

template <class L>
[[gnu::always_inline]] inline void put_tangents(bool rational, const Sample<L>& sample, NormalExchange<L>& exchange) {
  for (int c = 0; c < 3; ++c) {
    L::store(exchange.du[c], sample.du[c]);
    L::store(exchange.dv[c], sample.dv[c]);
  }
  if (rational) L::store(exchange.reciprocal_weight, sample.reciprocal_weight);
}

template <class L>
[[gnu::always_inline]] inline void take_normal(const NormalExchange<L>& exchange, Normal<L>& normal) {
  for (int c = 0; c < 3; ++c) normal.direction[c] = L::load(exchange.direction[c]);
  normal.kind = L::load(exchange.kind);
  normal.uncertain = L::load(exchange.uncertain);
}

/// Computes the unit normal; zero where there is none.
template <class L, bool Rational>
[[gnu::always_inline]] inline void unit_normal(const GridJob<typename L::Scalar>& job, const Sample<L>& sample,
                                               const Place& place, Normal<L>& normal) {
  normal.squared = cross<L>(sample.du, sample.dv, normal.direction);
  const auto safe = regular_normals<L>(job, place.lane, normal);
  if (xsimd::all(safe)) return;
  NormalExchange<L> exchange;
  put_tangents<L>(Rational, sample, exchange);
  for (int c = 0; c < 3; ++c) L::store(exchange.direction[c], normal.direction[c]);
  degenerate_normals<L>(job, place, xsimd::select(safe, L::broadcast(1), L::broadcast(0)), exchange);
  take_normal<L>(exchange, normal);
}
