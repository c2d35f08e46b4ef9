/* Makes Open3D's rays hit where its Embree is the system's. Open3D 0.16 gives every ray the mask 0, since its own Embree
 * is built without masks; an Embree with masks, as Debian's, then lets the rays pass everything. This sets the masks:
 *   cc -O2 -shared -fPIC bench/python/open3d_ray_masks.c -o ray_masks.so
 *   LD_PRELOAD=$PWD/ray_masks.so PYTHONPATH=tools/python bench/python/peer_report.py
 */

#include <dlfcn.h>
#include <embree3/rtcore.h>

typedef void (*Intersect)(RTCScene, struct RTCIntersectContext*, struct RTCRayHit*, unsigned, size_t);

void rtcIntersect1M(RTCScene scene, struct RTCIntersectContext* context, struct RTCRayHit* rays, unsigned count,
                    size_t stride) {
  static Intersect next;
  if (!next) *(void**)&next = dlsym(dlopen("libembree3.so.3", RTLD_LAZY), "rtcIntersect1M");
  for (unsigned k = 0; k < count; ++k) ((struct RTCRayHit*)((char*)rays + k * stride))->ray.mask = ~0u;
  next(scene, context, rays, count, stride);
}
