#pragma once
// Rays by the million as renderers hold them: arrays in float or double, and of each hit only what is asked for.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include "tessera/execution.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"
#include "tessera/views.h"

#pragma GCC visibility push(default)
namespace tessera {

/// Rays as arrays: ray k has record k of each view. There are as many rays as `direction` has records. The other views
/// hold at least as many; or they have stride 0, and their record 0 belongs to all rays, such as the eye of a camera.
/// Ranges and units are those of Ray. Numbers are taken to double, which is exact: a hit is that of the ray as given.
template <class T>
struct RayViews {
  View3<const T> origin = {}, direction = {};  ///< required
  View1<const T> tnear = {};                   ///< empty: 0
  View1<const T> tfar = {};                    ///< empty: infinity
  View1<const T> spawn_offset = {};            ///< empty: 0
  /// An instance is met where its mask and the ray's have a bit in common; scenes without instances take no notice.
  /// Empty: all bits.
  View1<const std::uint32_t> mask = {};
};

/// Hits as arrays: record k of each view is written for ray k. Empty views are not computed: t, parameters and indices
/// alone need no point of the surface. Units are those of Hit, from whose double numbers are rounded to T. Positions
/// are in the model's coordinates, in float too. A miss and an invalid ray get t = infinity, `no_hit` for each index,
/// no flag but `incomplete`, and 0 elsewhere.
template <class T>
struct HitViews {
  static constexpr std::uint32_t no_hit = std::numeric_limits<std::uint32_t>::max();
  View1<HitKind> kind = {};                               ///< hit, miss or invalid_ray
  View1<T> t = {};                                        ///< in [tnear, tfar], where these are numbers of T
  View1<T> u = {}, v = {};                                ///< in the surface's domain
  View1<T> patch_u = {}, patch_v = {};                    ///< in the patch, [0,1]^2
  View1<std::uint32_t> patch = {}, surface = {};          ///< as in Hit
  View1<std::uint32_t> instance = {};                     ///< no_hit in scenes that are not of instances
  View3<T> position = {}, normal = {}, du = {}, dv = {};  ///< as in Hit
  View1<T> residual = {};                                 ///< as in Hit
  View1<HitFlags> flags = {};                             ///< the normal decides one of them and is computed for it
};

/// A point where a ray meets a surface, before it counts as a hit.
struct HitCandidate {
  std::size_t ray = 0;                            ///< index in the batch
  std::uint32_t instance = Hit::no_instance;      ///< as in Hit
  std::uint32_t surface = 0, patch = 0;           ///< as in Hit
  double t = 0;                                   ///< as in Hit
  double u = 0, v = 0, patch_u = 0, patch_v = 0;  ///< as in Hit
};

/// A filter's answer. Any other number stops the batch.
enum class HitVerdict : std::uint8_t {
  accept,  ///< the point may be the hit
  reject,  ///< the ray goes on as if the surface had a hole there
  stop,    ///< the batch ends
};

/// Decides which points count: cut-outs by a texture, layers that a ray does not see. The points of a ray come in any
/// order, and not all of them: of closest hits only those that would be nearer than all accepted ones. A point at the
/// border of two patches, or of two pieces of one, may come once for each. Threads: called from any, several at once.
/// It may trace rays and may throw; see closest().
using HitFilter = std::function<HitVerdict(const HitCandidate&)>;

/// Options of a batch. Everything is optional.
struct BatchOptions {
  HitFilter filter = {};  ///< exact mode. Empty: all points count
};

/// Finds the closest hit of each ray: that of RayScene::closest for the same numbers in double, bit for bit. Rays that
/// follow on each other and are coherent are traced in packets. A ray that is not valid is a miss with
/// HitKind::invalid_ray. Without rays nothing is looked at or written. Allocates nothing, but for borders as
/// RayScene::closest.
/// Errors, with nothing written: count_mismatch (a view of rays with fewer records than `direction`), buffer_too_small
/// (an output with fewer), invalid_argument (no output; a view that lacks a component, is misaligned, has a stride
/// below 0, or below 1 as an output; an output that shares memory with another view), unsupported (a filter in grid
/// mode), stale.
/// Errors that leave outputs partly written: cancelled (by `execution`, or by the filter: index = the ray),
/// out_of_memory, and the exception of a filter (internal with its message, or out_of_memory).
Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<float>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<double>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<float>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<double>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});

/// Writes 1 where anything lies on the ray, 0 where not or where the ray is not valid, as RayScene::occluded. The
/// output is required. Errors: those of closest().
Status occluded(const RayScene& scene, const RayViews<float>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options = {}, const Execution& execution = {});
Status occluded(const RayScene& scene, const RayViews<double>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options = {}, const Execution& execution = {});

}  // namespace tessera
#pragma GCC visibility pop
