#pragma once
// Stores outputs of scattered samples, lanes = samples, from the stage to the caller's records.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/point/point_kernels.h.

#include "kernel/store/store.inl.h"

/// Prefetches the memory that the next call stores to into the second-level cache, since patches need the first. Stores
/// leave in order, so one to a far line holds up all that follow. `width`: values of a record.
template <class T>
inline void fetch_next(const T* out, int width) {
  const auto* next = reinterpret_cast<const char*>(out + width * point_slots * block_lanes);
  for (int b = 0; b < width * block_lanes * static_cast<int>(sizeof(T)); b += 64) __builtin_prefetch(next + b, 1, 2);
}

/// Stores `count` samples of a slot from `lane` on.
template <class L, Records Layout>
[[gnu::always_inline]] inline void store_lanes(const PointStoreJob<typename L::Scalar>& job,
                                               const typename L::Scalar* stage, const PointSlot& slot, int lane,
                                               int count) {
  if (job.width == 1) {
    L::store_first(job.out[0] + slot.first + lane, L::load(stage + lane), count);
  } else {
    typename L::Batch p[3];
    for (int c = 0; c < 3; ++c) p[c] = L::load(stage + c * block_lanes + lane);
    store_records<L, Layout>(job, slot.first + lane, p, count);
  }
}

/// Stores the samples of a slot as neighbouring records of three, or as numbers one after the other.
template <class L, Records Layout>
inline void store_slot(const PointStoreJob<typename L::Scalar>& job, const typename L::Scalar* stage,
                       const PointSlot& slot) {
  constexpr int together = Layout == Records::packed ? 3 : 1;
  for (int c = 0; c < job.width; c += together) fetch_next(job.out[c] + together * slot.first, together);
  if (slot.count == block_lanes) {
#pragma GCC unroll 4
    for (int lane = 0; lane < block_lanes; lane += L::width) store_lanes<L, Layout>(job, stage, slot, lane, L::width);
  } else {
    for (int lane = 0; lane < slot.count; lane += L::width)
      store_lanes<L, Layout>(job, stage, slot, lane, slot.count - lane < L::width ? slot.count - lane : int{L::width});
  }
}

template <class T>
inline std::ptrdiff_t record_of(const PointStoreJob<T>& job, int sample) {
  return (job.records ? static_cast<std::ptrdiff_t>(job.records[sample]) : sample) * job.stride;
}

/// Stores vectors whose three components lie together, each sample at its own record.
template <class L>
inline void store_vectors(const PointStoreJob<typename L::Scalar>& job, const typename L::Scalar* stage,
                          const PointSlot& slot) {
  using T = typename L::Scalar;
  alignas(64) T vectors[3 * L::width];
  for (int lane = 0; lane < slot.count; lane += L::width) {
    typename L::Batch p[3];
    for (int c = 0; c < 3; ++c) p[c] = L::load(stage + c * block_lanes + lane);
    L::interleave(p);
    for (int k = 0; k < 3; ++k) L::store(vectors + k * L::width, p[k]);
    const int part = slot.count - lane < L::width ? slot.count - lane : int{L::width};
    for (int l = 0; l < part; ++l)
      __builtin_memcpy(job.out[0] + record_of(job, slot.first + lane + l), vectors + 3 * l, 3 * sizeof(T));
  }
}

/// Stores one component after the other, each sample at its own record.
template <class T>
inline void store_apart(const PointStoreJob<T>& job, const T* stage, const PointSlot& slot) {
  for (int c = 0; c < job.width; ++c)
    for (int lane = 0; lane < slot.count; ++lane)
      job.out[c][record_of(job, slot.first + lane)] = stage[c * block_lanes + lane];
}

template <class L>
void store_points(const PointStoreJob<typename L::Scalar>& job) {
  const bool together = !job.records, number = job.width == 1;
  const bool arrays = together && job.stride == 1;
  const bool vectors = !number && job.out[1] == job.out[0] + 1 && job.out[2] == job.out[0] + 2;
  for (int k = 0; k < job.slot_count; ++k) {
    const auto* stage = job.stage + std::ptrdiff_t{k} * job.width * block_lanes;
    const PointSlot& slot = job.slots[k];
    if (together && vectors && job.stride == 3) {
      store_slot<L, Records::packed>(job, stage, slot);
    } else if (arrays) {
      store_slot<L, Records::arrays>(job, stage, slot);
    } else if (vectors) {
      store_vectors<L>(job, stage, slot);
    } else {
      store_apart(job, stage, slot);
    }
  }
}
