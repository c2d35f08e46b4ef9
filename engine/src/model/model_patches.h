#pragma once
// Gathers the patches of a model's surfaces for one set, as trimming loops cut them.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "block/patch_edges.h"
#include "block/patch_set_impl.h"
#include "block/patch_trims.h"
#include "parallel/call_progress.h"
#include "parallel/workspaces.h"
#include "tessera/model.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// The part of a face that its loops keep.
struct FaceTrims {
  TrimRegion region;
  std::vector<PatchUse> uses;               ///< by patch_uses(); empty if the face is whole
  std::optional<std::uint32_t> index = {};  ///< into PatchTrims::regions
};

/// A surface's patches, and the loops that cut them.
struct SurfaceLoops {
  std::optional<Result<PatchGrid>> grid = {};
  std::optional<Result<Shared<std::vector<TrimLoop>>>> loops = {};  ///< none if nothing cuts the patches
  bool is_loose = false;  ///< the loops are an outline, which may be off the sides of the domain
};

/// Finds the trims of faces. Faces of equal loops over equal grids share them, as instances of a part do.
class FaceTrimsFinder {
 public:
  /// Finds the trims of faces by all threads, so that find() has them. Those that have none are left to find().
  /// Errors: cancelled, out_of_memory.
  Status find_ahead(std::span<const SurfaceLoops> faces, const std::atomic<bool>* cancel);
  /// Returns the trims of the next face, to stay until the next call.
  Result<FaceTrims*> find(const Shared<std::vector<TrimLoop>>& loops, const PatchGrid& grid, bool is_loose);

 private:
  struct Known {
    Shared<std::vector<TrimLoop>> loops;
    TrimOptions options;
    FaceTrims trims;

    bool is_for(const std::vector<TrimLoop>& others, const PatchGrid& grid, const TrimOptions& other) const;
  };

  static TrimOptions options_of(const PatchGrid& grid, bool is_loose);
  static Result<FaceTrims> make(const std::vector<TrimLoop>& loops, const PatchGrid& grid, const TrimOptions& options,
                                CurveExtractions& extractions);

  std::unordered_multimap<double, Known> known_;
  Workspaces<CurveExtractions> extractions_;
};

/// The patches of one surface after the other, and the source of each patch.
struct GatheredPatches {
  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  std::vector<Domain> domains;  ///< `[surface]`
  std::size_t surface_count = 0;
  Box3 box;  ///< of their control points; empty: packed() finds it
  FitError fit_error;
  PatchTrims trims;

  void add(std::size_t surface, PatchGrid&& grid);
  void add(std::size_t surface, const PatchGrid& grid);
  /// Adds patches that are surfaces of their own, and leaves the box to packed(). There must be none before.
  void add_single(std::span<const ModelSurface> surfaces);
  /// Makes room for whole grids.
  void reserve(std::span<const PatchGrid> grids);
  /// Adds what a face keeps of its patches.
  void add_kept(std::size_t surface, const PatchGrid& grid, FaceTrims& face);
  void note_error(const FitError& error);
  Result<PatchSet> packed(PatchSetOptions options) &&;

 private:
  void add_sources(std::size_t surface, const PatchGrid& grid);
};

/// Gathers the patches of a model's surfaces one by one.
class ModelPatches {
 public:
  /// The model must outlive this object. `options`: those of the set.
  ModelPatches(const Model& model, const PatchSetOptions& options) : model_(model), options_(options) {}

  /// States that the surfaces from `first` on are the faces of a shape, placed in the model. It must outlive this
  /// object.
  void name_edges(const Shape& shape, const Affine& placement, std::size_t first);
  /// Does so for all instances of the model.
  void name_edges();
  /// Adds the next surface's patches.
  Status add(PatchGrid grid);
  /// Adds the next surfaces' patches, and copies no grid of those that have no loops.
  Status add_grids(std::span<const PatchGrid> grids);
  /// Passes the next surface if it is a patch, unplaced and uncut. Returns whether it is; the others are left to add().
  bool pass_whole_patch();
  /// Converts all surfaces of the model and adds their patches.
  Status add_all(const FitOptions& fit);
  const GatheredPatches& gathered() const { return all_; }
  /// Returns the box of the patches that are gathered, and drops them.
  Box3 take_box();
  Result<PatchSet> packed() &&;

 private:
  struct NamedFace {
    const ShapeFace* face = nullptr;
    std::uint32_t first_edge = 0;
  };

  /// Adds all surfaces if each is_whole_patch(), without grids. Returns whether it has.
  Result<bool> add_if_single();
  /// Finds the loops of a surface whose grid is known.
  void find_loops(std::size_t surface, SurfaceLoops& of) const;
  /// Adds the next surface's patches.
  Status add(SurfaceLoops of);
  /// Whether a surface is a patch, unplaced and uncut.
  bool is_whole_patch(std::size_t surface) const;
  NamedFace named_face(std::size_t surface) const { return surface < faces_.size() ? faces_[surface] : NamedFace{}; }
  /// Notes the patches of a face whose loops name edges. `first`: its first patch.
  void add_edges(std::uint32_t first_edge, const Shared<std::vector<TrimLoop>>& loops, const FaceTrims& trims,
                 std::size_t first, std::size_t places);

  const Model& model_;
  static constexpr std::array ends_of_steps{0.9, 1.0};  ///< of the conversion, and of packing
  const PatchSetOptions options_;
  CallProgress progress_{options_.execution, ends_of_steps};
  GatheredPatches all_;
  FaceTrimsFinder trims_;
  std::vector<NamedFace> faces_;  ///< by surface, as far as there are any
  PatchEdges edges_;
  std::vector<Status> faults_;
  std::vector<std::size_t> ends_;  ///< the end of each surface's patches
};

}}  // namespace tessera::abi_0_1
