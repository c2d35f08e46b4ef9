#pragma once
// Holds the inner state of a CertifiedTessellation.

#include <memory>
#include <vector>

#include "tess/plan/certified_plan.h"
#include "tess/write/mesh_tables.h"
#include "tessera/tessellation.h"

namespace tessera::inline abi_0_1 {

class CertifiedTessellation::Impl {
 public:
  /// `tolerance`: the distance to keep, infinite if there is no limit.
  Impl(const PatchSet& set, const CertifiedOptions& options, double tolerance, CertifiedPlan plan,
       const CertifiedPlanner& planner, Isa isa);

  const CertifiedOptions& options() const { return options_; }
  double tolerance() const { return tolerance_; }
  const CertifiedPlan& plan() const { return plan_; }
  std::span<const PatchShape> shapes() const { return shapes_; }  ///< shapes before welding
  const Weld& weld() const { return weld_; }
  const VertexCopies& joins() const { return joins_; }  ///< vertices with a common normal, or stored once
  const MeshTables& tables() const { return *tables_; }
  Isa isa() const { return isa_; }
  std::uint64_t revision() const { return revision_; }  ///< the set's, when the plan was made

  double bound() const { return bound_; }
  double angle() const { return angle_; }
  std::size_t patches_without_angle() const { return without_angle_; }
  double pixels() const { return pixels_; }
  bool certified() const { return fit_error_.certified; }
  std::size_t welded_borders() const { return weld_.joined_by_distance; }

  /// Finds what neighbours share, if anything; called once, with the set that the plan was made for. Errors: cancelled.
  Status join(const PatchSet& set, const CertifiedPlanner& planner, const Execution& execution);
  /// Returns a mesh of that size with all attributes that the plan has.
  Mesh allocate(const MeshCapacity& capacity) const;
  /// Checks that normals are only written if there are any. Errors: invalid_argument.
  Status check_normals(const MeshViews& out) const;
  /// Checks views that a mesh is written to. Errors: as check_views().
  bool has_normals() const { return !options_.share_vertices || options_.crease_angle; }
  /// Writes the copies of vertices after all patches are written: for patches that are written, or that copy from such.
  Status write_copies(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution,
                      FunctionRef<bool(std::size_t patch)> is_written) const;
  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const;
  std::size_t divided_otherwise(const Impl& other) const;

 private:
  CertifiedOptions options_;
  double tolerance_;
  CertifiedPlan plan_;
  std::vector<PatchShape> shapes_;
  Weld weld_;
  VertexCopies joins_;
  Vec3 origin_;
  FitError fit_error_;
  std::uint64_t revision_;
  Isa isa_;
  std::shared_ptr<const MeshTables> tables_;
  float bound_ = 0, angle_ = 0, pixels_ = 0;
  std::size_t without_angle_ = 0;
};

}  // namespace tessera::inline abi_0_1
