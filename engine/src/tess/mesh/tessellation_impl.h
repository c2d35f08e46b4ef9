#pragma once
// The common part of both kinds of plans: those from rates and those from tolerances.

#include <limits>
#include <memory>

#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

class EditedSurfaces;

class Tessellation::Impl {
 public:
  /// The bounds of a mesh, as the public calls return them.
  struct Proof {
    double tolerance = std::numeric_limits<double>::infinity();
    bool certified = false;
    std::span<const float> bounds = {}, angles = {}, pixels = {};
    std::size_t welded_borders = 0, open_edges = 0;
    std::span<const std::uint32_t> crossed = {}, beyond = {};
    double gap = 0;
    std::span<const float> edge_gaps = {};
    std::span<const EdgeVertex> edge_vertices = {};  ///< each `vertex` is one of its patch
  };

  Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  virtual ~Impl();

  /// Makes a set the one that the plan is for.
  void follow(const PatchSet& set);
  /// Checks that a set is the one that the plan is for. Errors: stale.
  Status check_set(const PatchSet& set) const;

  virtual Proof proof() const { return {}; }
  virtual std::vector<EdgeVertex> edge_vertices() const;
  virtual MeshCapacity capacity() const = 0;
  virtual MeshCapacity before(std::size_t patch) const = 0;
  virtual Mesh allocate() const = 0;
  virtual Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const = 0;
  /// Takes the view that the next update plans for. Errors: invalid_argument.
  virtual Status set_view(const View& view);
  virtual Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                    const Execution& execution) = 0;
  Result<MeshChange> update_surfaces(PatchSet& set, std::span<const SurfaceEdits> edits, const MeshViews& out,
                                     const Execution& execution);

 private:
  std::shared_ptr<const void> identity_;      ///< of the set that the plan is for
  std::unique_ptr<EditedSurfaces> surfaces_;  ///< made by the first update of splines
};

/// Makes a plan from options.rates. Errors: as Tessellation::make().
Result<std::unique_ptr<Tessellation::Impl>> make_uniform_mesh(const PatchSet& set, const TessellationOptions& options);
/// Makes a plan from tolerances. Errors: as Tessellation::make().
Result<std::unique_ptr<Tessellation::Impl>> make_proven_mesh(const PatchSet& set, const TessellationOptions& options,
                                                             const Execution& execution);

}}  // namespace tessera::abi_0_1
