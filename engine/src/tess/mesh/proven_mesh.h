#pragma once
// Meshes that keep tolerances: the plan that has been proven, and what their vertices are written from.

#include <memory>
#include <vector>

#include "eval/touched_blocks.h"
#include "tess/mesh/tessellation_impl.h"
#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_update.h"
#include "tess/write/mesh_tables.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks the options, except rates, and turns them into those of planning. Errors: invalid_argument.
Result<PlannerOptions> planner_options(const TessellationOptions& options, const PatchSet& set);
/// Returns the distance that checked options ask for, infinite if there is none. Errors: invalid_argument (the set has
/// no size that it could be a share of).
Result<double> tolerance_of(const TessellationOptions& options, const PatchSet& set);

/// Whether updates plan all anew: a set with trims or with edges of shapes, or borders of a tolerance of their own.
inline bool plans_anew(const PatchSet::Impl& set, const CertifiedPlan& plan, const TessellationOptions& options) {
  return set.trims || plan.closed() || options.border_tolerance;
}

/// Returns copies that few plans have, or none.
inline const VertexCopies& copies_in(const std::unique_ptr<VertexCopies>& slot) {
  static const VertexCopies none;
  return slot ? *slot : none;
}

/// A plan from tolerances.
class ProvenMesh final : public Tessellation::Impl {
 public:
  /// Checks the options and plans. `before`: the plan that is replaced, or null; its patches keep their segments where
  /// possible, and its tolerance. Errors: as Tessellation::make().
  static Result<std::unique_ptr<ProvenMesh>> make(const PatchSet& set, const TessellationOptions& options,
                                                  const ProvenMesh* before, const Execution& execution);

  const CertifiedPlan& plan() const { return plan_; }
  const MeshTables& tables() const { return *tables_; }
  bool has_f64_positions() const { return plan_.patches().has_f64_positions; }

  Proof proof() const override;
  MeshCapacity capacity() const override { return before(plan_.patch_count()); }
  MeshCapacity before(std::size_t patch) const override {
    if (!options_.quads) return {plan_.first_vertex(patch), plan_.first_triangle(patch), 0};
    return {plan_.first_vertex(patch), plan_.first_strip(patch), plan_.first_quad(patch)};
  }
  Mesh allocate() const override;
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const override;
  Status set_view(const View& view) override;
  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                            const Execution& execution) override;

 private:
  ProvenMesh(const PatchSet& set, const TessellationOptions& options, double tolerance, CertifiedPlan plan,
             const PlanFacts& facts, Isa isa);

  bool has_normals() const { return !options_.joining.share_vertices || options_.joining.crease_angle; }
  bool has_parameters() const { return !options_.joining.share_vertices || options_.parameters; }
  VertexParameters parameters() const { return options_.parameters.value_or(VertexParameters::surface); }
  /// Checks that normals, parameters and quads are only written if there are any. Errors: invalid_argument.
  Status check_attributes(const MeshViews& out) const;
  /// Finds what neighbours share, if anything. Errors: cancelled.
  Status join(const PatchSet::Impl& set, const PlanFacts& facts, const Execution& execution);
  /// Lists the welded positions of corners by the vertices that are stored: of each that is moved, all corners that
  /// share it, and the corner that owns the vertex where it goes.
  void weld_shared_corners();
  /// Writes the copies of vertices after all patches are written: for patches that are written, or that copy from such.
  Status write_copies(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution,
                      FunctionRef<bool(std::size_t patch)> is_written) const;

  PlanOfSet of(const PatchSet::Impl& set) const {
    return {set, plan_, weld_, copies_in(joins_), tolerance_, options_.spare, options_.headroom};
  }
  /// Checks an update; after an error the set's values and the views are as they were.
  Status start(PatchSet& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution);
  /// Makes the memory for proofs of a set.
  Status start_proofs(const PatchSet& set, const Execution& execution);
  /// update() where all is planned anew.
  Result<MeshChange> update_anew(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                 const Execution& execution);
  /// run() into views that need not have triangles.
  Status write_again(const PatchSet& set, const MeshViews& out, const Execution& execution) const;
  /// Touches the patches that were edited since the plan was proven.
  void touch_edited(const PatchSet::Impl& set);
  /// Replaces the plan by one from the edited patches, or from all, and returns how many patches changed.
  Result<std::size_t> redivide(const PatchSet& set, PlanUpdate::Outcome outcome, const Execution& execution);
  /// Takes the plan of another object, which is then empty. Returns how many patches changed.
  std::size_t replace(ProvenMesh& next);
  /// Writes the vertices of edited patches.
  Status write_touched(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution) const;
  std::size_t changed_patches(const ProvenMesh& other) const;

  TessellationOptions options_;
  double tolerance_;
  CertifiedPlan plan_;
  std::vector<PatchShape> shapes_;       ///< shapes before welding
  VertexCopies weld_;                    ///< vertices with a common position
  std::unique_ptr<VertexCopies> joins_;  ///< vertices with a common normal, or stored once; null if there are none
  std::size_t welded_borders_;
  Vec3 origin_;
  std::uint64_t revision_;  ///< the set's, of which the plan is proven
  bool is_certified_;
  bool is_view_new_ = false;  ///< whether the view of options_ is not the one that the plan is proven for
  Isa isa_;
  std::shared_ptr<const MeshTables> tables_;
  /// Made by the first update.
  std::unique_ptr<PlanUpdate> update_;
  std::unique_ptr<TouchedBlocks> edits_;
};

}}  // namespace tessera::abi_0_1
