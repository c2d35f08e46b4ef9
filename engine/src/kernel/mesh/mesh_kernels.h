#pragma once
// Vertices and triangles of the patches of a mesh.

#include <cstddef>
#include <cstdint>

#include "kernel/grid/grid_kernels.h"
#include "kernel/store/stream_state.h"

namespace tessera::inline abi_0_1::kernel {

/// Neighbouring samples of a row of a mesh's vertices that are evaluated together.
inline constexpr int mesh_tile = 8;

/// Of a bicubic patch, `[component][i][j]`.
inline constexpr int mesh_patch_points = 48;
/// Weights that a row of a cubic grid takes: see MeshCubicInner.
inline constexpr int mesh_row_weights = 32;

/// Weights of cubics at the inner k / rate, k = 1 .. rate - 1, for kernels that have mesh_points.
struct MeshCubicInner {
  /// For four neighbouring k as rows: `[(k - 1) / 4][order 0, 1][i][(k - 1) % 4][j of 4, all the same]`; an even number
  /// of fours.
  const float* rows = nullptr;
  /// As columns: `[order 0, 1][j][stride]`, at x that of k = x % (rate - 1) + 1; to x = rate + 14.
  const float* columns = nullptr;
  const std::int32_t* row_places = nullptr;  ///< 4 (x / (rate - 1)), as far
  std::ptrdiff_t stride = 0;
};
/// At k / rate along a border, `[order 0, 1][i][stride]`, k = 0 .. rate - 1 from 16 on, zeros before.
struct MeshCubicBorder {
  const float* weights = nullptr;
  std::ptrdiff_t stride = 0;
};

/// A border of a patch of a mesh, as the ring of border points runs.
struct MeshBorder {
  int rate = 0;
  /// Weights at k / rate, `[k / 8][order 0, 1][i][k % 8]`, those of order 0 bitwise symmetric (see BorderJob).
  const float* weights = nullptr;
  const MeshCubicBorder* cubic = nullptr;  ///< instead of them, where there are `points`
  float scale = 1;                         ///< of the homogeneous control points; 1 for polynomial patches
  bool is_point = false;                   ///< the whole border lies at `start`
  const float* start = nullptr;            ///< x y z; for borders that are points, and for rational patches
};

/// Vectors of neighbouring vertices: component c of vertex k goes to out[c][k * stride].
struct MeshRecords {
  float* out[3] = {nullptr, nullptr, nullptr};
  std::ptrdiff_t stride = 1;
  StreamState* lines = nullptr;  ///< there instead, x y z x y z .., past the caches
};

/// The vertices of one patch: inner points at (iu / inner_u, iv / inner_v), v fastest, then the border points.
struct MeshVertexJob {
  /// Degrees, rationality, `doubt` and `noise` (sixteen times the patch's), and exact_normal, which is asked for vertex
  /// lane < 8 ? iu + lane : iv + lane - 8; a lane beyond the last vertex means nothing.
  GridJob<float> grid;
  const float* net = nullptr;    ///< `[i][j][component]`, block_lanes apart
  int inner_u = 1, inner_v = 1;  ///< both 1, or both at least 2
  /// Weights at the inner k / inner_u, k = 1 .., `[(k - 1) / 8][order 0, 1][i][(k - 1) % 8]`, an even number of eights.
  const float* u_weights = nullptr;
  const float* v_weights = nullptr;
  /// Of a bicubic polynomial patch without collapsed borders, for kernels that have mesh_points: what these made of its
  /// net, and instead of the weights above:
  const float* points = nullptr;
  const MeshCubicInner *cubic_u = nullptr, *cubic_v = nullptr;
  MeshBorder border[4];          ///< v = 0, u = 1, v = 1, u = 0
  MeshRecords position, normal;  ///< from the patch's first vertex on; normal unwanted if all of it is null
  int writable = 0;              ///< records of them that may be written, whatever they then hold
};

/// A strip of triangles between a border and the inner points nearest to it: corner k is by codes[k] the
/// inner point of that number, the first of which is vertex `inner`, or with mesh_border_code the border point. Readable up
/// to a multiple of 16.
struct MeshStrip {
  const std::uint32_t* codes = nullptr;     ///< 64-byte aligned
  int count = 0;                            ///< codes, three a triangle
  std::uint32_t ring = 0;                   ///< the vertex of the border's first point
  std::uint32_t inner = 0, inner_step = 0;  ///< modulo 2^32
};
inline constexpr std::uint32_t mesh_border_code = 0x80000000;

/// The triangles of one patch.
struct MeshIndexJob {
  MeshStrip strip[4];
  std::uint32_t ring = 0, ring_size = 0;  ///< border points: the vertex behind the last is the first
  std::uint32_t first = 0, row = 0;       ///< inner vertices: the first, and from one row to the next
  int cells_u = 0, cells_v = 0;           ///< between inner points
  std::uint32_t* out = nullptr;
  std::uint32_t* end = nullptr;  ///< of what may be written
  StreamState* lines = nullptr;  ///< there instead, past the caches
};

struct MeshKernels {
  void (*mesh_vertices)(const MeshVertexJob&);
  void (*mesh_indices)(const MeshIndexJob&);
  /// The control points of a block of bicubic polynomial patches, `[i][j][component][lane]`, patch by patch: block_lanes
  /// times mesh_patch_points floats. Null where vertices are not made from them.
  void (*mesh_points)(const float* net, float* points);
  /// Stores what waits. Null where the others take no lines. finish_streaming comes after the last.
  void (*finish_lines)(StreamState& lines);
};

}  // namespace tessera::inline abi_0_1::kernel
