#include "visibility/ray_scene.hpp"

#include <fmt/format.h>

#include <bit>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "visibility/cuda/ray.hpp"
#include "visibility/embree_compat.hpp"
#include "visibility/instruction_set.hpp"
#include "visibility/segment_lanes.hpp"
#include "visibility/segment_test.hpp"

namespace fluxel {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

std::vector<PatchId> all_patches(const Scene& scene) {
  std::vector<PatchId> patches(scene.patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) patches[i] = PatchId{static_cast<std::uint32_t>(i)};
  return patches;
}

RTCRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, float t_far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = t_far;
  ray.mask = 0xFFFFFFFFu;
  return ray;
}

/// Embree's thread limit acts on the whole program, so it is always said. The best instruction set Embree
/// finds for itself.
std::string device_settings(int threads) {
  const std::string in_use = instruction_set_in_use();
  const char* isa = in_use == name_of(Isa::avx2)   ? ",isa=avx2"
                    : in_use == name_of(Isa::sse4) ? ",isa=sse4.2"
                                                   : "";
  return fmt::format("threads={}{}", threads, isa);
}

[[noreturn]] void throw_embree(const char* what, RTCError reason) {
  if (reason == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  const char* text =
      reason == RTC_ERROR_UNSUPPORTED_CPU ? "this processor is not supported" : "an internal error";
  throw std::runtime_error(fmt::format("Embree cannot {}: {} ({})", what, text, static_cast<int>(reason)));
}

}  // namespace

struct RayScene::State {
  const Scene* scene = nullptr;
  float surface_epsilon = 0;
  std::vector<PatchId> patch_of_triangle;
  std::vector<TriangleCore> core_of_triangle;
  RTCDevice device = nullptr;
  RTCScene embree_scene = nullptr;
  int widest_packet = 4;  // that the processor traces at once

  ~State() {
    rtcReleaseScene(embree_scene);
    rtcReleaseDevice(device);
  }

  [[nodiscard]] const Patch& patch(std::uint32_t triangle) const {
    return scene->patch(patch_of_triangle[triangle]);
  }

  /// What a filter finds behind Embree's pointer to the context.
  struct Query : embree::QueryContext {
    const State* state;
    std::vector<std::uint32_t> triangles{};  // that collect_hits has met
    bool out_of_memory = false;              // nothing may be thrown through Embree

    explicit Query(const State& of) : state(&of) { embree::init(*this); }

    static Query& of(const RTCFilterFunctionNArguments* arguments) {
      return *static_cast<Query*>(arguments->context);
    }
  };

  /// Ray k of those that a filter is asked about, and the triangle that Embree proposes for it.
  struct Proposal {
    glm::dvec3 from, along;
    std::uint32_t triangle;

    Proposal(const RTCFilterFunctionNArguments* arguments, unsigned k)
        : from(RTCRayN_org_x(arguments->ray, arguments->N, k), RTCRayN_org_y(arguments->ray, arguments->N, k),
               RTCRayN_org_z(arguments->ray, arguments->N, k)),
          along(RTCRayN_dir_x(arguments->ray, arguments->N, k),
                RTCRayN_dir_y(arguments->ray, arguments->N, k),
                RTCRayN_dir_z(arguments->ray, arguments->N, k)),
          triangle(RTCHitN_primID(arguments->hit, arguments->N, k)) {}
  };

  // Embree proposes, segment_test decides, or who is sure of what it would say: near an edge Embree's answer
  // depends on the rays that share the packet, and it knows a sliver's plane so badly that elements on it
  // would seem to lie behind it.

  static void keep_met_by_segments(const RTCFilterFunctionNArguments* arguments) {
    const State& state = *Query::of(arguments).state;
    const unsigned count = arguments->N;
    std::uint32_t valid = 0;
    for (unsigned k = 0; k < count; ++k) valid |= arguments->valid[k] != 0 ? 1u << k : 0u;
    const SegmentLanes segments{&RTCRayN_org_x(arguments->ray, count, 0),
                                &RTCRayN_org_y(arguments->ray, count, 0),
                                &RTCRayN_org_z(arguments->ray, count, 0),
                                &RTCRayN_dir_x(arguments->ray, count, 0),
                                &RTCRayN_dir_y(arguments->ray, count, 0),
                                &RTCRayN_dir_z(arguments->ray, count, 0),
                                count};
    const Crossings crossings{&RTCHitN_u(arguments->hit, count, 0), &RTCHitN_v(arguments->hit, count, 0)};
    while (valid != 0) {
      const auto triangle_of = [&](unsigned k) { return RTCHitN_primID(arguments->hit, count, k); };
      const std::uint32_t triangle = triangle_of(static_cast<unsigned>(std::countr_zero(valid)));
      std::uint32_t asked = 0;  // nearly always all of them
      for (std::uint32_t left = valid; left != 0; left &= left - 1)
        if (triangle_of(static_cast<unsigned>(std::countr_zero(left))) == triangle) asked |= left & -left;
      std::uint32_t met = segments_surely_meet(state.core_of_triangle[triangle], segments, crossings, asked);
      if (met != asked) met |= segments_meet(state.patch(triangle), segments, asked & ~met);
      for (std::uint32_t left = asked & ~met; left != 0; left &= left - 1)
        arguments->valid[std::countr_zero(left)] = 0;
      valid &= ~asked;
    }
  }

  static void keep_met_by_rays(const RTCFilterFunctionNArguments* arguments) {
    const State& state = *Query::of(arguments).state;
    for (unsigned k = 0; k < arguments->N; ++k) {
      if (arguments->valid[k] == 0) continue;
      const Proposal ray(arguments, k);
      if (!ray_meets(state.patch(ray.triangle), ray.from, ray.along)) arguments->valid[k] = 0;
    }
  }

  static void collect_hits(const RTCFilterFunctionNArguments* arguments) {
    const Proposal ray(arguments, 0);
    Query& query = Query::of(arguments);
    if (ray_meets(query.state->patch(ray.triangle), ray.from, ray.along)) {
      try {
        query.triangles.push_back(ray.triangle);
      } catch (const std::bad_alloc&) {
        query.out_of_memory = true;
      }
    }
    arguments->valid[0] = 0;  // and go on
  }

  template <class Rays, class Trace>
  [[nodiscard]] std::uint32_t trace_packet(Trace trace, const RayPacket& rays, int first, int count) const;

  /// The first hit of a ray that Embree has traced, as `traced`, and proposes a triangle for without having
  /// asked a filter, which takes time: it is nearly always met.
  [[nodiscard]] PatchHit decided_hit(std::uint32_t proposed, const Ray& traced, const Ray& ray) const {
    return ray_meets(patch(proposed), traced.origin, traced.direction) ? exact_hit(proposed, ray)
                                                                       : filtered_hit(traced, ray);
  }
  [[nodiscard]] PatchHit filtered_hit(const Ray& traced, const Ray& ray) const;

  template <class RayHits, class Trace>
  void meet_packet(Trace trace, std::span<const Ray> rays, std::span<PatchHit> hits) const;

  /// How wide a packet so many rays are traced in: narrow where the processor has no wider ones, or there is
  /// little to trace.
  [[nodiscard]] int packet_width(std::size_t rays) const {
    return rays <= 4 ? 4 : std::min(rays <= 8 ? 8 : 16, widest_packet);
  }

  [[nodiscard]] PatchHit exact_hit(std::uint32_t triangle, const Ray& ray) const {
    return {patch_of_triangle[triangle], plane_parameter(patch(triangle), ray.origin, ray.direction)};
  }
};

/// Bits first ... first + count - 1 of the rays that meet something, by a packet of Embree's.
template <class Rays, class Trace>
std::uint32_t RayScene::State::trace_packet(Trace trace, const RayPacket& rays, int first, int count) const {
  Rays query{};
  constexpr auto kWidth = static_cast<int>(std::extent_v<decltype(Rays::org_x)>);
  alignas(64) std::array<int, kWidth> valid;
  for (int k = 0; k < kWidth; ++k) {
    valid[static_cast<std::size_t>(k)] = k < count ? -1 : 0;
    // Lanes without a ray hold copies of the first.
    const auto lane = static_cast<std::size_t>(k < count ? first + k : first);
    query.org_x[k] = rays.origin_x[lane];
    query.org_y[k] = rays.origin_y[lane];
    query.org_z[k] = rays.origin_z[lane];
    query.dir_x[k] = rays.direction_x[lane];
    query.dir_y[k] = rays.direction_y[lane];
    query.dir_z[k] = rays.direction_z[lane];
    query.tfar[k] = 1;
    query.mask[k] = 0xFFFFFFFFu;
    query.id[k] = static_cast<unsigned>(k);
  }
  Query filter(*this);
  embree::occluded_filtered(trace, valid.data(), embree_scene, query, filter, keep_met_by_segments);
  std::uint32_t hidden = 0;
  for (int k = 0; k < count; ++k)
    if (query.tfar[k] < 0) hidden |= 1u << (first + k);
  return hidden;
}

PatchHit RayScene::State::filtered_hit(const Ray& traced, const Ray& ray) const {
  RTCRayHit query{};
  query.ray = make_ray(traced.origin, traced.direction, kFar);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Query filter(*this);
  embree::intersect_filtered(embree_scene, query, filter, keep_met_by_rays);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? exact_hit(query.hit.primID, ray) : PatchHit{};
}

/// What each of the rays, at most as many as a packet of Embree's has, meets first.
template <class RayHits, class Trace>
void RayScene::State::meet_packet(Trace trace, std::span<const Ray> rays, std::span<PatchHit> hits) const {
  RayHits query{};
  constexpr std::size_t kWidth = std::extent_v<decltype(query.ray.org_x)>;
  alignas(64) std::array<int, kWidth> valid{};
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto& [origin, direction] = rays[k];
    const double entry = cuda::entry_of_ray(origin, direction, static_cast<float>(scene->extent));
    if (entry == kFar) continue;
    valid[k] = -1;
    const glm::vec3 from(origin + entry * direction), along(direction);
    query.ray.org_x[k] = from.x, query.ray.org_y[k] = from.y, query.ray.org_z[k] = from.z;
    query.ray.dir_x[k] = along.x, query.ray.dir_y[k] = along.y, query.ray.dir_z[k] = along.z;
    query.ray.tfar[k] = kFar;
    query.ray.mask[k] = 0xFFFFFFFFu;
    query.ray.id[k] = static_cast<unsigned>(k);
    query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
  }
  Query unfiltered(*this);
  embree::intersect_filtered(trace, valid.data(), embree_scene, query, unfiltered, nullptr);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const glm::dvec3 from(query.ray.org_x[k], query.ray.org_y[k], query.ray.org_z[k]);
    const glm::dvec3 along(query.ray.dir_x[k], query.ray.dir_y[k], query.ray.dir_z[k]);
    hits[k] = valid[k] != 0 && query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID
                  ? decided_hit(query.hit.primID[k], {from, along}, rays[k])
                  : PatchHit{};
  }
}

RayScene::RayScene(const Scene& scene, int threads) : RayScene(scene, all_patches(scene), threads) {}

RayScene::RayScene(const Scene& scene, std::span<const PatchId> patches, int threads)
    : state_(std::make_unique<State>()) {
  state_->scene = &scene;
  state_->surface_epsilon = fluxel::surface_epsilon(scene);
  state_->device = rtcNewDevice(device_settings(threads).c_str());
  if (state_->device == nullptr) throw_embree("start", rtcGetDeviceError(nullptr));
  const auto has = [this](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(state_->device, property) != 0;
  };
  state_->widest_packet = has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
                          : has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                                           : 4;
  state_->embree_scene = rtcNewScene(state_->device);
  // Without ROBUST rays leak through the edges between patches.
  rtcSetSceneFlags(state_->embree_scene, RTC_SCENE_FLAG_ROBUST | embree::kFilterFlag);

  std::size_t corners = 0;
  std::size_t triangles = 0;
  for (const PatchId id : patches) {
    corners += scene.patch(id).outline.corners;
    triangles += scene.patch(id).outline.corners - 2;
  }
  if (triangles > 0) {
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFu);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners));
    auto* triangle = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles));
    if (vertex == nullptr || triangle == nullptr) throw std::bad_alloc();
    std::uint32_t first = 0;
    for (const PatchId id : patches) {
      const Outline<glm::dvec3> outline = enlarged(scene.patch(id), scene.extent);
      for (std::uint32_t c = 0; c < outline.corners; ++c)
        for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(outline.corner[c][axis]);
      for (std::uint32_t c = 2; c < outline.corners; ++c) {
        *triangle++ = first;
        *triangle++ = first + c - 1;
        *triangle++ = first + c;
        state_->patch_of_triangle.push_back(id);
        state_->core_of_triangle.emplace_back(
            scene.patch(id), std::array{outline.corner[0], outline.corner[c - 1], outline.corner[c]},
            scene.extent);
      }
      first += outline.corners;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(state_->embree_scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(state_->embree_scene);
  if (const RTCError failed = rtcGetDeviceError(state_->device); failed != RTC_ERROR_NONE)
    throw_embree("build the ray scene", failed);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

PatchHit RayScene::first_hit(const glm::dvec3& origin, const glm::dvec3& direction) const {
  const double entry = cuda::entry_of_ray(origin, direction, static_cast<float>(state_->scene->extent));
  if (entry == kFar) return {};
  RTCRayHit query{};
  query.ray = make_ray(origin + entry * direction, direction, kFar);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  State::Query unfiltered(*state_);
  embree::intersect_filtered(state_->embree_scene, query, unfiltered, nullptr);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const Ray traced{{query.ray.org_x, query.ray.org_y, query.ray.org_z},
                   {query.ray.dir_x, query.ray.dir_y, query.ray.dir_z}};
  return state_->decided_hit(query.hit.primID, traced, {origin, direction});
}

void RayScene::first_hits(std::span<const Ray> rays, std::span<PatchHit> hits) const {
  while (!rays.empty()) {
    const int width = state_->packet_width(rays.size());
    const std::size_t count = std::min(rays.size(), static_cast<std::size_t>(width));
    const auto some = rays.first(count);
    if (width == 16)
      state_->meet_packet<RTCRayHit16>(rtcIntersect16, some, hits);
    else if (width == 8)
      state_->meet_packet<RTCRayHit8>(rtcIntersect8, some, hits);
    else
      state_->meet_packet<RTCRayHit4>(rtcIntersect4, some, hits);
    rays = rays.subspan(count);
    hits = hits.subspan(count);
  }
}

void RayScene::all_hits(const glm::dvec3& origin, const glm::dvec3& direction, double t_max,
                        std::vector<PatchHit>& hits) const {
  const double entry = cuda::entry_of_ray(origin, direction, static_cast<float>(state_->scene->extent));
  if (entry == kFar || t_max < entry) return;
  RTCRayHit query{};
  query.ray = make_ray(origin + entry * direction, direction, static_cast<float>(t_max - entry));
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  State::Query filter(*state_);
  embree::intersect_filtered(state_->embree_scene, query, filter, State::collect_hits);
  if (filter.out_of_memory) throw std::bad_alloc();
  for (const std::uint32_t triangle : filter.triangles)
    hits.push_back(state_->exact_hit(triangle, {origin, direction}));
}

std::uint32_t RayScene::occluded(const RayPacket& rays, int count) const {
  std::uint32_t hidden = 0;
  for (int first = 0; first < count;) {
    const int left = count - first;
    const int width = state_->packet_width(static_cast<std::size_t>(left));
    const int traced = std::min(left, width);
    hidden |= width == 16  ? state_->trace_packet<RTCRay16>(rtcOccluded16, rays, first, traced)
              : width == 8 ? state_->trace_packet<RTCRay8>(rtcOccluded8, rays, first, traced)
                           : state_->trace_packet<RTCRay4>(rtcOccluded4, rays, first, traced);
    first += width;
  }
  return hidden;
}

const Scene& RayScene::scene() const { return *state_->scene; }

float RayScene::surface_epsilon() const { return state_->surface_epsilon; }

std::string ray_engine_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

}  // namespace fluxel
