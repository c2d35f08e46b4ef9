#pragma once
// Bernstein weights of a vector of parameters, one per lane, for scattered samples. A power t^k carries the error of
// its rounding along (Graillat 2009, Accurate floating-point product and exponentiation, alg. 3.5; the rest of 1 - t by
// Dekker's FastTwoSum). So a weight is right to about one rounding, as tabulated ones are: these lose 1.7 units at
// degree 3 and 1.9 at degree 15, like weights that are rounded once, plain products 2.7 and 8.8. Without fused
// multiply-adds the rests of products are zero. Derivatives use plain products.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/point/point_kernels.h.

/// The binomials C(n, i).
template <class T>
struct Binomials {
  T of[max_order][max_order]{};
  constexpr Binomials() {
    for (int n = 0; n < max_order; ++n)
      for (int i = 0; i <= n; ++i) of[n][i] = i == 0 ? 1 : of[n][i - 1] * static_cast<T>(n - i + 1) / static_cast<T>(i);
  }
};
template <class T>
inline constexpr Binomials<T> binomials;

/// Powers of t + rest below the degree, each as a rounded value and its rest.
template <class L, int Capacity>
struct Powers {
  typename L::Batch value[Capacity], rest[Capacity];

  /// Fills the powers of t alone; rest[1] is zero and stays unset.
  [[gnu::always_inline]] void fill(const typename L::Batch& t, int degree) {
    value[0] = L::broadcast(1);
    value[1] = t;
    for_each_coefficient<Capacity>(
        2, degree, [&](int k) __attribute__((always_inline)) {
          value[k] = value[k - 1] * t;
          const auto product_rest = L::fms(value[k - 1], t, value[k]);
          rest[k] = k == 2 ? product_rest : L::fma(rest[k - 1], t, product_rest);
        });
  }
  [[gnu::always_inline]] void fill(const typename L::Batch& t, const typename L::Batch& t_rest, int degree) {
    value[0] = L::broadcast(1);
    value[1] = t;
    rest[1] = t_rest;
    for_each_coefficient<Capacity>(
        2, degree, [&](int k) __attribute__((always_inline)) {
          value[k] = value[k - 1] * t;
          const auto product_rest = L::fms(value[k - 1], t, value[k]);
          rest[k] = L::fma(rest[k - 1], t, L::fma(value[k - 1], t_rest, product_rest));
        });
  }
};

/// Computes C(n,i) t^i s^(n-i), rounded about once.
template <class L, int Capacity>
[[gnu::always_inline]] inline void bernstein_values(const Powers<L, Capacity>& t, const Powers<L, Capacity>& s,
                                                    int degree, typename L::Batch* weights) {
  const int n = degree - 1;
  weights[0] = s.value[1];
  if (n > 0) weights[0] = L::fma(s.value[n], s.value[1], L::fma(s.rest[n], s.value[1], s.value[n] * s.rest[1]));
  for_each_coefficient<Capacity>(
      1, degree, [&](int i) __attribute__((always_inline)) {
        const auto product = t.value[i] * s.value[degree - i];
        auto rest = L::fms(t.value[i], s.value[degree - i], product);
        rest = L::fma(t.value[i], s.rest[degree - i], rest);
        if (i > 1) rest = L::fma(t.rest[i], s.value[degree - i], rest);
        const auto factor = L::broadcast(binomials<typename L::Scalar>.of[degree][i]);
        weights[i] = L::fma(factor, product, factor * rest);
      });
  weights[degree] = n > 1   ? L::fma(t.value[n], t.value[1], t.rest[n] * t.value[1])
                    : n > 0 ? t.value[1] * t.value[1]
                            : t.value[1];
}

/// Returns factor C(n,i) t^i s^(n-i) for a lower degree n.
template <class L, int Capacity>
[[gnu::always_inline]] inline typename L::Batch plain_bernstein(const Powers<L, Capacity>& t,
                                                                const Powers<L, Capacity>& s, int degree, int i,
                                                                int factor) {
  using T = typename L::Scalar;
  return L::broadcast(static_cast<T>(factor) * binomials<T>.of[degree][i]) * (t.value[i] * s.value[degree - i]);
}

/// Computes n (B^{n-1}_{i-1} - B^{n-1}_i).
template <class L, int Capacity>
[[gnu::always_inline]] inline void bernstein_first(const Powers<L, Capacity>& t, const Powers<L, Capacity>& s,
                                                   int degree, typename L::Batch* weights) {
  auto before = L::broadcast(0);
  for_each_coefficient<Capacity>(
      0, degree, [&](int i) __attribute__((always_inline)) {
        const auto next = plain_bernstein<L>(t, s, degree - 1, i, degree);
        weights[i] = before - next;
        before = next;
      });
  weights[degree] = before;
}

/// Computes n (n - 1) (B^{n-2}_{i-2} - 2 B^{n-2}_{i-1} + B^{n-2}_i).
template <class L, int Capacity>
[[gnu::always_inline]] inline void bernstein_second(const Powers<L, Capacity>& t, const Powers<L, Capacity>& s,
                                                    int degree, typename L::Batch* weights) {
  auto before = L::broadcast(0), last = before;  // of i - 2 and i - 1
  for_each_coefficient<Capacity>(
      0, degree + 1, [&](int i) __attribute__((always_inline)) {
        auto next = L::broadcast(0);
        if (i <= degree - 2) next = plain_bernstein<L>(t, s, degree - 2, i, degree * (degree - 1));
        weights[i] = (before - last) + (next - last);
        before = last;
        last = next;
      });
}

/// Computes `weights[order * (degree + 1) + i]` at t, for orders up to Order.
template <class L, int Order, int Capacity>
[[gnu::always_inline]] inline void bernstein_weights(const typename L::Batch& t, int degree,
                                                     typename L::Batch* weights) {
  const auto one = L::broadcast(1), s = one - t;
  Powers<L, Capacity> of_t, of_s;
  of_t.fill(t, degree);
  of_s.fill(s, (one - s) - t, degree);
  bernstein_values<L>(of_t, of_s, degree, weights);
  if constexpr (Order >= 1) bernstein_first<L>(of_t, of_s, degree, weights + degree + 1);
  if constexpr (Order >= 2) bernstein_second<L>(of_t, of_s, degree, weights + 2 * (degree + 1));
}
