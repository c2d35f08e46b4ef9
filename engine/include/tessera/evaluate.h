#pragma once
// Evaluation of patches: all patches over one grid of parameters, samples scattered over patches or surfaces, and grids
// that follow edits of control points. Callable, ruled and Coons surfaces over a grid, without patches.
//
// Memory: plans and maps own theirs and keep no argument; outputs go to the caller's memory. Threads: any number of
// calls at once on const objects, into memory that does not overlap, in the caller's TBB arena. Stack: 1 MiB each.

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
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

class CoonsPatch;
class ParametricSurface;
class RuledSurface;

/// Returns `count` equidistant parameters from 0 to 1: i / (count - 1). A count below 2 counts as 2. Errors: none;
/// throws std::bad_alloc if memory runs out. Memory: 8 bytes per parameter.
std::vector<double> uniform_parameters(int count);

/// How a grid is evaluated.
struct GridPlanOptions {
  Precision precision = Precision::single_precision;          ///< of coefficients, arithmetic and outputs
  Representation representation = Representation::bernstein;  ///< of the blocks that are read
  std::optional<Isa> isa = {};                                ///< default_isa() if empty
  /// In single precision, a smallest sine below 1e-6 counts as 1e-6, an umbilic tolerance below 1e-4 as 1e-4.
  LocalGeometryOptions geometry = {};
};

/// Parameters that differ from patch to patch, equally many for each: `[patch][iu]` and `[patch][iv]`.
struct PatchParameters {
  std::span<const double> u = {}, v = {};  ///< in [0,1]
};

/// A grid of local parameters, u_0..u_{N-1} x v_0..v_{M-1}, with basis weights tabulated for every degree of a set.
/// Immutable. It stays valid while the degrees of the set do: edits of control points keep them.
class GridPlan {
 public:
  /// Makes one grid for all patches. Parameters lie in [0,1], in any order, 1 to 2^24 each way.
  ///
  /// Errors: invalid_argument (a parameter: index; more points than memory can address; options.geometry outside
  /// [0,1)), non_finite (a parameter: index), unsupported (the set lacks the blocks), isa_unavailable, out_of_memory.
  static Result<GridPlan> make(const PatchSet& set, std::span<const double> u, std::span<const double> v,
                               const GridPlanOptions& options = {});
  /// Makes one grid per patch. A patch gets the bits that it gets from a plan with its parameters for all patches.
  ///
  /// Errors: as above, and invalid_argument (the number of parameters is no multiple of the number of patches).
  /// Memory: 3 (degree + 1) values per parameter and patch.
  static Result<GridPlan> make(const PatchSet& set, const PatchParameters& parameters,
                               const GridPlanOptions& options = {});

  GridPlan(GridPlan&&) noexcept;
  GridPlan& operator=(GridPlan&&) noexcept;
  ~GridPlan();

  std::size_t count_u() const;  ///< parameters along u, per patch
  std::size_t count_v() const;  ///< parameters along v, per patch
  Isa isa() const;              ///< the one that runs
  Precision precision() const;  ///< of outputs
  /// Records that each view of QuantityViews must hold: patch_count * count_u * count_v.
  std::size_t capacity() const;
  /// Values that each vector of QuantityBlocks must hold: block_count * count_u * count_v * 3 * PatchSet::lanes.
  /// Scalars and kinds need a third of it.
  std::size_t block_capacity() const;
  /// Returns the work that no evaluation of these quantities can avoid; see limits.h.
  Work work(const QuantityFlags& outputs) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit GridPlan(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Views of the caller's memory, one per quantity; empty ones are not computed. T is float or double.
///
/// - Record of a grid: (patch * count_u + iu) * count_v + iv. Record of samples: the number of the sample.
/// - Positions in float are relative to the set's origin, in double absolute.
/// - Normals are unit vectors. At a degenerate point they are the limit that unit_normal() defines, or zero if there is
///   none.
/// - Forms, curvatures and directions are those of local_geometry.h. They are zero, never NaN, where undefined: the
///   normal is not regular, the tangents are parallel within rounding errors or within LocalGeometryOptions, or a
///   number is out of range (a form beyond T, a curvature beyond 2^60 in float or 2^500 in double).
template <class T>
using QuantityViews = Quantities<View3<T>, View1<T>, View1<NormalKind>, View1<CurvatureKind>>;

/// Block-interleaved memory, one span per quantity; empty ones are not computed. T is float or double.
///
/// - Shapes: `[block][iu][iv][component][lane]`; scalars and kinds `[block][iu][iv][lane]`. This is the kernels' own
///   order, and the fastest.
/// - PatchSet::slot() is the place of a patch. Unused lanes of a last block repeat a patch.
/// - Spans must be aligned to 64 bytes and must not overlap. Values are those of QuantityViews.
template <class T>
using QuantityBlocks = Quantities<std::span<T>, std::span<T>, std::span<NormalKind>, std::span<CurvatureKind>>;

/// Evaluates all patches on the grid, into views. Derivatives are by local parameters.
///
/// Outputs may share memory by interleaving but must not overlap otherwise. Whole vectors are written, streaming as
/// Execution::stores says, to packed views, to structures of arrays, and to views that fill one record together. Float
/// positions and normals that begin longer records, in this order and without other outputs, are written record by
/// record by plain stores: vertices of position, normal and uv, say, whose uv keeps its value. Other views are written
/// value by value, at a small part of the speed.
///
/// Errors, with nothing written: buffer_too_small; stale (a plan for a set with other patches or blocks);
/// invalid_argument (no output; a plan of other precision; a view that lacks a component, has a stride below 1, is
/// misaligned, or overlaps another). cancelled leaves outputs partly written.
/// Memory: allocates nothing. Threads: the same bytes for any number of threads, and on AVX2, AVX-512 and NEON; a
/// quantity has the same bytes alone and together with others.
///
/// Error bounds of each component for the Bernstein representation, in units of 2^-23 (2^-52 in double). Roundings are
/// taken as independent; the tests hold the bounds for random nets of all degrees and for steep weights. The proven
/// worst case of positions is (d + 3) size, twice that for rational patches. Terms: d, the higher degree; `size`, the
/// largest |V - origin| of the patch; `ratio`, the largest weight over the weight at the point (1 for polynomial
/// patches); h = |r_u x r_v| / max(|r_u|, |r_v|), the sine of the tangents' angle times the shorter tangent; D, the
/// largest second derivative:
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
///
/// Positions in double, which are absolute, round once more, to 2^-53 of their own size. In the power representation
/// the bounds of positions and first derivatives are (1 + 2u)^m (1 + 2v)^n ratio times as large, m and n the degrees,
/// because coefficient k is C(m,k) times a k-th difference, at most 2^k size: random bicubic patches lose 34 units,
/// degrees 5 and 7 lose 1,200 and 140,000.
///
/// Source: the bounds of positions and derivatives follow from Higham, Accuracy and Stability of Numerical Algorithms,
/// 2nd ed., sec. 3.1, and the quotient rule (Piegl and Tiller, The NURBS Book, eq. 4.20). The other bounds follow to
/// first order in the errors of the tangents, which must be small against h, from the formulas of normal and curvatures
/// (do Carmo, Differential Geometry of Curves and Surfaces, sec. 3.3). The loss of the power representation: Farouki
/// and Rajan 1987, On the numerical condition of polynomials in Bernstein form.
template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityViews<T>& out,
                const Execution& execution = {});
/// Evaluates all patches on the grid, into blocks. Plans with parameters that differ from patch to patch write plain
/// stores. Errors, memory, threads and bounds: as for views.
template <class T>
Status evaluate(const PatchSet& set, const GridPlan& plan, const QuantityBlocks<T>& out,
                const Execution& execution = {});

/// How parameters outside of a patch's [0,1]^2, or of a surface's domain, are treated.
enum class OutsideDomain : std::uint8_t {
  error,        ///< invalid_argument, index = the first such sample
  clamp,        ///< the nearest parameter inside counts
  extrapolate,  ///< polynomials continue; results have no error bounds and may be infinite or NaN
};

/// How samples are evaluated.
struct PointOptions {
  OutsideDomain outside = OutsideDomain::error;  ///< for samples that lie outside
  std::optional<Isa> isa = {};                   ///< default_isa() if empty
  LocalGeometryOptions geometry = {};            ///< as in GridPlanOptions
};

/// Samples on patches: sample k lies at (u[k], v[k]) of patch[k]. `patch` has one record per sample; u and v hold at
/// least as many.
template <class T>
struct PatchSamples {
  View1<const std::uint32_t> patch = {};  ///< below patch_count()
  View1<const T> u = {}, v = {};          ///< in the patch's [0,1]^2
};

/// Evaluates all samples. Derivatives are by the patch's parameters.
///
/// A set without BlockKinds::float_points (double_points) packs these coefficients at the first call, and at the first
/// one after each edit. Samples may come in any order; those sorted by patch, a dozen or more per patch, run up to
/// twice as fast. Arrays (views of stride 1) are read in place, other views are copied first.
///
/// Errors, with nothing written: buffer_too_small, count_mismatch (fewer u or v than patches), invalid_argument (no
/// output; a view that lacks a component, is misaligned, has a stride below 1, or overlaps another; index = the sample:
/// no such patch, a parameter outside [0,1]), non_finite (index = the sample; or the patch, if its coefficients are out
/// of the range of the numbers), isa_unavailable, out_of_memory. cancelled leaves outputs partly written.
/// Memory: that of BlockKinds::float_points (double_points), unless the set holds them; else none.
/// Threads: the same bytes for any number of threads, any order of the samples, any choice
/// of outputs, and on AVX2 and AVX-512 (NEON is not tested).
///
/// Error bounds: as for grids, with exact parameters. On SSE2, where weights are made without fused multiply-adds:
/// positions 2 + d / 2, rational ones 4 + d.
template <class T>
Status evaluate(const PatchSet& set, const PatchSamples<T>& samples, const QuantityViews<T>& out,
                const PointOptions& options = {}, const Execution& execution = {});

/// The map from the parameters of a set's surfaces to its patches: the breakpoints of each surface, from
/// PatchSet::source(). Immutable; edits of control points keep it valid. Memory: 128 bytes per patch.
class SurfaceMap {
 public:
  /// The patches of each surface must be those of a PatchGrid, in its order and without gaps. make_patch_set() makes
  /// such sets. Errors: unsupported (a surface whose patches are not; index = the surface), out_of_memory.
  static Result<SurfaceMap> make(const PatchSet& set);

  SurfaceMap(SurfaceMap&&) noexcept;
  SurfaceMap& operator=(SurfaceMap&&) noexcept;
  ~SurfaceMap();

  std::size_t surface_count() const;  ///< one more than the largest number of a source
  /// Returns a surface's rectangle of parameters; nothing if no patch's source has this number. Needs surface <
  /// surface_count().
  std::optional<Domain> domain(std::size_t surface) const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit SurfaceMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Samples on surfaces: sample k lies at (u[k], v[k]) of surface[k], in that surface's own parameters. `u` has one
/// record per sample; v and `surface` hold at least as many.
struct SurfaceSamples {
  View1<const std::uint32_t> surface = {};  ///< empty: all lie on surface 0
  View1<const double> u = {}, v = {};       ///< in the surface's domain
};

/// Evaluates all samples. Finds each sample's patch, on a breakpoint the one with larger parameters. Derivatives and
/// the two forms are by the surface's parameters.
///
/// Errors: as for samples on patches, stale (a map of another set), and invalid_argument (index = the sample: no such
/// surface, a parameter outside of its domain). Memory and threads: as for samples on patches.
///
/// Error bounds: parameters within the patch are found in double and rounded to T. Results in float are further off, in
/// the units and terms of grids: positions by d / 2 size ratio, first derivatives by d^2 size, rational ones by 2 d^2
/// size ratio^2.
template <class T>
Status evaluate(const PatchSet& set, const SurfaceMap& map, const SurfaceSamples& samples, const QuantityViews<T>& out,
                const PointOptions& options = {}, const Execution& execution = {});

/// New control points for some patches. The points of patch[k] follow those of patch[k - 1]: (degree_u + 1) *
/// (degree_v + 1) points `[i][j]`, i along u, as BezierPatch::points(). Weights and degrees stay.
struct PatchEdits {
  std::span<const std::uint32_t> patch = {};  ///< each at most once; the set's own order is fastest
  std::span<const Vec3> points = {};          ///< patch after patch
};

/// Grids that follow edits. Holds the memory for updates of one set, so that repeated ones allocate nothing. Memory: 16
/// bytes per patch. Threads: one call at a time for each object and its set.
class GridUpdate {
 public:
  /// Errors: out_of_memory.
  static Result<GridUpdate> make(const PatchSet& set);

  GridUpdate(GridUpdate&&) noexcept;
  GridUpdate& operator=(GridUpdate&&) noexcept;
  ~GridUpdate();

  /// Sets the control points of each edit, as PatchSet::set_control_points(), and evaluates these patches alone. `out`
  /// are views of all patches, as evaluate() takes them; records of other patches are neither written nor read.
  ///
  /// The result has the same bytes as calls of these two functions. The revision grows by one, unless there is no edit.
  ///
  /// Errors, with nothing written: those of evaluate(); unsupported (a plan with parameters of each patch's own); stale
  /// (a set other than that of make()); invalid_argument (index = the edit: no such patch, or one that an earlier edit
  /// names); count_mismatch (points); non_finite (index = the edit: a point is not finite, or does not fit the set's
  /// numbers relative to its origin); out_of_memory. cancelled: each patch has its new control points and its new grid,
  /// or neither.
  ///
  /// Memory: the first update of a patch copies its control points, if other patches share their memory; later updates
  /// allocate nothing. Threads: the same bytes for any number of threads of the arena.
  template <class T>
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityViews<T>& out,
             const Execution& execution = {});
  /// Like the call above, into block-interleaved memory of all patches. A block with an edited patch is evaluated
  /// whole: its other lanes are written again, with the same bytes. Errors, memory and threads: as above.
  template <class T>
  Status run(PatchSet& set, const GridPlan& plan, const PatchEdits& edits, const QuantityBlocks<T>& out,
             const Execution& execution = {});

 private:
  class [[gnu::visibility("hidden")]] Impl;
  explicit GridUpdate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The threads that may call a surface's functions.
enum class Calls : std::uint8_t {
  one_thread,  ///< the caller's
  concurrent,  ///< any, several at once
};

/// Writes the positions at (u[i], v[j]) to record i * v.size() + j, with one call of the surface's function per record.
///
/// - `u`, `v`: parameters in the domain, in any order.
/// - `out`: u.size() * v.size() records. Positions are absolute.
///
/// Errors, with nothing written: non_finite and invalid_argument (index = a parameter that is not finite, or outside
/// the domain), invalid_argument (no parameters; a view that lacks a component or a stride, is misaligned, or shares
/// memory with another), buffer_too_small. Errors, with the output partly written: those of the function (of the first
/// record that has one), non_finite (a position too large for float), cancelled.
///
/// Memory: allocates nothing beyond what the function does. Threads: `calls` says which may call the function; the same
/// bytes for any number of threads.
template <class T>
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<T>& out, const Execution& execution = {}, Calls calls = Calls::one_thread);

/// Writes the positions at (u[i], v[j]) to record i * v.size() + j. Each border curve and each blending function is
/// called once per parameter, from the calling thread: 2 (Nu + Nv) curve calls for a Coons patch, 2 Nu or 2 Nv for a
/// ruled surface.
///
/// - `u`, `v`: parameters in the domain, in any order.
/// - `out`: u.size() * v.size() records. Positions are absolute.
///
/// Errors: invalid_argument and buffer_too_small (as above), non_finite (the sum of the bound below may be too large
/// for the precision), cancelled, isa_unavailable, those of functions. Only cancelled leaves anything written.
///
/// Memory beyond the output: O(Nu + Nv). Threads: the same bytes for any number of threads, and on AVX2, AVX-512 and
/// NEON.
///
/// Error bound: positions differ from position(surface, u, v) by at most 5 units of 2^-23 (8 of 2^-52 in double) times
/// the largest |g1 C1| + |g2 C2| + |f1 K1| + |f2 K2|, where K_a = D_a - r_a0 g1 - r_a1 g2; a ruled surface has no K.
template <class T>
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution = {});
template <class T>
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
