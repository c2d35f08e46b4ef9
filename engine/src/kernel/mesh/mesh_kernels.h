#pragma once
// Jobs and kernels for the vertices and triangles of one patch of a mesh.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid_kernels.h"
#include "kernel/store/stream_state.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// The number of neighbouring samples in a row of a mesh's vertices that are evaluated together.
inline constexpr int mesh_tile = 8;

/// Numbers of a bicubic patch, `[component][i][j]`.
inline constexpr int mesh_patch_points = 48;
/// Weights of one row of a cubic grid: see MeshCubicInner.
inline constexpr int mesh_row_weights = 32;

/// Weights of cubics at the inner k / rate, k = 1 .. rate - 1, for kernels that have mesh_points.
struct MeshCubicInner {
  /// Weights of rows, for four neighbouring k: `[(k - 1) / 4][order 0, 1][i][(k - 1) % 4][j of 4, all the same]`; an
  /// even number of fours.
  const float* rows = nullptr;
  /// Weights of columns, `[order 0, 1][j][stride]`: entry x is that of k = x % (rate - 1) + 1, up to x = rate + 14.
  const float* columns = nullptr;
  const std::int32_t* row_places = nullptr;  ///< 4 (x / (rate - 1)), up to the same x
  std::ptrdiff_t stride = 0;
};
/// Weights at k / rate along a border, `[order 0, 1][i][stride]`: k = 0 .. rate - 1 from index 16 on, zeros before.
struct MeshCubicBorder {
  const float* weights = nullptr;
  std::ptrdiff_t stride = 0;
};

/// A border of a patch of a mesh, in the direction of the ring of border points.
struct MeshBorder {
  int rate = 0;
  /// Weights at k / rate, `[k / 8][order 0, 1][i][k % 8]`, those of order 0 bitwise symmetric (see BorderJob).
  const float* weights = nullptr;
  const MeshCubicBorder* cubic = nullptr;  ///< instead of `weights`, if there are `points`
  float scale = 1;                         ///< factor of the homogeneous control points; 1 for polynomial patches
  bool is_point = false;                   ///< the whole border lies at `start`
  const float* start = nullptr;            ///< x y z; for borders that are points, and for rational patches
};

/// Vectors of neighbouring vertices: component c of vertex k goes to out[c][k * stride].
struct MeshRecords {
  float* out[3] = {nullptr, nullptr, nullptr};
  std::ptrdiff_t stride = 1;
  StreamState* lines = nullptr;  ///< if set, x y z x y z .. go there instead, past the caches
};

/// The vertices of one patch: inner points at (iu / inner_u, iv / inner_v), v fastest, then the border points.
struct MeshVertexJob {
  /// Degrees, rationality, `threshold` and `noise` (sixteen copies of the patch's), and exact_normal, which is called
  /// for vertex lane < 8 ? iu + lane : iv + lane - 8. Results of lanes beyond the last vertex are ignored.
  GridJob<float> grid;
  const float* net = nullptr;    ///< `[i][j][component]`, block_lanes apart
  int inner_u = 1, inner_v = 1;  ///< both 1, or both at least 2
  /// Weights at the inner k / inner_u, k = 1 .., `[(k - 1) / 8][order 0, 1][i][(k - 1) % 8]`, an even number of eights.
  const float* u_weights = nullptr;
  const float* v_weights = nullptr;
  /// For a bicubic polynomial patch without collapsed borders and kernels that have mesh_points: the points that these
  /// made of its net and, instead of the weights above, cubic weights.
  const float* points = nullptr;
  const MeshCubicInner *cubic_u = nullptr, *cubic_v = nullptr;
  MeshBorder border[4];          ///< v = 0, u = 1, v = 1, u = 0
  MeshRecords position, normal;  ///< from the patch's first vertex on; a normal with only null pointers is not wanted
  int writable = 0;              ///< records of them that may be overwritten
};

/// A strip of triangles between a border and the inner points nearest to it. Corner k is, by codes[k], the inner point
/// of that number, counted from vertex `inner`, or with mesh_border_code the border point. Readable up to a multiple of
/// 16.
struct MeshStrip {
  const std::uint32_t* codes = nullptr;     ///< 64-byte aligned
  int count = 0;                            ///< number of codes, three per triangle
  std::uint32_t ring = 0;                   ///< the vertex of the border's first point
  std::uint32_t inner = 0, inner_step = 0;  ///< modulo 2^32
};
inline constexpr std::uint32_t mesh_border_code = 0x80000000;

/// The triangles of one patch.
struct MeshIndexJob {
  MeshStrip strip[4];
  std::uint32_t ring = 0, ring_size = 0;  ///< border points: the vertex after the last is the first
  std::uint32_t first = 0, row = 0;       ///< inner vertices: the first, and the step from one row to the next
  int cells_u = 0, cells_v = 0;           ///< number of cells between inner points
  std::uint32_t* out = nullptr;
  std::uint32_t* end = nullptr;  ///< end of the writable memory
  StreamState* lines = nullptr;  ///< if set, indices go there instead, past the caches
};

struct MeshKernels {
  void (*mesh_vertices)(const MeshVertexJob&);
  void (*mesh_indices)(const MeshIndexJob&);
  /// Turns the control points of a block of bicubic polynomial patches, `[i][j][component][lane]`, into patch by patch:
  /// block_lanes times mesh_patch_points floats. Null where vertices are not made from them.
  void (*mesh_points)(const float* net, float* points);
  /// Stores the numbers that wait. Null where the other kernels take no lines. finish_streaming comes after the last.
  void (*finish_lines)(StreamState& lines);
};

}}}  // namespace tessera::abi_0_1::kernel
