#pragma once
// Positions and normals of a block that lie together in records of any stride, such as vertices of position, normal and
// uv: lanes = patches. One sample of a vector's patches is a matrix, six values by lanes. It is transposed in registers
// and goes to one record of each patch, so no vector of a patch is joined from several samples.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/isa/lanes.h.

#include "kernel/grid/grid_kernel.inl.h"

/// Samples that wait for their normals.
template <class L>
struct WaitingSamples {
  static constexpr int capacity = 32;
  struct One {
    typename L::Batch position[3], direction[3], squared;  ///< `direction` is r_u x r_v, `squared` its square
  };
  One at[capacity + 1];
};

/// The lanes in which r_u x r_v is safely above the tangents' errors.
template <class L>
[[gnu::always_inline]] inline auto safe_lanes(const GridJob<float>& job, int lane, const typename L::Batch& squared) {
  return (squared > L::load(job.threshold + lane)) & (squared <= L::broadcast(SafeRange<float>::highest));
}

/// Writes those of `count` samples again, from number `first` on, that have doubtful lanes.
template <class L>
[[gnu::noinline, gnu::cold]] void put_degenerate(const GridJob<float>& job, const WaitingSamples<L>& waiting,
                                                 std::ptrdiff_t first, int count, int lane, const RecordJob& records) {
  for (int k = 0; k < count; ++k) {
    const auto& one = waiting.at[k];
    const auto safe = safe_lanes<L>(job, lane, one.squared);
    if (xsimd::all(safe)) continue;
    const std::ptrdiff_t number = first + k, columns = job.v_end - job.v_begin;
    const Place place{job.u_begin + static_cast<int>(number / columns),
                      job.v_begin + static_cast<int>(number % columns), lane};
    const auto reciprocal = inverse_root<L>(one.squared);
    NormalExchange<L> exchange;
    for (int c = 0; c < 3; ++c) L::store(exchange.direction[c], one.direction[c] * reciprocal);
    Sample<L> sample;
    derive_again<L>(job, place, sample);
    put_tangents<L>(job.rational, sample, exchange);
    degenerate_normals<L>(job, place, xsimd::select(safe, L::broadcast(1), L::broadcast(0)), exchange);
    typename L::Batch normal[3];
    for (int c = 0; c < 3; ++c) normal[c] = L::load(exchange.direction[c]);
    store_sixes<L>(one.position, normal, records.out + lane, number * records.stride);
  }
}

/// Writes `count` samples, of which the first is number `first` of the job's part of the grid. A root is taken while
/// the sample before it is transposed.
template <class L>
[[gnu::noinline]] void put_samples(const GridJob<float>& job, WaitingSamples<L>& waiting, std::ptrdiff_t first,
                                   int count, int lane, const RecordJob& records) {
  waiting.at[count].squared = waiting.at[0].squared;  // a root that is not used
  float* out[L::width];                               // in registers: stores cannot change these
  for (int l = 0; l < L::width; ++l) out[l] = records.out[lane + l];
  const std::ptrdiff_t stride = records.stride;
  auto next = inverse_root<L>(waiting.at[0].squared);
  auto safe = safe_lanes<L>(job, lane, waiting.at[0].squared);
  std::ptrdiff_t at = first * stride;
  for (int k = 0; k < count; ++k, at += stride) {
    const auto& one = waiting.at[k];
    const auto reciprocal = next;
    next = inverse_root<L>(waiting.at[k + 1].squared);
    safe = safe & safe_lanes<L>(job, lane, one.squared);
    typename L::Batch normal[3];
    for (int c = 0; c < 3; ++c) normal[c] = one.direction[c] * reciprocal;
    store_sixes<L>(one.position, normal, out, at);
  }
  if (!xsimd::all(safe)) put_degenerate<L>(job, waiting, first, count, lane, records);
}

/// A row's sums and its normals are loops of their own: each is short, so that the processor works at several samples
/// at once. DegreeU and DegreeV 0 read the degree from the job.
template <class L, int DegreeU, int DegreeV, bool Rational>
void record_lanes(const GridJob<float>& job, const RecordJob& records, int lane) {
  constexpr int components = Rational ? 4 : 3, capacity = capacity_of<DegreeV>;
  const int count_u = DegreeU > 0 ? DegreeU + 1 : job.degree_u + 1;
  const int count_v = DegreeV > 0 ? DegreeV + 1 : job.degree_v + 1;
  const float* next_net = job.net + std::ptrdiff_t{count_u} * count_v * components * block_lanes;
  RowCurves<L, 1, components, capacity> curves;
  WaitingSamples<L> waiting;
  std::ptrdiff_t written = 0;
  int count = 0;
  for (int iu = job.u_begin; iu < job.u_end; ++iu) {
    if (lane == 0) prefetch_lines(next_net, iu * job.prefetched_lines, job.prefetched_lines);
    row_curves<L, DegreeV>(job.net + lane, job.u_weights + std::ptrdiff_t{iu} * 3 * count_u, count_u, count_v, curves);
    for (int iv = job.v_begin; iv < job.v_end;) {
      const int room = waiting.capacity - count, end = job.v_end - iv < room ? job.v_end : iv + room;
      for (; iv < end; ++iv) {
        Sample<L> sample;
        evaluate_sample<L, 1>(curves, job.v_weights + std::ptrdiff_t{iv} * 3 * count_v, count_v, sample);
        auto& one = waiting.at[count++];
        copy<L>(sample.position, one.position);
        one.squared = cross<L>(sample.du, sample.dv, one.direction);
      }
      if (count < waiting.capacity) continue;
      put_samples<L>(job, waiting, written, count, lane, records);
      written += count;
      count = 0;
    }
  }
  if (count > 0) put_samples<L>(job, waiting, written, count, lane, records);
}

template <class L, int DegreeU, int DegreeV, bool Rational>
void record_groups(const GridJob<float>& job, const RecordJob& records) {
  for (int lane = 0; lane < job.lane_count; lane += L::width)
    record_lanes<L, DegreeU, DegreeV, Rational>(job, records, lane);
}

template <class L>
Isa grid_records(const GridJob<float>& job, const RecordJob& records) {
  if (job.degree_u == 3 && job.degree_v == 3) {
    job.rational ? record_groups<L, 3, 3, true>(job, records) : record_groups<L, 3, 3, false>(job, records);
  } else {
    job.rational ? record_groups<L, 0, 0, true>(job, records) : record_groups<L, 0, 0, false>(job, records);
  }
  return this_isa;
}
