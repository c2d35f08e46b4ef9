#pragma once
// The calls in which Embree 3.13 and 4 differ, behind one interface, for the files of this floor that call Embree.

#include "tessera/ray_embree.h"

namespace tessera { inline namespace abi_0_1 {

enum class Coherence { incoherent, coherent };

/// Empties the interval of each inactive lane. On machines without AVX-512, Embree 3.13 traces 16-wide packets as
/// narrower ones and ignores their `valid`; on all machines it skips a ray with tnear > tfar.
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

/// Copies the context's instances into a hit; in Embree 4.1 and later also the index in an instance array.
inline void set_instances(const EmbreeContext& context, RTCHit& hit) {
  for (unsigned level = 0; level < RTC_MAX_INSTANCE_LEVEL_COUNT; ++level) {
    hit.instID[level] = context.instID[level];
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
    hit.instPrimID[level] = context.instPrimID[level];
#endif
  }
}

}}  // namespace tessera::abi_0_1
