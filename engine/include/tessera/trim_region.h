#pragma once
// The region of the parameter plane that the trimming loops of a face keep.
//
// Memory: a region owns what it needs; loops are not kept. Copies share everything. Threads: any number of calls at
// once.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "tessera/convert.h"
#include "tessera/geometry.h"
#include "tessera/status.h"
#include "tessera/trim_loop.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// On which side of its loops a point of a face lies.
enum class TrimSide : std::uint8_t {
  outside,  ///< cut away
  inside,   ///< kept
  border,   ///< on a loop, or so near that rounding decides; see TrimRegion::band()
};

/// The part of a face that its loops keep: points that an odd number of loops encloses. Neither the order of the loops
/// nor their orientation matters, and hardly their word "hole": only where every loop is a hole, the rectangle of the
/// domain is one more loop. Without loops, or if all of them enclose nothing, the whole rectangle is kept.
///
/// Loops are repaired first (remarks() tells what was done): gaps are closed by straight lines, parts outside of the
/// domain are cut off, parts that run back over themselves are dropped.
class TrimRegion {
 public:
  /// Makes the region of a surface's face.
  ///
  /// - `loops`: in the parameters of the breaks, at most 1e100 in absolute value.
  /// - `breaks_u`, `breaks_v`: borders between patches, as in PatchGrid: at least two, finite, strictly increasing.
  ///
  /// Errors: invalid_argument (breaks, snap), non_finite (breaks; index = the break), unsupported (coordinates beyond
  /// 1e100; a loop that runs over more than 64 periods; index = the loop), internal (a loop that repair leaves open),
  /// out_of_memory. Time: O(n log n) for n pieces of curves between patch borders, plus O(patches); O(n^2) at worst, as
  /// where one point is the middle of the chords of all pieces.
  static Result<TrimRegion> make(std::span<const TrimLoop> loops, std::span<const double> breaks_u,
                                 std::span<const double> breaks_v, const TrimOptions& options = {});
  /// Makes the region of a face that is one patch. Errors: as above.
  static Result<TrimRegion> make(std::span<const TrimLoop> loops, const Domain& domain,
                                 const TrimOptions& options = {});

  /// Makes the region of a face whose patches are these, as make_patch_set() of a model does: loops are in the grid's
  /// parameters (see grid_trims()); a parameter is periodic if the first and the last line of the grid are the same
  /// points, within 1e-9 of its size; ends of curves meet within 2^-32 of the domain. Errors: as above.
  static Result<TrimRegion> make(std::span<const TrimLoop> loops, const PatchGrid& grid);

  /// Tells on which side of the loops a point lies. Exact: `inside` and `outside` are right for the loops as they were
  /// given and repaired, whatever rounding does; `border` stands for points on a loop, and beside a curve for those
  /// within band() of it. A straight line with the ends that were given has no such band. Points outside of the domain,
  /// NaN included, are outside.
  TrimSide locate(double u, double v) const;
  /// Locates many points. All three spans have the same size. Errors: count_mismatch. Memory: allocates nothing.
  Status locate(std::span<const double> u, std::span<const double> v, std::span<TrimSide> sides) const;

  /// Tells whether patch (a, b), a < breaks_u.size() - 1 and b < breaks_v.size() - 1, is kept as a whole (`inside`),
  /// left out (`outside`) or cut by a loop (`border`). Loops along its sides do not cut a patch.
  TrimSide patch(std::size_t a, std::size_t b) const;
  bool is_whole() const;  ///< whether every patch is kept as a whole
  Domain domain() const;  ///< the rectangle between the first and the last breaks
  /// The largest distances from a loop in u and in v at which locate() may answer `border`: a few units in the last
  /// place of the coordinates, and what snapping displaced. A `border` is within both.
  ParameterPoint band() const;
  std::size_t piece_count() const;              ///< pieces between patch borders and extrema that bound the region
  std::span<const LoopRemark> remarks() const;  ///< what was repaired, in the order of the loops

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit TrimRegion(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
