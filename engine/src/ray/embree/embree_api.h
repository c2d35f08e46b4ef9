#pragma once
// Embree 3.13 and 4 as one: what the two call differently. For the files of this floor that speak to Embree.

#include "tessera/ray_embree.h"

namespace tessera::inline abi_0_1 {

enum class Coherence { incoherent, coherent };

/// Empties the interval of each inactive lane. Embree 3.13 ignores `valid` of 16-wide packets on machines without AVX-512,
/// where it traces them as narrower ones; it skips a ray with tnear > tfar on all.
inline void empty_inactive_lanes(const int* valid, RTCRay16& rays) {
  for (unsigned k = 0; k < 16; ++k)
    if (valid[k] == 0) rays.tnear[k] = 1, rays.tfar[k] = 0;
}

#if RTC_VERSION_MAJOR < 4

using EmbreeContext = RTCIntersectContext;

inline EmbreeContext embree_context() {
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  return context;
}

inline void set_coherence(EmbreeContext& context, Coherence coherence) {
  context.flags =
      coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}

inline void intersect(RTCScene scene, EmbreeContext& context, Coherence coherence, RTCRayHit& ray) {
  set_coherence(context, coherence);
  rtcIntersect1(scene, &context, &ray);
}
inline void intersect(RTCScene scene, EmbreeContext& context, Coherence coherence, const int* valid,
                      RTCRayHit16& rays) {
  set_coherence(context, coherence);
  empty_inactive_lanes(valid, rays.ray);
  rtcIntersect16(valid, scene, &context, &rays);
}
inline void occluded(RTCScene scene, EmbreeContext& context, Coherence coherence, RTCRay& ray) {
  set_coherence(context, coherence);
  rtcOccluded1(scene, &context, &ray);
}
inline void occluded(RTCScene scene, EmbreeContext& context, Coherence coherence, const int* valid, RTCRay16& rays) {
  set_coherence(context, coherence);
  empty_inactive_lanes(valid, rays);
  rtcOccluded16(valid, scene, &context, &rays);
}

inline void filter_hit(const RTCIntersectFunctionNArguments* of, const RTCFilterFunctionNArguments* with) {
  rtcFilterIntersection(of, with);
}
inline void filter_hit(const RTCOccludedFunctionNArguments* of, const RTCFilterFunctionNArguments* with) {
  rtcFilterOcclusion(of, with);
}

#else

using EmbreeContext = RTCRayQueryContext;

inline EmbreeContext embree_context() {
  EmbreeContext context;
  rtcInitRayQueryContext(&context);
  return context;
}

inline RTCRayQueryFlags flags_of(Coherence coherence) {
  return coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
inline RTCIntersectArguments intersect_arguments(EmbreeContext& context, Coherence coherence) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = flags_of(coherence);
  arguments.context = &context;
  return arguments;
}
inline RTCOccludedArguments occluded_arguments(EmbreeContext& context, Coherence coherence) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = flags_of(coherence);
  arguments.context = &context;
  return arguments;
}

inline void intersect(RTCScene scene, EmbreeContext& context, Coherence coherence, RTCRayHit& ray) {
  RTCIntersectArguments arguments = intersect_arguments(context, coherence);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect(RTCScene scene, EmbreeContext& context, Coherence coherence, const int* valid,
                      RTCRayHit16& rays) {
  RTCIntersectArguments arguments = intersect_arguments(context, coherence);
  empty_inactive_lanes(valid, rays.ray);
  rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void occluded(RTCScene scene, EmbreeContext& context, Coherence coherence, RTCRay& ray) {
  RTCOccludedArguments arguments = occluded_arguments(context, coherence);
  rtcOccluded1(scene, &ray, &arguments);
}
inline void occluded(RTCScene scene, EmbreeContext& context, Coherence coherence, const int* valid, RTCRay16& rays) {
  RTCOccludedArguments arguments = occluded_arguments(context, coherence);
  empty_inactive_lanes(valid, rays);
  rtcOccluded16(valid, scene, &rays, &arguments);
}

inline void filter_hit(const RTCIntersectFunctionNArguments* of, const RTCFilterFunctionNArguments* with) {
  rtcInvokeIntersectFilterFromGeometry(of, with);
}
inline void filter_hit(const RTCOccludedFunctionNArguments* of, const RTCFilterFunctionNArguments* with) {
  rtcInvokeOccludedFilterFromGeometry(of, with);
}

#endif

/// Where in a hit the instances are told; in Embree 4.1 and later also which of an array.
inline void set_instances(const EmbreeContext& context, RTCHit& hit) {
  for (unsigned level = 0; level < RTC_MAX_INSTANCE_LEVEL_COUNT; ++level) {
    hit.instID[level] = context.instID[level];
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
    hit.instPrimID[level] = context.instPrimID[level];
#endif
  }
}

}  // namespace tessera::inline abi_0_1
