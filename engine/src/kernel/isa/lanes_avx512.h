#pragma once
// Lanes of AVX-512 (F, DQ, BW, VL), 16 floats or 8 doubles: the operations that the kernels call.

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <xsimd/xsimd.hpp>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace isa_avx512 { namespace {

constexpr Isa this_isa = Isa::avx512;
template <class T>
using BatchOf = xsimd::batch<T, xsimd::avx512f>;

/// The permutations that interleave triples. Value l of vector k is lane (width k + l) / 3 of component (width k + l) %
/// 3. The first permutation picks from x and y, the second from its result and z.
template <class Index, int width>
struct InterleavedTriples {
  alignas(64) Index xy[3][width]{}, z[3][width]{};
  constexpr InterleavedTriples() {
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < width; ++l) {
        const int lane = (width * k + l) / 3, component = (width * k + l) % 3;
        xy[k][l] = component == 1 ? width + lane : lane;
        z[k][l] = component == 2 ? width + lane : l;
      }
  }
};

/// The few operations that xsimd lacks or, like fma on AVX-512 before 12.1, does not fuse.
template <class T>
struct Lanes;

template <>
struct Lanes<float> {
  using Scalar = float;
  using Batch = BatchOf<float>;
  static constexpr int width = 16;
  static constexpr int registers = 32;
  static Batch broadcast(float x) { return Batch(x); }
  static Batch load(const float* p) { return Batch::load_aligned(p); }
  static void store(float* p, Batch a) { a.store_aligned(p); }
  static void stream(float* p, Batch a) { _mm512_stream_ps(p, a); }
  static void fence() { _mm_sfence(); }                                               // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return _mm512_fmadd_ps(a, b, c); }    // a b + c
  static Batch fms(Batch a, Batch b, Batch c) { return _mm512_fmsub_ps(a, b, c); }    // a b - c
  static Batch fnma(Batch a, Batch b, Batch c) { return _mm512_fnmadd_ps(a, b, c); }  // c - a b
  static Batch inverse_root_guess(Batch a) {                                          // halves the exponent
    return _mm512_castsi512_ps(
        _mm512_sub_epi32(_mm512_set1_epi32(0x5f3759df), _mm512_srli_epi32(_mm512_castps_si512(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {  // small whole numbers
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm512_cvtepi32_epi8(_mm512_cvttps_epi32(a)));
  }
  static void store_first(float* p, Batch a, int count) {
    if (count == width) {
      _mm512_storeu_ps(p, a);
    } else {
      _mm512_mask_storeu_ps(p, static_cast<__mmask16>((1u << count) - 1u), a);
    }
  }
  /// Returns from[places[lane]].
  static Batch gather(const float* from, const std::int32_t* places) {
    return _mm512_i32gather_ps(_mm512_loadu_si512(places), from, sizeof(float));
  }
  /// Loads the first `count` values and zeros in the other lanes; reads no more.
  static Batch load_first(const float* p, int count) {
    return _mm512_maskz_loadu_ps(static_cast<__mmask16>((1u << count) - 1u), p);
  }
  // Halves of eight lanes, each from or to a place of its own.
  static Batch broadcast_halves(const float* low, const float* high) {
    return _mm512_mask_broadcastss_ps(_mm512_set1_ps(*low), 0xff00, _mm_load_ss(high));
  }
  static Batch load_halves(const float* low, const float* high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_load_ps(low)), _mm256_load_ps(high), 1);
  }
  static void store_halves(float* low, float* high, Batch a) {  // the high half last
    _mm256_storeu_ps(low, _mm512_castps512_ps256(a));
    _mm256_storeu_ps(high, _mm512_extractf32x8_ps(a, 1));
  }
  /// Loads four rows of 12 values from three aligned vectors; the last four lanes of a row are to be ignored. An
  /// unaligned load takes as long as two.
  static void load_twelves(const float* p, Batch (&rows)[4]) {
    const __m512i a = _mm512_load_si512(p), b = _mm512_load_si512(p + 16), c = _mm512_load_si512(p + 32);
    rows[0] = _mm512_castsi512_ps(a);
    rows[1] = _mm512_castsi512_ps(_mm512_alignr_epi32(b, a, 12));
    rows[2] = _mm512_castsi512_ps(_mm512_alignr_epi32(c, b, 8));
    rows[3] = _mm512_castsi512_ps(_mm512_alignr_epi32(c, c, 4));
  }
  /// Turns x0 x1 .. | y0 y1 .. | z0 z1 .. into x0 y0 z0 x1 ..
  static void interleave(Batch (&p)[3]) {
    static constexpr InterleavedTriples<int, width> lanes;
    const __m512 x = p[0], y = p[1], z = p[2];
    for (int k = 0; k < 3; ++k) {
      const __m512 xy = _mm512_permutex2var_ps(x, _mm512_load_si512(lanes.xy[k]), y);
      p[k] = _mm512_permutex2var_ps(xy, _mm512_load_si512(lanes.z[k]), z);
    }
  }
  /// A shift by `count` lanes, below `width`.
  struct Shift {
    __m512i lanes;  ///< from the vector before where bit 4 is set; higher bits are ignored
  };
  static __m512i each_lane() { return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15); }
  static Shift shift_by(int count) { return {_mm512_sub_epi32(each_lane(), _mm512_set1_epi32(count))}; }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const __m512 shifted = _mm512_permutex2var_ps(next, shift.lanes, carry);
    carry = next;
    return shifted;
  }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift& shift) {
    const __m512i twice = _mm512_add_epi32(each_lane(), each_lane());
    return _mm512_permutexvar_ps(_mm512_sub_epi32(twice, shift.lanes), a);
  }
  /// Returns x y z x y z ..
  static Batch triples(const float* x, const float* y, const float* z) {
    const __m512 xy = _mm512_mask_broadcastss_ps(_mm512_set1_ps(*x), 0x2492, _mm_load_ss(y));
    return _mm512_mask_broadcastss_ps(xy, 0x4924, _mm_load_ss(z));
  }
  /// Loads the source of each lane for picked().
  static __m512i load_places(const std::int32_t* places) { return _mm512_load_si512(places); }
  static Batch picked(Batch a, __m512i places) { return _mm512_permutexvar_ps(places, a); }
  /// Stores the lanes begin .. end - 1.
  static void store_between(float* p, Batch a, int begin, int end) {
    _mm512_mask_storeu_ps(p, static_cast<__mmask16>((1u << end) - (1u << begin)), a);
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ..., of which eight values are read. Rows k and k + 4
  /// share a vector from the start, which saves half of the shuffles across a vector.
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[8]) {
    __m512 a[8];
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) {
      const int first = k / 4 * 8 + k % 4;
      a[k] = _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_load_ps(row(first))), _mm256_load_ps(row(first + 4)), 1);
    }
    for (int i = 0; i < 8; i += 4) {  // fours of rows: a[i + l] gets columns l and 4 + l
      const __m512 b0 = _mm512_unpacklo_ps(a[i], a[i + 1]), b1 = _mm512_unpackhi_ps(a[i], a[i + 1]);
      const __m512 b2 = _mm512_unpacklo_ps(a[i + 2], a[i + 3]), b3 = _mm512_unpackhi_ps(a[i + 2], a[i + 3]);
      a[i] = _mm512_shuffle_ps(b0, b2, 0x44);
      a[i + 1] = _mm512_shuffle_ps(b0, b2, 0xee);
      a[i + 2] = _mm512_shuffle_ps(b1, b3, 0x44);
      a[i + 3] = _mm512_shuffle_ps(b1, b3, 0xee);
    }
    for (int l = 0; l < 4; ++l) {
      column[l] = _mm512_shuffle_f32x4(a[l], a[4 + l], 0x88);
      column[4 + l] = _mm512_shuffle_f32x4(a[l], a[4 + l], 0xdd);
    }
  }
  static void transpose(Batch (&row)[width]) {
    __m512 a[16], b[16];
    for (int i = 0; i < 16; i += 2) {  // pairs of rows
      a[i] = _mm512_unpacklo_ps(row[i], row[i + 1]);
      a[i + 1] = _mm512_unpackhi_ps(row[i], row[i + 1]);
    }
    for (int i = 0; i < 16; i += 4) {  // fours of rows: b[i + c] holds column 4 q + c in its quarter q
      b[i] = _mm512_shuffle_ps(a[i], a[i + 2], 0x44);
      b[i + 1] = _mm512_shuffle_ps(a[i], a[i + 2], 0xee);
      b[i + 2] = _mm512_shuffle_ps(a[i + 1], a[i + 3], 0x44);
      b[i + 3] = _mm512_shuffle_ps(a[i + 1], a[i + 3], 0xee);
    }
    for (int c = 0; c < 4; ++c) {  // quarters of 128 bits
      const __m512 even_low = _mm512_shuffle_f32x4(b[c], b[4 + c], 0x88),
                   odd_low = _mm512_shuffle_f32x4(b[c], b[4 + c], 0xdd);
      const __m512 even_high = _mm512_shuffle_f32x4(b[8 + c], b[12 + c], 0x88);
      const __m512 odd_high = _mm512_shuffle_f32x4(b[8 + c], b[12 + c], 0xdd);
      row[c] = _mm512_shuffle_f32x4(even_low, even_high, 0x88);
      row[8 + c] = _mm512_shuffle_f32x4(even_low, even_high, 0xdd);
      row[4 + c] = _mm512_shuffle_f32x4(odd_low, odd_high, 0x88);
      row[12 + c] = _mm512_shuffle_f32x4(odd_low, odd_high, 0xdd);
    }
  }
};

/// Writes six values of each lane, three of `a` and three of `b`, to out[lane] + at.
[[gnu::always_inline]] inline void put_sixes(const Lanes<float>::Batch (&a)[3], const Lanes<float>::Batch (&b)[3],
                                             float* const* out, std::ptrdiff_t at) {
  const __m512 xy_low = _mm512_unpacklo_ps(a[0], a[1]), xy_high = _mm512_unpackhi_ps(a[0], a[1]);
  const __m512 zx_low = _mm512_unpacklo_ps(a[2], b[0]), zx_high = _mm512_unpackhi_ps(a[2], b[0]);
  // Quarter q of four[l] is lane 4 q + l; that of two[l / 2] holds lanes 4 q + l and the next.
  const __m512 four[4] = {_mm512_shuffle_ps(xy_low, zx_low, 0x44), _mm512_shuffle_ps(xy_low, zx_low, 0xee),
                          _mm512_shuffle_ps(xy_high, zx_high, 0x44), _mm512_shuffle_ps(xy_high, zx_high, 0xee)};
  const __m512 two[2] = {_mm512_unpacklo_ps(b[1], b[2]), _mm512_unpackhi_ps(b[1], b[2])};
  const auto put = [&](auto quarter) __attribute__((always_inline)) {
    constexpr int q = decltype(quarter)::value;
    for (int l = 0; l < 4; ++l) _mm_storeu_ps(out[4 * q + l] + at, _mm512_extractf32x4_ps(four[l], q));
    for (int l = 0; l < 4; l += 2) {
      const __m128 pair = _mm512_extractf32x4_ps(two[l / 2], q);
      _mm_storel_pi(reinterpret_cast<__m64*>(out[4 * q + l] + at + 4), pair);
      _mm_storeh_pi(reinterpret_cast<__m64*>(out[4 * q + l + 1] + at + 4), pair);
    }
  };
  put(std::integral_constant<int, 0>());
  put(std::integral_constant<int, 1>());
  put(std::integral_constant<int, 2>());
  put(std::integral_constant<int, 3>());
}

template <>
struct Lanes<double> {
  using Scalar = double;
  using Batch = BatchOf<double>;
  static constexpr int width = 8;
  static constexpr int registers = 32;
  static Batch broadcast(double x) { return Batch(x); }
  static Batch load(const double* p) { return Batch::load_aligned(p); }
  static void store(double* p, Batch a) { a.store_aligned(p); }
  static void store_as(double* p, Batch a) { store(p, a); }
  static void store_as(float* p, Batch a) { _mm256_storeu_ps(p, _mm512_cvtpd_ps(a)); }  // rounded
  static void stream(double* p, Batch a) { _mm512_stream_pd(p, a); }
  static void fence() { _mm_sfence(); }  // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return _mm512_fmadd_pd(a, b, c); }
  static Batch fms(Batch a, Batch b, Batch c) { return _mm512_fmsub_pd(a, b, c); }
  static Batch fnma(Batch a, Batch b, Batch c) { return _mm512_fnmadd_pd(a, b, c); }
  static Batch inverse_root_guess(Batch a) {
    return _mm512_castsi512_pd(
        _mm512_sub_epi64(_mm512_set1_epi64(0x5fe6eb50c7b537a9), _mm512_srli_epi64(_mm512_castpd_si512(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm256_cvtepi32_epi8(_mm512_cvttpd_epi32(a)));
  }
  static void store_first(double* p, Batch a, int count) {
    if (count == width) {
      _mm512_storeu_pd(p, a);
    } else {
      _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1u << count) - 1u), a);
    }
  }
  static Batch load_first(const double* p, int count) {
    return _mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << count) - 1u), p);
  }
  static void interleave(Batch (&p)[3]) {
    static constexpr InterleavedTriples<long long, width> lanes;
    const __m512d x = p[0], y = p[1], z = p[2];
    for (int k = 0; k < 3; ++k) {
      const __m512d xy = _mm512_permutex2var_pd(x, _mm512_load_si512(lanes.xy[k]), y);
      p[k] = _mm512_permutex2var_pd(xy, _mm512_load_si512(lanes.z[k]), z);
    }
  }
  /// A shift by `count` lanes, below `width`.
  struct Shift {
    __m512i lanes;  ///< from the vector before where bit 3 is set; higher bits are ignored
  };
  static __m512i each_lane() { return _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7); }
  static Shift shift_by(int count) { return {_mm512_sub_epi64(each_lane(), _mm512_set1_epi64(count))}; }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const __m512d shifted = _mm512_permutex2var_pd(next, shift.lanes, carry);
    carry = next;
    return shifted;
  }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift& shift) {
    const __m512i twice = _mm512_add_epi64(each_lane(), each_lane());
    return _mm512_permutexvar_pd(_mm512_sub_epi64(twice, shift.lanes), a);
  }
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[4]) {
    __m512d a[4];
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
      const int first = k / 2 * 4 + k % 2;
      a[k] = _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(row(first))), _mm256_load_pd(row(first + 2)), 1);
    }
    const __m512d b0 = _mm512_unpacklo_pd(a[0], a[1]), b1 = _mm512_unpackhi_pd(a[0], a[1]);
    const __m512d b2 = _mm512_unpacklo_pd(a[2], a[3]), b3 = _mm512_unpackhi_pd(a[2], a[3]);
    column[0] = _mm512_shuffle_f64x2(b0, b2, 0x88);
    column[1] = _mm512_shuffle_f64x2(b1, b3, 0x88);
    column[2] = _mm512_shuffle_f64x2(b0, b2, 0xdd);
    column[3] = _mm512_shuffle_f64x2(b1, b3, 0xdd);
  }
  static void transpose(Batch (&row)[width]) {
    __m512d a[8];
    for (int i = 0; i < 8; i += 2) {
      a[i] = _mm512_unpacklo_pd(row[i], row[i + 1]);
      a[i + 1] = _mm512_unpackhi_pd(row[i], row[i + 1]);
    }
    for (int c = 0; c < 2; ++c) {  // a[2 i + c] holds column 2 q + c of rows 2 i, 2 i + 1 in its quarter q
      const __m512d even_low = _mm512_shuffle_f64x2(a[c], a[2 + c], 0x88),
                    odd_low = _mm512_shuffle_f64x2(a[c], a[2 + c], 0xdd);
      const __m512d even_high = _mm512_shuffle_f64x2(a[4 + c], a[6 + c], 0x88);
      const __m512d odd_high = _mm512_shuffle_f64x2(a[4 + c], a[6 + c], 0xdd);
      row[c] = _mm512_shuffle_f64x2(even_low, even_high, 0x88);
      row[4 + c] = _mm512_shuffle_f64x2(even_low, even_high, 0xdd);
      row[2 + c] = _mm512_shuffle_f64x2(odd_low, odd_high, 0x88);
      row[6 + c] = _mm512_shuffle_f64x2(odd_low, odd_high, 0xdd);
    }
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::isa_avx512

#define TESSERA_ISA_NAMESPACE isa_avx512
