#pragma once
// The vertices of one polynomial bicubic patch of a mesh, on AVX-512, lanes = sixteen points of the inner grid, then of
// the ring, wherever rows and sides end. The sums and their order are those of mesh_kernel.inl.h, hence the bits too.
// Each point's inputs come by permutations from registers that hold the patch.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/mesh/mesh_kernels.h.

#include "kernel/mesh/mesh_kernel.inl.h"

/// Turns a block `[i][j][component][lane]` into its patches, `[lane][component][i][j]`, and prefetches the next block.
template <class L>
void write_mesh_points(const float* net, float* points) {
  for (int k = 0; k < mesh_patch_points; ++k) __builtin_prefetch(net + (mesh_patch_points + k) * block_lanes);
  for (int c = 0; c < 3; ++c) {
    typename L::Batch row[16];
    for (int k = 0; k < 16; ++k) row[k] = L::load(net + (k * 3 + c) * block_lanes);
    L::transpose(row);
    for (int lane = 0; lane < 16; ++lane) L::store(points + lane * mesh_patch_points + c * 16, row[lane]);
  }
}

template <class L, int Order>
class CubicVertices {
 public:
  explicit CubicVertices(const MeshVertexJob& job)
      : job_(job),
        positions_(job.position),
        normals_(job.normal),
        shared_(Order > 0 && share_records(job.position, job.normal)) {}

  void write() {
    if (job_.inner_u > 1) write_inner();
    write_ring();
    positions_.stop();
    if constexpr (Order > 0) normals_.stop();
  }

 private:
  using Batch = typename L::Batch;
  static constexpr int width = 16, rows_at_once = 8;

  /// Row curves of up to eight u: [order][component] holds coefficient j of a row at 4 row + j.
  using Curves = __m512[Order + 1][3][2];

  void write_inner() {
    const int rows = job_.inner_u - 1, columns = job_.inner_v - 1;
    const MeshCubicInner &along_u = *job_.cubic_u, &along_v = *job_.cubic_v;
    for (int first = 0; first < rows; first += rows_at_once) {
      Curves curves;
      const int chunk = rows - first < rows_at_once ? rows - first : rows_at_once, count = chunk * columns;
      fill_rows(along_u.rows + std::ptrdiff_t{first} * mesh_row_weights, chunk > 4, curves);
      int row = 0, column = 0;
      for (int k = 0; k < count; k += width) {
        Sample<L> sample;
        const __m512i place =
            _mm512_add_epi32(_mm512_loadu_si512(along_v.row_places + column), _mm512_set1_epi32(4 * row));
        inner_sample(curves, place, along_v.columns + column, along_v.stride, sample);
        put(sample, count - k < width ? count - k : width);
        for (column += width; column >= columns; column -= columns) ++row;
      }
    }
  }

  [[gnu::always_inline]] void fill_rows(const float* weights, bool both, Curves& curves) const {
    for (int group = 0; group < 2; ++group) {
      const float* const w = group == 1 && both ? weights + 4 * mesh_row_weights : weights;
      for (int c = 0; c < 3; ++c) {
        __m512 point[4];
        for (int i = 0; i < 4; ++i) point[i] = _mm512_broadcast_f32x4(_mm_load_ps(job_.points + 16 * c + 4 * i));
        for (int order = 0; order <= Order; ++order) {
          const float* const of_order = w + order * 4 * width;
          __m512 sum = _mm512_mul_ps(_mm512_load_ps(of_order), point[0]);
          for (int i = 1; i < 4; ++i) sum = _mm512_fmadd_ps(_mm512_load_ps(of_order + i * width), point[i], sum);
          curves[order][c][group] = sum;
        }
      }
    }
  }

  [[gnu::always_inline]] static void inner_sample(const Curves& curves, __m512i place, const float* weights,
                                                  std::ptrdiff_t stride, Sample<L>& sample) {
    for (int j = 0; j < 4; ++j) {
      const __m512i at = _mm512_add_epi32(place, _mm512_set1_epi32(j));
      const __m512 weight = _mm512_loadu_ps(weights + j * stride), slope = _mm512_loadu_ps(weights + (4 + j) * stride);
      for (int c = 0; c < 3; ++c) {
        const __m512 curve = _mm512_permutex2var_ps(curves[0][c][0], at, curves[0][c][1]);
        add(j, weight, curve, sample.position[c]);
        if constexpr (Order > 0) {
          add(j, slope, curve, sample.dv[c]);
          add(j, weight, _mm512_permutex2var_ps(curves[1][c][0], at, curves[1][c][1]), sample.du[c]);
        }
      }
    }
  }
  [[gnu::always_inline]] static void add(int term, __m512 weight, __m512 value, Batch& sum) {
    sum = term == 0 ? _mm512_mul_ps(weight, value) : _mm512_fmadd_ps(weight, value, sum);
  }

  void write_ring() {
    // Control points of the borders in the order of the ring, at 4 side + i: v = 0, u = 1, v = 1, u = 0; and those next
    // to them.
    alignas(64) static constexpr int on[16] = {0, 4, 8, 12, 12, 13, 14, 15, 15, 11, 7, 3, 3, 2, 1, 0};
    alignas(64) static constexpr int beside[16] = {1, 5, 9, 13, 8, 9, 10, 11, 14, 10, 6, 2, 7, 6, 5, 4};
    __m512 border[3], across[3];
    for (int c = 0; c < 3; ++c) {
      const __m512 points = _mm512_load_ps(job_.points + 16 * c);
      border[c] = _mm512_permutexvar_ps(_mm512_load_si512(on), points);
      across[c] = _mm512_sub_ps(_mm512_permutexvar_ps(_mm512_load_si512(beside), points), border[c]);
    }
    int start[5] = {0};
    for (int side = 0; side < 4; ++side) start[side + 1] = start[side] + job_.border[side].rate;
    for (int first = 0; first < start[4]; first += width) {
      Sample<L> sample;
      ring_sample(border, across, start, first, sample);
      put(sample, start[4] - first < width ? start[4] - first : width);
    }
  }

  [[gnu::always_inline]] void ring_sample(const __m512 (&border)[3], const __m512 (&across)[3], const int (&start)[5],
                                          int first, Sample<L>& sample) const {
    constexpr int kinds = Order > 0 ? 8 : 4;
    static constexpr float first_corner[8] = {1, 0, 0, 0, -3, 3, 0, 0};  // for lanes beyond the last point
    __m512 weight[kinds];
    for (int kind = 0; kind < kinds; ++kind) weight[kind] = _mm512_set1_ps(first_corner[kind]);
    __m512i place = _mm512_setzero_si512();
    for (int side = 0; side < 4; ++side) {
      const MeshCubicBorder& lanes = *job_.border[side].cubic;
      const int begin = within(start[side] - first, 0), end = within(start[side + 1] - first, 0);
      if (begin == end) continue;
      const auto mask = static_cast<__mmask16>((1u << end) - (1u << begin));
      const float* from = lanes.weights + width + (first - start[side]);
      place = _mm512_mask_mov_epi32(place, mask, _mm512_set1_epi32(4 * side));
      for (int kind = 0; kind < kinds; ++kind)
        weight[kind] = _mm512_mask_loadu_ps(weight[kind], mask, from + kind * lanes.stride);
    }
    __m512i at[4];
    for (int i = 0; i < 4; ++i) at[i] = _mm512_add_epi32(place, _mm512_set1_epi32(i));
    for (int c = 0; c < 3; ++c) {
      __m512 term[4], along = _mm512_setzero_ps(), inwards = _mm512_setzero_ps();
      for (int i = 0; i < 4; ++i) {
        const __m512 point = _mm512_permutexvar_ps(at[i], border[c]);
        term[i] = _mm512_mul_ps(weight[i], point);
        if constexpr (Order > 0) {
          along = _mm512_fmadd_ps(weight[4 + i], point, along);
          inwards = _mm512_fmadd_ps(weight[i], _mm512_permutexvar_ps(at[i], across[c]), inwards);
        }
      }
      sample.position[c] = _mm512_add_ps(_mm512_add_ps(term[0], term[3]), _mm512_add_ps(term[1], term[2]));
      if constexpr (Order > 0) {
        sample.du[c] = along;
        sample.dv[c] = _mm512_mul_ps(inwards, _mm512_set1_ps(3));
      }
    }
  }
  static int within(int lane, int least) { return lane < least ? least : lane > width ? width : lane; }

  /// Writes the next `count` vertices.
  [[gnu::always_inline]] void put(const Sample<L>& sample, int count) {
    const int writable = vertex_ + width <= job_.writable ? width : count;
    Batch p[3];
    copy<L>(sample.position, p);
    if (!shared_) positions_.put(vertex_, p, count, writable);
    if constexpr (Order > 0) {
      Normal<L> normal;
      unit_normal<L, false>(job_.grid, sample, {vertex_, vertex_ + mesh_tile, 0}, normal);
      if (shared_) {
        put_shared<L>(job_.position, vertex_, sample.position, normal.direction, count);
      } else {
        normals_.put(vertex_, normal.direction, count, writable);
      }
    }
    vertex_ += count;
  }

  const MeshVertexJob& job_;
  RecordSink<L> positions_, normals_;
  const bool shared_;  ///< see share_records()
  int vertex_ = 0;
};
