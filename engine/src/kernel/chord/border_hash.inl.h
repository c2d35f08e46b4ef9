#pragma once
// Hashes and comparison of the borders of a block of patches, lanes = patches, for finding shared edges
// (tess/edges/shared_edges.h). A hash is the same for both directions, and for weights that differ by a power of two.
// It is a sum over the control points, each mixed with its distance to the nearer end by multiplications and shifts as
// in MurmurHash3 (Appleby 2011). match_borders() then decides whether borders with one hash are the same curve.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/isa/index_vector.inl.h"

template <class L>
[[gnu::always_inline]] inline Indices<L> mixed_bits(const Indices<L>& x) {
  const Indices<L> y = (x ^ x >> 16) * 0x85ebca6bu;
  return y ^ y >> 13;
}

template <class L>
[[gnu::always_inline]] inline Indices<L> load_bits(const float* values) {
  Indices<L> bits;
  __builtin_memcpy(&bits, values, sizeof bits);
  return bits;
}

/// Returns a power of two that brings the largest weight of a rational border of `count` points into [1/2, 1).
template <class L, class Weight>
[[gnu::always_inline]] inline typename L::Batch weight_scale(int count, const Weight& weight) {
  auto heaviest = weight(0);
  for (int k = 1; k < count; ++k) heaviest = xsimd::max(heaviest, weight(k));
  alignas(64) float scale[L::width];
  L::store(scale, heaviest);
  // 2^-k for a weight of at least 2^(k-1) and below 2^k
  for (float& w : scale) w = __builtin_bit_cast(float, (253u - (__builtin_bit_cast(std::uint32_t, w) >> 23)) << 23);
  return L::load(scale);
}

template <class L>
void hash_border(const BorderHashJob& job, const float* first, std::ptrdiff_t step, int count, std::uint32_t* hash) {
  const int components = job.rational ? 4 : 3;
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    const auto weight = [&](int k) { return L::load(first + k * step + 3 * block_lanes + lane); };
    const auto scale = job.rational ? weight_scale<L>(count, weight) : L::broadcast(1);
    Indices<L> sum = Indices<L>{} + static_cast<std::uint32_t>(count * 8 + components);
    for (int k = 0; k < count; ++k) {
      Indices<L> point = Indices<L>{} + static_cast<std::uint32_t>(k < count - 1 - k ? k + 1 : count - k);
      for (int c = 0; c < components; ++c) {
        alignas(64) float value[L::width];
        L::store(value, scale * L::load(first + k * step + c * block_lanes + lane));
        point = (point ^ load_bits<L>(value)) * 0x9e3779b1u;
        point ^= point >> 15;
      }
      sum += mixed_bits<L>(point);
    }
    sum = mixed_bits<L>(sum * 0xc2b2ae35u);
    __builtin_memcpy(hash + lane, &sum, sizeof sum);
  }
}

template <class L>
void hash_borders(const BorderHashJob& job) {
  const std::ptrdiff_t column = std::ptrdiff_t{job.rational ? 4 : 3} * block_lanes, row = column * (job.degree_v + 1);
  hash_border<L>(job, job.net, row, job.degree_u + 1, job.hash);
  hash_border<L>(job, job.net + row * job.degree_u, column, job.degree_v + 1, job.hash + block_lanes);
  hash_border<L>(job, job.net + column * job.degree_v, row, job.degree_u + 1, job.hash + 2 * block_lanes);
  hash_border<L>(job, job.net, column, job.degree_v + 1, job.hash + 3 * block_lanes);
}

template <class L>
void match_borders(const BorderMatchJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    const auto own = [&](int k, int c) { return L::load(job.first + k * job.step + c * block_lanes + lane); };
    const auto other = [&](int k, int c) {
      return L::gather(job.others + k * job.other_step + c * block_lanes, job.place + lane);
    };
    auto scale = L::broadcast(1), other_scale = scale;
    if (job.components == 4) {
      scale = weight_scale<L>(job.count, [&](int k) { return own(k, 3); });
      other_scale = weight_scale<L>(job.count, [&](int k) { return other(k, 3); });
    }
    Indices<L> differing{};
    for (int k = 0; k < job.count; ++k)
      for (int c = 0; c < job.components; ++c) {
        alignas(64) float a[L::width], b[L::width];
        L::store(a, scale * own(k, c));
        L::store(b, other_scale * other(k, c));
        differing |= load_bits<L>(a) ^ load_bits<L>(b);
      }
    __builtin_memcpy(job.differing + lane, &differing, sizeof differing);
  }
}
