#pragma once
// The patches of a ray scene in the user's own Embree scene, beside his geometry. The one header that names Embree's types:
// for those who link Embree themselves.

// The major version that tessera::ray was built with; its CMake target says so.
#ifndef TESSERA_EMBREE_MAJOR
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
namespace tessera::inline abi_0_1 {

/// A user geometry of all patches of a scene in exact mode, committed, with one reference, which the caller releases
/// (rtcReleaseGeometry). It is attached, masked, instanced and given filter functions like any other; its user data,
/// bounds and intersection functions are taken.
///
/// A hit: t is the float nearest to the root's, in [tnear, tfar]; primID is the patch, (u,v) the place in [0,1]^2 of it;
/// Ng is the unit normal along r_u x r_v, in the object's space. resolve() of the scene tells the rest.
/// Rays: single ones and packets. Each is traced in double as it stands in the object's space: what exact mode says holds
/// for that ray, which Embree has transformed in float where the geometry is instanced, and the scene's tolerance is a
/// length of that space. The user's scene must be robust (RTC_SCENE_FLAG_ROBUST): in others Embree's own boxes leak.
/// Inactive lanes of a packet need tnear > tfar beside valid = 0: Embree 3.13 ignores `valid` of 16-wide packets on machines
/// without AVX-512, whatever the geometry.
/// Filters, the geometry's and the context's (in Embree 4 the arguments'), see each root of a patch from the nearest on
/// until one is accepted, and a root at the border of two patches, or of two pieces of one, perhaps once for each.
///
/// The ray scene must outlive the geometry; it may be moved. While it is stale its patches are not met at all.
/// Errors: invalid_argument (no device), unsupported (grid mode; a box that reaches beyond 1.844e18, or with a diagonal
/// below 1e-15: Embree computes in float), stale; Embree's own go to the device's error function and are internal.
Result<RTCGeometry> make_embree_geometry(const RayScene& scene, RTCDevice device);

/// After a refit or rebuild of the ray scene, before the user's own scenes are committed: takes the new boxes and commits
/// the geometry. A geometry with RTC_BUILD_QUALITY_REFIT in a dynamic scene of low quality is refitted by Embree, unless
/// the ray scene was rebuilt. Errors: as above.
Status update_embree_geometry(const RayScene& scene, RTCGeometry geometry);

/// make_embree_geometry() for the scene's device, attached; the id. The scene is to be committed. Errors: as above.
Result<unsigned> attach(const RayScene& scene, RTCScene to);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
