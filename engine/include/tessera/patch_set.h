#pragma once
// A set of Bezier patches, packed for evaluation: what grids, meshes and ray scenes are made from.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/convert.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The numbers in which the coefficients of a block are held.
enum class Precision : std::uint8_t { single_precision, double_precision };
/// The basis over which the coefficients of a block are held.
enum class Representation : std::uint8_t {
  bernstein,  ///< the default: backward stable on [0,1]
  power,      ///< monomials u^i v^j; rounding errors grow with the degree: see evaluate()
};

/// Kinds of coefficients that a set holds. They are packed when it is made and again with each edit. Memory: each kind
/// takes (m+1)(n+1) * 3 coefficients per patch of degrees m and n, or * 4 if it is rational.
struct BlockKinds {
  bool float_bernstein = true;    ///< for grids, meshes and rays
  bool double_bernstein = false;  ///< for grids in double
  bool float_power = false;       ///< for grids in the power form
  bool double_power = false;      ///< for grids in double in the power form
  /// For scattered points (evaluate.h): Bernstein coefficients once more, patch by patch, each from a cache line on.
  /// 192 bytes per bicubic patch in float. Without them the set packs all patches at the first call after each edit.
  bool float_points = false;
  bool double_points = false;  ///< for scattered points in double
};

/// Where a patch came from: a surface of the model, and the rectangle of its parameters that the patch covers.
struct PatchSource {
  std::uint32_t surface = 0;  ///< index into the model's surfaces
  Domain domain = {};         ///< in the surface's own parameters
};

/// How a set is made.
struct PatchSetOptions {
  BlockKinds blocks = {};  ///< at least one kind
  /// The point that coefficients are relative to; finite. By default the centre of model_box().
  std::optional<Vec3> origin = {};
  /// Sets that are parts of a model: the model's box, which replaces the set's own wherever its size or centre matter,
  /// so that parts are meshed as the model is. It must contain the set's own, also after edits.
  std::optional<Box3> box = {};
  /// How far the patches lie from the surfaces that they approximate.
  FitError fit_error = {};
  /// The source of each patch, copied. Empty: patch k is surface k on [0,1]^2.
  std::span<const PatchSource> sources = {};
  /// Sets that are made of a model: whether trimming loops count. Patches that a face's loops cut away are then left
  /// out, and meshes follow the loops through those that they cut. If false, every patch is whole.
  bool trims = true;
  Execution execution = {};  ///< cancel and progress of the call that makes the set
};

/// Owns patches and their SoA blocks.
///
/// Patches of equal degrees and rationality lie together, 16 to a block, with coefficients `[i][j][component][lane]`.
/// The components are x, y, z, and w for rational patches, homogeneous and relative to the origin. Unused lanes repeat
/// a patch. Positions in float are relative to origin(); positions in double are absolute.
///
/// Memory: memory_bytes(), and 64 bytes per patch more while a set is made. Threads: const calls from any number of
/// threads; an edit excludes every other call.
class PatchSet {
 public:
  static constexpr int lanes = 16;  ///< patches in a block

  /// Copies the patches and packs them.
  ///
  /// Range: the smallest weight of a patch is at least 1e-9 of the largest (1e-70 if there are only double blocks). A
  /// coordinate relative to the origin is at most 5e33 (2.7e303) times the square of that ratio. So derivatives are
  /// finite.
  ///
  /// Errors:
  /// - invalid_argument (no patch; index = the patch: a source's domain that is not a finite rectangle)
  /// - count_mismatch (sources that are neither none nor one per patch)
  /// - invalid_argument (a box that does not contain all control points)
  /// - non_finite (the origin or the box; index = the patch: numbers out of that range)
  /// - cancelled, out_of_memory
  static Result<PatchSet> make(std::span<const BezierPatch> patches, const PatchSetOptions& options = {});

  PatchSet(PatchSet&&) noexcept;
  PatchSet& operator=(PatchSet&&) noexcept;
  ~PatchSet();

  std::size_t patch_count() const;                     ///< at least 1
  std::size_t surface_count() const;                   ///< one more than the largest PatchSource::surface
  const BezierPatch& patch(std::size_t index) const;   ///< index < patch_count()
  const PatchSource& source(std::size_t index) const;  ///< index < patch_count()
  Vec3 origin() const;                                 ///< the point of the model that float positions are relative to
  Box3 box() const;                                    ///< the box of all control points; reads each of them
  Box3 model_box() const;                              ///< PatchSetOptions::box; box() if that is empty
  const FitError& fit_error() const;                   ///< PatchSetOptions::fit_error; 0 for patches that are exact
  const BlockKinds& blocks() const;                    ///< PatchSetOptions::blocks
  std::size_t block_count() const;                     ///< blocks of all degrees together
  std::size_t cut_count() const;                       ///< how many patches trimming loops cut
  bool is_cut(std::size_t index) const;                ///< whether loops cut this one; index < patch_count()
  /// Returns why the loops of some surfaces could not be used: "surface 3 (rim): loop 0 ..."; index = the surface.
  /// These surfaces are kept whole.
  std::span<const Status> trim_faults() const;
  /// The place of a patch in block-interleaved output.
  struct Slot {
    std::uint32_t block = 0;  ///< below block_count()
    std::uint32_t lane = 0;   ///< below lanes
  };
  Slot slot(std::size_t index) const;  ///< index < patch_count()
  std::size_t memory_bytes() const;    ///< bytes of the patches and the blocks

  /// Returns a number that grows by one with each edit. Objects that were made at another revision may be stale.
  std::uint64_t revision() const;
  /// Sets the control points of one patch, as many as before; weights are kept. Repacks its lane of each block. Errors,
  /// with the set unchanged: invalid_argument (no such patch), count_mismatch (points), non_finite (a point; numbers
  /// out of the range of make()), out_of_memory. Memory: copies the patch's control points, 24 bytes per point, and
  /// frees those from before unless a copy of the patch has them.
  Status set_control_points(std::size_t index, std::span<const Vec3> points);

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit PatchSet(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
