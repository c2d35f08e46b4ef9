#pragma once
// Puts the patches of a ray scene into the user's own Embree scene, beside other geometry. The only header that names
// Embree's types: for programs that link Embree themselves.
//
// Threads: const calls on the ray scene from any number of threads; calls that change a geometry or a scene of Embree's
// as Embree demands, one at a time.

#ifndef TESSERA_EMBREE_MAJOR
/// The major version that tessera::ray was built with; its CMake target defines it.
#define TESSERA_EMBREE_MAJOR 3
#endif
#if TESSERA_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "tessera/ray_scene.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Makes a user geometry of all patches of a scene in exact mode.
///
/// Result: the geometry, committed, with one reference, which the caller releases (rtcReleaseGeometry). It can be
/// attached, masked, instanced and given filter functions like any other; its user data, bounds and intersection
/// functions are in use.
///
/// Hits: t is the float nearest to the root's, in [tnear, tfar]; primID is the patch; (u,v) is the place in the patch,
/// [0,1]^2; Ng is the unit normal along r_u x r_v, in the object's space. RayScene::resolve() returns the rest.
///
/// Rays: single rays and packets. Each ray is traced in double as it stands in the object's space, in the ray scene's
/// own tree. The guarantees of exact mode hold for that ray, which Embree has transformed in float where the geometry
/// is instanced; the scene's tolerance is a length of that space.
///
/// - The geometry is one primitive of Embree's, with a box around the whole scene, so the user's scene need not be
///   robust. The box is wide enough for Embree's rounding of rays that begin within 40,000 sizes of the scene.
/// - Inactive lanes of a packet need tnear > tfar as well as valid = 0: Embree 3.13 ignores `valid` of 16-wide packets
///   on machines without AVX-512, whatever the geometry.
///
/// Filters: those of the geometry and of the context (in Embree 4 of the arguments) get each root of the scene, from
/// the nearest on, until one is accepted. A root at the border of two patches, or of two pieces of one, may come once
/// for each.
///
/// Errors: invalid_argument (no device), unsupported (grid mode; a box that reaches beyond 1.844e18, or with a diagonal
/// below 1e-15: Embree computes in float), stale, internal (Embree's own, which go to the device's error function).
///
/// Lifetime: the ray scene must outlive the geometry; it may be moved. While it is stale, rays meet none of its
/// patches.
Result<RTCGeometry> make_embree_geometry(const RayScene& scene, RTCDevice device);

/// Takes the new boxes of the ray scene and commits the geometry. Call it after a refit or rebuild of the ray scene and
/// before the user's own scenes are committed. Embree refits a geometry with RTC_BUILD_QUALITY_REFIT in a dynamic scene
/// of low quality. Errors: as make_embree_geometry().
Status update_embree_geometry(const RayScene& scene, RTCGeometry geometry);

/// Makes the geometry for the device of the scene `to`, attaches it and returns its id. The caller commits the scene.
/// Errors: as make_embree_geometry().
Result<unsigned> attach(const RayScene& scene, RTCScene to);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
