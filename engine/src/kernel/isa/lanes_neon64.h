#pragma once
// Lanes of NEON on AArch64, 4 floats or 2 doubles, with fused multiply-adds: the same bits as AVX2 and AVX-512.

#include <arm_neon.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace isa_neon64 { namespace {

constexpr Isa this_isa = Isa::neon64;

// The functions that the kernels call by the name of xsimd. On NEON, Debian's xsimd (8.1) divides floats and takes
// roots by estimates, and its minimum and maximum treat NaN differently from x86: other bits. These functions replace
// it.
namespace xsimd {

/// The register type of floats or doubles, and its operations.
template <class T>
struct Neon;

template <>
struct Neon<float> {
  using Register = float32x4_t;
  using Bits = uint32x4_t;
  static Register all(float x) { return vdupq_n_f32(x); }
  static Register load(const float* p) { return vld1q_f32(p); }
  static void store(float* p, Register a) { vst1q_f32(p, a); }
  static Register chosen(Bits mask, Register a, Register b) { return vbslq_f32(mask, a, b); }
  static Register root(Register a) { return vsqrtq_f32(a); }
  static Register size(Register a) { return vabsq_f32(a); }
  static Register negated(Register a) { return vnegq_f32(a); }
  static Bits below(Register a, Register b) { return vcltq_f32(a, b); }
  static Bits at_most(Register a, Register b) { return vcleq_f32(a, b); }
  static Bits same(Register a, Register b) { return vceqq_f32(a, b); }
  static std::uint32_t lowest(Bits mask) { return vminvq_u32(mask); }
  static std::uint32_t highest(Bits mask) { return vmaxvq_u32(mask); }
};

template <>
struct Neon<double> {
  using Register = float64x2_t;
  using Bits = uint64x2_t;
  static Register all(double x) { return vdupq_n_f64(x); }
  static Register load(const double* p) { return vld1q_f64(p); }
  static void store(double* p, Register a) { vst1q_f64(p, a); }
  static Register chosen(Bits mask, Register a, Register b) { return vbslq_f64(mask, a, b); }
  static Register root(Register a) { return vsqrtq_f64(a); }
  static Register size(Register a) { return vabsq_f64(a); }
  static Register negated(Register a) { return vnegq_f64(a); }
  static Bits below(Register a, Register b) { return vcltq_f64(a, b); }
  static Bits at_most(Register a, Register b) { return vcleq_f64(a, b); }
  static Bits same(Register a, Register b) { return vceqq_f64(a, b); }
  static std::uint32_t lowest(Bits mask) { return vminvq_u32(vreinterpretq_u32_u64(mask)); }
  static std::uint32_t highest(Bits mask) { return vmaxvq_u32(vreinterpretq_u32_u64(mask)); }
};

/// A truth value for each lane: all bits or none.
template <class T>
struct batch_bool {
  typename Neon<T>::Bits bits;
  friend batch_bool operator&(batch_bool a, batch_bool b) { return {a.bits & b.bits}; }
  friend batch_bool operator|(batch_bool a, batch_bool b) { return {a.bits | b.bits}; }
  friend batch_bool operator^(batch_bool a, batch_bool b) { return {a.bits ^ b.bits}; }
  friend batch_bool operator!(batch_bool a) { return {~a.bits}; }
};

template <class T>
struct batch {
  using Register = typename Neon<T>::Register;
  using Bool = batch_bool<T>;
  Register lanes;

  batch() = default;
  batch(Register a) : lanes(a) {}
  explicit batch(T x) : lanes(Neon<T>::all(x)) {}
  operator Register() const { return lanes; }
  static batch load_unaligned(const T* p) { return Neon<T>::load(p); }
  void store_unaligned(T* p) const { Neon<T>::store(p, lanes); }
  friend batch operator+(batch a, batch b) { return a.lanes + b.lanes; }
  friend batch operator-(batch a, batch b) { return a.lanes - b.lanes; }
  friend batch operator*(batch a, batch b) { return a.lanes * b.lanes; }
  friend batch operator/(batch a, batch b) { return a.lanes / b.lanes; }
  friend batch operator-(batch a) { return Neon<T>::negated(a); }
  friend Bool operator<(batch a, batch b) { return {Neon<T>::below(a, b)}; }
  friend Bool operator>(batch a, batch b) { return {Neon<T>::below(b, a)}; }
  friend Bool operator<=(batch a, batch b) { return {Neon<T>::at_most(a, b)}; }
  friend Bool operator>=(batch a, batch b) { return {Neon<T>::at_most(b, a)}; }
  friend Bool operator==(batch a, batch b) { return {Neon<T>::same(a, b)}; }
  friend Bool operator!=(batch a, batch b) { return !Bool{Neon<T>::same(a, b)}; }
};

template <class T>
batch<T> select(batch_bool<T> mask, batch<T> a, batch<T> b) {
  return Neon<T>::chosen(mask.bits, a, b);
}
template <class T>
batch<T> abs(batch<T> a) {
  return Neon<T>::size(a);
}
template <class T>
batch<T> sqrt(batch<T> a) {
  return Neon<T>::root(a);
}
inline batch<float> copysign(batch<float> size, batch<float> sign) {
  return vbslq_f32(vdupq_n_u32(0x80000000u), sign, size);
}
inline batch<float> floor(batch<float> a) { return vrndmq_f32(a); }
inline batch<float> ceil(batch<float> a) { return vrndpq_f32(a); }
/// Returns, as on x86, the second value where one is NaN.
template <class T>
batch<T> min(batch<T> a, batch<T> b) {
  return select(a < b, a, b);
}
template <class T>
batch<T> max(batch<T> a, batch<T> b) {
  return select(a > b, a, b);
}
template <class T>
bool all(batch_bool<T> mask) {
  return Neon<T>::lowest(mask.bits) != 0;
}
template <class T>
bool any(batch_bool<T> mask) {
  return Neon<T>::highest(mask.bits) != 0;
}

}  // namespace xsimd

/// Operations on lanes for which NEON has no instructions, through memory.
template <class Scalar>
struct ThroughMemory {
  using Batch = xsimd::batch<Scalar>;
  static constexpr int width = 16 / static_cast<int>(sizeof(Scalar));
  /// A shift by `count` lanes, below `width`.
  struct Shift {
    int count;
  };
  static Shift shift_by(int count) { return {count}; }
  /// Returns the carry with which the next shift_in() leaves the first lanes of `a` in place.
  static Batch carried(Batch a, const Shift& shift) {
    Batch carry;
    for (int i = 0; i < width; ++i) carry.lanes[i] = a.lanes[(i + shift.count) % width];
    return carry;
  }
  /// Returns the last lanes of the vector before `next` and the first ones of `next`; `carry` is for the following
  /// call.
  static Batch shift_in(Batch& carry, Batch next, const Shift& shift) {
    Batch shifted;
    for (int i = 0; i < width; ++i)
      shifted.lanes[i] = i < shift.count ? carry.lanes[width - shift.count + i] : next.lanes[i - shift.count];
    carry = next;
    return shifted;
  }
  /// Loads the first `count` values and zeros in the other lanes; reads no more.
  static Batch load_first(const Scalar* p, int count) {
    Batch a(Scalar(0));
    for (int i = 0; i < width && i < count; ++i) a.lanes[i] = p[i];
    return a;
  }
};

template <class T>
struct Lanes;

template <>
struct Lanes<float> : ThroughMemory<float> {
  using Scalar = float;
  using Batch = xsimd::batch<float>;
  static constexpr int width = 4;
  static constexpr int registers = 32;
  static Batch broadcast(float x) { return Batch(x); }
  static Batch load(const float* p) { return vld1q_f32(p); }
  static void store(float* p, Batch a) { vst1q_f32(p, a); }
  static void stream(float* p, Batch a) { vst1q_f32(p, a); }  // AArch64 has only hints
  static void fence() {}
  static Batch fma(Batch a, Batch b, Batch c) { return vfmaq_f32(c, a, b); }             // a b + c
  static Batch fms(Batch a, Batch b, Batch c) { return vfmaq_f32(vnegq_f32(c), a, b); }  // a b - c
  static Batch fnma(Batch a, Batch b, Batch c) { return vfmsq_f32(c, a, b); }            // c - a b
  static Batch inverse_root_guess(Batch a) {                                             // halves the exponent
    return vreinterpretq_f32_u32(vsubq_u32(vdupq_n_u32(0x5f3759df), vshrq_n_u32(vreinterpretq_u32_f32(a), 1)));
  }
  /// Returns from[places[lane]].
  static Batch gather(const float* from, const std::int32_t* places) {
    const float values[width] = {from[places[0]], from[places[1]], from[places[2]], from[places[3]]};
    return vld1q_f32(values);
  }
  static void store_bytes(std::uint8_t* p, Batch a) {  // small whole numbers
    const uint16x4_t pairs = vqmovn_u32(vcvtq_u32_f32(a));
    vst1_lane_u32(reinterpret_cast<std::uint32_t*>(p), vreinterpret_u32_u8(vqmovn_u16(vcombine_u16(pairs, pairs))), 0);
  }
  static void store_first(float* p, Batch a, int count) {
    if (count == width) {
      vst1q_f32(p, a);
    } else {
      alignas(16) float values[width];
      vst1q_f32(values, a);
      for (int i = 0; i < count; ++i) p[i] = values[i];
    }
  }
  /// Turns x0 x1 .. | y0 y1 .. | z0 z1 .. into x0 y0 z0 x1 ..
  static void interleave(Batch (&p)[3]) {
    alignas(16) float values[3 * width];
    vst3q_f32(values, float32x4x3_t{{p[0], p[1], p[2]}});
    for (int k = 0; k < 3; ++k) p[k] = vld1q_f32(values + k * width);
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ...
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    const float32x4x2_t a = vtrnq_f32(row[0], row[1]), b = vtrnq_f32(row[2], row[3]);
    for (int c = 0; c < 2; ++c) {  // a.val[c] holds column c in its low half, c + 2 in its high one
      row[c] = vcombine_f32(vget_low_f32(a.val[c]), vget_low_f32(b.val[c]));
      row[2 + c] = vcombine_f32(vget_high_f32(a.val[c]), vget_high_f32(b.val[c]));
    }
  }
};

template <>
struct Lanes<double> : ThroughMemory<double> {
  using Scalar = double;
  using Batch = xsimd::batch<double>;
  static constexpr int width = 2;
  static constexpr int registers = 32;
  static Batch broadcast(double x) { return Batch(x); }
  static Batch load(const double* p) { return vld1q_f64(p); }
  static void store(double* p, Batch a) { vst1q_f64(p, a); }
  static void store_as(double* p, Batch a) { store(p, a); }
  static void store_as(float* p, Batch a) { vst1_f32(p, vcvt_f32_f64(a)); }  // rounded
  static void stream(double* p, Batch a) { vst1q_f64(p, a); }
  static void fence() {}
  static Batch fma(Batch a, Batch b, Batch c) { return vfmaq_f64(c, a, b); }
  static Batch fms(Batch a, Batch b, Batch c) { return vfmaq_f64(vnegq_f64(c), a, b); }
  static Batch fnma(Batch a, Batch b, Batch c) { return vfmsq_f64(c, a, b); }
  static Batch inverse_root_guess(Batch a) {
    return vreinterpretq_f64_u64(vsubq_u64(vdupq_n_u64(0x5fe6eb50c7b537a9), vshrq_n_u64(vreinterpretq_u64_f64(a), 1)));
  }
  static void store_bytes(std::uint8_t* p, Batch a) {
    for (int l = 0; l < width; ++l) p[l] = static_cast<std::uint8_t>(a.lanes[l]);
  }
  static void store_first(double* p, Batch a, int count) {
    if (count == width) {
      vst1q_f64(p, a);
    } else {
      vst1q_lane_f64(p, a, 0);
    }
  }
  static void interleave(Batch (&p)[3]) {
    const float64x2_t x = p[0], y = p[1], z = p[2];
    p[0] = vzip1q_f64(x, y);
    p[1] = vcombine_f64(vget_low_f64(z), vget_high_f64(x));
    p[2] = vzip2q_f64(y, z);
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ...
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    const float64x2_t a = row[0], b = row[1];
    row[0] = vzip1q_f64(a, b);
    row[1] = vzip2q_f64(a, b);
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::isa_neon64

#define TESSERA_ISA_NAMESPACE isa_neon64
