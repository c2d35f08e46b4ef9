#pragma once
// Uniform grids whose borders agree between neighbouring patches, for meshes and for ray scenes.

#include <array>
#include <optional>
#include <utility>

#include "base/aligned.h"
#include "base/impl_access.h"
#include "base/internal_export.h"
#include "eval/touched_blocks.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// The grid i / rate_u x j / rate_v over every patch of a set. Positions on a border depend on that border's control
/// points and the rate along it alone, and not on the direction in which the border runs: two patches that share a
/// border's control points share the bits of its positions. A collapsed border is one point, bit for bit.
class UniformGrid {
 public:
  /// Rates of at least 1. Errors: those of GridPlan::make.
  TESSERA_INTERNAL_EXPORT static Result<UniformGrid> make(const PatchSet& set, int rate_u, int rate_v,
                                                          std::optional<Isa> isa);

  int rate_u() const { return rate_u_; }
  int rate_v() const { return rate_v_; }
  /// Records that each view must hold: patch_count * (rate_u + 1) * (rate_v + 1), in the order `[patch][iu][iv]`.
  std::size_t capacity() const { return plan_.capacity(); }
  /// Evaluates all patches. Errors: those of evaluate().
  Status run(const PatchSet& set, const QuantityViews<float>& out, const Execution& execution) const {
    return run(impl_of(set), out, execution);
  }
  /// For callers that keep the set's inner state, which stays in place when the set is moved.
  TESSERA_INTERNAL_EXPORT Status run(const PatchSet::Impl& set, const QuantityViews<float>& out,
                                     const Execution& execution) const;
  /// Packs edits and evaluates the patches that they touch, which the set and prepare_edits() have checked. Errors:
  /// cancelled; each patch then has its new control points and its new grid, or neither.
  Status update(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                const QuantityViews<float>& out, const Execution& execution) const;

 private:
  UniformGrid(GridPlan plan, int rate_u, int rate_v) : plan_(std::move(plan)), rate_u_(rate_u), rate_v_(rate_v) {}

  GridPlan plan_;
  int rate_u_, rate_v_;
  /// Weights of each degree in use along u and v: `[k][i]`, see BorderJob::weights.
  std::array<AlignedVector<float>, max_degree + 1> border_weights_u_, border_weights_v_;
};

}}  // namespace tessera::abi_0_1
