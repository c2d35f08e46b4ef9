#pragma once
// Jobs and kernels for scattered points, lanes = samples: check, location, evaluation, storing.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// Up to block_lanes neighbouring samples, one per lane.
struct PointSlot {
  int first = 0, count = 0;
  bool run = false;  ///< all lie on one patch
};
/// The largest number of slots that one call evaluates.
inline constexpr int point_slots = 8;

/// Scattered samples, evaluated slot by slot into a stage. Lanes beyond a slot's count are evaluated too; their results
/// are ignored.
template <class T>
struct PointJob {
  /// Degrees, rationality, the inputs that decide normals, and the stage: outputs `[slot][component][lane]` and
  /// `[slot][lane]`. A sample's Place is (slot, 0, lane). net, weights and ranges are not read.
  GridJob<T> grid;
  const T* points = nullptr;     ///< coefficients of patch 0, `[i][component][j]`, aligned to a cache line
  std::size_t patch_values = 0;  ///< values from one patch to the next
  /// `[sample]`: the patch. Like u and v it is readable for point_padding samples beyond the last.
  const std::uint32_t* patch = nullptr;
  const T* u = nullptr;  ///< `[sample]`
  const T* v = nullptr;
  int count = 0;               ///< total number of samples
  std::size_t prefetched = 0;  ///< bytes of a patch to prefetch; 0 where all stay in the first-level cache
  bool far = false;            ///< patches are not even in the second-level cache

  // Results of a call: the slots that it cut from sample `next` on, and the sample after them.
  int next = 0;
  PointSlot slots[point_slots];
  int slot_count = 0;
};
/// Samples between a prefetch and its use, longer than a cache miss. `near` is from the second-level cache to the
/// first, 3 KB of bicubic patches. `far` is from beyond to the second, where more lines may be in flight than to the
/// first: 1M patches of 192 bytes are then touched 1.3 times as fast.
template <class T>
inline constexpr int near_distance = 64 / sizeof(T);
inline constexpr int far_distance = 64;
inline constexpr int point_padding = block_lanes + far_distance;

/// A check of whether samples can be evaluated.
template <class T>
struct PointCheckJob {
  const std::uint32_t* patch = nullptr;  ///< `[sample]`; must be below `patches`
  std::uint32_t patches = 0;
  const T* u = nullptr;  ///< `[sample]`; must lie in [low, high]
  const T* v = nullptr;
  T low = 0, high = 1;
  std::size_t count = 0;
};

/// A search for parameters among strictly increasing breakpoints. It finds the span on the right of a breakpoint, the
/// last one at the end, and the outer ones beyond.
struct LocateJob {
  const double* breaks = nullptr;  ///< spans + 1 values
  std::size_t spans = 0;           ///< at least 1, below 2^31
  const double* t = nullptr;       ///< `[sample]`, like all that follow
  std::size_t count = 0;           ///< the kernel rounds it up to a multiple of locate_lanes
  std::int64_t* span = nullptr;    ///< `[sample]`
  double* local = nullptr;         ///< `[sample]`: 0 to 1 within the span, exact at its ends
  double* width = nullptr;         ///< `[sample]`: length of the span
};
inline constexpr std::size_t locate_lanes = 16;

/// Moves one output of slots from the stage to the caller's records.
template <class T>
struct PointStoreJob {
  const T* stage = nullptr;  ///< `[slot][component][lane]`
  int width = 3;             ///< components
  const PointSlot* slots = nullptr;
  int slot_count = 0;
  const std::uint32_t* records = nullptr;   ///< `[sample]`; null: sample k has the record k
  T* out[3] = {nullptr, nullptr, nullptr};  ///< component c of record k goes to out[c][k * stride]
  std::ptrdiff_t stride = 1;
};

struct PointKernels {
  Isa (*points_f32)(PointJob<float>&);
  Isa (*points_f64)(PointJob<double>&);
  bool (*check_points_f32)(const PointCheckJob<float>&);
  bool (*check_points_f64)(const PointCheckJob<double>&);
  void (*locate)(const LocateJob&);
  void (*store_points_f32)(const PointStoreJob<float>&);
  void (*store_points_f64)(const PointStoreJob<double>&);
};

}}}  // namespace tessera::abi_0_1::kernel
