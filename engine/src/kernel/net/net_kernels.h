#pragma once
// Jobs and kernels for control nets: packing into blocks, their bounds, sums of their rows.

#include <cstddef>

#include "kernel/isa/block_lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// The control points of a block's patches, to be packed into its lanes relative to an origin.
template <class T>
struct PackJob {
  const double* const* nets = nullptr;  ///< one per lane, `[i][j]`: x y z x y z ..
  int degree_u = 0, degree_v = 0;
  double origin[3] = {0, 0, 0};  ///< subtracted from x, y, z
  T* out = nullptr;              ///< `[number][lane]`, 64-byte aligned
  /// Where the nets are copied unchanged in the same pass, one per lane; null: nowhere.
  double* const* copies = nullptr;
  /// `[threshold, noise][lane]`, 64-byte aligned: the threshold is (4 n l)^2, at least min_threshold, and the noise is
  /// n, where n is `noise` times the lane's largest coefficient and l is `longest` times its box's diagonal. Limited to
  /// T's largest value.
  T* thresholds = nullptr;
  double noise = 0, longest = 0, min_threshold = 0;
};

/// The boxes of the control points of a block's patches, without a change of origin.
struct alignas(64) NetBoxes {
  double lower[3][block_lanes], upper[3][block_lanes];
};

/// The facts about nets that packing them into a block finds.
struct alignas(64) PackedNets {
  NetBoxes boxes;
  double largest[block_lanes];  ///< largest |x|, |y| or |z| of a lane's coefficients
  bool edges_may_be_points;     ///< false: the first two points of each edge of each net differ
};

/// Bounds of points' numbers, number k at index k mod run: whole vectors of every width, with x, y and z apart.
struct PointBounds {
  static constexpr std::size_t run = 24;
  alignas(64) double lower[run];
  alignas(64) double upper[run];
};

/// Computes out[x] = weights[0] rows[x] + weights[1] rows[stride + x] + .. for x < width.
struct CombineJob {
  const double* weights = nullptr;
  std::size_t count = 0;  ///< number of rows, at least 1
  const double* rows = nullptr;
  std::size_t stride = 0, width = 0;
  double* out = nullptr;
};

struct NetKernels {
  void (*pack_f32)(const PackJob<float>&, PackedNets& found);
  void (*pack_f64)(const PackJob<double>&, PackedNets& found);
  /// Bounds `nets`, as in PackJob, of `count` numbers each.
  void (*bound_nets)(const double* const* nets, std::size_t count, NetBoxes& boxes);
  /// Extends the bounds by points of `count` numbers, x y z x y z ..
  void (*bound_points)(const double* points, std::size_t count, PointBounds& bounds);
  /// Returns whether all numbers lie within [-limit, limit]; a NaN does not.
  bool (*within)(const double* numbers, std::size_t count, double limit);
  void (*combine)(const CombineJob&);
};

}}}  // namespace tessera::abi_0_1::kernel
