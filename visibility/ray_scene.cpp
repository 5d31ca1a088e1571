#include "visibility/ray_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "scene/contact_pairs.hpp"
#include "visibility/embree_compat.hpp"

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

/// How far along a ray from outside the scene begins, by its parameter: where it enters the ball around the
/// recentred origin with twice the scene's extent, which holds all patches. 0 for a ray from within, or
/// none where a ray passes the ball by. In double precision, so that a far origin costs no digits.
std::optional<double> entry_of_ray(const glm::dvec3& origin, const glm::dvec3& direction, double extent) {
  const double radius = 2 * extent;
  if (glm::dot(origin, origin) <= radius * radius) return 0;
  const double closest = -glm::dot(origin, direction) / glm::dot(direction, direction);
  const glm::dvec3 at = origin + closest * direction;
  const double square = radius * radius - glm::dot(at, at);
  if (square < 0 || closest < 0) return std::nullopt;
  return closest - std::sqrt(square) / glm::length(direction);
}

[[noreturn]] void throw_embree(const char* what, RTCError reason) {
  if (reason == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  const char* text =
      reason == RTC_ERROR_UNSUPPORTED_CPU ? "this processor is not supported" : "an internal error";
  throw std::runtime_error(fmt::format("Embree cannot {}: {} ({})", what, text, static_cast<int>(reason)));
}

/// The context first, so that Embree's pointer to it is a pointer to this.
struct HitCollector {
  embree::QueryContext context;
  std::vector<std::uint32_t> primitives;
};

void collect_and_go_on(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<HitCollector*>(arguments->context);
  collector->primitives.push_back(RTCHitN_primID(arguments->hit, arguments->N, 0));
  arguments->valid[0] = 0;
}

}  // namespace

struct RayScene::State {
  const Scene* scene = nullptr;
  float surface_epsilon = 0;
  std::vector<PatchId> patch_of_triangle;
  RTCDevice device = nullptr;
  RTCScene embree_scene = nullptr;
  int widest_packet = 4;  // that the processor traces at once

  ~State() {
    rtcReleaseScene(embree_scene);
    rtcReleaseDevice(device);
  }

  /// The context first, so that Embree's pointer to it is a pointer to this.
  struct PlaneCheck {
    embree::QueryContext context;
    const State* state;
  };

  /// Drops the hits of segments whose ends lie on one side of the patch's plane in double precision. Embree
  /// knows a plane to the rounding of corners as seen from the ray's origin, over the triangle's width: a
  /// sliver's plane tilts so much that elements on it would seem to lie behind it.
  static void keep_hits_between_ends(const RTCFilterFunctionNArguments* arguments) {
    const State& state = *reinterpret_cast<PlaneCheck*>(arguments->context)->state;
    const unsigned lanes = arguments->N;
    RTCRayN* ray = arguments->ray;
    for (unsigned k = 0; k < lanes; ++k) {
      if (arguments->valid[k] == 0) continue;
      const std::uint32_t triangle = RTCHitN_primID(arguments->hit, lanes, k);
      const Patch& patch = state.scene->patch(state.patch_of_triangle[triangle]);
      const glm::dvec3 origin(RTCRayN_org_x(ray, lanes, k), RTCRayN_org_y(ray, lanes, k),
                              RTCRayN_org_z(ray, lanes, k));
      const glm::dvec3 direction(RTCRayN_dir_x(ray, lanes, k), RTCRayN_dir_y(ray, lanes, k),
                                 RTCRayN_dir_z(ray, lanes, k));
      const double height = glm::dot(patch.normal, origin - patch.outline.corner[0]);
      const double end_height = height + glm::dot(patch.normal, direction);
      if ((height > 0) == (end_height > 0)) arguments->valid[k] = 0;
    }
  }

  template <class Trace, class Rays>
  [[nodiscard]] std::uint32_t trace_packet(Trace trace, const RayPacket& rays, int first, int count,
                                           Rays& query) const;

  [[nodiscard]] PatchHit exact_hit(std::uint32_t triangle, const glm::dvec3& origin,
                                   const glm::dvec3& direction) const {
    const PatchId id = patch_of_triangle[triangle];
    const Patch& patch = scene->patch(id);
    const double t =
        glm::dot(patch.normal, patch.outline.corner[0] - origin) / glm::dot(patch.normal, direction);
    return {id, t};
  }
};

/// Bits first ... first + count - 1 of the rays that meet something, by a packet of Embree's.
template <class Trace, class Rays>
std::uint32_t RayScene::State::trace_packet(Trace trace, const RayPacket& rays, int first, int count,
                                            Rays& query) const {
  constexpr int kWidth = sizeof query.org_x / sizeof query.org_x[0];
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
  PlaneCheck check{{}, this};
  embree::init(check.context);
  embree::occluded_filtered(trace, valid.data(), embree_scene, query, check.context, keep_hits_between_ends);
  std::uint32_t hidden = 0;
  for (int k = 0; k < count; ++k)
    if (query.tfar[k] < 0) hidden |= 1u << (first + k);
  return hidden;
}

RayScene::RayScene(const Scene& scene, int threads) : RayScene(scene, all_patches(scene), threads) {}

RayScene::RayScene(const Scene& scene, std::span<const PatchId> patches, int threads)
    : state_(std::make_unique<State>()) {
  state_->scene = &scene;
  // What counts as one plane when patches are cut must be one plane for rays too: else a patch that has taken
  // another's area may look out from behind it.
  state_->surface_epsilon =
      static_cast<float>(contact_tolerance(scene) + 4 * scene.extent * std::numeric_limits<float>::epsilon());
  // Embree's thread limit acts on the whole program, so it is always said.
  state_->device = rtcNewDevice(fmt::format("threads={}", threads).c_str());
  if (state_->device == nullptr) throw_embree("start", rtcGetDeviceError(nullptr));
  const auto has = [this](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(state_->device, property) != 0;
  };
  state_->widest_packet = has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
                          : has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                                           : 4;
  state_->embree_scene = rtcNewScene(state_->device);
  // Without ROBUST rays leak through the edges between patches.
  rtcSetSceneFlags(state_->embree_scene,
                   RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT | embree::kFilterFlag);

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
      const Outline<glm::dvec3>& outline = scene.patch(id).outline;
      for (std::uint32_t c = 0; c < outline.corners; ++c)
        for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(outline.corner[c][axis]);
      for (std::uint32_t c = 2; c < outline.corners; ++c) {
        *triangle++ = first;
        *triangle++ = first + c - 1;
        *triangle++ = first + c;
        state_->patch_of_triangle.push_back(id);
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
  const auto entry = entry_of_ray(origin, direction, state_->scene->extent);
  if (!entry) return {};
  RTCRayHit query{};
  query.ray = make_ray(origin + *entry * direction, direction, kFar);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(state_->embree_scene, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return state_->exact_hit(query.hit.primID, origin, direction);
}

void RayScene::all_hits(const glm::dvec3& origin, const glm::dvec3& direction, double t_max,
                        std::vector<PatchHit>& hits) const {
  const auto entry = entry_of_ray(origin, direction, state_->scene->extent);
  if (!entry || t_max < *entry) return;
  HitCollector collector;
  embree::init(collector.context);
  RTCRayHit query{};
  query.ray = make_ray(origin + *entry * direction, direction, static_cast<float>(t_max - *entry));
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect_filtered(state_->embree_scene, query, collector.context, collect_and_go_on);
  for (const std::uint32_t triangle : collector.primitives)
    hits.push_back(state_->exact_hit(triangle, origin, direction));
}

std::uint32_t RayScene::occluded(const RayPacket& rays, int count) const {
  std::uint32_t hidden = 0;
  for (int first = 0; first < count;) {
    const int left = count - first;
    // Narrow packets where the processor has no wider ones, or there is little to trace.
    const int width = left <= 4 ? 4 : std::min(left <= 8 ? 8 : 16, state_->widest_packet);
    const auto trace = [&]<class Rays>(auto how, Rays query) {
      return state_->trace_packet(how, rays, first, std::min(left, width), query);
    };
    hidden |= width == 16  ? trace(rtcOccluded16, RTCRay16{})
              : width == 8 ? trace(rtcOccluded8, RTCRay8{})
                           : trace(rtcOccluded4, RTCRay4{});
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
