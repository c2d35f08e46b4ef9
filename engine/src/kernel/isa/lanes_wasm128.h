#pragma once
// Lanes of WebAssembly's 128-bit SIMD, 4 floats or 2 doubles: the same bits as SSE2, without fused multiply-adds.

#include <wasm_simd128.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace isa_wasm128 { namespace {

constexpr Isa this_isa = Isa::wasm128;

// The functions that the kernels call by the name of xsimd: Debian's xsimd (8.1) has none for WebAssembly.
namespace xsimd {

/// The register type of floats or doubles, and its operations.
template <class T>
struct Wasm;

template <>
struct Wasm<float> {
  using Register [[gnu::vector_size(16)]] = float;
  using Bits [[gnu::vector_size(16)]] = std::int32_t;
  static v128_t root(v128_t a) { return wasm_f32x4_sqrt(a); }
  static v128_t size(v128_t a) { return wasm_f32x4_abs(a); }
  static v128_t lesser(v128_t a, v128_t b) { return wasm_f32x4_pmin(b, a); }
  static v128_t greater(v128_t a, v128_t b) { return wasm_f32x4_pmax(b, a); }
  static bool all(v128_t mask) { return wasm_i32x4_all_true(mask); }
};
template <>
struct Wasm<double> {
  using Register [[gnu::vector_size(16)]] = double;
  using Bits [[gnu::vector_size(16)]] = std::int64_t;
  static v128_t root(v128_t a) { return wasm_f64x2_sqrt(a); }
  static v128_t size(v128_t a) { return wasm_f64x2_abs(a); }
  static v128_t lesser(v128_t a, v128_t b) { return wasm_f64x2_pmin(b, a); }
  static v128_t greater(v128_t a, v128_t b) { return wasm_f64x2_pmax(b, a); }
  static bool all(v128_t mask) { return wasm_i64x2_all_true(mask); }
};

/// A truth value for each lane: all bits or none.
template <class T>
struct batch_bool {
  typename Wasm<T>::Bits bits;
  friend batch_bool operator&(batch_bool a, batch_bool b) { return {a.bits & b.bits}; }
  friend batch_bool operator|(batch_bool a, batch_bool b) { return {a.bits | b.bits}; }
  friend batch_bool operator^(batch_bool a, batch_bool b) { return {a.bits ^ b.bits}; }
  friend batch_bool operator!(batch_bool a) { return {~a.bits}; }
};

template <class T>
struct batch {
  using Register = typename Wasm<T>::Register;
  using Bool = batch_bool<T>;
  static constexpr int width = 16 / static_cast<int>(sizeof(T));
  Register lanes;

  batch() = default;
  batch(Register a) : lanes(a) {}
  static batch of(v128_t a) { return batch(reinterpret_cast<Register>(a)); }
  explicit batch(T x) {
    for (int l = 0; l < width; ++l) lanes[l] = x;
  }
  v128_t v() const { return reinterpret_cast<v128_t>(lanes); }
  operator Register() const { return lanes; }
  static batch load_unaligned(const T* p) { return of(wasm_v128_load(p)); }
  void store_unaligned(T* p) const { wasm_v128_store(p, v()); }
  friend batch operator+(batch a, batch b) { return a.lanes + b.lanes; }
  friend batch operator-(batch a, batch b) { return a.lanes - b.lanes; }
  friend batch operator*(batch a, batch b) { return a.lanes * b.lanes; }
  friend batch operator/(batch a, batch b) { return a.lanes / b.lanes; }
  friend batch operator-(batch a) { return -a.lanes; }
  friend Bool operator<(batch a, batch b) { return {a.lanes < b.lanes}; }
  friend Bool operator>(batch a, batch b) { return {a.lanes > b.lanes}; }
  friend Bool operator<=(batch a, batch b) { return {a.lanes <= b.lanes}; }
  friend Bool operator>=(batch a, batch b) { return {a.lanes >= b.lanes}; }
  friend Bool operator==(batch a, batch b) { return {a.lanes == b.lanes}; }
  friend Bool operator!=(batch a, batch b) { return {a.lanes != b.lanes}; }
};

template <class T>
batch<T> select(batch_bool<T> mask, batch<T> a, batch<T> b) {
  return batch<T>::of(wasm_v128_bitselect(a.v(), b.v(), reinterpret_cast<v128_t>(mask.bits)));
}
template <class T>
batch<T> abs(batch<T> a) {
  return batch<T>::of(Wasm<T>::size(a.v()));
}
template <class T>
batch<T> sqrt(batch<T> a) {
  return batch<T>::of(Wasm<T>::root(a.v()));
}
inline batch<float> copysign(batch<float> size, batch<float> sign) {
  return batch<float>::of(wasm_v128_bitselect(sign.v(), size.v(), wasm_i32x4_const_splat(INT32_MIN)));
}
inline batch<float> floor(batch<float> a) { return batch<float>::of(wasm_f32x4_floor(a.v())); }
inline batch<float> ceil(batch<float> a) { return batch<float>::of(wasm_f32x4_ceil(a.v())); }
/// Returns, as on x86, the second value where one is NaN.
template <class T>
batch<T> min(batch<T> a, batch<T> b) {
  return batch<T>::of(Wasm<T>::lesser(a.v(), b.v()));
}
template <class T>
batch<T> max(batch<T> a, batch<T> b) {
  return batch<T>::of(Wasm<T>::greater(a.v(), b.v()));
}
template <class T>
bool all(batch_bool<T> mask) {
  return Wasm<T>::all(reinterpret_cast<v128_t>(mask.bits));
}
template <class T>
bool any(batch_bool<T> mask) {
  return wasm_v128_any_true(reinterpret_cast<v128_t>(mask.bits));
}

}  // namespace xsimd

/// Operations that are alike for floats and doubles.
template <class T>
struct WasmLanes {
  using Scalar = T;
  using Batch = xsimd::batch<T>;
  static constexpr int width = Batch::width;
  static constexpr int registers = 16;
  static Batch broadcast(T x) { return Batch(x); }
  static Batch load(const T* p) { return Batch::load_unaligned(p); }
  static void store(T* p, Batch a) { a.store_unaligned(p); }
  static void stream(T* p, Batch a) { a.store_unaligned(p); }  // WebAssembly has no such stores
  static void fence() {}
  static Batch fma(Batch a, Batch b, Batch c) { return a * b + c; }
  static Batch fms(Batch a, Batch b, Batch c) { return a * b - c; }
  static Batch fnma(Batch a, Batch b, Batch c) { return c - a * b; }
  static void store_bytes(std::uint8_t* p, Batch a) {  // small whole numbers
    for (int l = 0; l < width; ++l) p[l] = static_cast<std::uint8_t>(a.lanes[l]);
  }
  static void store_first(T* p, Batch a, int count) {
    if (count == width) {
      a.store_unaligned(p);
    } else {
      for (int l = 0; l < width - 1; ++l)
        if (l < count) p[l] = a.lanes[l];
    }
  }
  /// Loads the first `count` values and zeros in the other lanes; reads no more.
  static Batch load_first(const T* p, int count) {
    if (count == width) return Batch::load_unaligned(p);
    Batch a(T(0));
    for (int l = 0; l < width - 1; ++l)
      if (l < count) a.lanes[l] = p[l];
    return a;
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
  static Batch shifted(Batch a, Batch b, int count) {
    if (count == 0) return b;
    if constexpr (width == 4) {
      if (count == 1) return __builtin_shufflevector(a.lanes, b.lanes, 3, 4, 5, 6);
      if (count == 2) return __builtin_shufflevector(a.lanes, b.lanes, 2, 3, 4, 5);
      if (count == 3) return __builtin_shufflevector(a.lanes, b.lanes, 1, 2, 3, 4);
    } else {
      if (count == 1) return __builtin_shufflevector(a.lanes, b.lanes, 1, 2);
    }
    return a;
  }
};

template <class T>
struct Lanes;

template <>
struct Lanes<float> : WasmLanes<float> {
  static Batch inverse_root_guess(Batch a) {  // halves the exponent
    return Batch::of(wasm_i32x4_sub(wasm_i32x4_const_splat(0x5f3759df), wasm_u32x4_shr(a.v(), 1)));
  }
  /// Returns from[places[lane]].
  static Batch gather(const float* from, const std::int32_t* places) {
    return Batch::Register{from[places[0]], from[places[1]], from[places[2]], from[places[3]]};
  }
  /// Turns x0 x1 .. | y0 y1 .. | z0 z1 .. into x0 y0 z0 x1 ..
  static void interleave(Batch (&p)[3]) {
    const Batch::Register x = p[0], y = p[1], z = p[2];
    const Batch::Register xy = __builtin_shufflevector(x, y, 0, 4, 1, 1),
                          yz = __builtin_shufflevector(y, z, 1, 5, 2, 2),
                          zx = __builtin_shufflevector(z, x, 2, 7, 3, 3);
    p[0] = __builtin_shufflevector(xy, z, 0, 1, 4, 2);
    p[1] = __builtin_shufflevector(__builtin_shufflevector(yz, x, 0, 1, 6, 2), yz, 0, 1, 2, 6);
    p[2] = __builtin_shufflevector(__builtin_shufflevector(zx, y, 0, 1, 7, 2), zx, 0, 1, 2, 6);
  }
  /// Sets vector l to value l of the rows at row(0), row(1), ...
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    const Batch::Register a = row[0], b = row[1], c = row[2], d = row[3];
    const Batch::Register ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                          cd = __builtin_shufflevector(c, d, 0, 4, 1, 5),
                          ab2 = __builtin_shufflevector(a, b, 2, 6, 3, 7),
                          cd2 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    row[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    row[1] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    row[2] = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5);
    row[3] = __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7);
  }
};

template <>
struct Lanes<double> : WasmLanes<double> {
  static void store_as(double* p, Batch a) { store(p, a); }
  static void store_as(float* p, Batch a) { wasm_v128_store64_lane(p, wasm_f32x4_demote_f64x2_zero(a.v()), 0); }
  static Batch inverse_root_guess(Batch a) {
    return Batch::of(wasm_i64x2_sub(wasm_i64x2_const_splat(0x5fe6eb50c7b537a9), wasm_u64x2_shr(a.v(), 1)));
  }
  static void interleave(Batch (&p)[3]) {
    const Batch::Register x = p[0], y = p[1], z = p[2];
    p[0] = __builtin_shufflevector(x, y, 0, 2);
    p[1] = __builtin_shufflevector(z, x, 0, 3);
    p[2] = __builtin_shufflevector(y, z, 1, 3);
  }
  template <class Row>
  static void load_columns(const Row& row, Batch (&column)[width]) {
    for (int k = 0; k < width; ++k) column[k] = load(row(k));
    transpose(column);
  }
  static void transpose(Batch (&row)[width]) {
    const Batch::Register a = row[0], b = row[1];
    row[0] = __builtin_shufflevector(a, b, 0, 2);
    row[1] = __builtin_shufflevector(a, b, 1, 3);
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::isa_wasm128

#define TESSERA_ISA_NAMESPACE isa_wasm128
