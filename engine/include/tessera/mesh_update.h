#pragma once
// Certified meshes that follow their patches: new control points in, the vertices of the touched patches out.

#include <cstddef>
#include <memory>
#include <span>

#include "tessera/certified_tessellation.h"
#include "tessera/update.h"

#pragma GCC visibility push(default)
namespace tessera {

/// A certified plan and the memory for updates of its mesh, so that repeated ones allocate nothing. An animated model costs
/// what the evaluation of its touched patches costs: triangles stay as they are. Threads: one call at a time.
///
///   auto update = MeshUpdate::make(set, std::move(plan));   // once plan.run(set, mesh.views()) has written the mesh
///   update->run(set, {patches, points}, mesh.views());      // each frame
///   if (update->restate(set).ok() && update->unproven() > 0)
///     if (auto changed = update->retessellate(set); changed && *changed > 0)
///       mesh = ...                                          // update->plan().allocate() and run()
class MeshUpdate {
 public:
  /// Takes over a plan of the set as it is. Errors: stale (another revision of the set, or number of patches);
  /// out_of_memory. Memory: 256 bytes a patch, those of the plan among them.
  static Result<MeshUpdate> make(const PatchSet& set, CertifiedTessellation plan);

  MeshUpdate(MeshUpdate&&) noexcept;
  MeshUpdate& operator=(MeshUpdate&&) noexcept;
  ~MeshUpdate();

  const CertifiedTessellation& plan() const;  ///< that of the mesh as it is now

  /// PatchSet::set_control_points() for each edit, and then the positions and normals of these patches alone: each task
  /// packs the patches that it evaluates while they are in its cache. `out` are the views of the mesh that the plan has
  /// written; positions, and normals if wanted, are enough. Records of other patches are not touched, but for vertices
  /// that welding takes from touched ones. The same bytes in the set and in the views as by those calls and by
  /// CertifiedTessellation::run(), for any number of threads. The revision grows by one, unless there is no edit.
  /// A patch's first update gives its points memory of their own, if it shares it with other patches; the next ones
  /// allocate nothing, but for a patch with a border that welding made a point.
  /// Where borders of the same bits are moved apart, so is the mesh; retessellate() finds what still meets.
  /// Errors, with nothing written: those of the views (buffer_too_small, invalid_argument); stale (the set was edited by
  /// other means; or index = the edit: other collapsed borders than in the plan); invalid_argument (index = the edit: no
  /// such patch, or one that an edit before names); count_mismatch (points); non_finite (index = the edit: a point is
  /// not finite, or does not fit the set's numbers relative to its origin). cancelled: each patch then has its new control
  /// points and its new vertices, or neither.
  Status run(PatchSet& set, const PatchEdits& edits, const MeshViews& out, const Execution& execution = {});

  /// Proves anew how far the mesh lies from the patches that were touched since the last call: about a quarter of what
  /// an update of theirs costs, but for plans of the fewest triangles, up to 110 us a bicubic patch; what such a plan has proven,
  /// one patch in a hundred is not known to keep, by up to 6%. Distances alone: angles and pixels are proven by a plan, and
  /// count as not proven for patches that were touched. Allocates nothing. Errors: stale (the set was edited by other
  /// means), cancelled.
  Status restate(const PatchSet& set, const Execution& execution = {});
  /// How far mesh and patches lie apart at most, as of the last restate(); at first the plan's bounds().
  std::span<const float> bounds() const;
  double bound() const;  ///< the largest
  /// How many patches their rates no longer serve: whose bound is above the plan's tolerance, or of whose angle or pixels
  /// nothing is known any more. As of the last restate().
  std::size_t unproven() const;

  /// Takes CertifiedTessellation::retessellate() of the plan in its place. How many patches are divided otherwise: if none,
  /// the mesh stays as it is; else it is another one, for plan().allocate() or capacity() and run(). All of them, if the
  /// set was edited by other means: then run() is due in any case. Errors: as there; the plan stays then.
  Result<std::size_t> retessellate(const PatchSet& set, double spare = 0.25, const Execution& execution = {});

 private:
  class [[gnu::visibility("hidden")]] Impl;
  explicit MeshUpdate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
#pragma GCC visibility pop
