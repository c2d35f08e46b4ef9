// Writes patches of a mesh that shares vertices, or has quads.

#include <algorithm>

#include "tess/plan/ring_vertices.h"
#include "tess/write/patch_writer.h"
#include "tess/write/vertex_job.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The largest number of ring points that are evaluated at once. A border has no more.
constexpr std::size_t max_points = max_rate;

/// Restricts a job to a part of the division that it was prepared for.
void restrict_to(const Division& part, VertexJob& vertices) {
  vertices.exact.division = &part;
  vertices.job.inner_u = part.inner.u.rate();
  vertices.job.inner_v = part.inner.v.rate();
  for (std::size_t side = 0; side < 4; ++side) vertices.job.border[side].rate = part.border[side].rate();
}

}  // namespace

void PatchWriter::write_owned(std::size_t k, VertexJob& vertices) const {
  if (plan_.patches().has_f64_positions) return write_f64(k);
  const Division& division = plan_.division(k);
  Division part = division;
  if (division.has_inner_points()) {
    part.border = {};
    prepare(k, vertices);
    restrict_to(part, vertices);
    set_records(vertices.job.position, out_.position, plan_.first_vertex(k));
    set_records(vertices.job.normal, out_.normal, plan_.first_vertex(k));
    vertices.job.writable = static_cast<int>(std::min<std::size_t>(division.inner_count(), std::size_t{1} << 30));
    kernels_.mesh_vertices(vertices.job);
    part.border = division.border;
  }
  part.inner = {1, 1};
  if (division.ring_count() <= max_points) {
    write_ring(k, part, vertices);
  } else {
    for (std::size_t side = 0; side < 4; ++side) {
      part.border = {};
      part.border[side] = division.border[side];
      write_ring(k, part, vertices);
    }
  }
  if (plan_.is_f64(k)) write_f64(k);
}

void PatchWriter::write_ring(std::size_t k, const Division& part, VertexJob& vertices) const {
  alignas(cache_line) std::array<float, 3 * max_points> positions, normals;
  prepare(k, vertices);
  restrict_to(part, vertices);
  set_packed(vertices.job.position, positions.data());
  set_packed(vertices.job.normal, out_.normal.empty() ? nullptr : normals.data());
  vertices.job.writable = static_cast<int>(max_points);
  kernels_.mesh_vertices(vertices.job);
  std::size_t from = 0;
  for (std::uint32_t side = 0; side < 4; ++side) {
    const std::uint32_t border = static_cast<std::uint32_t>(4 * k) + side;
    const std::size_t count = part.border[side].rate();
    if (count == 0) continue;
    const auto put = [&](std::size_t n, std::size_t to) {
      for (int c = 0; c < 3; ++c) {
        out_.position.at(to, c) = positions[3 * (from + n) + static_cast<std::size_t>(c)];
        if (!out_.normal.empty()) out_.normal.at(to, c) = normals[3 * (from + n) + static_cast<std::size_t>(c)];
      }
    };
    if (plan_.owns_corner(border)) put(0, plan_.ring_vertex(border, 0));
    if (plan_.owns_border(border) && count > 1)
      for (std::size_t n = 1, to = plan_.ring_vertex(border, 1); n < count; ++n, ++to) put(n, to);
    from += count;
  }
}

void PatchWriter::share_indices(std::size_t k, std::uint32_t* indices) const {
  const Division& division = plan_.division(k);
  std::array<std::uint32_t, 4 * max_points> ring;
  std::size_t count = 0;
  for (std::uint32_t side = 0; side < 4; ++side) {
    const RingVertices vertices(plan_, static_cast<std::uint32_t>(4 * k) + side);
    for (int n = 0; n < vertices.rate(); ++n) ring[count++] = static_cast<std::uint32_t>(vertices(n));
  }
  const auto first = static_cast<std::uint32_t>(plan_.first_vertex(k) + division.inner_count());
  const std::size_t strips = division.triangle_count() - 2 * division.cell_count();
  for (std::size_t n = 0; n < 3 * strips; ++n)
    if (const std::uint32_t at = indices[n] - first; at < count) indices[n] = ring[at];
}

void PatchWriter::write_quads(std::size_t k) const {
  const std::size_t strip = plan_.first_strip(k);
  write_triangles(k, out_.indices.data() + 3 * strip, out_.indices.data() + 3 * plan_.first_strip(k + 1));
  const Division& division = plan_.division(k);
  const auto first = static_cast<std::uint32_t>(plan_.first_vertex(k)),
             row = static_cast<std::uint32_t>(division.inner.v.rate() - 1);
  std::uint32_t* to = out_.quads.data() + 4 * plan_.first_quad(k);
  for (int iu = 0; iu < division.inner.u.rate() - 2; ++iu)
    for (int iv = 0; iv < division.inner.v.rate() - 2; ++iv) {
      const std::uint32_t p00 = first + static_cast<std::uint32_t>(iu) * row + static_cast<std::uint32_t>(iv);
      *to++ = p00;
      *to++ = p00 + row;
      *to++ = p00 + row + 1;
      *to++ = p00 + 1;
    }
}

}}  // namespace tessera::abi_0_1
