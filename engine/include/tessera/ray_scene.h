#pragma once
// Traces rays against a patch set: single rays, and arrays of rays in float or double as renderers hold them.

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
#include "tessera/ray_hit.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

struct Model;

/// The geometry that rays meet.
enum class RayMode : std::uint8_t {
  /// Facets of evaluated grids in a tree of boxes, then Newton on the surface: every hit that is not flagged lies on
  /// the surface. It shows what the tessellation shows, with true t, u, v and normals. Rays meet what loops keep of
  /// that. The facets decide what is met and in which order. A silhouette may be missed or flagged. If two surfaces lie
  /// nearer to each other than to their facets, the farther one may be returned.
  grid,
  /// The surface itself, of the control points in double. Every intersection is found, also at shared borders and
  /// poles. Silhouettes are found down to the tolerance. A returned hit lies within the tolerance of the ray; hits that
  /// are not flagged uncertified or edge are roots up to rounding. Rays meet what the loops of a trimmed face keep;
  /// where a loop may pass on either side of a root, the hit is uncertified.
  ///
  /// Between the faces of a shape there may be slits along edges. In sets that are made of a shape or of a model with
  /// instances, no ray slips through them: within an edge's gap, the edge itself is a hit (HitFlags::edge), unless the
  /// ray begins there. Other rays meet faces alone, those of a closed shell an even number of times. The gap is twice
  /// what samples show, not proven.
  ///
  /// Pieces of patches lie in a tree of boxes. Interval Newton steps in float search each piece; where these prove
  /// nothing, branch and bound in double does. Every rounding is bounded, also for far origins.
  exact,
};

/// How a scene is made.
struct RaySceneOptions {
  RayMode mode = RayMode::exact;  ///< the geometry that rays meet
  int rate = 8;                   ///< grid mode: grid segments per patch and direction, 1 to 4096
  bool refine = true;             ///< grid mode: false leaves hits on the facets (for comparison)
  std::optional<Isa> isa = {};    ///< default_isa() if empty; hits of exact mode are equal on all, up to rounding
  /// Exact mode: the minimum number of pieces per patch and direction, 1, 2, 4 or 8. Patches that are bent, twisted or
  /// much longer than wide are cut into more, up to 64 per direction, by their own shape alone.
  int pieces = 1;
  /// Exact mode: how far a returned point may lie from the ray, in the model's unit, above 0.
  ///
  /// It matters where the ray touches the surface or passes a border: there, points within the tolerance may be hits.
  /// By default 2e-12 of the set's size. The minimum is twice the bound on rounding; smaller values are raised to it.
  /// That is at most 2e-12 of the size for bicubic patches and 9e-12 at degree 15; a third more after edits.
  std::optional<double> tolerance = {};
  /// Exact mode: replaces the set's box wherever the scene's size and centre matter. It must contain the set's box,
  /// also after edits. By default the set's box.
  ///
  /// Parts of a model can each have their own scene with the model's box and otherwise equal options. They return the
  /// numbers of the scene of the whole model, to the last bit: the nearest of their closest hits is its closest hit. A
  /// flag may be missing: `uncertified`, where a neighbour in another part makes a hit unsure.
  std::optional<Box3> box = {};
  /// Exact mode: the number of patches, the first ones of the set, that rays can hit. By default all.
  ///
  /// The patches after them are neighbours: they decide where a point at a border belongs and are never hit. If each
  /// part of a model also has the patches of other parts that share borders and corners with it, then the parts
  /// together return each hit of the whole model once, also in all().
  std::optional<std::size_t> patches = {};
  /// Exact mode. True: builds for refitting now. False: the first refit is a rebuild. Rays take about a fifth longer in
  /// a scene built for refitting.
  bool editable = false;
  /// Exact mode: whether edges of shapes are hits, where rays pass them within their gap. If false, rays meet faces
  /// alone.
  bool edges = true;
  int rebuild_after = 0;  ///< exact mode: n makes every n-th refit a rebuild; 0: none, 1: all
};

class RayScene;

/// A scene placed elsewhere by an affine map, which may mirror and scale differently by direction. Its condition number
/// is at most 1e8.
struct RayInstance {
  const RayScene* scene = nullptr;  ///< a scene of patches in exact mode
  Affine to_world = {};             ///< from the scene's coordinates to the world's
  /// Rays with masks (RayViews::mask) meet the instance where both masks have a bit in common; other rays have all
  /// bits.
  std::uint32_t mask = ~std::uint32_t{0};
};

/// A patch set prepared for rays.
///
/// Memory: a set that the scene does not keep itself must outlive it (it may be moved), because the scene refers to the
/// set's inner state. After an edit of the set the scene is stale until refit() or rebuild(), and its queries fail.
///
/// Threads: const calls from any number of threads; edits of the set, refit and rebuild exclude them and each other.
class RayScene {
 public:
  /// Makes a scene of a set's patches.
  ///
  /// Errors: invalid_argument (the rate, the pieces, the tolerance, the box, more patches than the set has,
  /// rebuild_after), isa_unavailable, cancelled, out_of_memory, internal (Embree's own), and:
  /// - grid mode: unsupported (no float Bernstein blocks; a box with a diagonal below 1e-9 or reaching further than
  ///   1e12 from the set's origin; more than 2^32 grid points)
  /// - exact mode: unsupported (a diagonal outside of 1e-140 to 1e140; 2^32 pieces)
  ///
  /// Memory: memory_bytes(), and 128 bytes per patch more while the scene is made.
  static Result<RayScene> make(const PatchSet& set, const RaySceneOptions& options = {},
                               const Execution& execution = {});
  /// Makes a scene that keeps the set itself, for sets that are not edited. Errors: as above, with the set as it was.
  static Result<RayScene> make(PatchSet&& set, const RaySceneOptions& options = {}, const Execution& execution = {});
  /// Makes a scene of a model in one call. Errors: as above; those of make_patch_set(); the first of
  /// PatchSet::trim_faults(), for loops that cannot be used (index = the surface).
  static Result<RayScene> make(const Model& model, const RaySceneOptions& options = {},
                               const Execution& execution = {});

  /// Makes a scene in grid mode whose facets are the triangles and quads of a mesh of the set with
  /// VertexParameters::patch, such as one that keeps a tolerance. Only the options `refine` and `isa` are used.
  ///
  /// Errors: those of grid mode, and:
  /// - invalid_argument (no patch for each face, or no parameters for each vertex, as where vertices are shared;
  ///   another origin than the set's)
  /// - non_finite (index = the vertex: a position or a parameter)
  /// - invalid_argument (index = the vertex or the face: parameters outside of [0, 1], an index that is no vertex, a
  ///   patch that the set does not have)
  ///
  /// Memory: the mesh is used where it lies. It must stay there and may change only between an edit and the refit of
  /// the set. Its positions are copied if their vector has no capacity for one more number.
  static Result<RayScene> make(const PatchSet& set, const Mesh& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {});
  /// Deleted: the set and the mesh must outlive the scene.
  static Result<RayScene> make(const PatchSet& set, Mesh&& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {}) = delete;
  static Result<RayScene> make(PatchSet&& set, const Mesh& mesh, const RaySceneOptions& options = {},
                               const Execution& execution = {}) = delete;

  /// Makes a scene of instances of one scene or several, which must outlive it (they may be moved).
  ///
  /// Hits: position, normal and residual are in the world; surface, patch and parameters are those of the instance's
  /// scene. Normals are along r_u x r_v there, so on the other side in an instance that is mirrored.
  ///
  /// Accuracy: the guarantees of exact mode hold for the ray as mapped back into an instance's coordinates, in double.
  /// All patches of an instance see the same mapped ray, so nothing leaks between them.
  ///
  /// - The map rounds the ray by 1e-15 times its condition number times the instance's size, however far away the ray's
  ///   origin is; tnear and tfar hold to the last digit.
  /// - The residual is the distance from the original ray.
  /// - The tolerance is that of the instance's scene, a length there.
  /// - Nothing is guaranteed where borders of two instances meet.
  ///
  /// After a refit of one of the scenes, this scene is stale until its own refit(), which is always a rebuild, but only
  /// of the boxes of instances.
  ///
  /// Errors, index = the first such instance: invalid_argument (no scene; a map that is nearly singular), non_finite (a
  /// map), unsupported (a scene in grid mode or of instances; sizes outside of 1e-140 to 1e140), stale (a scene).
  /// Without index: invalid_argument (no instance), cancelled, out_of_memory, internal (Embree's own).
  static Result<RayScene> make(std::span<const RayInstance> instances, const Execution& execution = {});

  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// Finds the closest hit of each ray. hits.size() >= rays.size(). An invalid ray is a miss with HitKind::invalid_ray.
  ///
  /// Errors: buffer_too_small, stale (the set was edited: refit), cancelled, out_of_memory. Memory: allocates nothing,
  /// except for the first ray with a spawn_offset after a build or a refit, which looks for the borders that patches
  /// share.
  Status closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution = {}) const;
  /// Writes 1 where anything lies on the ray, and 0 where nothing does or the ray is invalid. `occluded` must hold at
  /// least rays.size() values. In grid mode the facets decide, not the surface: a ray that leaves the surface must
  /// begin further away than the facets lie. Errors: as closest().
  Status occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, const Execution& execution = {}) const;
  /// Finds all hits of each ray, in exact mode. An invalid ray has none.
  ///
  /// A point that several pieces or neighbours share is one hit. Two points are one where they coincide on a patch or
  /// at a shared border, not where they are merely near in t.
  ///
  /// Errors, with empty lists: unsupported (grid mode), stale, cancelled, out_of_memory. Memory: that of `lists` is
  /// reused; the first call after a build or a refit looks for the borders that patches share.
  Status all(std::span<const Ray> rays, HitLists& lists, const Execution& execution = {}) const;
  /// Finds the closest hit of one ray. A stale scene, as any error, returns HitKind::invalid_ray.
  Hit closest(const Ray& ray) const;
  /// Whether anything lies on one ray: hit or miss. An invalid ray and any error, such as a stale scene, return
  /// HitKind::invalid_ray.
  HitKind occluded(const Ray& ray) const;

  /// Updates the scene after edits of the set, however they were made. Between an edit and the refit all queries are
  /// errors. Does nothing if nothing was edited.
  ///
  /// Exact mode: makes the pieces of the edited patches anew, cut as they were, and refits the BVH. Its boxes overlap
  /// more the further patches have moved, so rays take longer until a rebuild. Grid mode always rebuilds. Exact mode
  /// rebuilds where the set's box has left the range that coordinates are scaled to, at most twice or half as large.
  ///
  /// Errors: as make(); the scene is then stale until a refit or a rebuild succeeds.
  Status refit(const Execution& execution = {});
  /// Makes all pieces or grids and the BVH anew. Errors: as refit().
  Status rebuild(const Execution& execution = {});

  /// Returns how far a hit's position may lie from its surface through rounding: the Ray::spawn_offset of secondary
  /// rays. It does not hold for hits with `unrefined` or with flags of grid mode; for hits with `edge` add the edge's
  /// gap.
  double spawn_offset() const;
  /// Returns the curvatures at a hit of this scene, by the parameters of the patch; in a scene of instances those of
  /// the surface as placed in the world. Errors: stale, invalid_argument (not a hit; no such patch, point or instance),
  /// non_finite (the point).
  Result<LocalGeometry> local_geometry(const Hit& hit) const;
  /// Returns the point (u,v) in [0,1]^2 of a patch as a hit with t and residual 0: completes a hit that came through
  /// the user's own Embree scene. Errors: stale, invalid_argument (no such patch or point), non_finite (the point),
  /// unsupported (instances).
  Result<Hit> resolve(std::uint32_t patch, double u, double v) const;
  /// Returns the root next to (u,v), with all the digits of double, for a ray that is known to meet the patch near
  /// there, for example in float.
  ///
  /// If there is no root within the tolerance, the hit is unrefined: the point nearest to the ray that was found. tnear
  /// and tfar are ignored. Errors: stale, invalid_argument (no such patch or point; the ray), non_finite (the point),
  /// unsupported (instances; grid mode).
  Result<Hit> resolve(const Ray& ray, std::uint32_t patch, double u, double v) const;

  /// Returns the gap of each edge of the set's shapes, of the first instance's shape, then the next: within this
  /// distance, rays meet it. 0 where whole patches share the bits of their border, and along edges of one face. Empty
  /// for sets without edges, in grid mode, and for instances. Errors: stale, out_of_memory. Memory: 8 bytes per edge.
  Result<std::vector<double>> edge_gaps() const;
  /// Returns the box of the facets, or of what loops keep of the pieces' nets; empty while stale.
  Box3 box() const;
  std::uint64_t revision() const;  ///< the set's, when the scene was made or last refitted
  /// Returns the bytes of grids or nets, and BVH; for instances without those of their scenes.
  std::size_t memory_bytes() const;

  class [[gnu::visibility("hidden")]] Impl;

 private:
  friend struct ImplAccess;
  explicit RayScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Rays as arrays: ray k has record k of each view. Ranges and units are those of Ray.
///
/// There are as many rays as `direction` has records. The other views hold at least as many; or they have stride 0, and
/// their record 0 belongs to all rays, such as the eye of a camera. Numbers are converted to double, which is exact.
template <class T>
struct RayViews {
  View3<const T> origin = {}, direction = {};  ///< required
  View1<const T> tnear = {};                   ///< empty: 0
  View1<const T> tfar = {};                    ///< empty: infinity
  View1<const T> spawn_offset = {};            ///< empty: 0
  /// A ray meets an instance where their masks have a bit in common; scenes without instances ignore it. Empty: all
  /// bits.
  View1<const std::uint32_t> mask = {};
};

/// Hits as arrays: record k of each view is written for ray k. Units are those of Hit, whose double numbers are rounded
/// to T. Positions are in the model's coordinates, also in float.
///
/// Empty views are not computed; t, parameters and indices alone need no point of the surface. A miss or an invalid ray
/// gets t = infinity, `no_hit` for each index, no flag except `incomplete`, and 0 elsewhere.
template <class T>
struct HitViews {
  /// The index of a patch, surface or instance where there is none.
  static constexpr std::uint32_t no_hit = std::numeric_limits<std::uint32_t>::max();
  View1<HitKind> kind = {};                               ///< hit, miss or invalid_ray
  View1<T> t = {};                                        ///< in [tnear, tfar], where these are numbers of T
  View1<T> u = {}, v = {};                                ///< in the surface's domain
  View1<T> patch_u = {}, patch_v = {};                    ///< in the patch, [0,1]^2
  View1<std::uint32_t> patch = {}, surface = {};          ///< as in Hit
  View1<std::uint32_t> instance = {};                     ///< as in Hit; no_hit in scenes of patches
  View3<T> position = {}, normal = {}, du = {}, dv = {};  ///< as in Hit
  View1<T> residual = {};                                 ///< as in Hit
  View1<HitFlags> flags = {};  ///< as in Hit; one depends on the normal, which is then computed
};

/// A point where a ray meets a surface, before it counts as a hit.
struct HitCandidate {
  std::size_t ray = 0;                            ///< index in the batch
  std::uint32_t instance = Hit::no_instance;      ///< as in Hit
  std::uint32_t surface = 0, patch = 0;           ///< as in Hit
  double t = 0;                                   ///< as in Hit
  double u = 0, v = 0, patch_u = 0, patch_v = 0;  ///< as in Hit
};

/// A filter's answer. Any other value stops the batch.
enum class HitVerdict : std::uint8_t {
  accept,  ///< the point may be the hit
  reject,  ///< the ray goes on as if the surface had a hole there
  stop,    ///< the batch ends
};

/// Decides which points count, for example for cut-outs by a texture or layers that a ray does not see.
///
/// The points of a ray come in any order, and not all of them: for closest hits only those that would be nearer than
/// all accepted ones. A point at the border of two patches, or of two pieces of one, may come once for each.
///
/// Threads: called from any thread, also from several at once. A filter may trace rays and may throw; see closest().
using HitFilter = std::function<HitVerdict(const HitCandidate&)>;

/// How closest() and occluded() treat arrays of rays.
struct BatchOptions {
  HitFilter filter = {};  ///< exact mode only; empty: all points count
};

/// Finds the closest hit of each ray: that of RayScene::closest() for the same numbers in double, bit for bit.
///
/// Consecutive coherent rays are traced in packets. An invalid ray is a miss with HitKind::invalid_ray. Without rays no
/// view is read, checked or written.
///
/// Errors, with nothing written:
/// - count_mismatch (a view of rays with fewer records than `direction`)
/// - buffer_too_small (an output with fewer records than `direction`)
/// - invalid_argument (no output; a view that lacks a component, is misaligned, or has a stride below 0, below 1 for an
///   output; an output that shares memory with another view)
/// - unsupported (a filter in grid mode), stale
///
/// Errors that leave outputs partly written: cancelled (by `execution`, or by the filter: index = the ray),
/// out_of_memory, and the exception of a filter (internal with its message, or out_of_memory).
/// Memory: allocates nothing, except for borders as RayScene::closest(). Threads: as RayScene.
Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<float>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<double>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<float>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<double>& hits,
               const BatchOptions& options = {}, const Execution& execution = {});

/// Writes 1 where anything lies on the ray, and 0 where nothing does or the ray is invalid, as RayScene::occluded().
/// The output is required. Errors, memory and threads: as closest().
Status occluded(const RayScene& scene, const RayViews<float>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options = {}, const Execution& execution = {});
Status occluded(const RayScene& scene, const RayViews<double>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options = {}, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
