#pragma once
// The vertices of one patch of a mesh: an inner grid, then the ring of its border points (tess/cells/stitched_patch.h).
// Lanes are samples of the patch, in tiles of eight neighbours; an AVX-512 vector holds two tiles, each of a row of its
// own.
//
// Inner points: first the row curves of sixteen u at once, q = sum_i f_i(u) row_i with lanes = u, then along each the
// points, sum_j g_j(v) q_j with lanes = v. The sums and their order are those of a grid (grid_kernel.inl.h).
//
// Border points: the sum of border_kernel.inl.h, whose bits are those of every patch that has the border. Their normals
// come from the border's own tangent and the one across it, degree (second row - first row), which points inwards: the
// ring runs counter-clockwise, so along x inwards is r_u x r_v on every side. Where the border is a point its own
// tangent is zero; r_u then tends to the tangent of the row next to it, relative to the point.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/mesh/mesh_kernels.h.

#include "kernel/store/line_sink.inl.h"
#include "kernel/sample/normal_kernel.inl.h"
#include "kernel/sample/symmetric_sum.inl.h"

/// Returns one number per tile in the tile's lanes.
template <class L>
[[gnu::always_inline]] inline typename L::Batch in_tiles(const float* a, const float* b) {
  if constexpr (L::width == 2 * mesh_tile) {
    return L::broadcast_halves(a, b);
  } else {
    return L::broadcast(*a);
  }
}
/// Loads the lanes of tiles from `lane` on.
template <class L>
[[gnu::always_inline]] inline typename L::Batch load_tiles(const float* a, const float* b, int lane) {
  if constexpr (L::width == 2 * mesh_tile) {
    return L::load_halves(a, b);
  } else {
    return L::load(a + lane);
  }
}
template <class L>
[[gnu::always_inline]] inline void store_tiles(float* a, float* b, int lane, const typename L::Batch& x) {
  if constexpr (L::width == 2 * mesh_tile) {
    L::store_halves(a, b, x);
  } else {
    x.store_unaligned(a + lane);
  }
}

/// Up to eight neighbouring inner points of a row.
struct InnerTile {
  const float* row;      ///< first coefficient of the row
  const float* weights;  ///< `[order][i][mesh_tile]`
  int at;                ///< place of the first point in the stage
};
/// Up to eight neighbouring points of a border.
struct BorderTile {
  const float* first;            ///< first control point
  std::ptrdiff_t step, inwards;  ///< to the next control point, and to that of the second row
  const float* weights;
  int at, count;
  const MeshBorder* border;
  bool starts;       ///< the tile has the border's first point
  bool leaves_pole;  ///< that point is also the last of a border that is a point
};
/// Indexed by whether a tile leaves a pole: 1 in the lane of the point that does.
constexpr float pole_lanes[2][mesh_tile] = {{}, {1}};

inline bool is_packed(const MeshRecords& out) {
  return out.stride == 3 && out.out[1] == out.out[0] + 1 && out.out[2] == out.out[0] + 2;
}

/// Writes records of three that follow each other or have places of their own.
template <class L>
class RecordSink {
 public:
  explicit RecordSink(const MeshRecords& out) : out_(out), sink_(start(out)) {}
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;

  /// Puts the first `count` records of a vector from `record` on. The memory of `writable` records may be overwritten.
  [[gnu::always_inline]] void put(int record, typename L::Batch (&p)[3], int count, int writable) {
    if constexpr (has_lines<L>)
      if (out_.lines) return put_to_lines(p, count);
    if (is_packed(out_)) {
      store_records<L, Records::packed>(out_, record, p, writable);
    } else if (out_.stride == 1) {
      store_records<L, Records::arrays>(out_, record, p, writable);
    } else {
      store_records<L, Records::strided>(out_, record, p, count);
    }
  }
  void stop() const {
    if constexpr (has_lines<L>)
      if (out_.lines) sink_.stop(*out_.lines);
  }

 private:
  struct None {};
  static auto start(const MeshRecords& out) {
    if constexpr (has_lines<L>) {
      return out.lines ? LineSink<L, true>(*out.lines) : LineSink<L, true>(nullptr);
    } else {
      return None();
    }
  }

  [[gnu::always_inline]] void put_to_lines(typename L::Batch (&p)[3], int count) {
    L::interleave(p);
    if (count == L::width) {
      for (int k = 0; k < 3; ++k) sink_.put(p[k]);
    } else {
      for (int k = 0, left = 3 * count; left > 0; ++k, left -= L::width)
        sink_.put(p[k], left < L::width ? left : int{L::width});
    }
  }

  const MeshRecords& out_;
  std::conditional_t<has_lines<L>, LineSink<L, true>, None> sink_;
};

/// Whether positions and normals begin common records of a larger stride, as vertices with uv at their end do.
inline bool share_records(const MeshRecords& position, const MeshRecords& normal) {
  const auto follows = [&](const float* value, int place) { return value == position.out[0] + place; };
  return position.stride > 6 && normal.stride == position.stride && follows(position.out[1], 1) &&
         follows(position.out[2], 2) && follows(normal.out[0], 3) && follows(normal.out[1], 4) &&
         follows(normal.out[2], 5);
}

/// Writes the first `count` lanes to such records, from a record on.
template <class L>
[[gnu::always_inline]] inline void put_shared(const MeshRecords& out, int record,
                                              const typename L::Batch (&position)[3],
                                              const typename L::Batch (&normal)[3], int count) {
  float unused[6], *to[L::width];
  for (int l = 0; l < L::width; ++l) to[l] = l < count ? out.out[0] + (record + l) * out.stride : unused;
  store_sixes<L>(position, normal, to, 0);
}

template <class L, int Degree, bool Rational, int Order>
class PatchVertices {
 public:
  explicit PatchVertices(const MeshVertexJob& job)
      : job_(job),
        count_u_(Degree > 0 ? Degree + 1 : job.grid.degree_u + 1),
        count_v_(Degree > 0 ? Degree + 1 : job.grid.degree_v + 1) {}
  PatchVertices(const PatchVertices&) = delete;
  PatchVertices& operator=(const PatchVertices&) = delete;

  void write() {
    if (job_.inner_u > 1) write_inner();
    write_ring();
    flush();
  }

 private:
  using Batch = typename L::Batch;
  static constexpr int components = Rational ? 4 : 3, capacity = capacity_of<Degree>, rows_at_once = 16;
  static constexpr int tiles_per_vector = L::width > mesh_tile ? L::width / mesh_tile : 1;
  static constexpr int staged = 1024;
  static constexpr int outputs = Order > 0 ? 6 : 3;

  int count_u() const { return Degree > 0 ? Degree + 1 : count_u_; }
  int count_v() const { return Degree > 0 ? Degree + 1 : count_v_; }

  void write_inner() {
    const int rows = job_.inner_u - 1, columns = job_.inner_v - 1;
    const std::ptrdiff_t tile_values = std::ptrdiff_t{2} * count_v() * mesh_tile;
    for (int first = 0; first < rows; first += rows_at_once) {
      fill_rows(first);
      const int last = rows - first < rows_at_once ? rows - first : rows_at_once;
      int row = 0, column = 0;
      const auto next = [&] {
        const InnerTile tile{rows_ + row, job_.v_weights + column / mesh_tile * tile_values, staged_};
        staged_ += columns - column < mesh_tile ? columns - column : mesh_tile;
        column += mesh_tile;
        if (column >= columns) column = 0, ++row;
        return tile;
      };
      while (row < last) {
        if (staged_ + tiles_per_vector * mesh_tile > staged) flush();
        const InnerTile a = next();
        write_tiles(a, tiles_per_vector > 1 && row < last ? next() : a);
      }
    }
  }

  /// Computes the row curves of sixteen u: rows_[order][component][j][row].
  void fill_rows(int first) {
    const int terms_u = count_u(), terms_v = count_v();
    const std::ptrdiff_t tile_values = std::ptrdiff_t{2} * terms_u * mesh_tile;
    const std::ptrdiff_t row_values = std::ptrdiff_t{terms_v} * components * block_lanes;
    const float* weights = job_.u_weights + first / mesh_tile * tile_values;
    for (int lane = 0; lane < rows_at_once; lane += L::width)
      for (int order = 0; order <= Order; ++order) {
        const float* a = weights + lane / mesh_tile * tile_values + order * terms_u * mesh_tile;
        Batch weight[capacity];
        for (int i = 0; i < terms_u; ++i)
          weight[i] = load_tiles<L>(a + i * mesh_tile, a + tile_values + i * mesh_tile, lane % mesh_tile);
        float* row = rows_ + order * components * terms_v * rows_at_once + lane;
        for (int j = 0; j < terms_v; ++j)
          for (int c = 0; c < components; ++c) {
            const float* net = job_.net + (j * components + c) * block_lanes;
            Batch sum = weight[0] * L::broadcast(*net);
#pragma GCC unroll 4
            for (int i = 1; i < terms_u; ++i) sum = L::fma(weight[i], L::broadcast(net[i * row_values]), sum);
            L::store(row + (c * terms_v + j) * rows_at_once, sum);
          }
      }
  }

  void write_ring() {
    const std::ptrdiff_t point = std::ptrdiff_t{components} * block_lanes, row = count_v() * point;
    const std::ptrdiff_t last_u = (count_u() - 1) * row, last_v = (count_v() - 1) * point;
    const std::ptrdiff_t first[4] = {0, last_u, last_u + last_v, last_v};
    const std::ptrdiff_t step[4] = {row, point, -row, -point}, inwards[4] = {point, -row, -point, row};
    int side = 0, k = 0;
    const auto next = [&] {
      const MeshBorder& border = job_.border[side];
      const int count = border.rate - k < mesh_tile ? border.rate - k : mesh_tile,
                terms = side % 2 == 0 ? count_u() : count_v();
      const BorderTile tile{job_.net + first[side],
                            step[side],
                            inwards[side],
                            border.weights + std::ptrdiff_t{2} * k * terms,
                            staged_,
                            count,
                            &border,
                            k == 0,
                            k == 0 && !border.is_point && job_.border[(side + 3) % 4].is_point};
      staged_ += count;
      k += mesh_tile;
      if (k >= border.rate) k = 0, ++side;
      return tile;
    };
    while (side < 4) {
      if (staged_ + tiles_per_vector * mesh_tile > staged) flush();
      const int terms = side % 2 == 0 ? count_u() : count_v();
      const BorderTile a = next();
      const bool pairs = tiles_per_vector > 1 && side < 4 && (side % 2 == 0 ? count_u() : count_v()) == terms;
      write_tiles(a, pairs ? next() : a, terms);
    }
  }

  [[gnu::noinline]] void write_tiles(const InnerTile& a, const InnerTile& b) {
    for (int lane = 0; lane < mesh_tile; lane += L::width) {
      Sample<L> sample;
      inner_sample(a, b, lane, count_v(), sample);
      stage(sample, a.at, b.at, lane);
    }
  }
  [[gnu::noinline]] void write_tiles(const BorderTile& a, const BorderTile& b, int terms) {
    for (int lane = 0; lane < mesh_tile; lane += L::width) {
      Sample<L> sample;
      border_sample(a, b, lane, terms, sample);
      stage(sample, a.at, b.at, lane);
    }
    if (needs_fix(a)) fix(a);
    if (needs_fix(b)) fix(b);
  }
  [[gnu::always_inline]] void stage(const Sample<L>& sample, int a, int b, int lane) {
    for (int c = 0; c < 3; ++c) store_tiles<L>(stage_[c] + a, stage_[c] + b, lane, sample.position[c]);
    if constexpr (Order > 0) {
      Normal<L> normal;
      unit_normal<L, Rational>(job_.grid, sample, {vertex_ + a, vertex_ + b, lane}, normal);
      for (int c = 0; c < 3; ++c) store_tiles<L>(stage_[3 + c] + a, stage_[3 + c] + b, lane, normal.direction[c]);
    }
  }
  static bool needs_fix(const BorderTile& tile) { return tile.border->is_point || (Rational && tile.starts); }
  /// Replaces positions that are no sums.
  [[gnu::noinline]] void fix(const BorderTile& tile) {
    for (int k = 0; k < (tile.border->is_point ? tile.count : 1); ++k)
      for (int c = 0; c < 3; ++c) stage_[c][tile.at + k] = tile.border->start[c];
  }

  [[gnu::always_inline]] void inner_sample(const InnerTile& a, const InnerTile& b, int lane, int terms,
                                           Sample<L>& sample) {
    const int count = Degree > 0 ? Degree + 1 : terms;
    RowCurves<L, Order, components, capacity> curves;
    Batch weights[2 * capacity];
    for (int order = 0; order <= Order; ++order)
      for (int j = 0; j < count; ++j) {
        const int k = (order * count + j) * mesh_tile;
        weights[order * count + j] = load_tiles<L>(a.weights + k, b.weights + k, lane);
        for (int c = 0; c < components; ++c) {
          const int value = ((order * components + c) * count + j) * rows_at_once;
          curves.by_u[order][c][j] = in_tiles<L>(a.row + value, b.row + value);
        }
      }
    evaluate_sample<L, Order>(curves, weights, count, sample);
  }

  [[gnu::always_inline]] void border_sample(const BorderTile& a, const BorderTile& b, int lane, int terms,
                                            Sample<L>& sample) {
    const int count = Degree > 0 ? Degree + 1 : terms;
    const int degree = count - 1, degree_across = (count_u() == count ? count_v() : count_u()) - 1;
    const Batch scale = in_tiles<L>(&a.border->scale, &b.border->scale);
    const float poles[2] = {a.border->is_point ? 1.0f : 0.0f, b.border->is_point ? 1.0f : 0.0f};
    const auto at_pole = in_tiles<L>(&poles[0], &poles[1]) > L::broadcast(0),
               leaves_pole =
                   load_tiles<L>(pole_lanes[a.leaves_pole], pole_lanes[b.leaves_pole], lane) > L::broadcast(0);
    Batch terms_of[components][capacity], p[components], along[components], inwards[components];
    for (int c = 0; c < components; ++c) along[c] = inwards[c] = L::broadcast(0);
    for (int i = 0; i < count; ++i) {
      const int k = i * mesh_tile, derivative = (count + i) * mesh_tile;
      const Batch weight = load_tiles<L>(a.weights + k, b.weights + k, lane);
      const float *at_a = a.first + i * a.step, *at_b = b.first + i * b.step;
      // A derivative that vanishes at a pole is replaced by its own derivative along the border, which does not.
      for (int c = 0; c < components; ++c) {
        Batch point = in_tiles<L>(at_a + c * block_lanes, at_b + c * block_lanes);
        if constexpr (Rational) point = point * scale;
        terms_of[c][i] = weight * point;
        if constexpr (Order > 0) {
          Batch across = in_tiles<L>(at_a + a.inwards + c * block_lanes, at_b + b.inwards + c * block_lanes);
          if constexpr (Rational) across = across * scale;
          across = across - point;
          const Batch slope = load_tiles<L>(a.weights + derivative, b.weights + derivative, lane);
          along[c] = L::fma(slope, xsimd::select(at_pole, across, point), along[c]);
          inwards[c] = L::fma(xsimd::select(leaves_pole, slope, weight), across, inwards[c]);
        }
      }
    }
    for (int c = 0; c < components; ++c) {
      p[c] = symmetric(terms_of[c], degree);
      if constexpr (Order > 0) inwards[c] = inwards[c] * L::broadcast(static_cast<float>(degree_across));
    }
    if constexpr (Rational) {
      const Batch q = L::broadcast(1) / p[3];
      sample.reciprocal_weight = q;
      for (int c = 0; c < 3; ++c) sample.position[c] = p[c] * q;
      if constexpr (Order > 0) {
        divide_first<L>(along, q, sample.position, sample.du);
        divide_first<L>(inwards, q, sample.position, sample.dv);
      }
    } else {
      copy<L>(p, sample.position);
      if constexpr (Order > 0) copy<L>(along, sample.du), copy<L>(inwards, sample.dv);
    }
  }

  /// Adds the products in the order of symmetric_sum().
  [[gnu::always_inline]] static Batch symmetric(const Batch* term, int degree) {
    Batch sum = term[0] + term[degree];
    for (int i = 1; 2 * i < degree; ++i) sum = sum + (term[i] + term[degree - i]);
    if (degree % 2 == 0) sum = sum + term[degree / 2];
    return sum;
  }

  /// Writes the stage to the caller's records.
  void flush() {
    if (Order > 0 && share_records(job_.position, job_.normal)) {
      write_shared();
    } else {
      write_records(job_.position, stage_);
      if constexpr (Order > 0) write_records(job_.normal, stage_ + 3);
    }
    vertex_ += staged_;
    staged_ = 0;
  }

  /// Packed vectors may run over the end into records that the same thread writes later.
  void write_records(const MeshRecords& out, const float (*stage)[staged + rows_at_once]) const {
    RecordSink<L> sink(out);
    for (int k = 0; k < staged_; k += L::width) {
      Batch p[3];
      for (int c = 0; c < 3; ++c) p[c] = Batch::load_unaligned(stage[c] + k);
      const int count = staged_ - k < L::width ? staged_ - k : int{L::width};
      sink.put(vertex_ + k, p, count, vertex_ + k + L::width <= job_.writable ? int{L::width} : count);
    }
    sink.stop();
  }

  [[gnu::noinline, gnu::cold]] void write_shared() const {
    for (int k = 0; k < staged_; k += L::width) {
      Batch value[2][3];
      for (int c = 0; c < outputs; ++c) value[c / 3][c % 3] = Batch::load_unaligned(stage_[c] + k);
      put_shared<L>(job_.position, vertex_ + k, value[0], value[1],
                    staged_ - k < L::width ? staged_ - k : int{L::width});
    }
  }

  const MeshVertexJob& job_;
  const int count_u_, count_v_;
  int vertex_ = 0, staged_ = 0;  // vertices: written, staged
  alignas(64) float rows_[(Order + 1) * components * capacity * rows_at_once];
  alignas(64) float stage_[outputs][staged + rows_at_once];
};
