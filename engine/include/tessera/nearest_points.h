#pragma once
// Finds the points of a patch set that are nearest to given ones: single points, and arrays in float or double.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

struct Model;

/// Whether a nearest point was found.
enum class NearestKind : std::uint8_t {
  none,   ///< the surface is farther away than the largest distance that was asked for
  found,  ///< all members are meaningful
  /// The point is not finite or more than 1e139 sizes of the model away, or the largest distance is negative or NaN.
  invalid_point,
};

/// Properties of a nearest point.
struct NearestFlags {
  /// No other point of the surface is nearer by more than NearestPoint::rounding: proven. For `none`: no point of the
  /// surface lies within the largest distance by more than that.
  bool certified : 1 = false;
  /// Another point, more than 1e-6 of the size away, is as near up to rounding, as in the middle between two planes.
  bool ambiguous : 1 = false;
  /// The line to the nearest point is not perpendicular to the surface: the point lies on a border of what loops keep,
  /// on a border of the surface, or on a crease between patches.
  bool border : 1 = false;
  bool degenerate_normal : 1 = false;  ///< the normal is a limit at a degenerate point, or undefined (zero)
};

/// The point of a surface that is nearest to a given one.
struct NearestPoint {
  NearestKind kind = NearestKind::none;                       ///< whether the other members are meaningful
  NearestFlags flags;                                         ///< what is proven, and what is special
  std::uint32_t surface = 0, patch = 0;                       ///< PatchSource::surface, and the index in the set
  double u = 0, v = 0;                                        ///< in the surface's domain
  double patch_u = 0, patch_v = 0;                            ///< in the patch, [0,1]^2
  Vec3 position;                                              ///< on the surface at (u,v)
  Vec3 normal;                                                ///< unit, along du x dv
  double distance = std::numeric_limits<double>::infinity();  ///< from the point that was asked for
  double rounding = 0;                                        ///< bounds the rounding of the distance
};

/// Places of surfaces for several points: places[first[k]] to places[first[k + 1] - 1] are those of point k, by patches
/// and parameters.
struct SurfacePlaces {
  std::vector<NearestPoint> places;  ///< point after point
  std::vector<std::size_t> first;    ///< one more than there are points
};

/// A patch set prepared for queries by points.
///
/// Method: patches are cut into pieces that are nearly flat, which lie in a tree of boxes. Within a piece, bounds of
/// derivatives prove that the distance is convex or monotone, then Newton's method finds its one minimum; other pieces
/// are halved. Where loops cut a face, the curves that bound the kept part are searched as well. Kernels of
/// default_isa() measure boxes and evaluate bicubic patches.
///
/// Memory: the set must outlive the scene, unless the scene keeps it; it may be moved. About 340 bytes per piece. After
/// an edit of the set the scene is stale until refit(), and its queries fail.
///
/// Threads: const calls from any number of threads, with the same results; edits of the set and refit exclude them.
class PointScene {
 public:
  /// Makes the pieces and the tree of a set.
  ///
  /// Errors: unsupported (the box of the set has a diagonal outside of 1e-140 to 1e140; 2^31 pieces), isa_unavailable,
  /// cancelled, out_of_memory.
  static Result<PointScene> make(const PatchSet& set, const Execution& execution = {});
  /// Makes a scene that keeps the set itself. Errors: as above.
  static Result<PointScene> make(PatchSet&& set, const Execution& execution = {});
  /// Makes a scene of a model in one call. Errors: as above; those of make_patch_set(); the first of
  /// PatchSet::trim_faults(), for loops that cannot be used (index = the surface).
  static Result<PointScene> make(const Model& model, const Execution& execution = {});

  PointScene(PointScene&&) noexcept;
  PointScene& operator=(PointScene&&) noexcept;
  ~PointScene();

  /// Finds the nearest point of the surface to each point, of what loops keep of it.
  ///
  /// - `points`: in the model's coordinates.
  /// - `nearest`: at least as many. A point that is not finite is NearestKind::invalid_point.
  /// - `max_distance`: surfaces farther away count as none; at least 0.
  ///
  /// If several points are equally near, the one of the first patch is returned.
  ///
  /// Errors: buffer_too_small, invalid_argument (max_distance), stale, cancelled, out_of_memory.
  Status nearest(std::span<const Vec3> points, std::span<NearestPoint> nearest,
                 double max_distance = std::numeric_limits<double>::infinity(), const Execution& execution = {}) const;
  /// Finds the nearest point to one point. A stale scene, as any error, returns NearestKind::invalid_point.
  NearestPoint nearest(const Vec3& point, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Finds the nearest points of the nearest patches to each point, one of each patch.
  ///
  /// - `count`: patches for each point, 1 to 2^20.
  /// - `nearest`: at least `count` for each point, `[point][k]`, the nearest first; NearestKind::none where there are
  ///   fewer patches within max_distance. NearestFlags::certified: no patch that is not listed is nearer, and no other
  ///   point of a listed one. `ambiguous` is not set.
  ///
  /// Errors: those of nearest(); invalid_argument (count).
  Status nearest_patches(std::span<const Vec3> points, std::size_t count, std::span<NearestPoint> nearest,
                         double max_distance = std::numeric_limits<double>::infinity(),
                         const Execution& execution = {}) const;

  /// Finds all places of the surface within a distance of each point, such as the parameters of points that lie on it.
  /// A point at a border that patches share has a place in each of them; one at a pole has one in each patch.
  ///
  /// - `distance`: how far a place may be away, above 0, at most 1e-3 of the size. Places of one patch that are nearer
  ///   to each other than four times that count as one, the nearest.
  ///
  /// A point that is not finite has no places. NearestFlags::certified: there are no others.
  ///
  /// Errors, with empty lists: invalid_argument (distance), stale, cancelled, out_of_memory. Memory: that of `places`
  /// is reused.
  Status places(std::span<const Vec3> points, double distance, SurfacePlaces& places,
                const Execution& execution = {}) const;

  /// Updates the scene after edits of the set, and does nothing if nothing was edited. Pieces are cut as they were, and
  /// the tree keeps its shape, unless the set's box has left the range that coordinates are scaled to. Errors: as
  /// make(); the scene is then stale until a refit succeeds.
  Status refit(const Execution& execution = {});

  std::uint64_t revision() const;    ///< the set's, when the scene was made or last refitted
  std::size_t memory_bytes() const;  ///< of pieces, curves and tree

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit PointScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Points as arrays: point k has record k of each view. There are as many points as `position` has records. Numbers are
/// converted to double, which is exact.
template <class T>
struct PointViews {
  View3<const T> position = {};  ///< required; in the model's coordinates
  /// Surfaces farther away count as none, at least 0. Empty: infinity. Stride 0: record 0 belongs to all points.
  View1<const T> max_distance = {};
  /// The nearest points of so many patches are wanted, 1 to 2^20: record k * patches + j of outputs is the j-th of
  /// point k, as PointScene::nearest_patches() has them. For 1, the nearest point.
  std::size_t patches = 1;
};

/// Nearest points as arrays: record k of each view is written for point k. Units are those of NearestPoint, whose
/// double numbers are rounded to T. Empty views are not computed. For none and for an invalid point, the distance is
/// infinite, indices are no_id, flags are those of NearestPoint, and all else is 0.
template <class T>
struct NearestViews {
  View1<NearestKind> kind = {};                   ///< found, none or invalid_point
  View1<std::uint32_t> patch = {}, surface = {};  ///< as in NearestPoint
  View1<T> u = {}, v = {};                        ///< in the surface's domain
  View1<T> patch_u = {}, patch_v = {};            ///< in the patch, [0,1]^2
  View1<T> distance = {};                         ///< as in NearestPoint
  View3<T> position = {}, normal = {};            ///< as in NearestPoint
  View1<NearestFlags> flags = {};                 ///< as in NearestPoint
};

/// Finds the nearest point of the surface to each point, or those of several patches: that of PointScene::nearest() for
/// the same numbers in double, bit for bit. A point whose largest distance is negative or NaN is an invalid point.
///
/// Errors, with nothing written: count_mismatch (fewer largest distances than points), buffer_too_small (an output with
/// too few records), invalid_argument (`patches`; no output; a view that lacks a component, is misaligned, or has a
/// stride below 0, below 1 for an output; an output that shares memory with another view), stale. Errors that leave
/// outputs partly written: cancelled, out_of_memory.
Status nearest(const PointScene& scene, const PointViews<float>& points, const NearestViews<float>& nearest,
               const Execution& execution = {});
Status nearest(const PointScene& scene, const PointViews<float>& points, const NearestViews<double>& nearest,
               const Execution& execution = {});
Status nearest(const PointScene& scene, const PointViews<double>& points, const NearestViews<float>& nearest,
               const Execution& execution = {});
Status nearest(const PointScene& scene, const PointViews<double>& points, const NearestViews<double>& nearest,
               const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
