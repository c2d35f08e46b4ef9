#pragma once
// Jobs and kernels that evaluate a block of patches over a grid, lanes = patches.

#include <cstddef>
#include <cstdint>

#include "kernel/isa/block_lanes.h"
#include "tessera/execution.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// The place of a parameter in GridJob::u_edges and v_edges.
inline constexpr std::uint8_t edge_inside = 0, edge_start = 1, edge_end = 2;

/// Computes the normal of one point in the caller's own arithmetic, for points that a lane's numbers cannot decide.
/// Writes three components and returns the NormalKind.
template <class T>
using ExactNormal = int (*)(void* context, int iu, int iv, int lane, T* normal);

/// Writes the threshold and noise of the patch under one lane.
template <class T>
using LaneThreshold = void (*)(void* context, int iu, int lane, T* threshold, T* noise);

/// The memory of a job's outputs; null if a quantity is not wanted. Vectors are `[sample][component][lane]`, scalars
/// and kinds `[sample][lane]`, samples in the order of the job's part of the grid, v fastest. Aligned to 64 bytes.
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
  /// Stores are then plain.
  bool by_lane = false;
  int lane_count = block_lanes;  ///< the lanes in use; vectors of others may be left out, and their outputs unset
  int u_begin = 0, u_end = 0;    ///< the part of the grid to evaluate
  int v_begin = 0, v_end = 0;

  std::ptrdiff_t vector_step = 3 * block_lanes;  ///< elements from one sample's vector to the next one's
  std::ptrdiff_t scalar_step = block_lanes;      ///< elements from one sample's scalar to the next one's
  T offset[3] = {0, 0, 0};  ///< added to positions (doubles only: floats stay relative to the origin)
  bool streaming = false;   ///< non-temporal stores; the caller ends them with finish_streaming
  /// Cache lines behind the net, where the next block's is, that each row prefetches: row k those from k *
  /// prefetched_lines on. They need not be readable.
  int prefetched_lines = 0;

  // The inputs that decide where r_u x r_v is the normal; read if normals or curvatures are wanted.
  const T* threshold = nullptr;  ///< `[lane]`: at or below this |r_u x r_v|^2 the tangents' rounding errors count
  /// `[lane]`: error of a tangent's component, times the weight at the point; negative: no normal anywhere.
  const T* noise = nullptr;
  const T* collapsed = nullptr;  ///< `[edge u0, u1, v0, v1][lane]`: 1 where that edge is one point; null if none is
  const std::uint8_t* u_edges = nullptr;  ///< `[iu]`: edge_start where u = 0, edge_end where u = 1
  const std::uint8_t* v_edges = nullptr;  ///< `[iv]`
  ExactNormal<T> exact_normal = nullptr;
  void* exact_context = nullptr;
  /// If lanes are samples of many patches, `threshold` holds an upper bound of all, and this writes that of one lane.
  LaneThreshold<T> lane_threshold = nullptr;
  T min_sine = 0;           ///< sine of the tangents' angle below which curvatures are undefined
  T umbilic_tolerance = 0;  ///< a point is umbilic if (k1 - k2) / (|k1| + |k2|) is at most this
};

template <class T>
struct LineJob;

/// Rows of the ring through which mesh_lines_f32 sends samples: whole samples, and whole vectors of any width.
inline constexpr int mesh_line_rows = 96;

/// Records of a block's patches: those of lane l begin at out[l]. A record begins with a position and a normal; what
/// follows up to its stride is not touched.
struct RecordJob {
  float* out[block_lanes] = {};  ///< at any multiple of 4 bytes; lanes beyond GridJob::lane_count repeat one before
  std::ptrdiff_t stride = 8;     ///< values from one record to the next, at least 6
};

/// Grid kernels. Each returns its own ISA, which the report passes to the caller.
struct GridKernels {
  Isa (*grid_f32)(const GridJob<float>&);
  /// Writes positions and normals of bicubic patches, and nothing else, six values per record, as put_lines_f32 does.
  /// `lines.rows` has mesh_line_rows rows, which hold the job's outputs in turn. Null where it would not pay.
  Isa (*mesh_lines_f32)(const GridJob<float>&, const LineJob<float>& lines);
  /// Writes positions and normals, and nothing else, to records of any stride by plain stores; the job's own outputs
  /// are not read. The patches have their parameters in common.
  Isa (*grid_records_f32)(const GridJob<float>&, const RecordJob& records);
};
struct DoubleGridKernels {
  Isa (*grid_f64)(const GridJob<double>&);
};

}}}  // namespace tessera::abi_0_1::kernel
