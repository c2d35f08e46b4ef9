#pragma once
// Lanes of AVX2 with FMA, 8 floats or 4 doubles: the operations that the kernels call.

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <xsimd/xsimd.hpp>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace isa_avx2 { namespace {

constexpr Isa this_isa = Isa::avx2;

/// An immediate operand.
template <int bits>
using Bits = std::integral_constant<int, bits>;

/// Eight lanes (a double takes two) turned by `count`: their sources, and which of them then belong to the vector
/// before.
struct Turn {
  __m256i lanes, before;
};
Turn turn_by(int count) {
  const __m256i each = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), by = _mm256_set1_epi32(count);
  return {_mm256_and_si256(_mm256_sub_epi32(each, by), _mm256_set1_epi32(7)), _mm256_cmpgt_epi32(by, each)};
}

/// The few operations that xsimd lacks.
template <class T>
struct Lanes;

template <>
struct Lanes<float> {
  using Scalar = float;
  using Batch = xsimd::batch<float, xsimd::avx2>;
  static constexpr int width = 8;
  static constexpr int registers = 16;
  static Batch broadcast(float x) { return Batch(x); }
  static Batch load(const float* p) { return Batch::load_aligned(p); }
  static void store(float* p, Batch a) { a.store_aligned(p); }
  static void stream(float* p, Batch a) { _mm256_stream_ps(p, a); }
  static void fence() { _mm_sfence(); }                                               // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return _mm256_fmadd_ps(a, b, c); }    // a b + c
  static Batch fms(Batch a, Batch b, Batch c) { return _mm256_fmsub_ps(a, b, c); }    // a b - c
  static Batch fnma(Batch a, Batch b, Batch c) { return _mm256_fnmadd_ps(a, b, c); }  // c - a b
  static Batch inverse_root_guess(Batch a) {                                          // halves the exponent
    return _mm256_castsi256_ps(
        _mm256_sub_epi32(_mm256_set1_epi32(0x5f3759df), _mm256_srli_epi32(_mm256_castps_si256(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {  // small whole numbers
    const __m256i whole = _mm256_cvttps_epi32(a);
    const __m128i pairs = _mm_packs_epi32(_mm256_castsi256_si128(whole), _mm256_extracti128_si256(whole, 1));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packus_epi16(pairs, pairs));
  }
  static void store_first(float* p, Batch a, int count) {
    if (count == width) {
      _mm256_storeu_ps(p, a);
    } else {
      const __m256i index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
      _mm256_maskstore_ps(p, _mm256_cmpgt_epi32(_mm256_set1_epi32(count), index), a);
    }
  }
  /// Returns from[places[lane]].
  static Batch gather(const float* from, const std::int32_t* places) {
    return _mm256_i32gather_ps(from, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(places)), sizeof(float));
  }
  /// Loads the first `count` values and zeros in the other lanes; reads no more.
  static Batch load_first(const float* p, int count) {
    if (count == 4) return _mm256_zextps128_ps256(_mm_loadu_ps(p));
    const __m256i index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    return _mm256_maskload_ps(p, _mm256_cmpgt_epi32(_mm256_set1_epi32(count), index));
  }
  /// Turns x0 x1 .. | y0 y1 .. | z0 z1 .. into x0 y0 z0 x1 ..: value 8 k + l comes by permutations from lane (8 k + l)
  /// / 3 and by blends from component (8 k + l) % 3.
  static void interleave(Batch (&p)[3]) {
    const auto blended = [&](__m256i lanes, auto second, auto third) {
      const __m256 x = _mm256_permutevar8x32_ps(p[0], lanes), y = _mm256_permutevar8x32_ps(p[1], lanes);
      return _mm256_blend_ps(_mm256_blend_ps(x, y, second()), _mm256_permutevar8x32_ps(p[2], lanes), third());
    };
    const __m256 a = blended(_mm256_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2), Bits<0x92>(), Bits<0x24>());
    const __m256 b = blended(_mm256_setr_epi32(2, 3, 3, 3, 4, 4, 4, 5), Bits<0x24>(), Bits<0x49>());
    const __m256 c = blended(_mm256_setr_epi32(5, 5, 6, 6, 6, 7, 7, 7), Bits<0x49>(), Bits<0x92>());
    p[0] = a;
    p[1] = b;
    p[2] = c;
  }
  /// A shift by `count` lanes, below `width`.
  using Shift = Turn;
  static Shift shift_by(int count) { return turn_by(count); }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const __m256 turned = _mm256_permutevar8x32_ps(next, shift.lanes);
    const __m256 shifted = _mm256_blendv_ps(turned, carry, _mm256_castsi256_ps(shift.before));
    carry = turned;
    return shifted;
  }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift&) { return a; }
  /// Stores the lanes begin .. end - 1.
  static void store_between(float* p, Batch a, int begin, int end) {
    const __m256i index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i from = _mm256_cmpgt_epi32(_mm256_set1_epi32(begin), index);
    _mm256_maskstore_ps(p, _mm256_andnot_si256(from, _mm256_cmpgt_epi32(_mm256_set1_epi32(end), index)), a);
  }
  // Halves of four lanes.
  static Batch load_fours(const float* low, const float* high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(low)), _mm_load_ps(high), 1);
  }
  /// Returns lane `k` of each half in all of its lanes.
  static Batch lane_of_fours(Batch a, int k) {
    return k == 0   ? _mm256_permute_ps(a, 0x00)
           : k == 1 ? _mm256_permute_ps(a, 0x55)
           : k == 2 ? _mm256_permute_ps(a, 0xaa)
                    : _mm256_permute_ps(a, 0xff);
  }
  /// Transposes each half.
  static void transpose_fours(Batch (&row)[4]) {
    const __m256 a = _mm256_unpacklo_ps(row[0], row[1]), b = _mm256_unpackhi_ps(row[0], row[1]);
    const __m256 c = _mm256_unpacklo_ps(row[2], row[3]), d = _mm256_unpackhi_ps(row[2], row[3]);
    row[0] = _mm256_shuffle_ps(a, c, 0x44);
    row[1] = _mm256_shuffle_ps(a, c, 0xee);
    row[2] = _mm256_shuffle_ps(b, d, 0x44);
    row[3] = _mm256_shuffle_ps(b, d, 0xee);
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ..., of which four values are read. Rows k and k + 4 share
  /// a vector from the start, which saves a third of a transpose's shuffles.
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[4]) {
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) column[k] = load_fours(row(k), row(4 + k));
    transpose_fours(column);
  }
  static void transpose(Batch (&row)[width]) {
    Batch upper[4] = {row[0], row[1], row[2], row[3]}, lower[4] = {row[4], row[5], row[6], row[7]};
    transpose_fours(upper);
    transpose_fours(lower);
    for (int c = 0; c < 4; ++c) {  // half h of upper[c] and lower[c] is column 4 h + c
      row[c] = _mm256_permute2f128_ps(upper[c], lower[c], 0x20);
      row[4 + c] = _mm256_permute2f128_ps(upper[c], lower[c], 0x31);
    }
  }
};

/// Writes six values of each lane, three of `a` and three of `b`, to out[lane] + at.
[[gnu::always_inline]] inline void put_sixes(const Lanes<float>::Batch (&a)[3], const Lanes<float>::Batch (&b)[3],
                                             float* const* out, std::ptrdiff_t at) {
  Lanes<float>::Batch four[4] = {a[0], a[1], a[2], b[0]};
  Lanes<float>::transpose_fours(four);  // half h of four[l] is lane 4 h + l
  const __m256 two[2] = {_mm256_unpacklo_ps(b[1], b[2]), _mm256_unpackhi_ps(b[1], b[2])};
  const auto put = [&](auto half) __attribute__((always_inline)) {
    constexpr int h = decltype(half)::value;
    for (int l = 0; l < 4; l += 2) {
      const __m128 pair = _mm256_extractf128_ps(two[l / 2], h);
      float *const even = out[4 * h + l] + at, *const odd = out[4 * h + l + 1] + at;
      _mm_storeu_ps(even, _mm256_extractf128_ps(four[l], h));
      _mm_storel_pi(reinterpret_cast<__m64*>(even + 4), pair);
      _mm_storeu_ps(odd, _mm256_extractf128_ps(four[l + 1], h));
      _mm_storeh_pi(reinterpret_cast<__m64*>(odd + 4), pair);
    }
  };
  put(Bits<0>());
  put(Bits<1>());
}

template <>
struct Lanes<double> {
  using Scalar = double;
  using Batch = xsimd::batch<double, xsimd::avx2>;
  static constexpr int width = 4;
  static constexpr int registers = 16;
  static Batch broadcast(double x) { return Batch(x); }
  static Batch load(const double* p) { return Batch::load_aligned(p); }
  static void store(double* p, Batch a) { a.store_aligned(p); }
  static void store_as(double* p, Batch a) { store(p, a); }
  static void store_as(float* p, Batch a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a)); }  // rounded
  static void stream(double* p, Batch a) { _mm256_stream_pd(p, a); }
  static void fence() { _mm_sfence(); }  // after the last stream
  static Batch fma(Batch a, Batch b, Batch c) { return _mm256_fmadd_pd(a, b, c); }
  static Batch fms(Batch a, Batch b, Batch c) { return _mm256_fmsub_pd(a, b, c); }
  static Batch fnma(Batch a, Batch b, Batch c) { return _mm256_fnmadd_pd(a, b, c); }
  static Batch inverse_root_guess(Batch a) {
    return _mm256_castsi256_pd(
        _mm256_sub_epi64(_mm256_set1_epi64x(0x5fe6eb50c7b537a9), _mm256_srli_epi64(_mm256_castpd_si256(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {
    const __m128i whole = _mm256_cvttpd_epi32(a), pairs = _mm_packs_epi32(whole, whole);
    _mm_storeu_si32(p, _mm_packus_epi16(pairs, pairs));
  }
  static void store_first(double* p, Batch a, int count) {
    if (count == width) {
      _mm256_storeu_pd(p, a);
    } else {
      const __m256i index = _mm256_setr_epi64x(0, 1, 2, 3);
      _mm256_maskstore_pd(p, _mm256_cmpgt_epi64(_mm256_set1_epi64x(count), index), a);
    }
  }
  static Batch load_first(const double* p, int count) {
    const __m256i index = _mm256_setr_epi64x(0, 1, 2, 3);
    return _mm256_maskload_pd(p, _mm256_cmpgt_epi64(_mm256_set1_epi64x(count), index));
  }
  static void interleave(Batch (&p)[3]) {
    const auto blended = [&](auto lanes, auto second, auto third) {
      const __m256d x = _mm256_permute4x64_pd(p[0], lanes()), y = _mm256_permute4x64_pd(p[1], lanes());
      return _mm256_blend_pd(_mm256_blend_pd(x, y, second()), _mm256_permute4x64_pd(p[2], lanes()), third());
    };
    const __m256d a = blended(Bits<0x40>(), Bits<0x2>(), Bits<0x4>());  // lanes 0 0 0 1
    const __m256d b = blended(Bits<0xa5>(), Bits<0x9>(), Bits<0x2>());  // 1 1 2 2
    const __m256d c = blended(Bits<0xfe>(), Bits<0x4>(), Bits<0x9>());  // 2 3 3 3
    p[0] = a;
    p[1] = b;
    p[2] = c;
  }
  using Shift = Turn;
  static Shift shift_by(int count) { return turn_by(2 * count); }
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    const __m256d turned = _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(next), shift.lanes));
    const __m256d shifted = _mm256_blendv_pd(turned, carry, _mm256_castsi256_pd(shift.before));
    carry = turned;
    return shifted;
  }
  static Batch carried(Batch a, const Shift&) { return a; }
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[2]) {
    const auto rows = [&](int k) {
      return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(row(k))), _mm_load_pd(row(2 + k)), 1);
    };
    const __m256d a = rows(0), b = rows(1);
    column[0] = _mm256_unpacklo_pd(a, b);
    column[1] = _mm256_unpackhi_pd(a, b);
  }
  static void transpose(Batch (&row)[width]) {
    const __m256d a = _mm256_unpacklo_pd(row[0], row[1]), b = _mm256_unpackhi_pd(row[0], row[1]);
    const __m256d c = _mm256_unpacklo_pd(row[2], row[3]), d = _mm256_unpackhi_pd(row[2], row[3]);
    row[0] = _mm256_permute2f128_pd(a, c, 0x20);
    row[1] = _mm256_permute2f128_pd(b, d, 0x20);
    row[2] = _mm256_permute2f128_pd(a, c, 0x31);
    row[3] = _mm256_permute2f128_pd(b, d, 0x31);
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::isa_avx2

#define TESSERA_ISA_NAMESPACE isa_avx2
