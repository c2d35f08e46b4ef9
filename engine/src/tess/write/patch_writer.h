#pragma once
// Writes patches of a certified mesh from their packed control points into the caller's memory.

#include <optional>

#include "block/patch_set_impl.h"
#include "tess/cells/parameter_map.h"
#include "tess/plan/certified_plan.h"
#include "tess/write/mesh_tables.h"
#include "tessera/execution.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

namespace kernel {
struct KernelTable;
struct StreamState;
}  // namespace kernel

struct VertexJob;

/// Writes patches [begin, end) of a plan, as triangles, or with quads if there are views of these, and nothing outside
/// their records. The bits of a vertex do not depend on the range. Borders of patches that are one edge have the same
/// positions.
class PatchWriter {
 public:
  /// `bytes`: how much will be written, if not the whole mesh.
  PatchWriter(const PatchSet::Impl& set, const CertifiedPlan& plan, const MeshTables& tables,
              const kernel::KernelTable& kernels, const ParameterMaps& maps, const MeshViews& out, Stores stores,
              std::optional<std::size_t> bytes = {});

  bool streaming() const { return streaming_; }

  void write(std::size_t begin, std::size_t end) const;

 private:
  friend class VertexPass;
  /// Writes positions and normals of a patch whose vertices are its own; may overwrite any records before `end`.
  void write_vertices(std::size_t k, std::size_t end, VertexJob& vertices) const;
  /// Sets all that a patch's vertices are written from; the caller sets where they are written.
  void prepare(std::size_t k, VertexJob& vertices) const;
  void prepare_points(const PatchSet::Slot& slot, const float* net, const Division& division,
                      VertexJob& vertices) const;
  void prepare_weights(std::size_t k, const BlockGroup& group, const Division& division, VertexJob& vertices) const;
  /// Writes the triangles of a patch; may overwrite anything before `end`. `lines`: if not null, it stands at `out`,
  /// and the indices are written past the caches.
  void write_triangles(std::size_t k, std::uint32_t* out, std::uint32_t* end,
                       kernel::StreamState* lines = nullptr) const;
  /// Replaces a patch's own vertices by shared ones in the indices of its strips.
  void share_indices(std::size_t k, std::uint32_t* indices) const;
  void write_quads(std::size_t k) const;
  /// Writes positions from the double control points: rounded once to float, in place of those from float sums; and in
  /// double, with normals, for plans with positions in double.
  void write_f64(std::size_t k) const;
  /// Writes only the vertices that a patch owns, in a mesh with shared vertices.
  void write_owned(std::size_t k, VertexJob& vertices) const;
  void write_ring(std::size_t k, const Division& part, VertexJob& vertices) const;
  void write_parameters(std::size_t k) const;
  void write_patch_numbers(std::size_t k) const;

  const PatchSet::Impl& set_;
  const CertifiedPlan& plan_;
  const MeshTables& tables_;
  const kernel::KernelTable& kernels_;
  const ParameterMaps& maps_;
  const MeshViews& out_;
  bool streaming_;
};

}}  // namespace tessera::abi_0_1
