#pragma once

// Embree 3.13 and 4 differ in their headers' folder and in how a query is called. Only ray_scene.cpp includes
// this.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <initializer_list>
#include <span>

#include "visibility/untraceable_ray.hpp"

namespace fluxel::embree {

/// Whether Embree takes all of these components of rays, which must not exceed its FLT_LARGE; none of them
/// NaN. Without a branch for each: packets lose no time to it.
inline bool are_traceable(std::span<const float> components) {
  constexpr float kLargest = 1.844e18f;
  int traceable = 1;
  for (const float component : components) traceable &= static_cast<int>(std::abs(component) <= kLargest);
  return traceable != 0;
}

/// Every ray goes through here on its way to Embree. Throws UntraceableRay.
inline void require_traceable(const RTCRay& ray) {
  for (const float component : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z})
    if (!are_traceable(std::span(&component, 1))) throw UntraceableRay();
  if (std::isnan(ray.tfar)) throw UntraceableRay();
}

/// The same of a packet whose idle lanes hold rays too.
template <class Rays>
void require_traceable(const Rays& rays) {
  if (!(are_traceable(rays.org_x) && are_traceable(rays.org_y) && are_traceable(rays.org_z) &&
        are_traceable(rays.dir_x) && are_traceable(rays.dir_y) && are_traceable(rays.dir_z)))
    throw UntraceableRay();
}

// Packets are traced without the coherent flag: its frustum traversal in Embree 3.13.5 now and then did not
// end on packets with few active rays, and is no faster here.

#if RTC_VERSION_MAJOR >= 4

inline void intersect_filtered(RTCScene scene, RTCRayHit& ray, RTCRayQueryContext& context,
                               RTCFilterFunctionN filter) {
  require_traceable(ray.ray);
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
  require_traceable(rays);
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
  require_traceable(ray.ray);
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
}

template <class Trace, class Rays>
void occluded_filtered(Trace trace, const int* valid, RTCScene scene, Rays& rays, QueryContext& context,
                       RTCFilterFunctionN filter) {
  require_traceable(rays);
  context.filter = filter;
  trace(valid, scene, &context, &rays);
}

#endif

}  // namespace fluxel::embree
