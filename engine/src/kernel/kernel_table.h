#pragma once
// What a kernel is given, and the table of the kernels of one instruction set: plain function pointers over raw memory.
// Callers validate; kernels assume. One table an ISA, each in a translation unit of its own.

#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/isa.h"

namespace tessera::kernel {

/// Patches in a block: one a lane.
inline constexpr int block_lanes = 16;

/// Where a parameter lies: what GridJob::u_edges and v_edges hold.
inline constexpr std::uint8_t edge_inside = 0, edge_start = 1, edge_end = 2;

/// The normal of one point in the caller's own arithmetic, for points that a lane's numbers can't decide. Writes three
/// components and returns the NormalKind.
template <class T>
using ExactNormal = int (*)(void* context, int iu, int iv, int lane, T* normal);

/// Doubt and noise of the patch under one lane.
template <class T>
using LaneDoubt = void (*)(void* context, int iu, int lane, T* doubt, T* noise);

/// A block of patches over a grid of tabulated weights. T is float or double.
template <class T>
struct GridJob {
  const T* net = nullptr;        ///< `[i][j][component][lane]`, 64-byte aligned; 3 components, or 4 if rational (homogeneous)
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  const T* u_weights = nullptr;  ///< `[iu][order][i]`: values, first and second derivatives, degree_u + 1 of each
  const T* v_weights = nullptr;  ///< `[iv][order][j]`
  /// Each lane has parameters of its own: weights are `[iu][order][i][lane]`, edges `[iu][lane]`, likewise along v.
  /// Stores are plain then.
  bool by_lane = false;
  int u_begin = 0, u_end = 0;    ///< the part of the grid to evaluate
  int v_begin = 0, v_end = 0;

  /// Outputs `[sample][component][lane]`, samples in the order of the part, v fastest, `vector_step` elements apart;
  /// null where not wanted. Aligned to the vector width (64 bytes is enough for all).
  T* position = nullptr;
  T* du = nullptr;
  T* dv = nullptr;
  T* normal = nullptr;
  T* duu = nullptr;
  T* duv = nullptr;
  T* dvv = nullptr;
  T* first_form = nullptr;       ///< r_u.r_u, r_u.r_v, r_v.r_v
  T* second_form = nullptr;      ///< r_uu.N, r_uv.N, r_vv.N
  T* first_direction = nullptr;
  T* second_direction = nullptr;
  std::ptrdiff_t vector_step = 3 * block_lanes;
  /// Outputs `[sample][lane]`, `scalar_step` elements apart.
  T* gaussian = nullptr;
  T* mean = nullptr;
  T* first_curvature = nullptr;
  T* second_curvature = nullptr;
  std::ptrdiff_t scalar_step = block_lanes;
  /// Outputs `[sample][lane]` without gaps, of the values of NormalKind and CurvatureKind.
  std::uint8_t* normal_kind = nullptr;
  std::uint8_t* curvature_kind = nullptr;
  T offset[3] = {0, 0, 0};       ///< added to positions (doubles only: floats stay relative to the origin)
  bool streaming = false;        ///< non-temporal stores; the caller ends them with finish_streaming

  // What decides where r_u x r_v stands for the normal; read where normals or curvatures are wanted.
  const T* doubt = nullptr;      ///< `[lane]`: at or below this |r_u x r_v|^2 the tangents' rounding errors count
  /// `[lane]`: error of a tangent's component, times the weight at the point; negative: no normal anywhere.
  const T* noise = nullptr;
  const T* collapsed = nullptr;  ///< `[edge u0, u1, v0, v1][lane]`: 1 where that edge is one point; null if none is
  const std::uint8_t* u_edges = nullptr;  ///< `[iu]`: edge_start where u = 0, edge_end where u = 1
  const std::uint8_t* v_edges = nullptr;  ///< `[iv]`
  ExactNormal<T> exact_normal = nullptr;
  void* exact_context = nullptr;
  /// Where lanes are samples of many patches, `doubt` holds an upper bound of all, and this says what one lane's is.
  LaneDoubt<T> lane_doubt = nullptr;
  T smallest_sine = 0;           ///< of the tangents' angle, below which curvatures are undefined
  T umbilic_tolerance = 0;       ///< (k1 - k2) / (|k1| + |k2|) at or below which a point is umbilic
};

/// Border curves of a block, evaluated so that the direction of the parameter does not change a bit.
template <class T>
struct BorderJob {
  const T* control = nullptr;    ///< the first control point, `[component][lane]`
  std::ptrdiff_t control_step = 0;  ///< elements from one control point of the border to the next
  int degree = 0;
  bool rational = false;
  const T* weights = nullptr;    ///< `[k][degree + 1]`, bitwise symmetric: weights[k][i] == weights[count-1-k][degree-i]
  int count = 0;
  T* position = nullptr;         ///< `[k][component][lane]`
};

/// Results of a block's lanes on their way to an array each, from piece to piece of the grid: what falls short of a whole
/// aligned vector waits here.
template <class T>
struct LineState {
  static constexpr int values = 64 / static_cast<int>(sizeof(T));
  alignas(64) T part[block_lanes][values];  ///< the vector at `next` as far as it is known, up to `end`
  alignas(64) T head[block_lanes][values];  ///< once next is beyond first: that one, which another lane may share
  T* first[block_lanes];                    ///< the vector in which the lane begins, at value `begin`
  T* next[block_lanes];
  int begin[block_lanes], end[block_lanes];
};

/// The next values of all lanes.
template <class T>
struct LineJob {
  LineState<T>* state = nullptr;
  /// Value k of lane l at rows[k * step + l]; aligned to 64 bytes. Another 15 rows can be read, and mean nothing.
  const T* rows = nullptr;
  std::ptrdiff_t step = block_lanes;
  std::ptrdiff_t count = 0;
  int lane_count = block_lanes;  ///< lanes beyond it have the values and the memory of one before
  bool streaming = false;        ///< non-temporal stores, as in GridJob
};

/// The control points of a block's patches, into its lanes, relative to an origin.
template <class T>
struct PackJob {
  const double* const* nets = nullptr;  ///< one a lane, `[number]`: x y z x y z ..
  std::size_t count = 0;         ///< numbers in each, a multiple of 3
  double shift[3] = {0, 0, 0};   ///< added to x, y, z
  T* out = nullptr;              ///< `[number][lane]`, 64-byte aligned
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
  std::size_t count = 0;         ///< of rows, at least 1
  const double* rows = nullptr;
  std::size_t stride = 0, width = 0;
  double* out = nullptr;
};

/// Rows of a transfinite grid: g1_j C1_i + g2_j C2_i + f1_i K1_j + f2_i K2_j at record i * column_count + j.
template <class T>
struct BlendJob {
  const T* rows = nullptr;       ///< `[i][8]`: C1 and C2, three components each, then f1 and f2
  const T* columns = nullptr;    ///< `[8][column_step]`: g1, g2, then K1 and K2, three components each; 64-byte aligned
  std::ptrdiff_t column_step = 0;   ///< at least column_count, a multiple of 16: whole vectors are read
  std::ptrdiff_t row_count = 0, column_count = 0;
  T* out[3] = {nullptr, nullptr, nullptr};  ///< component c of record k goes to out[c][k * stride]
  std::ptrdiff_t stride = 1;
};

/// Up to block_lanes neighbouring samples, one a lane.
struct PointSlot {
  int first = 0, count = 0;
  bool run = false;  ///< all lie on one patch
};
/// Slots that a call evaluates at the most.
inline constexpr int point_slots = 8;

/// Scattered samples, evaluated slot by slot into a stage. Lanes beyond a slot's count are evaluated too and mean
/// nothing.
template <class T>
struct PointJob {
  /// Degrees, rationality, what decides about normals, and the stage: outputs `[slot][component][lane]` and
  /// `[slot][lane]`. A sample's Place is (slot, 0, lane). net, weights and ranges are not read.
  GridJob<T> grid;
  const T* points = nullptr;        ///< coefficients of patch 0, `[i][component][j]`, from a cache line on
  std::size_t patch_values = 0;     ///< from one patch to the next
  /// `[sample]`: the patch. Like u and v it is readable for point_padding samples beyond the last.
  const std::uint32_t* patch = nullptr;
  const T* u = nullptr;             ///< `[sample]`
  const T* v = nullptr;
  int count = 0;                    ///< samples in all
  std::size_t prefetched = 0;       ///< bytes of a patch to fetch ahead; 0 where all stay in the first-level cache
  bool far = false;                 ///< patches are not even in the second-level cache

  // What a call leaves: the slots that it cut from sample `next` on, and the sample behind them.
  int next = 0;
  PointSlot slots[point_slots];
  int slot_count = 0;
};
/// Samples from a fetch to its use, beyond the time of a cache miss: from the second-level cache to the first, and from
/// beyond to the second, for more lines may be on their way there than to the first: 1M patches of 192 bytes are
/// touched 1.3 times as fast.
inline constexpr int near_distance = 16, far_distance = 64;
inline constexpr int point_padding = block_lanes + far_distance;

/// Whether samples can be evaluated.
template <class T>
struct PointCheckJob {
  const std::uint32_t* patch = nullptr;  ///< `[sample]`; must be below `patches`
  std::uint32_t patches = 0;
  const T* u = nullptr;  ///< `[sample]`; must lie in [low, high]
  const T* v = nullptr;
  T low = 0, high = 1;
  std::size_t count = 0;
};

/// Finds parameters among strictly increasing breakpoints: the span on the right of a breakpoint, the last one at the
/// end, the outer ones beyond.
struct LocateJob {
  const double* breaks = nullptr;  ///< spans + 1 of them
  std::size_t spans = 0;           ///< at least 1, below 2^31
  const double* t = nullptr;       ///< `[sample]`, like all that follow
  std::size_t count = 0;           ///< the kernel rounds it up to a multiple of locate_lanes
  std::int64_t* span = nullptr;    ///< `[sample]`
  double* local = nullptr;         ///< `[sample]`: 0 to 1 within the span, exact at its ends
  double* width = nullptr;         ///< `[sample]`: of the span
};
inline constexpr std::size_t locate_lanes = 16;

/// Moves one output of slots from the stage to records of the caller's.
template <class T>
struct PointStoreJob {
  const T* stage = nullptr;            ///< `[slot][component][lane]`
  int width = 3;                       ///< components
  const PointSlot* slots = nullptr;
  int slot_count = 0;
  const std::uint32_t* records = nullptr;   ///< `[sample]`; null: sample k has the record k
  T* out[3] = {nullptr, nullptr, nullptr};  ///< component c of record k goes to out[c][k * stride]
  std::ptrdiff_t stride = 1;
};

/// Bounds on the second derivatives of a block of polynomial patches, over the whole patch, its halves and quarters: see
/// ChordBound. They include the rounding of the packed coefficients.
struct ChordJob {
  const float* net = nullptr;   ///< `[i][j][component][lane]`
  int degree_u = 0, degree_v = 0;
  float* pieces = nullptr;      ///< `[piece of 9][uu, uv, vv][lane]`, in units of `unit`
  float* unit = nullptr;        ///< `[lane]`: a power of two above the largest coefficient
  float* size = nullptr;        ///< `[lane]`: the largest coefficient, at least 2^-120
};

/// The rates with the fewest cells that keep a distance, for the patches of a block.
struct RateJob {
  const float* pieces = nullptr;    ///< as above
  const float* distance = nullptr;  ///< `[lane]`, in the patch's unit
  int most_rate = 0;
  std::int32_t* rate_u = nullptr;   ///< `[lane]`: 0 where the search failed, which does not prove that there are none
  std::int32_t* rate_v = nullptr;
  float* chord = nullptr;           ///< `[lane]`: the bound that the rates keep, in the patch's unit
};

/// Hashes of the borders of a block of patches, of the bits of their control points.
struct BorderHashJob {
  const float* net = nullptr;     ///< `[i][j][component][lane]`
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  std::uint32_t* hash = nullptr;  ///< `[side v = 0, u = 1, v = 1, u = 0][lane]`
};

/// Neighbouring samples of a row of a mesh's vertices that are evaluated together.
inline constexpr int mesh_tile = 8;

/// A border of a patch of a mesh, as the ring of border points runs.
struct MeshBorder {
  int rate = 0;
  /// Weights at k / rate, `[k / 8][order 0, 1][i][k % 8]`, those of order 0 bitwise symmetric (see BorderJob).
  const float* weights = nullptr;
  float scale = 1;                 ///< of the homogeneous control points; 1 for polynomial patches
  bool is_point = false;           ///< the whole border lies at `start`
  const float* start = nullptr;    ///< x y z; for borders that are points, and for rational patches
};

/// Vectors of neighbouring vertices: component c of vertex k goes to out[c][k * stride].
struct MeshRecords {
  float* out[3] = {nullptr, nullptr, nullptr};
  std::ptrdiff_t stride = 1;
};

/// Lines of 64 bytes, both ends aligned to that, on their way past the caches.
struct LineQueue {
  const float* from = nullptr;
  float* to = nullptr;
  std::size_t lines = 0;
};
inline constexpr int line_queues = 3;

/// The vertices of one patch: inner points at (iu / inner_u, iv / inner_v), v fastest, then the border points.
struct MeshVertexJob {
  /// Degrees, rationality, `doubt` and `noise` (sixteen times the patch's), and exact_normal, which is asked for vertex
  /// lane < 8 ? iu + lane : iv + lane - 8; a lane beyond the last vertex means nothing.
  GridJob<float> grid;
  const float* net = nullptr;        ///< `[i][j][component]`, block_lanes apart
  int inner_u = 1, inner_v = 1;      ///< both 1, or both at least 2
  /// Weights at the inner k / inner_u, k = 1 .., `[(k - 1) / 8][order 0, 1][i][(k - 1) % 8]`, an even number of eights.
  const float* u_weights = nullptr;
  const float* v_weights = nullptr;
  MeshBorder border[4];              ///< v = 0, u = 1, v = 1, u = 0
  MeshRecords position, normal;      ///< from the patch's first vertex on; normal.out[0] null: not wanted
  /// Others' lines, line_queues queues; so many are sent with each vector of vertices: stores to memory take place while the
  /// next vertices are computed. The kernel counts them off.
  LineQueue* queues = nullptr;
  int lines_a_vector = 0;
  int writable = 0;                  ///< records of them that may be written, whatever they then hold
};

/// A strip of triangles between a border and the inner points nearest to it: corner k is by codes[k] the
/// inner point of that number, the first of which is vertex `inner`, or with mesh_border_code the border point. Readable up
/// to a multiple of 16.
struct MeshStrip {
  const std::uint32_t* codes = nullptr;  ///< 64-byte aligned
  int count = 0;                 ///< codes, three a triangle
  std::uint32_t ring = 0;        ///< the vertex of the border's first point
  std::uint32_t inner = 0, inner_step = 0;  ///< modulo 2^32
};
inline constexpr std::uint32_t mesh_border_code = 0x80000000;

/// The triangles of one patch.
struct MeshIndexJob {
  MeshStrip strip[4];
  std::uint32_t ring = 0, ring_size = 0;      ///< border points: the vertex behind the last is the first
  std::uint32_t first = 0, row = 0;           ///< inner vertices: the first, and from one row to the next
  int cells_u = 0, cells_v = 0;               ///< between inner points
  std::uint32_t* out = nullptr;
  std::uint32_t* end = nullptr;               ///< of what may be written
};

/// Kernels return their unit's own ISA, which the report hands to the caller.
struct KernelTable {
  Isa isa;
  Isa (*grid_f32)(const GridJob<float>&);
  Isa (*grid_f64)(const GridJob<double>&);
  void (*border_f32)(const BorderJob<float>&);
  /// Patch-contiguous results: where those of each lane begin, in order the pieces, and what is left in the end.
  void (*begin_lines_f32)(LineState<float>& state, float* const* memory);
  void (*begin_lines_f64)(LineState<double>& state, double* const* memory);
  void (*put_lines_f32)(const LineJob<float>&);
  void (*put_lines_f64)(const LineJob<double>&);
  void (*end_lines_f32)(const LineState<float>& state, int lane_count, bool streaming);
  void (*end_lines_f64)(const LineState<double>& state, int lane_count, bool streaming);
  Isa (*blend_f32)(const BlendJob<float>&);
  Isa (*blend_f64)(const BlendJob<double>&);
  void (*pack_f32)(const PackJob<float>&);
  void (*pack_f64)(const PackJob<double>&);
  /// `nets` and `count` as in PackJob.
  void (*bound_nets)(const double* const* nets, std::size_t count, NetBoxes& boxes);
  /// Extends the bounds by points of `count` numbers, x y z x y z ..
  void (*bound_points)(const double* points, std::size_t count, PointBounds& bounds);
  void (*combine)(const CombineJob&);
  Isa (*points_f32)(PointJob<float>&);
  Isa (*points_f64)(PointJob<double>&);
  bool (*check_points_f32)(const PointCheckJob<float>&);
  bool (*check_points_f64)(const PointCheckJob<double>&);
  void (*locate)(const LocateJob&);
  void (*store_points_f32)(const PointStoreJob<float>&);
  void (*store_points_f64)(const PointStoreJob<double>&);
  void (*hash_borders)(const BorderHashJob&);
  void (*bound_chords)(const ChordJob&);
  void (*find_rates)(const RateJob&);
  void (*mesh_vertices)(const MeshVertexJob&);
  void (*mesh_indices)(const MeshIndexJob&);
  /// Copies lines of 64 bytes past the caches, both aligned to 64 bytes. finish_streaming() comes after the last.
  void (*stream_lines)(const void* from, void* to, std::size_t lines);
  /// For limits.h: `rounds` times 16 independent fused multiply-adds of whole vectors; returns the lanes of a vector.
  int (*fma_f32)(std::size_t rounds, float* sink);
  int (*fma_f64)(std::size_t rounds, double* sink);
  /// For limits.h: fills bytes (a multiple of 64, aligned to 64) with full-width stores.
  void (*fill)(void* memory, std::size_t bytes, bool streaming);
  /// Once a task has streamed, before its results are given to other threads. Not once a block: a fence waits for memory.
  void (*finish_streaming)();
};

// Each is defined in a build for its processor alone.
const KernelTable& sse2_kernels();
const KernelTable& avx2_kernels();
const KernelTable& avx512_kernels();
const KernelTable& neon64_kernels();

/// The kernels of every ISA that processor and operating system support, slowest first; at least one.
std::span<const KernelTable* const> machine_kernels();

/// Those of default_isa(), or the baseline's where TESSERA_ISA names none: for kernels that compute the same bits on all.
const KernelTable& default_kernels();

/// The kernels of an ISA. Call it only for one that available_isas() lists.
const KernelTable& kernels(Isa isa);

}  // namespace tessera::kernel
