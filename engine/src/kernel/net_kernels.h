#pragma once
// Control nets: into blocks, their bounds, sums of their rows.

#include <cstddef>

#include "kernel/block_lanes.h"

namespace tessera::kernel {

/// The control points of a block's patches, into its lanes, relative to an origin.
template <class T>
struct PackJob {
  const double* const* nets = nullptr;  ///< one a lane, `[number]`: x y z x y z ..
  std::size_t count = 0;                ///< numbers in each, a multiple of 3
  double shift[3] = {0, 0, 0};          ///< added to x, y, z
  T* out = nullptr;                     ///< `[number][lane]`, 64-byte aligned
};

/// The boxes of the control points of a block's patches.
struct alignas(64) NetBoxes {
  double lower[3][block_lanes], upper[3][block_lanes];
};

/// Bounds of points' numbers, number k in the place k mod run: whole vectors of every width, and of x, y and z apart.
struct PointBounds {
  static constexpr std::size_t run = 24;
  alignas(64) double lower[run];
  alignas(64) double upper[run];
};

/// out[x] = weights[0] rows[x] + weights[1] rows[stride + x] + .. for x < width.
struct CombineJob {
  const double* weights = nullptr;
  std::size_t count = 0;  ///< of rows, at least 1
  const double* rows = nullptr;
  std::size_t stride = 0, width = 0;
  double* out = nullptr;
};

struct NetKernels {
  void (*pack_f32)(const PackJob<float>&);
  void (*pack_f64)(const PackJob<double>&);
  /// `nets` and `count` as in PackJob.
  void (*bound_nets)(const double* const* nets, std::size_t count, NetBoxes& boxes);
  /// Extends the bounds by points of `count` numbers, x y z x y z ..
  void (*bound_points)(const double* points, std::size_t count, PointBounds& bounds);
  /// Whether all numbers lie within [-limit, limit]; a NaN does not.
  bool (*within)(const double* numbers, std::size_t count, double limit);
  void (*combine)(const CombineJob&);
};

}  // namespace tessera::kernel
