#pragma once

// Embree 3.13 and 4 differ in their headers' folder and in how a query is called. Only ray_scene.cpp includes
// this.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace fluxel::embree {

// Packets are traced without the coherent flag: its frustum traversal in Embree 3.13.5 now and then did not
// end on packets with few active rays, and is no faster here.

#if RTC_VERSION_MAJOR >= 4

inline void intersect_filtered(RTCScene scene, RTCRayHit& ray, RTCRayQueryContext& context,
                               RTCFilterFunctionN filter) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &ray, &arguments);
}

/// `trace` is rtcOccluded4, 8 or 16.
template <class Trace, class Rays>
void occluded_filtered(Trace trace, const int* valid, RTCScene scene, Rays& rays, RTCRayQueryContext& context,
                       RTCFilterFunctionN filter) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  trace(valid, scene, &rays, &arguments);
}

using QueryContext = RTCRayQueryContext;
inline void init(QueryContext& context) { rtcInitRayQueryContext(&context); }
inline constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

#else

using QueryContext = RTCIntersectContext;
inline void init(QueryContext& context) { rtcInitIntersectContext(&context); }
inline constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void intersect_filtered(RTCScene scene, RTCRayHit& ray, QueryContext& context,
                               RTCFilterFunctionN filter) {
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
}

template <class Trace, class Rays>
void occluded_filtered(Trace trace, const int* valid, RTCScene scene, Rays& rays, QueryContext& context,
                       RTCFilterFunctionN filter) {
  context.filter = filter;
  trace(valid, scene, &context, &rays);
}

#endif

}  // namespace fluxel::embree
