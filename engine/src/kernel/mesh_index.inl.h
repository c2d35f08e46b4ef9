// The triangles of one patch of a mesh (tess/stitched_patch.h), written in whole vectors. What runs over the end of a part is overwritten by the next. Included by the units as
// sample_kernel.inl.h is.

template <class L>
[[gnu::always_inline]] inline Indices<L> load_indices(const std::uint32_t* from) {
  Indices<L> indices;
  __builtin_memcpy(&indices, from, sizeof indices);
  return indices;
}
/// A vector of indices, or as much of it as fits.
template <class L>
[[gnu::always_inline]] inline void store_indices(std::uint32_t* out, const std::uint32_t* end,
                                                 const Indices<L>& indices) {
  if (end - out >= L::width) {
    __builtin_memcpy(out, &indices, sizeof indices);
  } else {
    for (int l = 0; out + l < end; ++l) out[l] = indices[l];
  }
}

/// One strip by its template.
template <class L>
std::uint32_t* write_strip(const MeshIndexJob& job, const MeshStrip& strip, std::uint32_t* out) {
  const std::uint32_t wrap = job.ring + job.ring_size;
  for (int k = 0; k < strip.count; k += L::width) {
    const Indices<L> code = load_indices<L>(strip.codes + k), at = code & (mesh_border_code - 1),
                     border = 0 - (code >> 31);
    Indices<L> index = ((strip.ring + at) & border) | ((strip.inner + at * strip.inner_step) & ~border);
    index -= reinterpret_cast<Indices<L>>(index == wrap) & job.ring_size;
    store_indices<L>(out + k, job.end, index);
  }
  return out + strip.count;
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

/// Both triangles of the inner cells, row after row, eight cells at a time.
template <class L>
std::uint32_t* write_cells(const MeshIndexJob& job, std::uint32_t* out) {
  constexpr int cells = 8, length = 6 * cells;
  static constexpr CellCorners<cells> corners;
  Indices<L> pattern[length / L::width];
  for (int k = 0; k < length / L::width; ++k)
    pattern[k] =
        load_indices<L>(corners.along + k * L::width) + job.row * load_indices<L>(corners.across + k * L::width);
  std::uint32_t first = job.first;
  for (int iu = 0; iu < job.cells_u; ++iu, first += job.row) {
    for (int iv = 0; iv < job.cells_v; iv += cells) {
      const std::uint32_t base = first + static_cast<std::uint32_t>(iv);
      std::uint32_t* const to = out + 6 * iv;
      if (job.end - to >= length) {
        for (int k = 0; k < length / L::width; ++k) store_indices<L>(to + k * L::width, to + length, pattern[k] + base);
      } else {
        for (int k = 0; k < length && to + k < job.end; k += L::width)
          store_indices<L>(to + k, job.end, pattern[k / L::width] + base);
      }
    }
    out += 6 * job.cells_v;
  }
  return out;
}

template <class L>
void write_mesh_indices(const MeshIndexJob& job) {
  std::uint32_t* out = job.out;
  for (const MeshStrip& strip : job.strip) out = write_strip<L>(job, strip, out);
  write_cells<L>(job, out);
}
