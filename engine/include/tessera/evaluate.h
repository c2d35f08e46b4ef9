#pragma once
// Evaluation of patches: all patches over one grid of parameters, samples scattered over patches or surfaces, and grids
// that follow edits of control points.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/limits.h"
#include "tessera/local_geometry.h"
#include "tessera/patch_set.h"
#include "tessera/quantities.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// `count` parameters from 0 to 1: i / (count - 1). A count below 2 counts as 2.
std::vector<double> uniform_parameters(int count);

/// How a grid is evaluated.
struct GridPlanOptions {
  Precision precision = Precision::single_precision;          ///< of coefficients, arithmetic and outputs
  Representation representation = Representation::bernstein;  ///< of the blocks that are read
  std::optional<Isa> isa = {};                                ///< default_isa() if empty
  /// In single precision a smallest sine below 1e-6 counts as 1e-6, and an umbilic tolerance below 1e-4 as 1e-4.
  LocalGeometryOptions geometry = {};
};

/// Parameters that differ from patch to patch, as many for each: `[patch][iu]` and `[patch][iv]`.
struct PatchParameters {
  std::span<const double> u = {}, v = {};  ///< in [0,1], as many for every patch
};

/// The grid u_0..u_{N-1} x v_0..v_{M-1} of local parameters, with basis weights tabulated for every degree of a set.
/// Immutable; reusable for as long as the set's degrees stay (edits of control points keep them).
class GridPlan {
 public:
  /// Parameters in [0,1], in any order, 1 to 2^24 each way. Errors: invalid_argument or non_finite (index = the
  /// parameter), invalid_argument (more points than memory can address), unsupported (the set lacks the blocks),
  /// isa_unavailable; invalid_argument (options.geometry: not from 0 to below 1).
  static Result<GridPlan> make(const PatchSet& set, std::span<const double> u, std::span<const double> v,
                               const GridPlanOptions& options = {});
  /// A grid of its own for each patch. Its weights take 3 (degree + 1) values a parameter of a patch. A patch's results
  /// are, bit for bit, those of its parameters given for all patches. Errors: the same, and invalid_argument (parameters
  /// that are not as many for each patch).
  static Result<GridPlan> make(const PatchSet& set, const PatchParameters& parameters,
                               const GridPlanOptions& options = {});

  GridPlan(GridPlan&&) noexcept;
  GridPlan& operator=(GridPlan&&) noexcept;
  ~GridPlan();

  std::size_t count_u() const;  ///< parameters along u, of a patch
  std::size_t count_v() const;  ///< parameters along v, of a patch
  Isa isa() const;              ///< the one that runs
  Precision precision() const;  ///< of outputs
  /// Records that a patch-contiguous view must hold: patch_count * count_u * count_v.
  std::size_t capacity() const;
  /// Values that one block-interleaved output of vectors must hold: block_count * count_u * count_v * 3 *
  /// PatchSet::lanes; one of scalars or kinds a third of it.
  std::size_t block_capacity() const;
  /// What the evaluation must compute and write at the least; see limits.h.
  Work work(const QuantityFlags& outputs) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit GridPlan(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Patch-contiguous outputs, `[patch][iu][iv]`: record (patch * count_u + iu) * count_v + iv. Any subset in one pass;
/// empty views are not computed. Positions in float are relative to the set's origin, in double absolute. Derivatives
/// are by local parameters. Normals are unit vectors; at a degenerate point the limit, or zero where there is none: as
/// unit_normal() defines it, and computed by it where the lanes' rounding errors leave it open. Forms, curvatures and
/// directions are those of local_geometry.h, zero wherever undefined and never NaN: the normal is not regular, or the
/// tangents are parallel within rounding errors or within GridPlanOptions::geometry, or a figure is out of range (a
/// form beyond the numbers, a curvature beyond 2^60 in float, 2^500 in double).
template <class T>
using QuantityViews = Quantities<View3<T>, View1<T>, View1<NormalKind>, View1<CurvatureKind>>;

/// Evaluates all patches. Outputs may share memory by interleaving but must not overlap otherwise. Views that fill one
/// record together, packed views, and structures of arrays are written by whole vectors, streaming as Execution::stores
/// says; others value by value, at a small part of the speed. Allocates nothing.
/// Errors: buffer_too_small, invalid_argument (a plan of other precision, or for other patches; a view that lacks a
/// component, has a stride of 0, is not aligned to its numbers, or shares memory with another), cancelled. Nothing is
/// written on any error but cancelled. The same bytes for any number of threads, and on
/// AVX2, AVX-512 and NEON; each output alone is what it is together with others.
/// Error bounds of each component for the Bernstein representation, in units of 2^-23 (2^-52 in double). The bounds are
/// stated by d, the higher degree; `size`, the largest |V - origin| of the patch; `ratio`, the largest weight over the
/// weight at the point, 1 for polynomial patches; h = |r_u x r_v| / max(|r_u|, |r_v|), the sine of the tangents' angle
/// times the shorter tangent; D, the largest second derivative.
/// - positions: 2 size; rational (4 + d / 4) size
/// - first derivatives: 16 d size ratio
/// - second derivatives: 16 d^2 size; rational 48 d^2 size ratio^2
/// - first form: 32 d size ratio times the longer tangent
/// - normals: 8 d size ratio / h; limit normals half the bound of second derivatives over h, where r_uv stands for the
///   tangent that vanishes, in h as well
/// - second form: half the bound of second derivatives, and D times that of normals
/// - mean and principal curvatures: the bound of the second form over h^2
/// - Gaussian curvature: |k1| + |k2| times the bound of curvatures, and the square of that bound
/// - principal directions: 2 / (k1 - k2) times the bound of curvatures, and the bound of normals
/// The ratio enters by the quotient rule, r_u = (A_u - w_u r) / w: errors of w_u go with the largest weight, those of r
/// with the size, and both are divided by the weight at the point. Bounds over h hold to first order: where the errors
/// of the tangents are small against h. Positions in double, which are absolute, round once more, to 2^-53 of their own
/// size.
/// In the power representation the bounds of positions and first derivatives are (1 + 2u)^m (1 + 2v)^n ratio times as
/// large, m and n the degrees: random bicubic patches lose 34 units, degrees 5 and 7 lose 1,200 and 140,000.
template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityViews<T>& out,
                const Execution& execution = {});

/// Block-interleaved outputs, `[block][iu][iv][component][lane]`, scalars and kinds `[block][iu][iv][lane]`: the
/// kernels' own order, and the fastest. A patch's place is PatchSet::slot(); unused lanes of a last block repeat a
/// patch. The members mean what those of QuantityViews mean. Empty spans are not computed. Memory must be aligned to 64
/// bytes and apart from each other (invalid_argument otherwise). Grids of each patch's own are stored plainly.
template <class T>
using QuantityBlocks = Quantities<std::span<T>, std::span<T>, std::span<NormalKind>, std::span<CurvatureKind>>;
template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityBlocks<T>& out,
                const Execution& execution = {});

/// What becomes of parameters outside of a patch's [0,1]^2, or of a surface's domain.
enum class OutsideDomain : std::uint8_t {
  error,        ///< invalid_argument, index = the first such sample
  clamp,        ///< the nearest parameter inside counts
  extrapolate,  ///< the polynomials go on. No error bounds; far out, or where a rational patch has its poles, results may
                ///< be infinite or NaN
};

/// How samples are evaluated.
struct PointOptions {
  OutsideDomain outside = OutsideDomain::error;  ///< what is done with samples that lie outside
  std::optional<Isa> isa = {};                   ///< default_isa() if empty
  LocalGeometryOptions geometry = {};            ///< as in GridPlanOptions
};

/// Sample k lies at (u[k], v[k]) of patch[k]. There are as many samples as `patch` has records; u and v hold at least as
/// many.
template <class T>
struct PatchSamples {
  View1<const std::uint32_t> patch = {};  ///< below patch_count()
  View1<const T> u = {}, v = {};          ///< in the patch's [0,1]^2
};

/// Evaluates all samples, in any order of patches; samples that come sorted by patch, a dozen or more of a patch in
/// a row, run up to twice as fast as others. Arrays (views of stride 1) are read where they lie, others copied first.
/// The set must hold BlockKinds::float_points (double_points). Allocates nothing.
/// Positions in float are relative to the set's origin, in double absolute; derivatives are by the patch's parameters.
/// Degenerate points as in QuantityViews, by unit_normal().
/// Errors, with nothing written: unsupported (the set lacks the coefficients), buffer_too_small, count_mismatch (fewer
/// u or v than patches), invalid_argument (no output; views that lack a component, that are misaligned, whose stride is
/// below 1, that share memory with another view; index = the sample: no such patch, parameter outside [0,1]), non_finite
/// (index = the sample), isa_unavailable; cancelled, which may leave outputs partly written.
/// The same bytes for any number of threads, for any order of the samples and choice of outputs, and on AVX2 and
/// AVX-512. Bounds as for grids (evaluate.h), the parameters taken as exact; on SSE2 positions 2 + d / 2, rational ones
/// 4 + d, for weights are made without fused multiply-adds there.
template <class T>
Status evaluate(const PatchSet& set, const PatchSamples<T>& samples, const QuantityViews<T>& out,
                const PointOptions& options = {}, const Execution& execution = {});

/// From the parameters of a set's surfaces to its patches: the breakpoints of each surface, from PatchSet::source().
/// Immutable; edits of control points keep it valid. Memory: 128 bytes a patch.
class SurfaceMap {
 public:
  /// The patches of each surface must be those of a PatchGrid, one after the other in its order, as make_patch_set()
  /// leaves them. Errors: unsupported (index = a surface of which that is not true), out_of_memory.
  static Result<SurfaceMap> make(const PatchSet& set);

  SurfaceMap(SurfaceMap&&) noexcept;
  SurfaceMap& operator=(SurfaceMap&&) noexcept;
  ~SurfaceMap();

  std::size_t surface_count() const;  ///< one more than the largest number of a source
  /// Nothing for a number that no patch's source bears. surface < surface_count().
  std::optional<Domain> domain(std::size_t surface) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit SurfaceMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Sample k lies at (u[k], v[k]) of surface[k], in that surface's own parameters. There are as many samples as u has
/// records; v and `surface` hold at least as many.
struct SurfaceSamples {
  View1<const std::uint32_t> surface = {};  ///< empty: all lie on surface 0
  View1<const double> u = {}, v = {};       ///< in the surface's domain
};

/// Finds each sample's patch, the one on the right of a breakpoint, and evaluates there. Derivatives and the two forms
/// are by the surface's parameters. Errors as above, and invalid_argument (a map of another set; index = the sample: no
/// such surface, parameter outside of its domain). Parameters within the patch are found in double and rounded to T. For
/// each, results in float are further off, in the units and terms of evaluate.h: positions by d / 2 size ratio, first
/// derivatives by d^2 size, rational ones 2 d^2 size ratio^2.
template <class T>
Status evaluate(const PatchSet& set, const SurfaceMap& map, const SurfaceSamples& samples, const QuantityViews<T>& out,
                const PointOptions& options = {}, const Execution& execution = {});

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
  template <class T>
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityViews<T>& out,
             const Execution& execution = {});
  /// The same into block-interleaved memory of all patches. A block with an edited patch is evaluated whole: its other
  /// lanes are written, with the bytes that evaluate() gives them.
  template <class T>
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityBlocks<T>& out,
             const Execution& execution = {});

 private:
  class [[gnu::visibility("hidden")]] Impl;
  explicit GridUpdate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
