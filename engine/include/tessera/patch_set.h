#pragma once
// A set of Bezier patches, packed for evaluation.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "tessera/bezier_patch.h"
#include "tessera/convert.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// In which numbers, and over which basis, the coefficients of the blocks are held.
enum class Precision : std::uint8_t { single_precision, double_precision };
enum class Representation : std::uint8_t {
  bernstein,  ///< the default: backward stable on [0,1]
  power,      ///< monomials u^i v^j; loses up to 58 / 2,950 / 135,000 ULP at degrees 3 / 5 / 7
};

/// Which coefficients a set holds, packed when it is made and again with each edit. Each kind costs (m+1)(n+1) * (3 or 4) coefficients a patch.
struct BlockKinds {
  bool float_bernstein = true;    ///< what grids, meshes and rays read
  bool double_bernstein = false;  ///< for grids in double
  bool float_power = false;       ///< for grids in the power form
  bool double_power = false;      ///< the same in double
  /// Bernstein coefficients again, patch by patch, each from a cache line on: what scattered points are evaluated from
  /// (evaluate_points.h). 192 bytes a bicubic patch in float.
  bool float_points = false;
  bool double_points = false;  ///< the same in double
};

/// Where a patch came from: a surface of the model, and the rectangle of that surface's parameters that it covers.
struct PatchSource {
  std::uint32_t surface = 0;  ///< index into the model's surfaces
  Domain domain = {};         ///< of the surface's own parameters
};

/// What a set holds.
struct PatchSetOptions {
  BlockKinds blocks = {};  ///< at least one kind
  /// Coefficients of float blocks are relative to this point. By default the centre of the set's box.
  std::optional<Vec3> origin = {};
  /// How far the patches lie from the surfaces that they stand for.
  FitError fit_error = {};
  /// The source of each patch, copied. Empty: each patch is a surface of its own on [0,1]^2.
  std::span<const PatchSource> sources = {};
};

/// Owns patches and their SoA blocks: patches of equal degrees and rationality lie together, 16 to a block, coefficients
/// `[i][j][component][lane]` (x, y, z, and w for rational ones, homogeneous, relative to the origin; unused lanes repeat a patch).
/// Positions in float are relative to origin(); positions in double are absolute. Memory to make one: 64 bytes a patch.
/// Threads: const calls from any number of threads; an edit excludes every other call.
class PatchSet {
 public:
  static constexpr int lanes = 16;  ///< patches in a block

  /// Errors: invalid_argument (no patch), count_mismatch (sources, unless empty: one a patch), out_of_memory, and
  /// non_finite (index = the patch) if the smallest weight is below 1e-9 of the largest (1e-70 if there are double blocks
  /// alone), or a coordinate, after the origin is taken off, above 5e33 (2.7e303) times the square of that ratio: so
  /// derivatives are numbers.
  static Result<PatchSet> from(std::span<const BezierPatch> patches, const PatchSetOptions& options = {});

  PatchSet(PatchSet&&) noexcept;
  PatchSet& operator=(PatchSet&&) noexcept;
  ~PatchSet();

  std::size_t patch_count() const;                     ///< at least 1
  std::size_t surface_count() const;                   ///< one more than the largest number of a source
  const BezierPatch& patch(std::size_t index) const;   ///< index < patch_count()
  const PatchSource& source(std::size_t index) const;  ///< index < patch_count()
  Vec3 origin() const;                                 ///< of float positions, in the model
  Box3 box() const;                                    ///< of all control points; looks at each of them
  const FitError& fit_error() const;                   ///< as given; 0 for patches that are exact
  const BlockKinds& blocks() const;                    ///< as given
  std::size_t block_count() const;                     ///< of all degrees together
  /// Where a patch lies in block-interleaved output. index < patch_count().
  struct Slot {
    std::uint32_t block = 0;  ///< below block_count()
    std::uint32_t lane = 0;   ///< below lanes
  };
  Slot slot(std::size_t index) const;  ///< where a patch lies
  std::size_t memory_bytes() const;    ///< patches and blocks

  /// Grows by one with each edit. What was made from another revision is stale.
  std::uint64_t revision() const;
  /// New control points for one patch, as many as before, weights kept; repacks its lane of each block.
  /// Errors: invalid_argument (no such patch), count_mismatch, non_finite; the set is then unchanged.
  Status set_control_points(std::size_t index, std::span<const Vec3> points);

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit PatchSet(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
