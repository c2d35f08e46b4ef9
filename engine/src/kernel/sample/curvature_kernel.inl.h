#pragma once
// Fundamental forms, curvatures and principal directions, lanes = patches, as surface/net/local_geometry.cpp defines
// them. With e1 = r_u / |r_u|, e2 = N x e1 the second form is the symmetric matrix (s11, s12; s12, s22), so k1 and k2
// do not suffer from H^2 - K (do Carmo, Differential Geometry of Curves and Surfaces, sec. 3.3). With E = r_u.r_u, F =
// r_u.r_v, L = r_uu.N, ...:
//   s11 = L / E,  s12 = (M - (F/E) L) / |r_u x r_v|,  s22 = (N - 2 (F/E) M + (F/E)^2 L) E / |r_u x r_v|^2.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/isa/lanes.h.

#include "kernel/sample/normal_kernel.inl.h"

template <class L>
struct Curvature {
  typename L::Batch e, f, g, l, m, n;  ///< the two forms
  typename L::Batch s11, s12, s22;
  typename L::Batch r_u[3], inverse_e;  ///< the direction of r_u, and 1 over its squared length
  typename L::Batch skewed;             ///< 1 where the sine of the tangents' angle is above the limit
  typename L::Batch defined;            ///< 1 where curvatures are defined
};
constexpr int distinct_curvatures = 0, umbilic_point = 1, undefined_curvatures = 2;

/// The largest |s_ij| that counts as a number: K and its products then stay in range.
template <class T>
constexpr T largest_curvature = static_cast<T>(sizeof(T) == 4 ? 0x1p60 : 0x1p500);

/// Computes all but `defined`, from tangents whose squares are in range.
template <class L>
[[gnu::always_inline]] inline void shape_operator(const GridJob<typename L::Scalar>& job, const Sample<L>& at,
                                                  const Normal<L>& normal, Curvature<L>& k) {
  k.e = dot<L>(at.du, at.du);
  k.f = dot<L>(at.du, at.dv);
  k.g = dot<L>(at.dv, at.dv);
  k.l = dot<L>(at.duu, normal.direction);
  k.m = dot<L>(at.duv, normal.direction);
  k.n = dot<L>(at.dvv, normal.direction);
  copy<L>(at.du, k.r_u);
  k.inverse_e = L::broadcast(1) / k.e;
  const auto slope = k.f * k.inverse_e;
  const auto m_less = L::fnma(slope, k.l, k.m);
  k.s11 = k.l * k.inverse_e;
  k.s12 = m_less * normal.reciprocal;
  k.s22 = L::fnma(slope, m_less + k.m, k.n) * (k.e * (normal.reciprocal * normal.reciprocal));
  // |r_u x r_v|^2 / E is the squared height of r_v over r_u.
  const auto sine = L::broadcast(job.min_sine * job.min_sine);
  k.skewed = xsimd::select(normal.squared * k.inverse_e > sine * k.g, L::broadcast(1), L::broadcast(0));
}

/// The vectors passed to a call and back through memory: vectors that a call may see cannot stay in registers.
template <class L>
struct ShapeExchange {
  using Vector = typename L::Scalar[L::width];
  alignas(64) Vector tangents[5][3];  ///< r_u, r_v, r_uu, r_uv, r_vv
  alignas(64) Vector normal[3];
  alignas(64) Vector safe;                                      ///< 1 in the lanes that are unchanged
  alignas(64) Vector s11, s12, s22, inverse_e, skewed, r_u[3];  ///< in and out

  static void put(const typename L::Batch (&from)[3], Vector (&to)[3]) {
    for (int c = 0; c < 3; ++c) L::store(to[c], from[c]);
  }
  static void take(const Vector (&from)[3], typename L::Batch (&to)[3]) {
    for (int c = 0; c < 3; ++c) to[c] = L::load(from[c]);
  }
};

/// Scales tangents and second derivatives by parameters such that the largest components of r_u and r_v are 1. This
/// changes the forms but not the curvatures.
template <class L>
inline void rescale(ShapeExchange<L>& exchange) {
  typename L::Batch du[3], dv[3];
  exchange.take(exchange.tangents[0], du);
  exchange.take(exchange.tangents[1], dv);
  const typename L::Batch size[5] = {largest_component<L>(du), largest_component<L>(dv), largest_component<L>(du),
                                     largest_component<L>(du), largest_component<L>(dv)};
  for (int k = 0; k < 5; ++k) {
    typename L::Batch vector[3];
    exchange.take(exchange.tangents[k], vector);
    for (int c = 0; c < 3; ++c) {
      vector[c] = vector[c] / size[k];
      if (k >= 2) vector[c] = vector[c] / size[k == 2 ? 0 : 1];
    }
    exchange.put(vector, exchange.tangents[k]);
  }
}

/// Computes the shape operator of lanes whose squares leave the range.
template <class L>
[[gnu::noinline, gnu::cold]] void rescaled_shape(const GridJob<typename L::Scalar>& job, ShapeExchange<L>& exchange) {
  rescale<L>(exchange);
  Sample<L> scaled;
  exchange.take(exchange.tangents[0], scaled.du);
  exchange.take(exchange.tangents[1], scaled.dv);
  exchange.take(exchange.tangents[2], scaled.duu);
  exchange.take(exchange.tangents[3], scaled.duv);
  exchange.take(exchange.tangents[4], scaled.dvv);
  Normal<L> unit;
  unit.squared = cross<L>(scaled.du, scaled.dv, unit.direction);
  unit.reciprocal = inverse_root<L>(unit.squared);
  exchange.take(exchange.normal, unit.direction);
  Curvature<L> other;
  shape_operator<L>(job, scaled, unit, other);
  const auto keep = L::load(exchange.safe) > L::broadcast(0);
  const auto choose = [&](auto& mine, const auto& its) { L::store(mine, xsimd::select(keep, L::load(mine), its)); };
  choose(exchange.s11, other.s11);
  choose(exchange.s12, other.s12);
  choose(exchange.s22, other.s22);
  choose(exchange.inverse_e, other.inverse_e);
  choose(exchange.skewed, other.skewed);
  for (int c = 0; c < 3; ++c) choose(exchange.r_u[c], other.r_u[c]);
}

/// Does so for vectors in registers. Lanes that are `safe` are unchanged.
template <class L>
[[gnu::always_inline]] inline void rescale_unsafe(const GridJob<typename L::Scalar>& job, const Sample<L>& at,
                                                  const Normal<L>& normal, const typename L::Batch& safe,
                                                  Curvature<L>& k) {
  ShapeExchange<L> exchange;
  exchange.put(at.du, exchange.tangents[0]);
  exchange.put(at.dv, exchange.tangents[1]);
  exchange.put(at.duu, exchange.tangents[2]);
  exchange.put(at.duv, exchange.tangents[3]);
  exchange.put(at.dvv, exchange.tangents[4]);
  exchange.put(normal.direction, exchange.normal);
  exchange.put(k.r_u, exchange.r_u);
  L::store(exchange.safe, safe);
  L::store(exchange.s11, k.s11);
  L::store(exchange.s12, k.s12);
  L::store(exchange.s22, k.s22);
  L::store(exchange.inverse_e, k.inverse_e);
  L::store(exchange.skewed, k.skewed);
  rescaled_shape<L>(job, exchange);
  k.s11 = L::load(exchange.s11);
  k.s12 = L::load(exchange.s12);
  k.s22 = L::load(exchange.s22);
  k.inverse_e = L::load(exchange.inverse_e);
  k.skewed = L::load(exchange.skewed);
  exchange.take(exchange.r_u, k.r_u);
}

template <class L>
[[gnu::always_inline]] inline void curvature(const GridJob<typename L::Scalar>& job, const Sample<L>& at,
                                             const Normal<L>& normal, Curvature<L>& k) {
  using T = typename L::Scalar;
  const auto zero = L::broadcast(0), one = L::broadcast(1);
  const auto lowest = L::broadcast(SafeRange<T>::lowest), highest = L::broadcast(SafeRange<T>::highest);
  shape_operator<L>(job, at, normal, k);
  const auto safe = (xsimd::min(xsimd::min(k.e, k.g), normal.squared) >= lowest) &
                    (xsimd::max(xsimd::max(k.e, k.g), normal.squared) <= highest);
  if (!xsimd::all(safe)) rescale_unsafe<L>(job, at, normal, xsimd::select(safe, one, zero), k);
  // Sums, since a maximum may lose a NaN.
  const auto forms = (k.e + k.g) + (xsimd::abs(k.f) + (xsimd::abs(k.l) + (xsimd::abs(k.m) + xsimd::abs(k.n))));
  const auto shape = xsimd::abs(k.s11) + (xsimd::abs(k.s12) + xsimd::abs(k.s22));
  const auto defined = (normal.kind + normal.uncertain == zero) & (k.skewed > zero) &
                       (forms <= L::broadcast(std::numeric_limits<T>::max())) &
                       (shape <= L::broadcast(largest_curvature<T>));
  k.defined = xsimd::select(defined, one, zero);
}

template <class L>
inline typename L::Batch mean_curvature(const Curvature<L>& k) {
  return L::broadcast(static_cast<typename L::Scalar>(0.5)) * (k.s11 + k.s22);
}

/// The inputs of the principal curvatures, passed through memory as in ShapeExchange.
template <class L>
struct CurvatureExchange {
  using Vector = typename L::Scalar[L::width];
  alignas(64) Vector s11, s12, s22, inverse_e, defined, r_u[3], normal[3];

  [[gnu::always_inline]] void put(const Curvature<L>& k, const typename L::Batch (&direction)[3]) {
    L::store(s11, k.s11);
    L::store(s12, k.s12);
    L::store(s22, k.s22);
    L::store(inverse_e, k.inverse_e);
    L::store(defined, k.defined);
    for (int c = 0; c < 3; ++c) {
      L::store(r_u[c], k.r_u[c]);
      L::store(normal[c], direction[c]);
    }
  }
  [[gnu::always_inline]] void take(Curvature<L>& k, typename L::Batch (&direction)[3]) const {
    k.s11 = L::load(s11);
    k.s12 = L::load(s12);
    k.s22 = L::load(s22);
    k.inverse_e = L::load(inverse_e);
    k.defined = L::load(defined);
    for (int c = 0; c < 3; ++c) {
      k.r_u[c] = L::load(r_u[c]);
      direction[c] = L::load(normal[c]);
    }
  }
};

/// k1 >= k2 and their kind. The radius of Mohr's circle, hypot((s11 - s22) / 2, s12), is computed without squares that
/// leave the range.
template <class L>
struct Principal {
  typename L::Batch half_difference, radius, first, second;
  typename L::Batch umbilic;  ///< 1 where k1 = k2 within tolerance
};

template <class L>
[[gnu::always_inline]] inline void principal_curvatures(const GridJob<typename L::Scalar>& job, const Curvature<L>& k,
                                                        Principal<L>& p) {
  const auto zero = L::broadcast(0), one = L::broadcast(1), mean = mean_curvature<L>(k);
  p.half_difference = L::broadcast(static_cast<typename L::Scalar>(0.5)) * (k.s11 - k.s22);
  const auto a = xsimd::abs(p.half_difference), b = xsimd::abs(k.s12);
  const auto larger = xsimd::max(a, b), ratio = xsimd::min(a, b) / larger;
  p.radius = xsimd::select(larger > zero, larger * xsimd::sqrt(L::fma(ratio, ratio, one)), zero);
  p.first = mean + p.radius;
  p.second = mean - p.radius;
  // A subnormal difference counts as none: it has no inverse, which the directions need.
  using T = typename L::Scalar;
  const auto bound = L::fma(L::broadcast(job.umbilic_tolerance), xsimd::abs(p.first) + xsimd::abs(p.second),
                            L::broadcast(4 * std::numeric_limits<T>::min()));
  p.umbilic = xsimd::select(p.radius + p.radius > bound, zero, one);
}

/// Computes the unit tangents of k1 and k2, first x second = N, by the half angle of (half_difference, s12); e1 and e2
/// at an umbilic.
template <class L>
[[gnu::always_inline]] inline void principal_directions(const Curvature<L>& k, const typename L::Batch (&normal)[3],
                                                        const Principal<L>& p, typename L::Batch (&first)[3],
                                                        typename L::Batch (&second)[3]) {
  using T = typename L::Scalar;
  const auto zero = L::broadcast(0), one = L::broadcast(1), half = L::broadcast(static_cast<T>(0.5));
  const auto inverse = one / p.radius;
  const auto wide = xsimd::sqrt(L::fma(half, xsimd::abs(p.half_difference) * inverse, half));
  const auto narrow = (half * (xsimd::abs(k.s12) * inverse)) / wide;
  const auto forward = p.half_difference >= zero, umbilic = p.umbilic > zero;
  const auto sine_size = xsimd::select(forward, narrow, wide);
  const auto cosine = xsimd::select(umbilic, one, xsimd::select(forward, wide, narrow));
  const auto sine = xsimd::select(umbilic, zero, xsimd::select(k.s12 < zero, zero - sine_size, sine_size));
  const auto inverse_length = xsimd::sqrt(k.inverse_e);
  typename L::Batch e1[3], e2[3];
  for (int c = 0; c < 3; ++c) e1[c] = k.r_u[c] * inverse_length;
  cross<L>(normal, e1, e2);
  for (int c = 0; c < 3; ++c) {
    first[c] = L::fma(sine, e2[c], cosine * e1[c]);
    second[c] = L::fms(cosine, e2[c], sine * e1[c]);
  }
}
