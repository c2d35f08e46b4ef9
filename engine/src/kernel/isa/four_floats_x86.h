#pragma once
// Vectors of four floats and of three doubles in registers of SSE or AVX, with fused multiply-adds if the unit has
// them.

#include <immintrin.h>

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE { namespace {

using Four = __m128;

struct Fours {
  static Four load(const float* p) { return _mm_loadu_ps(p); }
  static void store(float* p, Four a) { _mm_storeu_ps(p, a); }
  static Four all(float x) { return _mm_set1_ps(x); }
  static Four min(Four a, Four b) { return _mm_min_ps(a, b); }
  static Four max(Four a, Four b) { return _mm_max_ps(a, b); }
  static Four abs(Four a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
  /// Returns the bits of the places where a <= b.
  static unsigned at_most(Four a, Four b) { return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a, b))); }
#if defined(__FMA__)
  static Four fma(Four a, Four b, Four c) { return _mm_fmadd_ps(a, b, c); }    // a b + c
  static Four fms(Four a, Four b, Four c) { return _mm_fmsub_ps(a, b, c); }    // a b - c
  static Four fnma(Four a, Four b, Four c) { return _mm_fnmadd_ps(a, b, c); }  // c - a b
#else
  static Four fma(Four a, Four b, Four c) { return a * b + c; }
  static Four fms(Four a, Four b, Four c) { return a * b - c; }
  static Four fnma(Four a, Four b, Four c) { return c - a * b; }
#endif
  /// Copies one value to all places.
  template <int k>
  static Four lane(Four a) {
    return _mm_shuffle_ps(a, a, 0x55 * k);
  }
  // Functions of the first three values.
  static float sum3(Four a) { return _mm_cvtss_f32(a + lane<1>(a) + lane<2>(a)); }
  static float max3(Four a) { return _mm_cvtss_f32(max(max(a, lane<1>(a)), lane<2>(a))); }
  static float min3(Four a) { return _mm_cvtss_f32(min(min(a, lane<1>(a)), lane<2>(a))); }
  /// Returns magnitudes whose reciprocals are finite, with unchanged signs.
  static Four away_from_zero(Four a) {
    return _mm_or_ps(_mm_max_ps(abs(a), _mm_set1_ps(1e-18f)), _mm_and_ps(_mm_set1_ps(-0.0f), a));
  }
  /// Returns the first three values of `a` and the last of `b`.
  static Four with_last(Four a, Four b) {
    const Four ends = _mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 3, 2, 2));
    return _mm_shuffle_ps(a, ends, _MM_SHUFFLE(2, 0, 1, 0));
  }
};

/// Three doubles, and an ignored fourth.
struct Triple {
#if defined(__AVX2__)
  __m256d all;
  static Triple load(const double* p) { return {_mm256_maskload_pd(p, _mm256_setr_epi64x(-1, -1, -1, 0))}; }
  static Triple zero() { return {_mm256_setzero_pd()}; }
  void store(double* p) const { _mm256_storeu_pd(p, all); }  // all four
  friend Triple operator-(Triple a, Triple b) { return {a.all - b.all}; }
  friend Triple operator*(double s, Triple a) { return {_mm256_set1_pd(s) * a.all}; }
  static Triple fma(double s, Triple a, Triple b) { return {_mm256_fmadd_pd(_mm256_set1_pd(s), a.all, b.all)}; }
#else
  __m128d low, high;
  static Triple load(const double* p) { return {_mm_loadu_pd(p), _mm_load_sd(p + 2)}; }
  static Triple zero() { return {_mm_setzero_pd(), _mm_setzero_pd()}; }
  void store(double* p) const { _mm_storeu_pd(p, low), _mm_storeu_pd(p + 2, high); }  // all four
  friend Triple operator-(Triple a, Triple b) { return {a.low - b.low, a.high - b.high}; }
  friend Triple operator*(double s, Triple a) { return {_mm_set1_pd(s) * a.low, _mm_set1_pd(s) * a.high}; }
  static Triple fma(double s, Triple a, Triple b) {
    return {_mm_set1_pd(s) * a.low + b.low, _mm_set1_pd(s) * a.high + b.high};
  }
#endif
};

}}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
