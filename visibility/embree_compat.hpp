#pragma once

// Embree 3.13 and 4 differ in their headers' folder and in how a query is called. Only ray_scene.cpp includes
// this.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <type_traits>

#include "visibility/untraceable_ray.hpp"

namespace fluxel::embree {

/// Below 0 where Embree does not take a ray's component: one beyond its FLT_LARGE, or NaN, whose bits are
/// larger numbers still. In whole numbers, whose signs can be collected without a branch for each.
inline std::int32_t room_of(float component) {
  constexpr auto kLargest = std::bit_cast<std::int32_t>(1.844e18f);
  return kLargest - (std::bit_cast<std::int32_t>(component) & 0x7FFFFFFF);
}

/// Every ray goes through here on its way to Embree. Throws UntraceableRay.
inline void require_traceable(const RTCRay& ray) {
  std::int32_t room = 0;
  for (const float component : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z})
    room |= room_of(component);
  if (room < 0 || std::isnan(ray.tfar)) throw UntraceableRay();
}

/// The same of a packet whose idle lanes hold rays too.
template <class Rays>
void require_traceable(const Rays& rays) {
  std::int32_t of_any = 0;
  for (std::size_t lane = 0; lane < std::extent_v<decltype(Rays::org_x)>; ++lane)
    of_any |= room_of(rays.org_x[lane]) | room_of(rays.org_y[lane]) | room_of(rays.org_z[lane]) |
              room_of(rays.dir_x[lane]) | room_of(rays.dir_y[lane]) | room_of(rays.dir_z[lane]);
  if (of_any < 0) throw UntraceableRay();
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

/// `trace` is rtcIntersect4, 8 or 16.
template <class Trace, class RayHits>
void intersect_filtered(Trace trace, const int* valid, RTCScene scene, RayHits& rays,
                        RTCRayQueryContext& context, RTCFilterFunctionN filter) {
  require_traceable(rays.ray);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  trace(valid, scene, &rays, &arguments);
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

template <class Trace, class RayHits>
void intersect_filtered(Trace trace, const int* valid, RTCScene scene, RayHits& rays, QueryContext& context,
                        RTCFilterFunctionN filter) {
  require_traceable(rays.ray);
  context.filter = filter;
  trace(valid, scene, &context, &rays);
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
