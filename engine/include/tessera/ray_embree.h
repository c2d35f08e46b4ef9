#pragma once
// Puts the patches of a ray scene into the user's own Embree scene, beside other geometry. The only header that names
// Embree's types: for programs that link Embree themselves. It is there if tessera::ray was built with Embree.
//
// Threads: const calls on the ray scene from any number of threads; calls that change a geometry or a scene of Embree's
// as Embree demands, one at a time.

#ifndef TESSERA_EMBREE_MAJOR
/// The major version that tessera::ray was built with, or 0; its CMake target defines it.
#define TESSERA_EMBREE_MAJOR 3
#endif
#if TESSERA_EMBREE_MAJOR == 0
#error \
    "This tessera::ray was built without Embree: build it with TESSERA_USE_EMBREE=ON, or trace its scenes by RayScene."
#elif TESSERA_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <span>

#include "tessera/execution.h"
#include "tessera/ray_hit.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The point of a patch that a ray leaves.
struct EmbreeOrigin {
  unsigned geometry = RTC_INVALID_GEOMETRY_ID;  ///< RTCHit::geomID; RTC_INVALID_GEOMETRY_ID: the ray leaves no patch
  unsigned patch = 0;                           ///< RTCHit::primID
  unsigned instance[RTC_MAX_INSTANCE_LEVEL_COUNT];  ///< RTCHit::instID; initially RTC_INVALID_GEOMETRY_ID
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
  unsigned instance_primitive[RTC_MAX_INSTANCE_LEVEL_COUNT];  ///< RTCHit::instPrimID
#endif
  double u = 0, v = 0;  ///< in the patch, [0,1]^2

  EmbreeOrigin();
  /// Takes the numbers of a hit of rtcIntersect1(), or of a lane (rtcGetHitFromHitN). A miss is no origin.
  explicit EmbreeOrigin(const RTCHit& hit);
};

#if TESSERA_EMBREE_MAJOR == 4
/// Embree's context of a query.
using EmbreeQueryContext = RTCRayQueryContext;
#else
/// Embree's context of a query.
using EmbreeQueryContext = RTCIntersectContext;
#endif

/// The context of a query whose rays leave patches. Pass its address to rtcIntersect and rtcOccluded, in Embree 4 in
/// their arguments. It may be a base of the user's own context.
///
/// Effect: in the geometry and instance that its origin names, a ray begins at that point of the patch in double,
/// whatever rounding has made of the ray's own origin, and it leaves the surfaces there as with Ray::spawn_offset. So
/// tnear can be 0, at any size, angle and border. To all other geometries the ray is as it stands. Its own origin must
/// be that point up to the rounding of float: a ray that goes on from elsewhere needs no origin, but a tnear.
///
/// - One origin is that of all rays of the call. Of several, RTCRay::id is the index; other ids have no origin.
/// - An origin that names no geometry, no patch of it, or parameters that are NaN or outside of [0,1] is ignored: the
///   ray is then one that leaves no patch. RayScene::resolve() returns an error for such numbers.
/// - The offset is RayScene::spawn_offset(), without the gap of an edge. So a ray that leaves a face at an edge of a
///   shape may meet another face beyond the edge's gap (RayScene::edge_gaps()).
/// - Plain contexts of Embree are never taken for this one. In Embree 3 a mark in RTCIntersectContext::flags tells
///   them apart, which only set_coherent() keeps. In Embree 4 EmbreeGeometryOptions::origins does.
///
/// Memory: the origins are used where they lie, and must stay there during the call. The first ray with an origin after
/// a build or a refit looks for the borders that patches share; if memory runs out, patches beside the origin's may be
/// hit at the origin. Threads: one call at a time, since Embree writes instances to the context.
struct EmbreeOriginContext : EmbreeQueryContext {
  std::span<const EmbreeOrigin> origins;  ///< one for all rays, or one for each RTCRay::id, or none

  /// `origins` may be empty, as in a query from the camera.
  explicit EmbreeOriginContext(std::span<const EmbreeOrigin> origins = {});
  /// For one ray, or several from one point. The origin must outlive the context.
  explicit EmbreeOriginContext(const EmbreeOrigin& origin);
  /// Deleted: the origin must outlive the context.
  explicit EmbreeOriginContext(EmbreeOrigin&&) = delete;
#if TESSERA_EMBREE_MAJOR != 4
  /// Sets RTC_INTERSECT_CONTEXT_FLAG_COHERENT or RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT, which is the initial value.
  void set_coherent(bool coherent);

 private:
  using EmbreeQueryContext::flags;
#endif
};

/// How a geometry is made.
struct EmbreeGeometryOptions {
  /// Embree 4 only, whose contexts have no flags: true if the context of each ray that may meet the geometry is an
  /// EmbreeOriginContext. If false, origins are ignored. Embree 3 ignores this option.
  bool origins = false;
};

/// Makes a user geometry of all patches of a scene in exact mode.
///
/// Result: the geometry, committed, with one reference, which the caller releases (rtcReleaseGeometry). It can be
/// attached, masked, instanced and given filter functions like any other; its user data, bounds and intersection
/// functions are in use.
///
/// Hits: t is the float nearest to the root's, in [tnear, tfar]; primID is the patch; (u,v) is the place in the patch,
/// [0,1]^2; Ng is the unit normal along r_u x r_v, in the object's space. resolve() returns the rest.
///
/// Rays: single rays and packets. Each ray is traced in double as it stands in the object's space, in the ray scene's
/// own tree. The guarantees of exact mode hold for that ray, which Embree has transformed in float where the geometry
/// is instanced; the scene's tolerance is a length of that space.
///
/// - The geometry is one primitive of Embree's, with a box around the whole scene, so the user's scene need not be
///   robust. The box is wide enough for Embree's rounding of rays that begin within 40,000 sizes of the scene.
/// - Rays that leave a patch need no offset: see EmbreeOriginContext.
/// - Inactive lanes of a packet need tnear > tfar as well as valid = 0: Embree 3.13 ignores `valid` of 16-wide packets
///   on machines without AVX-512, whatever the geometry.
///
/// Filters: those of the geometry and of the context (in Embree 4 of the arguments) get each root of the scene, from
/// the nearest on, until one is accepted. A root at the border of two patches, or of two pieces of one, may come once
/// for each.
///
/// Motion: patches stand still. With several time steps (rtcSetGeometryTimeStepCount) they are the same at each, and a
/// ray's time makes no difference. A whole scene moves as an instance, whose transforms Embree interpolates.
///
/// Point queries: rtcPointQuery() finds nothing here, without an error, since the geometry has no function for them.
///
/// Errors: invalid_argument (no device), unsupported (grid mode; a box that reaches beyond 1.844e18, or with a diagonal
/// below 1e-15: Embree computes in float), stale, internal (Embree's own, which go to the device's error function).
///
/// Lifetime: the ray scene must outlive the geometry; it may be moved. While it is stale, rays meet none of its
/// patches.
Result<RTCGeometry> make_embree_geometry(const RayScene& scene, RTCDevice device,
                                         const EmbreeGeometryOptions& options = {});

/// Takes the new boxes of the ray scene and commits the geometry. Call it after a refit or rebuild of the ray scene and
/// before the user's own scenes are committed. Embree refits a geometry with RTC_BUILD_QUALITY_REFIT in a dynamic scene
/// of low quality. Errors: as make_embree_geometry().
Status update_embree_geometry(const RayScene& scene, RTCGeometry geometry);

/// Makes the geometry for the device of the scene `to`, attaches it and returns its id. The caller commits the scene.
/// Errors: as make_embree_geometry().
Result<unsigned> attach(const RayScene& scene, RTCScene to, const EmbreeGeometryOptions& options = {});

/// Completes hits of Embree: hits[k] is the point of from[k] on its patch, in double, in the scene's own coordinates.
///
/// `geometry` is the id of the scene's geometry. hits.size() >= from.size(). A miss and a hit of another geometry
/// become a miss. The numbers are those of RayScene::resolve() for a point; t is that of Embree's ray, and
/// Hit::instance is RTCHit::instID of the innermost instance.
///
/// Errors, with nothing written: buffer_too_small, stale. Errors with the other hits written, index = the first such
/// hit: invalid_argument (no such patch or point), non_finite (the point), unsupported (a scene of instances). Errors
/// with some written: cancelled, out_of_memory. Threads: const; runs in the caller's arena.
Status resolve(const RayScene& scene, unsigned geometry, std::span<const RTCRayHit> from, std::span<Hit> hits,
               const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
