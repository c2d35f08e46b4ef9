#pragma once
// Evaluation of every patch of a set over one grid of parameters.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/isa.h"
#include "tessera/limits.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/views.h"

namespace tessera {

/// `count` >= 2 parameters from 0 to 1: i / (count - 1).
std::vector<double> uniform_parameters(int count);

/// Which outputs are meant, for capacity and work.
struct GridOutputs {
  bool position = true, du = false, dv = false, normal = false;
};

struct GridPlanOptions {
  Precision precision = Precision::single_precision;
  Representation representation = Representation::bernstein;
  std::optional<Isa> isa = {};  ///< default_isa() if empty
};

/// The grid u_0..u_{N-1} x v_0..v_{M-1} of local parameters, with basis weights tabulated for every degree of a set.
/// Immutable; reusable for as long as the set's degrees stay (edits of control points keep them).
class GridPlan {
 public:
  /// Parameters in [0,1], in any order, 1 to 2^24 each way. Errors: invalid_argument or non_finite (index = the parameter),
  /// invalid_argument (more points than memory can address),
  /// unsupported (the set lacks the blocks), isa_unavailable.
  static Result<GridPlan> make(const PatchSet& set, std::span<const double> u, std::span<const double> v,
                               const GridPlanOptions& options = {});

  GridPlan(GridPlan&&) noexcept;
  GridPlan& operator=(GridPlan&&) noexcept;
  ~GridPlan();

  std::size_t count_u() const;
  std::size_t count_v() const;
  Isa isa() const;
  Precision precision() const;
  /// Records that a patch-contiguous view must hold: patch_count * count_u * count_v.
  std::size_t capacity() const;
  /// Values that one block-interleaved output must hold: block_count * count_u * count_v * 3 * PatchSet::lanes.
  std::size_t block_capacity() const;
  /// What the evaluation must compute and write at the least; see limits.h.
  Work work(const GridOutputs& outputs) const;

  class Impl;
  const Impl& impl() const { return *impl_; }  ///< for the library's own use

 private:
  explicit GridPlan(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Patch-contiguous outputs, `[patch][iu][iv]`: record (patch * count_u + iu) * count_v + iv.
/// Empty views are not computed. Positions in float are relative to the set's origin, in double absolute.
/// Derivatives are by local parameters. Normals are unit vectors; at a degenerate point the limit (see unit_normal),
/// or zero where there is none.
template <class T>
struct GridViews {
  View3<T> position = {}, du = {}, dv = {}, normal = {};
};

/// Evaluates all patches. Outputs may share memory by interleaving but must not overlap otherwise.
/// Errors: buffer_too_small, invalid_argument (a plan of other precision, or for other patches; a stride of 0),
/// cancelled. Nothing is written on any error but cancelled. The same bytes for any number of threads, and on
/// AVX2 and AVX-512. Error bounds for the Bernstein representation, in units of 2^-23 (2^-52 in double) times the largest
/// |V - origin| of the patch: positions 2, rational 4, derivatives 16 times the degree; for derivatives of rational patches the
/// largest |w (V - origin)| over the weight at the point takes its place, since the derivative itself grows with that ratio. Normals: 8 times the
/// degree, times that size over |r_u x r_v| / max(|r_u|, |r_v|), the sine of the tangents' angle times the shorter tangent.
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridViews<float>& out, const Execution& execution = {});
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridViews<double>& out, const Execution& execution = {});

/// Block-interleaved outputs, `[block][iu][iv][component][lane]`: the kernels' own order, and the fastest.
/// A patch's place is PatchSet::slot(); unused lanes of a last block repeat a patch. Empty spans are not computed.
/// Memory must be aligned to 64 bytes (invalid_argument otherwise).
template <class T>
struct GridBlocks {
  std::span<T> position = {}, du = {}, dv = {}, normal = {};
};
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridBlocks<float>& out, const Execution& execution = {});
Status evaluate(const PatchSet& set, const GridPlan& plan, const GridBlocks<double>& out, const Execution& execution = {});

}  // namespace tessera
