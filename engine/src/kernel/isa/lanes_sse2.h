#pragma once
// Lanes of SSE2, the baseline of x86-64, 4 floats or 2 doubles: the operations that the kernels call. Without fused
// multiply-adds, results differ in their last bits from those of the other units, within the same stated bounds.

#include <emmintrin.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <xsimd/xsimd.hpp>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace isa_sse2 { namespace {

constexpr Isa this_isa = Isa::sse2;

template <class T>
struct Lanes;

template <>
struct Lanes<float> {
  using Scalar = float;
  using Batch = xsimd::batch<float, xsimd::sse2>;
  static constexpr int width = 4;
  static constexpr int registers = 16;
  static Batch broadcast(float x) { return Batch(x); }
  static Batch load(const float* p) { return Batch::load_aligned(p); }
  static void store(float* p, Batch a) { a.store_aligned(p); }
  static void stream(float* p, Batch a) { _mm_stream_ps(p, a); }
  static void fence() { _mm_sfence(); }  // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return a * b + c; }
  static Batch fms(Batch a, Batch b, Batch c) { return a * b - c; }
  static Batch fnma(Batch a, Batch b, Batch c) { return c - a * b; }
  static Batch inverse_root_guess(Batch a) {  // halves the exponent
    return _mm_castsi128_ps(_mm_sub_epi32(_mm_set1_epi32(0x5f3759df), _mm_srli_epi32(_mm_castps_si128(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {  // small whole numbers
    const __m128i whole = _mm_cvttps_epi32(a), pairs = _mm_packs_epi32(whole, whole);
    _mm_storeu_si32(p, _mm_packus_epi16(pairs, pairs));
  }
  static void store_first(float* p, Batch a, int count) {
    if (count == width) {
      _mm_storeu_ps(p, a);
    } else {
      alignas(16) float values[width];
      a.store_aligned(values);
      for (int i = 0; i < count; ++i) p[i] = values[i];
    }
  }
  /// Returns from[places[lane]].
  static Batch gather(const float* from, const std::int32_t* places) {
    return _mm_setr_ps(from[places[0]], from[places[1]], from[places[2]], from[places[3]]);
  }
  /// Loads the first `count` values and zeros in the other lanes; reads no more.
  static Batch load_first(const float* p, int count) {
    if (count == width) return _mm_loadu_ps(p);
    alignas(16) float values[width] = {0, 0, 0, 0};
    for (int i = 0; i < count; ++i) values[i] = p[i];
    return _mm_load_ps(values);
  }
  /// Turns x0 x1 .. | y0 y1 .. | z0 z1 .. into x0 y0 z0 x1 ..
  static void interleave(Batch (&p)[3]) {
    const __m128 x = p[0], y = p[1], z = p[2];
    const __m128 zx_low = _mm_shuffle_ps(z, x, 0x50), yz = _mm_shuffle_ps(y, z, 0x55);  // z0 z0 x1 x1, y1 y1 z1 z1
    const __m128 zx_high = _mm_shuffle_ps(z, x, 0xfa), yz_high = _mm_shuffle_ps(y, z, 0xff);
    p[0] = _mm_shuffle_ps(_mm_unpacklo_ps(x, y), zx_low, 0x84);
    p[1] = _mm_shuffle_ps(yz, _mm_unpackhi_ps(x, y), 0x48);
    p[2] = _mm_shuffle_ps(zx_high, yz_high, 0x88);
  }
  /// A shift by `count` lanes, below `width`.
  struct Shift {
    int count;
  };
  static Shift shift_by(int count) { return {count}; }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const Batch before = carry;
    carry = next;
    return shifted(before, next, shift.count);
  }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift& shift) { return shifted(a, a, width - shift.count); }
  /// Returns the `count` last lanes of a, then the first ones of b.
  static Batch shifted(__m128 a, __m128 b, int count) {
    switch (count) {
      case 0:
        return b;
      case 1:
        return _mm_move_ss(_mm_shuffle_ps(b, b, 0x90), _mm_shuffle_ps(a, a, 0xff));
      case 2:
        return _mm_shuffle_ps(a, b, 0x4e);
      case 3:
        return _mm_shuffle_ps(_mm_shuffle_ps(a, a, 0xf9), _mm_shuffle_ps(a, b, 0x0f), 0x84);
      default:
        return a;
    }
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ...
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    __m128 a = row[0], b = row[1], c = row[2], d = row[3];
    _MM_TRANSPOSE4_PS(a, b, c, d);
    row[0] = a;
    row[1] = b;
    row[2] = c;
    row[3] = d;
  }
};

template <>
struct Lanes<double> {
  using Scalar = double;
  using Batch = xsimd::batch<double, xsimd::sse2>;
  static constexpr int width = 2;
  static constexpr int registers = 16;
  static Batch broadcast(double x) { return Batch(x); }
  static Batch load(const double* p) { return Batch::load_aligned(p); }
  static void store(double* p, Batch a) { a.store_aligned(p); }
  static void store_as(double* p, Batch a) { store(p, a); }
  static void store_as(float* p, Batch a) { _mm_storel_pi(reinterpret_cast<__m64*>(p), _mm_cvtpd_ps(a)); }  // rounded
  static void stream(double* p, Batch a) { _mm_stream_pd(p, a); }
  static void fence() { _mm_sfence(); }  // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return a * b + c; }
  static Batch fms(Batch a, Batch b, Batch c) { return a * b - c; }
  static Batch fnma(Batch a, Batch b, Batch c) { return c - a * b; }
  static Batch inverse_root_guess(Batch a) {
    return _mm_castsi128_pd(_mm_sub_epi64(_mm_set1_epi64x(0x5fe6eb50c7b537a9), _mm_srli_epi64(_mm_castpd_si128(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {
    const __m128i whole = _mm_cvttpd_epi32(a), pairs = _mm_packs_epi32(whole, whole);
    _mm_storeu_si16(p, _mm_packus_epi16(pairs, pairs));
  }
  static void store_first(double* p, Batch a, int count) {
    if (count == width) {
      _mm_storeu_pd(p, a);
    } else {
      _mm_store_sd(p, a);
    }
  }
  static Batch load_first(const double* p, int count) { return count == width ? _mm_loadu_pd(p) : _mm_load_sd(p); }
  static void interleave(Batch (&p)[3]) {
    const __m128d x = p[0], y = p[1], z = p[2];
    p[0] = _mm_unpacklo_pd(x, y);
    p[1] = _mm_shuffle_pd(z, x, 2);
    p[2] = _mm_unpackhi_pd(y, z);
  }
  /// A shift by `count` lanes, below `width`.
  struct Shift {
    int count;
  };
  static Shift shift_by(int count) { return {count}; }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const Batch before = carry;
    carry = next;
    return shifted(before, next, shift.count);
  }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift& shift) { return shifted(a, a, width - shift.count); }
  static Batch shifted(__m128d a, __m128d b, int count) {
    return count == 0 ? b : count == 1 ? _mm_shuffle_pd(a, b, 1) : a;
  }
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    const __m128d a = row[0], b = row[1];
    row[0] = _mm_unpacklo_pd(a, b);
    row[1] = _mm_unpackhi_pd(a, b);
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::isa_sse2

#define TESSERA_ISA_NAMESPACE isa_sse2
