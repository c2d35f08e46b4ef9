#pragma once
// Shares the vertices of trimmed sets and of shapes by index.

#include <memory>
#include <optional>

#include "tess/mesh/proven_mesh.h"
#include "tess/mesh/tessellation_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// A mesh whose vertices at one place are one. With normals, those of one normal; with parameters, those of one surface
/// and of the same parameters.
///
/// Memory: 8 bytes per vertex of the patches, and these
/// vertices themselves while the mesh is made or written.
class MergedMesh final : public Tessellation::Impl {
 public:
  /// Errors: those of ProvenMesh::make(), whose `options` must not share vertices.
  static Result<std::unique_ptr<Tessellation::Impl>> make(const PatchSet& set, const TessellationOptions& options,
                                                          const Execution& execution);

  Proof proof() const override { return own_->proof(); }
  std::vector<EdgeVertex> edge_vertices() const override;
  MeshCapacity capacity() const override;
  MeshCapacity before(std::size_t) const override { return {}; }  // patches have no vertices of their own
  Mesh allocate() const override;
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const override;
  Status set_view(const View& view) override { return own_->set_view(view); }
  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                            const Execution& execution) override;

 private:
  /// Where a vertex of a patch comes from: the surface, and how far parameters reach over the patch.
  struct Origin {
    std::uint32_t surface;
    double u, v;
  };

  MergedMesh(std::unique_ptr<ProvenMesh> own, const TessellationOptions& options)
      : own_(std::move(own)), has_normals_(options.joining.crease_angle.has_value()), parameters_(options.parameters) {}
  Status find(const PatchSet& set, const Execution& execution);
  /// Returns the origin of each vertex of a patch; none without parameters.
  std::vector<Origin> origins(const PatchSet& set) const;
  /// Numbers the vertices of a whole mesh anew. Returns whether the numbers are as before.
  bool renumber(const PatchSet& set, const Mesh& all);
  Status check(const MeshViews& out) const;
  Status check_attributes(const MeshViews& out) const;
  /// Makes memory for the patches' own vertices; triangles go to `out` at once.
  MeshViews views_for(const MeshViews& out, Mesh& own) const;
  void gather(const MeshViews& own, const MeshViews& out) const;

  std::unique_ptr<ProvenMesh> own_;
  bool has_normals_;
  std::optional<VertexParameters> parameters_;  ///< vertices that have other ones are apart
  bool is_stale_ = false;                       ///< an update has failed after it changed the plan
  std::vector<float> no_normals_ = {};
  std::vector<std::uint32_t> numbers_;  ///< by vertex of a patch: that of the merged mesh
  std::vector<std::uint32_t> sources_;  ///< by vertex of the merged mesh: the first of a patch
};

}}  // namespace tessera::abi_0_1
