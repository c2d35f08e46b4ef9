#pragma once
// Holds the kernel's job that writes the vertices of patches, with the memory that the job points to.

#include <algorithm>
#include <array>

#include "kernel/table/kernel_table.h"
#include "tess/cells/stitched_patch.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// The source of exact normals: a patch and its division.
struct ExactPatch {
  const BezierPatch* patch = nullptr;
  const Division* division = nullptr;
};

/// Computes an exact normal: see kernel::ExactNormal and MeshVertexJob::grid.
inline int exact_normal(void* context, int first, int second, int lane, float* normal) {
  const auto& exact = *static_cast<const ExactPatch*>(context);
  const auto vertex =
      static_cast<std::size_t>(lane < kernel::mesh_tile ? first + lane : second + lane - kernel::mesh_tile);
  const auto at = exact.division->parameters(std::min(vertex, exact.division->vertex_count() - 1));
  const UnitNormal found = unit_normal(*exact.patch, at.u, at.v);
  normal[0] = static_cast<float>(found.direction.x);
  normal[1] = static_cast<float>(found.direction.y);
  normal[2] = static_cast<float>(found.direction.z);
  return static_cast<int>(found.kind);
}

inline kernel::StreamState stream_from(float* memory) { return {.first = memory, .next = memory}; }

/// A job and the memory that it points to, used for one patch after the other.
struct VertexJob {
  kernel::MeshVertexJob job;
  std::array<kernel::StreamState, 2> lines;  ///< cache lines of positions and of normals
  alignas(cache_line) std::array<float, kernel::block_lanes> threshold, noise;
  std::array<std::array<float, 3>, 4> starts;
  ExactPatch exact;
  /// The points of a block's patches, patch by patch: see kernel::MeshKernels::mesh_points.
  static constexpr std::size_t no_block = static_cast<std::size_t>(-1);
  std::size_t points_block = no_block;
  alignas(cache_line) std::array<float, std::size_t{kernel::mesh_patch_points} * kernel::block_lanes> points;

  VertexJob() {
    job.grid.threshold = threshold.data();
    job.grid.noise = noise.data();
    job.grid.exact_normal = exact_normal;
    job.grid.exact_context = &exact;
  }
  VertexJob(const VertexJob&) = delete;
  VertexJob& operator=(const VertexJob&) = delete;

  /// Writes vertices past the caches from now on, beginning with this one of a mesh. Each patch must follow the one
  /// before it.
  void start_lines(const MeshViews& out, std::size_t vertex) {
    lines[0] = stream_from(out.position.component[0] + 3 * vertex);
    job.position.lines = &lines[0];
    if (out.normal.empty()) return;
    lines[1] = stream_from(out.normal.component[0] + 3 * vertex);
    job.normal.lines = &lines[1];
  }
  /// Writes lines that are not complete yet.
  void finish_lines(const kernel::KernelTable& kernels) {
    for (const kernel::MeshRecords* records : {&job.position, &job.normal})
      if (records->lines) kernels.finish_lines(*records->lines);
  }
};

inline bool is_packed(const View3<float>& view) {
  return view.stride == 3 && view.component[1] == view.component[0] + 1 && view.component[2] == view.component[0] + 2;
}

/// Sets records field by field, because a copy of a new record would wait for its stores.
inline void set_packed(kernel::MeshRecords& out, float* first) {
  for (int c = 0; c < 3; ++c) out.out[c] = first ? first + c : nullptr;
  out.stride = 3;
}
inline void set_records(kernel::MeshRecords& out, const View3<float>& view, std::size_t first) {
  for (int c = 0; c < 3; ++c) out.out[c] = view.empty() ? nullptr : &view.at(first, c);
  out.stride = view.stride;
}

}}  // namespace tessera::abi_0_1
