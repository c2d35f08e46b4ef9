#pragma once
// The triangles of one patch of a mesh (tess/cells/stitched_patch.h), lanes = indices, written in whole vectors.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/mesh/mesh_kernels.h.

#include "kernel/store/line_sink.inl.h"
#include "kernel/isa/index_vector.inl.h"

template <class L>
[[gnu::always_inline]] inline Indices<L> load_indices(const std::uint32_t* from) {
  Indices<L> indices;
  __builtin_memcpy(&indices, from, sizeof indices);
  return indices;
}
/// Writes indices to memory in whole vectors; the part beyond the end of a piece is overwritten by the next piece.
template <class L>
class IndexRecords {
 public:
  explicit IndexRecords(const MeshIndexJob& job) : out_(job.out), end_(job.end) {}
  /// Puts the first `count` indices of a vector.
  [[gnu::always_inline]] void put(const Indices<L>& indices, int count) {
    if (end_ - out_ >= L::width) {
      __builtin_memcpy(out_, &indices, sizeof indices);
    } else {
      for (int l = 0; l < count; ++l) out_[l] = indices[l];
    }
    out_ += count;
  }
  void stop() const {}

 private:
  std::uint32_t *out_, *const end_;
};

/// Writes indices past the caches.
template <class L>
class IndexLines {
 public:
  explicit IndexLines(const MeshIndexJob& job) : job_(job), sink_(*job.lines) {}
  [[gnu::always_inline]] void put(const Indices<L>& indices, int count) {
    typename L::Batch bits;
    __builtin_memcpy(&bits, &indices, sizeof bits);
    if (count == L::width) {
      sink_.put(bits);
    } else {
      sink_.put(bits, count);
    }
  }
  void stop() const { sink_.stop(*job_.lines); }

 private:
  const MeshIndexJob& job_;
  LineSink<L, true> sink_;
};

/// Writes one strip by its template.
template <class L, class Sink>
[[gnu::always_inline]] inline void write_strip(const MeshIndexJob& job, const MeshStrip& strip, Sink& sink) {
  const std::uint32_t wrap = job.ring + job.ring_size;
  for (int k = 0; k < strip.count; k += L::width) {
    const Indices<L> code = load_indices<L>(strip.codes + k), at = code & (mesh_border_code - 1),
                     border = 0 - (code >> 31);
    Indices<L> index = ((strip.ring + at) & border) | ((strip.inner + at * strip.inner_step) & ~border);
    index -= reinterpret_cast<Indices<L>>(index == wrap) & job.ring_size;
    sink.put(index, strip.count - k < L::width ? strip.count - k : int{L::width});
  }
}

/// The corners of both triangles of neighbouring cells, in vertices along the row and in rows.
template <int Cells>
struct CellCorners {
  alignas(64) std::uint32_t along[6 * Cells]{}, across[6 * Cells]{};
  constexpr CellCorners() {
    constexpr std::uint32_t v[6] = {0, 0, 1, 0, 1, 1}, u[6] = {0, 1, 1, 0, 1, 0};
    for (std::uint32_t k = 0; k < 6 * Cells; ++k) along[k] = k / 6 + v[k % 6], across[k] = u[k % 6];
  }
};

/// Writes both triangles of the inner cells, row after row, eight cells at a time.
template <class L, class Sink>
[[gnu::always_inline]] inline void write_cells(const MeshIndexJob& job, Sink& sink) {
  constexpr int cells = 8, vectors = 6 * cells / L::width;
  static constexpr CellCorners<cells> corners;
  Indices<L> pattern[vectors];
  for (int k = 0; k < vectors; ++k)
    pattern[k] =
        load_indices<L>(corners.along + k * L::width) + job.row * load_indices<L>(corners.across + k * L::width);
  std::uint32_t first = job.first;
  for (int iu = 0; iu < job.cells_u; ++iu, first += job.row) {
    for (int left = 6 * job.cells_v, base = 0; left > 0; base += cells)
      for (int k = 0; k < vectors && left > 0; ++k, left -= L::width)
        sink.put(pattern[k] + (first + static_cast<std::uint32_t>(base)), left < L::width ? left : int{L::width});
  }
}

template <class L, class Sink>
void write_indices_to(const MeshIndexJob& job) {
  Sink sink(job);
  for (const MeshStrip& strip : job.strip) write_strip<L>(job, strip, sink);
  write_cells<L>(job, sink);
  sink.stop();
}

template <class L>
void write_mesh_indices(const MeshIndexJob& job) {
  if constexpr (has_lines<L>)
    if (job.lines) return write_indices_to<L, IndexLines<L>>(job);
  write_indices_to<L, IndexRecords<L>>(job);
}
