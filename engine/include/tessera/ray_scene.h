#pragma once
// Ray queries on a patch set: single rays, and arrays of rays in float or double as renderers hold them.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/local_geometry.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Points origin + t * direction, tnear <= t <= tfar, in the model's coordinates. The direction need not be a unit
/// vector. Valid: finite origin and direction with components of at most 1.844e18, direction not zero, 0 <= tnear <=
/// tfar; tfar may be infinite; a spawn_offset of 0 to 1.844e18. Both ends belong to the interval and hold for the refined
/// t, in double.
struct Ray {
  Vec3 origin = {}, direction = {};                       ///< in the model
  double tnear = 0;                                       ///< at least 0
  double tfar = std::numeric_limits<double>::infinity();  ///< at least tnear
  /// Exact mode: above 0, the ray leaves the surfaces that pass its origin at no more than this distance: the root of each
  /// of them that stands for the origin is no hit, wherever rounding has moved it. For an origin that is a hit's position
  /// this is RayScene::spawn_offset(). Which root that is follows from Kantorovich's theorem, which shows that there is one
  /// within so much of the origin and no other near it: other hits stay, at however small a distance and angle, as long as
  /// the surface leaves the ray in between by more than the tolerance. Where it does not, as along a plane or over a chord
  /// of sqrt(8 tolerance / curvature), all of that is the origin.
  double spawn_offset = 0;
};
/// The largest magnitude of a valid ray's components: about the square root of float's range, Embree's limit.
inline constexpr double max_ray_component = 1.844e18;
/// Whether a ray is valid, as Ray says.
bool is_valid(const Ray& ray);

enum class HitKind : std::uint8_t {
  miss,
  hit,
  invalid_ray,  ///< treated as a miss
};

/// What is to be known about a hit beside its numbers.
struct HitFlags {
  bool unrefined : 1 = false;  ///< Newton did not converge inside the patch: t, position, u, v are those of the facet
  bool degenerate_normal : 1 = false;  ///< the normal is a limit at a degenerate point, or undefined (zero)
  /// Exact mode: the point lies on the ray within the tolerance, but it was not proven to be the one root of the surface
  /// thereabouts. The ray touches the surface or runs along it (t is then good to about the square root of tolerance
  /// times size), meets a pole, or passes a border by less than the tolerance.
  bool uncertified : 1 = false;
  /// Exact mode: the bound on the work for one piece of a patch was reached, as where a surface runs along the ray or
  /// is folded up into a line. There may be other hits, of a miss too.
  bool incomplete : 1 = false;
  /// Exact mode, of uncertified hits: the ray runs along the tangent plane, within 1e-3 of its direction.
  bool tangential : 1 = false;
  /// Exact mode, of uncertified hits: the position is off the ray by more than rounding, yet within the tolerance.
  bool within_tolerance : 1 = false;
};

/// Where a ray meets a surface. Of a miss and an invalid ray only the kind counts.
struct Hit {
  HitKind kind = HitKind::miss;  ///< whether the rest means anything
  HitFlags flags;                ///< what the numbers don't say
  std::uint16_t steps =
      0;  ///< exact mode: the work, pieces of patches looked at and parts of them searched; of misses too
  std::uint32_t surface = 0, patch = 0;  ///< PatchSource::surface, and the index in the set
  static constexpr std::uint32_t no_instance = std::numeric_limits<std::uint32_t>::max();  ///< of other scenes' hits
  std::uint32_t instance = no_instance;                ///< index, in a scene of instances
  double t = std::numeric_limits<double>::infinity();  ///< position = origin + t * direction, up to the residual
  double u = 0, v = 0;                                 ///< in the surface's domain
  double patch_u = 0, patch_v = 0;                     ///< in the patch, [0,1]^2
  Vec3 position;                                       ///< on the surface at (u,v)
  Vec3 normal;                                         ///< unit, along du x dv
  Vec3 du, dv;          ///< derivatives of the position by u and by v, the surface's; to about 1e-8
  double residual = 0;  ///< distance from the position to the ray; of an unrefined hit, to the surface at (u,v)
};

/// The hits of several rays one after the other: of ray k, in the order of t, hits[first[k]] to hits[first[k + 1] - 1].
struct HitLists {
  std::vector<Hit> hits;           ///< ray after ray
  std::vector<std::size_t> first;  ///< one more than rays
};

enum class RayMode : std::uint8_t {
  /// Evaluated grids in an Embree BVH, then Newton on the surface: every hit that is not flagged lies on it. Facets
  /// decide what is met and in which order: a silhouette may be missed or flagged, and of two surfaces nearer to each
  /// other than to their facets the farther one may come first. What the tessellation shows, with true t, u, v and
  /// normals.
  grid,
  /// The surface itself: pieces of patches in an Embree BVH, each searched by interval Newton steps in float and, where
  /// these prove nothing, by branch and bound in double, with every rounding bounded, far origins included. What the
  /// surface of the control points in double meets is hit, at shared borders and poles too, silhouettes down to the
  /// tolerance; a returned hit lies within the tolerance of the ray. Hits that are not flagged uncertified are roots up
  /// to rounding.
  exact,
};

/// How a scene is made.
struct RaySceneOptions {
  RayMode mode = RayMode::exact;  ///< what rays are to meet
  int rate = 8;                   ///< grid mode: grid segments a patch and direction, 1 to 4096
  bool refine = true;             ///< grid mode: false leaves hits on the facets (for comparison)
  std::optional<Isa> isa = {};    ///< the hits of exact mode are those of every one, up to rounding
  /// Exact mode: pieces a patch and direction at least, 1, 2, 4 or 8. Patches that are bent, twisted or much longer than wide
  /// are cut into more, up to 64 a direction, by their own shape alone.
  int pieces = 1;
  /// Exact mode: how far from the ray a point that is returned may lie, in the model's unit; above 0. It counts where
  /// the ray touches the surface or passes a border: there points within it may be hits. By default 2e-12 of the set's
  /// size; smaller ones than twice the bound on rounding (2e-12 of the size for bicubic patches, 9e-12 at degree 15,
  /// at the most; a third more after edits) are raised to that.
  std::optional<double> tolerance = {};
  /// Exact mode: the box that takes the place of the set's wherever the scene's size and centre count; it holds the set's,
  /// after edits too. Parts of a model, each in a scene of its own with the model's box and the other options alike, return
  /// the numbers that the scene of the whole returns, to the last bit: the nearest of their closest hits is its closest hit.
  /// A flag may be missing, `uncertified` where it is a neighbour that makes a hit unsure.
  std::optional<Box3> box = {};
  /// Exact mode: so many patches of the set, its first ones, are the scene's; those behind are neighbours, which decide
  /// where a point at a border belongs, and are never hit themselves. Parts that have each the patches of the others that
  /// share borders and corners with them return among them each hit of the whole, in all() as well, once. By default all.
  std::optional<std::size_t> patches = {};
  /// Exact mode: makes ready for edits at once; else the first refit does, which then takes as long as a rebuild. Rays in a
  /// scene that follows edits take about a fifth longer.
  bool editable = false;
  int rebuild_after = 0;  ///< exact mode: of so many refits each last one is a rebuild; 0: none is, 1: all are
};

class RayScene;

/// A scene that stands elsewhere: its patches, taken through an affine map. Mirrors are allowed, and scales that differ by
/// direction; a condition number above 1e8 is not.
struct RayInstance {
  const RayScene* scene = nullptr;  ///< of patches, in exact mode
  Affine to_world = {};             ///< from the scene to where it stands
  /// Rays of batches with masks (ray_batch.h) meet it where both masks have a bit in common; other rays have all bits.
  std::uint32_t mask = ~std::uint32_t{0};
};

/// A patch set ready for rays. Keeps a reference to the set's inner state: the set must outlive the scene (it may be
/// moved). Threads: const calls from any number of threads; edits of the set, refit and rebuild exclude them and each
/// other.
class RayScene {
 public:
  /// Errors: invalid_argument (the rate, the pieces, the tolerance, the box, more patches than the set has, rebuild_after),
  /// isa_unavailable, cancelled, out_of_memory, internal (Embree's own), unsupported. Grid mode: unsupported are no float
  /// Bernstein blocks, a box with a diagonal below 1e-9 or reaching further than 1e12 from the set's origin, more than 2^32
  /// grid points. Exact mode: unsupported are a diagonal outside of 1e-140 to 1e140, 2^32 pieces.
  static Result<RayScene> make(const PatchSet& set, const RaySceneOptions& options = {},
                               const Execution& execution = {});
  /// Deleted: the set must outlive the scene.
  static Result<RayScene> make(PatchSet&& set, const RaySceneOptions& options = {},
                               const Execution& execution = {}) = delete;

  /// Grid mode on facets that are there: the triangles and quads of a mesh of the set, such as one that keeps a tolerance,
  /// in the memory where they are. It must stay there, and change only between edit and refit of the set. Of its positions
  /// a copy is made if their vector has no room for one number more. Of the options `refine` and `isa` count.
  /// Errors: invalid_argument (no patch of each face or no parameters of each vertex, as where vertices are shared; another
  /// origin than the set's; index = the vertex or the face: numbers that are not finite, parameters outside of [0, 1], an
  /// index that is no vertex, a patch that the set does not have), and those of grid mode.
  static Result<RayScene> make(const PatchSet& set, const Mesh& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {});
  /// Deleted: the set and the mesh must outlive the scene.
  static Result<RayScene> make(const PatchSet& set, Mesh&& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {}) = delete;
  static Result<RayScene> make(PatchSet&& set, const Mesh& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {}) = delete;

  /// A scene of instances, of one scene or several, which must outlive it (they may be moved). Positions, normals and
  /// residuals of its hits are in the world, surface, patch and parameters those of the instance's scene; normals are
  /// along r_u x r_v there, so on the other side in an instance that is mirrored.
  /// What exact mode says holds of the ray as taken back into an instance's coordinates, in double: all patches of an
  /// instance see the same one, so nothing leaks between them. The map rounds it by 1e-15 times its condition number, of
  /// the instance's size, however far away its origin is, and tnear and tfar hold to the last digit; the residual is the
  /// distance from the ray as given. Nothing is promised where borders of two instances meet. The tolerance is that of the
  /// instance's scene, a length there.
  /// After a refit of one of the scenes this one is stale until it is refitted itself, which is always a rebuild, of the
  /// boxes of instances alone.
  /// Errors: invalid_argument (no instance; of the first one: no scene, a map that is not finite or nearly singular),
  /// unsupported (of the first one: a scene in grid mode or of instances; sizes outside of 1e-140 to 1e140), stale (a
  /// scene), cancelled, out_of_memory, internal (Embree's own). index = the instance.
  static Result<RayScene> make(std::span<const RayInstance> instances, const Execution& execution = {});

  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// The closest hit of each ray; hits.size() >= rays.size(). A ray that is not valid is a miss with
  /// HitKind::invalid_ray. Allocates nothing, but that the first ray with a spawn_offset after a build or a refit looks for
  /// the borders that patches share. Errors: buffer_too_small, stale (the set was edited: refit), cancelled, out_of_memory.
  Status closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution = {}) const;
  /// 1 where anything lies on the ray, 0 where not or where the ray is not valid; occluded.size() >= rays.size().
  /// In grid mode the facets decide, not the surface: a ray that leaves the surface must begin further off than they
  /// lie.
  Status occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, const Execution& execution = {}) const;
  /// All hits of each ray, in exact mode. A point that several pieces or neighbours share is one hit: two are the same
  /// where they coincide on a patch or at a shared border, not where they are merely near in t. Rays that are not valid
  /// have none. Memory of `lists` is used again; the first call after a build or a refit looks for the borders that
  /// patches share. Errors: unsupported (grid mode), stale, cancelled, out_of_memory; the lists are then empty.
  Status all(std::span<const Ray> rays, HitLists& lists, const Execution& execution = {}) const;
  /// One ray. A stale scene gives a miss with HitKind::invalid_ray.
  Hit closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const;  ///< one ray; false while the scene is stale

  /// After edits of the set, whichever way they were made; between an edit and its refit all queries are errors. Exact
  /// mode: makes the pieces of the edited patches anew, cut as they were, and refits the BVH, whose boxes overlap more the
  /// further patches have moved: rays then take longer, until a rebuild. It is a rebuild where the set's box has left the
  /// range that coordinates are scaled to, twice as large or half as large at the most, and in grid mode. Nothing is done
  /// where nothing was edited. Errors: those of make; the scene then stays stale until a refit or a rebuild succeeds.
  Status refit(const Execution& execution = {});
  /// As made anew: all pieces or grids, and the BVH. Errors: as those of refit.
  Status rebuild(const Execution& execution = {});

  /// How far a hit's position may be from its surface, for rounding: the offset of secondary rays. Flags unrefined and
  /// those of grid mode aside.
  double spawn_offset() const;
  /// Curvatures at a hit of this scene, with parameters those of the patch; in a scene of instances those of the surface as
  /// it stands in the world. Errors: stale, invalid_argument (not a hit; no such patch, point or instance).
  Result<LocalGeometry> local_geometry(const Hit& hit) const;
  /// The point (u,v) in [0,1]^2 of a patch as a hit, t and residual 0: what else there is to know of a hit that came through
  /// one's own Embree scene. Errors: stale, invalid_argument (no such patch or point), unsupported (instances).
  Result<Hit> resolve(std::uint32_t patch, double u, double v) const;
  /// The same for a ray that is known to meet the patch near (u,v), in float for example: the root next to it with all the
  /// digits of double. The hit is unrefined where there is none within the tolerance, and is then the point nearest to the
  /// ray that was found. tnear and tfar count for nothing. Errors: as above; invalid_argument (the ray); unsupported (grid
  /// mode).
  Result<Hit> resolve(const Ray& ray, std::uint32_t patch, double u, double v) const;

  Box3 box() const;                ///< of facets or pieces' nets: tighter than of all control points; empty while stale
  std::uint64_t revision() const;  ///< of the set, when the scene was made or last refitted
  /// Grids or nets, and BVH; of instances without their scenes. To make it, 128 bytes a patch more.
  std::size_t memory_bytes() const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit RayScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

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

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
