#pragma once
// Evaluation at scattered points: each sample names its patch, or its surface, and its parameters.

#include <cstdint>
#include <memory>
#include <optional>

#include "tessera/domain.h"
#include "tessera/evaluate.h"
#include "tessera/execution.h"
#include "tessera/isa.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/views.h"

#pragma GCC visibility push(default)
namespace tessera {

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

/// Record k of each view belongs to sample k. Otherwise as GridViews says; any subset in one pass.
template <class T>
using PointViews = GridViews<T>;

/// Evaluates all samples, in any order of patches; samples that come sorted by patch, a dozen or more of a patch in
/// a row, run up to twice as fast as others. Arrays (views of stride 1) are read where they lie, others copied first.
/// The set must hold BlockKinds::float_points (double_points). Allocates nothing.
/// Positions in float are relative to the set's origin, in double absolute; derivatives are by the patch's parameters.
/// Degenerate points as in GridViews, by unit_normal().
/// Errors, with nothing written: unsupported (the set lacks the coefficients), buffer_too_small, count_mismatch (fewer
/// u or v than patches), invalid_argument (no output; views that lack a component, that are misaligned, whose stride is
/// below 1, that share memory with another view; index = the sample: no such patch, parameter outside [0,1]), non_finite
/// (index = the sample), isa_unavailable; cancelled, which may leave outputs partly written.
/// The same bytes for any number of threads, for any order of the samples and choice of outputs, and on AVX2 and
/// AVX-512. Bounds as for grids (evaluate.h), the parameters taken as exact; on SSE2 positions 2 + d / 2, rational ones
/// 4 + d, for weights are made without fused multiply-adds there.
Status evaluate(const PatchSet& set, const PatchSamples<float>& samples, const PointViews<float>& out,
                const PointOptions& options = {}, const Execution& execution = {});
Status evaluate(const PatchSet& set, const PatchSamples<double>& samples, const PointViews<double>& out,
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
  const Impl& impl() const { return *impl_; }  ///< for the library's own use

 private:
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
Status evaluate(const PatchSet& set, const SurfaceMap& map, const SurfaceSamples& samples, const PointViews<float>& out,
                const PointOptions& options = {}, const Execution& execution = {});
Status evaluate(const PatchSet& set, const SurfaceMap& map, const SurfaceSamples& samples,
                const PointViews<double>& out, const PointOptions& options = {}, const Execution& execution = {});

}  // namespace tessera
#pragma GCC visibility pop
