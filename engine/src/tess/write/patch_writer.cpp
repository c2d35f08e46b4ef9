#include "tess/write/patch_writer.h"

#include <algorithm>
#include <limits>

#include "eval/streaming_threshold.h"
#include "kernel/table/kernel_table.h"
#include "tess/cells/f64_points.h"
#include "tess/write/vertex_job.h"
#include "tess/write/vertex_views.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns a side's first control point as packed. It is not computed as w p / w, which would depend on the weight.
std::array<float, 3> start_of(const BezierPatch& net, const Vec3& origin, Side side) {
  const bool end_u = side == Side::u1 || side == Side::v1, end_v = side == Side::v1 || side == Side::u0;
  const Vec3 p = net.point(end_u ? net.degree_u() : 0, end_v ? net.degree_v() : 0) - origin + Vec3{};
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Kernels write indices past the caches as if they were floats.
kernel::StreamState lines_from(std::uint32_t* index) { return stream_from(reinterpret_cast<float*>(index)); }

}  // namespace

PatchWriter::PatchWriter(const PatchSet::Impl& set, const CertifiedPlan& plan, const MeshTables& tables,
                         const kernel::KernelTable& kernels, const ParameterMaps& maps, const MeshViews& out,
                         Stores stores, std::optional<std::size_t> bytes)
    : set_(set), plan_(plan), tables_(tables), kernels_(kernels), maps_(maps), out_(out) {
  const MeshCapacity size = plan.capacity();
  if (!bytes)
    bytes = sizeof(float) * size.vertices * (out.normal.empty() ? 3 : 6) + 3 * sizeof(std::uint32_t) * size.triangles;
  const bool large = stores == Stores::streaming || (stores == Stores::automatic && *bytes > streaming_threshold());
  streaming_ = large && kernels.finish_lines && !plan.shares_vertices() && plan.patches().rare->f64_patches.empty() &&
               plan.cuts().empty() && !plan.closed() && out.quads.empty() && is_packed(out.position) &&
               (out.normal.empty() || is_packed(out.normal));
}

void PatchWriter::write(std::size_t begin, std::size_t end) const {
  VertexJob vertices;
  std::optional<kernel::StreamState> lines;  // cache lines of indices
  if (streaming_) {
    vertices.start_lines(out_, plan_.first_vertex(begin));
    lines = lines_from(out_.indices.data() + 3 * plan_.first_triangle(begin));
  }
  for (std::size_t k = begin; k < end; ++k) {
    if (plan_.division(k).empty) continue;
    if (plan_.shares_vertices()) {
      write_owned(k, vertices);
    } else {
      write_vertices(k, plan_.first_vertex(end), vertices);
    }
    if (out_.quads.empty()) {
      write_triangles(k, out_.indices.data() + 3 * plan_.first_triangle(k),
                      out_.indices.data() + 3 * plan_.first_triangle(end), lines ? &*lines : nullptr);
    } else {
      write_quads(k);
    }
    if (!out_.parameter.empty()) write_parameters(k);
    write_patch_numbers(k);
  }
  if (!streaming_) return;
  vertices.finish_lines(kernels_);
  kernels_.finish_lines(*lines);
  kernels_.finish_streaming();
}

void PatchWriter::write_vertices(std::size_t k, std::size_t end, VertexJob& vertices) const {
  if (plan_.patches().has_f64_positions) return write_f64(k);
  prepare(k, vertices);
  const std::size_t first = plan_.first_vertex(k);
  set_records(vertices.job.position, out_.position, first);
  set_records(vertices.job.normal, out_.normal, first);
  vertices.job.writable = static_cast<int>(std::min<std::size_t>(end - first, std::numeric_limits<int>::max()));
  kernels_.mesh_vertices(vertices.job);
  if (plan_.is_f64(k)) write_f64(k);
}

void PatchWriter::write_f64(std::size_t k) const {
  const BezierPatch& patch = set_.patches[k];
  const F64Points points(patch, set_.origin);
  const Division& division = plan_.division(k);
  const bool normals = plan_.patches().has_f64_positions && !out_.normal.empty();
  std::size_t vertex = plan_.first_vertex(k), place = 0;  // numbers in the mesh, and among all vertices of the division
  const auto put = [&](const Vec3& p) {
    if (!out_.position.empty()) put_vector(out_.position, vertex, p);
    if (!out_.model_position.empty()) put_vector(out_.model_position, vertex, set_.origin + p);
    if (normals)
      put_vector(out_.normal, vertex,
                 unit_normal(patch, division.parameters(place).u, division.parameters(place).v).direction);
    ++vertex;
  };
  points.for_inner(division, [&](const Vec3& p) {
    put(p);
    ++place;
  });
  for (const Side side : all_sides) {
    const std::uint32_t border = static_cast<std::uint32_t>(4 * k) + static_cast<std::uint32_t>(side);
    points.for_border(division, side, [&](int n, const Vec3& p) {
      if (n == 0 ? plan_.owns_corner(border) : plan_.owns_border(border)) put(p);
      ++place;
    });
  }
}

void PatchWriter::write_patch_numbers(std::size_t k) const {
  const auto fill = [k](std::span<std::uint32_t> numbers, std::size_t begin, std::size_t end) {
    if (!numbers.empty()) std::fill(numbers.data() + begin, numbers.data() + end, static_cast<std::uint32_t>(k));
  };
  if (out_.quads.empty()) return fill(out_.patch, plan_.first_triangle(k), plan_.first_triangle(k + 1));
  fill(out_.patch, plan_.first_strip(k), plan_.first_strip(k + 1));
  fill(out_.quad_patch, plan_.first_quad(k), plan_.first_quad(k + 1));
}

void PatchWriter::prepare(std::size_t k, VertexJob& vertices) const {
  const Division& division = plan_.division(k);
  const PatchSet::Slot slot = set_.slots[k];
  const BlockGroup& group = set_.group_of_block(slot.block);
  kernel::MeshVertexJob& job = vertices.job;
  job.net =
      set_.f32.bernstein.data() + group.first_value + (slot.block - group.first_block) * group.block_values + slot.lane;
  job.grid.degree_u = group.degree_u;
  job.grid.degree_v = group.degree_v;
  job.grid.rational = group.rational;
  const float* thresholds =
      set_.f32.bernstein_threshold.data() + 2 * std::size_t{PatchSet::lanes} * slot.block + slot.lane;
  std::fill(vertices.threshold.begin(), vertices.threshold.end(), thresholds[0]);
  std::fill(vertices.noise.begin(), vertices.noise.end(), thresholds[PatchSet::lanes]);
  vertices.exact = {&set_.patches[k], &division};
  job.inner_u = division.inner.u.rate();
  job.inner_v = division.inner.v.rate();
  for (std::size_t side = 0; side < 4; ++side) job.border[side].rate = division.border[side].rate();
  if (kernels_.mesh_points && MeshTables::takes_points(group, division)) {
    prepare_points(slot, job.net - slot.lane, division, vertices);
  } else {
    job.points = nullptr;
    prepare_weights(k, group, division, vertices);
  }
}

void PatchWriter::prepare_points(const PatchSet::Slot& slot, const float* net, const Division& division,
                                 VertexJob& vertices) const {
  kernel::MeshVertexJob& job = vertices.job;
  if (vertices.points_block != slot.block) {
    kernels_.mesh_points(net, vertices.points.data());
    vertices.points_block = slot.block;
  }
  job.points = vertices.points.data() + std::size_t{kernel::mesh_patch_points} * slot.lane;
  if (division.has_inner_points()) {
    job.cubic_u = tables_.cubic_inner(division.inner.u);
    job.cubic_v = tables_.cubic_inner(division.inner.v);
  }
  for (const Side side : all_sides)
    job.border[static_cast<std::size_t>(side)].cubic = tables_.cubic_border(division.along_ring(side));
}

void PatchWriter::prepare_weights(std::size_t k, const BlockGroup& group, const Division& division,
                                  VertexJob& vertices) const {
  kernel::MeshVertexJob& job = vertices.job;
  if (division.has_inner_points()) {
    job.u_weights = tables_.inner_weights(group.degree_u, division.inner.u);
    job.v_weights = tables_.inner_weights(group.degree_v, division.inner.v);
  }
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    kernel::MeshBorder& border = job.border[s];
    border.weights = tables_.border_weights(degree_along(side, group), division.along_ring(side));
    border.is_point = division.collapsed.has(side);
    if (!border.is_point && !group.rational) continue;  // other borders use neither start nor scale
    vertices.starts[s] = start_of(set_.patches[k], set_.origin, side);
    border.start = vertices.starts[s].data();
    border.scale = group.rational ? PackedBorder(set_, k, side).scale() : 1;
  }
}

void PatchWriter::write_parameters(std::size_t k) const {
  const Division& division = plan_.division(k);
  std::size_t vertex = plan_.first_vertex(k);
  const auto write = [&](auto put_at) {
    const auto put = [&](float u, float v) { put_at(vertex++, u, v); };
    const float *inner_u = tables_.parameters(division.inner.u), *inner_v = tables_.parameters(division.inner.v);
    for (int iu = 1; iu < division.inner.u.rate(); ++iu)
      for (int iv = 1; iv < division.inner.v.rate(); ++iv) put(inner_u[iu], inner_v[iv]);
    for (const Side side : all_sides) {
      const auto s = static_cast<std::size_t>(side);
      const float* along = tables_.parameters(division.border[s]);
      const int rate = division.border[s].rate(), last = plan_.owns_border(4 * k + s) ? rate : 1;
      for (int n = plan_.owns_corner(4 * k + s) ? 0 : 1; n < last; ++n) {
        const float t = along[is_backward(side) ? rate - n : n];
        const float across = is_far(side);
        runs_along_u(side) ? put(t, across) : put(across, t);
      }
    }
  };
  maps_.of(k).with_put(out_.parameter, write);
}

void PatchWriter::write_triangles(std::size_t k, std::uint32_t* out, std::uint32_t* end,
                                  kernel::StreamState* lines) const {
  const Division& division = plan_.division(k);
  const auto first = static_cast<std::uint32_t>(plan_.first_vertex(k));
  const bool cells = out_.quads.empty();
  if (!division.has_inner_points()) {
    if (lines) kernels_.finish_lines(*lines);
    std::uint32_t* const last = division.write_triangles(first, out, cells);
    if (lines) *lines = lines_from(last);
    if (plan_.shares_vertices()) share_indices(k, out);
    return;
  }
  const auto number = [](auto n) { return static_cast<std::uint32_t>(n); };
  const std::uint32_t row = number(division.inner.v.rate() - 1), last_row = number(division.inner.u.rate() - 2) * row;
  kernel::MeshIndexJob job;
  job.ring = first + number(division.inner_count());
  job.ring_size = number(division.ring_count());
  job.first = first;
  job.row = row;
  job.cells_u = cells ? division.inner.u.rate() - 2 : 0;
  job.cells_v = division.inner.v.rate() - 2;
  job.out = out;
  job.end = end;
  job.lines = lines;
  const std::uint32_t start[4] = {0, last_row, last_row + row - 1, row - 1}, step[4] = {row, 1, 0 - row, 0 - 1u};
  std::uint32_t ring = job.ring;
  for (const Side side : all_sides) {
    const auto s = static_cast<std::size_t>(side);
    const MeshTables::Strip strip =
        tables_.strip(division.along_ring(side), division.inner_along_ring(side), division.collapsed.has(side));
    job.strip[s] = {strip.codes, strip.count, ring, first + start[s], step[s]};
    ring += number(division.border[s].rate());
  }
  kernels_.mesh_indices(job);
  if (plan_.shares_vertices()) share_indices(k, out);
}

}}  // namespace tessera::abi_0_1
