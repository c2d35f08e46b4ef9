#pragma once
// Vectors of four floats and of three doubles in registers of WebAssembly.

#include <wasm_simd128.h>

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE { namespace {

using Four [[gnu::vector_size(16)]] = float;

struct Fours {
  static v128_t v(Four a) { return reinterpret_cast<v128_t>(a); }
  static Four of(v128_t a) { return reinterpret_cast<Four>(a); }
  static Four load(const float* p) { return of(wasm_v128_load(p)); }
  static void store(float* p, Four a) { wasm_v128_store(p, v(a)); }
  static Four all(float x) { return of(wasm_f32x4_splat(x)); }
  static Four min(Four a, Four b) { return of(wasm_f32x4_pmin(v(b), v(a))); }
  static Four max(Four a, Four b) { return of(wasm_f32x4_pmax(v(b), v(a))); }
  static Four abs(Four a) { return of(wasm_f32x4_abs(v(a))); }
  /// Returns the bits of the places where a <= b.
  static unsigned at_most(Four a, Four b) {
    return static_cast<unsigned>(wasm_i32x4_bitmask(wasm_f32x4_le(v(a), v(b))));
  }
  static Four fma(Four a, Four b, Four c) { return a * b + c; }
  static Four fms(Four a, Four b, Four c) { return a * b - c; }
  static Four fnma(Four a, Four b, Four c) { return c - a * b; }
  /// Copies one value to all places.
  template <int k>
  static Four lane(Four a) {
    return __builtin_shufflevector(a, a, k, k, k, k);
  }
  // Functions of the first three values.
  static float sum3(Four a) { return (a + lane<1>(a) + lane<2>(a))[0]; }
  static float max3(Four a) { return max(max(a, lane<1>(a)), lane<2>(a))[0]; }
  static float min3(Four a) { return min(min(a, lane<1>(a)), lane<2>(a))[0]; }
  /// Returns magnitudes whose reciprocals are finite, with unchanged signs.
  static Four away_from_zero(Four a) {
    return of(wasm_v128_bitselect(v(a), v(max(abs(a), all(1e-18f))), wasm_i32x4_const_splat(INT32_MIN)));
  }
  /// Returns the first three values of `a` and the last of `b`.
  static Four with_last(Four a, Four b) { return __builtin_shufflevector(a, b, 0, 1, 2, 7); }
};

/// Three doubles, and an ignored fourth.
struct Triple {
  using Two [[gnu::vector_size(16)]] = double;
  Two low, high;
  static Two load2(const double* p) { return reinterpret_cast<Two>(wasm_v128_load(p)); }
  static void store2(double* p, Two a) { wasm_v128_store(p, reinterpret_cast<v128_t>(a)); }
  static Triple load(const double* p) { return {load2(p), Two{p[2], 0}}; }
  static Triple zero() { return {Two{}, Two{}}; }
  void store(double* p) const { store2(p, low), store2(p + 2, high); }  // all four
  friend Triple operator-(Triple a, Triple b) { return {a.low - b.low, a.high - b.high}; }
  friend Triple operator*(double s, Triple a) { return {s * a.low, s * a.high}; }
  static Triple fma(double s, Triple a, Triple b) { return {s * a.low + b.low, s * a.high + b.high}; }
};

}}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
