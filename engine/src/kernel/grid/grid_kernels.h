#pragma once
// A block of patches over a grid.

#include <cstddef>
#include <cstdint>

#include "kernel/isa/block_lanes.h"
#include "tessera/execution.h"
#include "tessera/quantities.h"

namespace tessera::inline abi_0_1::kernel {

/// Where a parameter lies: what GridJob::u_edges and v_edges hold.
inline constexpr std::uint8_t edge_inside = 0, edge_start = 1, edge_end = 2;

/// The normal of one point in the caller's own arithmetic, for points that a lane's numbers can't decide. Writes three
/// components and returns the NormalKind.
template <class T>
using ExactNormal = int (*)(void* context, int iu, int iv, int lane, T* normal);

/// Doubt and noise of the patch under one lane.
template <class T>
using LaneDoubt = void (*)(void* context, int iu, int lane, T* doubt, T* noise);

/// Where a job's outputs go; null where a quantity is not wanted. Vectors are `[sample][component][lane]`, scalars and
/// kinds `[sample][lane]`, samples in the order of the job's part of the grid, v fastest. Aligned to 64 bytes.
template <class T>
using GridJobOutputs = Quantities<T*, T*, std::uint8_t*>;

/// A block of patches over a grid of tabulated weights. T is float or double.
template <class T>
struct GridJob : GridJobOutputs<T> {
  const T* net = nullptr;  ///< `[i][j][component][lane]`, 64-byte aligned; 3 components, or 4 if rational (homogeneous)
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  const T* u_weights = nullptr;  ///< `[iu][order][i]`: values, first and second derivatives, degree_u + 1 of each
  const T* v_weights = nullptr;  ///< `[iv][order][j]`
  /// Each lane has parameters of its own: weights are `[iu][order][i][lane]`, edges `[iu][lane]`, likewise along v.
  /// Stores are plain then.
  bool by_lane = false;
  int u_begin = 0, u_end = 0;  ///< the part of the grid to evaluate
  int v_begin = 0, v_end = 0;

  std::ptrdiff_t vector_step = 3 * block_lanes;  ///< elements from one sample's vector to the next one's
  std::ptrdiff_t scalar_step = block_lanes;      ///< elements from one sample's scalar to the next one's
  T offset[3] = {0, 0, 0};  ///< added to positions (doubles only: floats stay relative to the origin)
  bool streaming = false;   ///< non-temporal stores; the caller ends them with finish_streaming
  /// Cache lines behind the net, where the next block's is, that row k asks for: from k * prefetched_lines on. Readable or
  /// not.
  int prefetched_lines = 0;

  // What decides where r_u x r_v stands for the normal; read where normals or curvatures are wanted.
  const T* doubt = nullptr;  ///< `[lane]`: at or below this |r_u x r_v|^2 the tangents' rounding errors count
  /// `[lane]`: error of a tangent's component, times the weight at the point; negative: no normal anywhere.
  const T* noise = nullptr;
  const T* collapsed = nullptr;  ///< `[edge u0, u1, v0, v1][lane]`: 1 where that edge is one point; null if none is
  const std::uint8_t* u_edges = nullptr;  ///< `[iu]`: edge_start where u = 0, edge_end where u = 1
  const std::uint8_t* v_edges = nullptr;  ///< `[iv]`
  ExactNormal<T> exact_normal = nullptr;
  void* exact_context = nullptr;
  /// Where lanes are samples of many patches, `doubt` holds an upper bound of all, and this says what one lane's is.
  LaneDoubt<T> lane_doubt = nullptr;
  T min_sine = 0;           ///< of the tangents' angle, below which curvatures are undefined
  T umbilic_tolerance = 0;  ///< (k1 - k2) / (|k1| + |k2|) at or below which a point is umbilic
};

template <class T>
struct LineJob;

/// Rows of the ring through which mesh_lines_f32 sends samples: whole samples, and whole vectors of any width.
inline constexpr int mesh_line_rows = 96;

/// Each returns its own ISA, which the report hands to the caller.
struct GridKernels {
  Isa (*grid_f32)(const GridJob<float>&);
  /// Positions and normals of bicubic patches, nothing else, six values a record, as put_lines_f32 puts them: `lines.rows`
  /// has mesh_line_rows rows, which hold the job's outputs in turn. Null where it would not pay.
  Isa (*mesh_lines_f32)(const GridJob<float>&, const LineJob<float>& lines);
};
struct DoubleGridKernels {
  Isa (*grid_f64)(const GridJob<double>&);
};

}  // namespace tessera::inline abi_0_1::kernel
