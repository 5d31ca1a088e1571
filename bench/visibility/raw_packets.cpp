#include "bench/visibility/raw_packets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel::bench {

namespace {

bool is_unknown(const Element& element, float height) {
  return (element.sides & (height > 0 ? kFront : kBack)) != 0;
}

constexpr std::uint64_t kLanes = 16;

void add_ray(const glm::vec3& from, const glm::vec3& to, TilePackets& out) {
  const auto lane = static_cast<std::size_t>(out.rays % kLanes);
  if (lane == 0) out.packets.push_back({});
  RTCRay16& packet = out.packets.back();
  packet.org_x[lane] = from.x;
  packet.org_y[lane] = from.y;
  packet.org_z[lane] = from.z;
  packet.dir_x[lane] = to.x - from.x;
  packet.dir_y[lane] = to.y - from.y;
  packet.dir_z[lane] = to.z - from.z;
  packet.tfar[lane] = 1;
  packet.mask[lane] = 0xFFFFFFFFu;
  ++out.rays;
}

void add_triangles(RTCDevice device, RTCScene embree_scene, const Scene& scene) {
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> triangles;
  for (const Patch& patch : scene.patches) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t c = 0; c < patch.outline.corners; ++c) corners.emplace_back(patch.outline.corner[c]);
    for (std::uint32_t c = 2; c < patch.outline.corners; ++c)
      triangles.insert(triangles.end(), {first, first + c - 1, first + c});
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryMask(geometry, 0xFFFFFFFFu);
  std::ranges::copy(corners, static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
                                 geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                 corners.size())));
  std::ranges::copy(triangles, static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
                                   geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   3 * sizeof(std::uint32_t), triangles.size() / 3)));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_scene, geometry);
  rtcReleaseGeometry(geometry);
}

/// Coherent: Embree walks with the frustum of all rays. Not for packets with idle lanes, on which that walk
/// now and then did not end (3.13.5).
void occluded(const int* valid, RTCScene scene, RTCRay16& rays, bool coherent) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &rays, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
#endif
}

void add_pair(float lift, const Element& row, const Element& column, TilePackets& out) {
  if (row.patch == column.patch) return;
  const glm::vec3 separation = column.centroid - row.centroid;
  const float row_height = glm::dot(row.normal, separation);
  const float column_height = -glm::dot(column.normal, separation);
  if (std::min(std::abs(row_height), std::abs(column_height)) <= 2 * lift) return;
  if (!is_unknown(row, row_height) || !is_unknown(column, column_height)) return;
  add_ray(row.centroid + std::copysign(lift, row_height) * row.normal,
          column.centroid + std::copysign(lift, column_height) * column.normal, out);
}

}  // namespace

void pack_tile(float lift, std::span<const Element> elements, const TilePlace& place, std::size_t block,
               TilePackets& out) {
  out.packets.clear();
  out.rays = 0;
  const std::size_t first_row = place.first * kTileSize, first_column = place.second * kTileSize;
  const std::size_t rows = std::min(first_row + kTileSize, elements.size());
  const std::size_t columns = std::min(first_column + kTileSize, elements.size());
  const std::size_t width = block == 1 ? kTileSize : block;
  for (std::size_t r = first_row; r < rows; r += block)
    for (std::size_t c = first_column; c < columns; c += width)
      for (std::size_t i = r; i < std::min(r + block, rows); ++i)
        for (std::size_t j = std::max(c, i + 1); j < std::min(c + width, columns); ++j)
          add_pair(lift, elements[i], elements[j], out);
}

RawEmbree::RawEmbree(const Scene& scene, bool robust)
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  add_triangles(device_, scene_, scene);
  rtcCommitScene(scene_);
}

RawEmbree::~RawEmbree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

std::uint64_t RawEmbree::trace(TilePackets& tile, bool coherent) const {
  std::uint64_t seen = 0, left = tile.rays;
  alignas(64) std::array<int, kLanes> valid;
  valid.fill(-1);
  for (RTCRay16& packet : tile.packets) {
    const std::uint64_t count = std::min(left, kLanes);
    if (count < kLanes) std::fill(valid.begin() + static_cast<std::ptrdiff_t>(count), valid.end(), 0);
    occluded(valid.data(), scene_, packet, coherent && count == kLanes);
    for (std::uint64_t k = 0; k < count; ++k) seen += packet.tfar[k] >= 0 ? 1u : 0u;
    left -= count;
  }
  return seen;
}

}  // namespace fluxel::bench
