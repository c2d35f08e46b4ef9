#pragma once
// Grids that follow their patches: new control points in, the grids of the touched patches out, in one pass.

#include <cstdint>
#include <memory>
#include <span>

#include "tessera/evaluate.h"

#pragma GCC visibility push(default)
namespace tessera {

/// New control points for some patches. Those of patch[k] follow those of patch[k - 1]: (degree_u + 1) * (degree_v + 1)
/// points `[i][j]`, i along u, as BezierPatch::points(). Weights and degrees stay.
struct PatchEdits {
  std::span<const std::uint32_t> patch = {};  ///< in any order, each at most once; in the set's order is fastest
  std::span<const Vec3> points = {};          ///< patch after patch
};

/// Memory for updates of one set, 16 bytes a patch; repeated ones allocate nothing. Threads: one call at a time.
class GridUpdate {
 public:
  /// Errors: out_of_memory.
  static Result<GridUpdate> make(const PatchSet& set);

  GridUpdate(GridUpdate&&) noexcept;
  GridUpdate& operator=(GridUpdate&&) noexcept;
  ~GridUpdate();

  /// PatchSet::set_control_points() for each edit, and then evaluate() of these patches alone: each task packs the
  /// patches that it evaluates while they are in its cache. `out` are views of all patches, as evaluate() takes them; the
  /// records of other patches are not touched, nor read. The same bytes in the set and in the views as by those calls,
  /// for any number of threads. The revision grows by one, unless there is no edit.
  /// A patch's first update gives its points memory of their own, if it shares it with other patches; the next ones
  /// allocate nothing.
  /// Errors, with nothing written: those of evaluate(); unsupported (a plan with parameters of each patch's own);
  /// invalid_argument (another set than the one of make(); index =
  /// the edit: no such patch, or one that an edit before names); count_mismatch (points); non_finite (index = the edit: a
  /// point is not finite, or does not fit the set's numbers relative to its origin); out_of_memory. cancelled: each patch
  /// then has its new control points and its new grid, or neither.
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const GridViews<float>& out,
             const Execution& execution = {});
  /// The same in double.
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const GridViews<double>& out,
             const Execution& execution = {});
  /// The same into block-interleaved memory of all patches. A block with an edited patch is evaluated whole: its other
  /// lanes are written, with the bytes that evaluate() gives them.
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const GridBlocks<float>& out,
             const Execution& execution = {});
  /// The same in double.
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const GridBlocks<double>& out,
             const Execution& execution = {});

 private:
  class [[gnu::visibility("hidden")]] Impl;
  explicit GridUpdate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
#pragma GCC visibility pop
