#pragma once
// Vectors of four floats and of three doubles in registers of NEON.

#include <arm_neon.h>

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE { namespace {

using Four = float32x4_t;

struct Fours {
  static Four load(const float* p) { return vld1q_f32(p); }
  static void store(float* p, Four a) { vst1q_f32(p, a); }
  static Four all(float x) { return vdupq_n_f32(x); }
  static Four min(Four a, Four b) { return vminq_f32(a, b); }
  static Four max(Four a, Four b) { return vmaxq_f32(a, b); }
  static Four abs(Four a) { return vabsq_f32(a); }
  /// Returns the bits of the places where a <= b.
  static unsigned at_most(Four a, Four b) {
    constexpr std::uint32_t bits[] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcleq_f32(a, b), vld1q_u32(bits)));
  }
  static Four fma(Four a, Four b, Four c) { return vfmaq_f32(c, a, b); }             // a b + c
  static Four fms(Four a, Four b, Four c) { return vfmaq_f32(vnegq_f32(c), a, b); }  // a b - c
  static Four fnma(Four a, Four b, Four c) { return vfmsq_f32(c, a, b); }            // c - a b
  /// Copies one value to all places.
  template <int k>
  static Four lane(Four a) {
    return vdupq_laneq_f32(a, k);
  }
  // Functions of the first three values.
  static float sum3(Four a) { return vgetq_lane_f32(a + lane<1>(a) + lane<2>(a), 0); }
  static float max3(Four a) { return vgetq_lane_f32(max(max(a, lane<1>(a)), lane<2>(a)), 0); }
  static float min3(Four a) { return vgetq_lane_f32(min(min(a, lane<1>(a)), lane<2>(a)), 0); }
  /// Returns magnitudes whose reciprocals are finite, with unchanged signs.
  static Four away_from_zero(Four a) {
    return vbslq_f32(vdupq_n_u32(0x80000000u), a, vmaxq_f32(vabsq_f32(a), vdupq_n_f32(1e-18f)));
  }
  /// Returns the first three values of `a` and the last of `b`.
  static Four with_last(Four a, Four b) { return vcopyq_laneq_f32(a, 3, b, 3); }
};

/// Three doubles, and an ignored fourth.
struct Triple {
  float64x2_t low, high;
  static Triple load(const double* p) { return {vld1q_f64(p), vdupq_n_f64(p[2])}; }
  static Triple zero() { return {vdupq_n_f64(0), vdupq_n_f64(0)}; }
  void store(double* p) const { vst1q_f64(p, low), vst1q_f64(p + 2, high); }  // all four
  friend Triple operator-(Triple a, Triple b) { return {a.low - b.low, a.high - b.high}; }
  friend Triple operator*(double s, Triple a) { return {vmulq_n_f64(a.low, s), vmulq_n_f64(a.high, s)}; }
  static Triple fma(double s, Triple a, Triple b) {
    return {vfmaq_n_f64(b.low, a.low, s), vfmaq_n_f64(b.high, a.high, s)};
  }
};

}}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
