#include "visibility/device_scene.hpp"

#include <bit>
#include <cstring>

namespace fluxel {

namespace {

template <class T, class Vec>
cuda::Vector<T> vector(const Vec& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

cuda::SceneArrays device_scene(const RayScene& ray_scene, std::span<const Element> elements) {
  const Scene& scene = ray_scene.scene();
  std::vector<cuda::ExactPatch> patches;
  patches.reserve(scene.patches.size());
  for (const Patch& patch : scene.patches) {
    cuda::ExactPatch& exact = patches.emplace_back();
    for (std::uint32_t c = 0; c < patch.outline.corners; ++c)
      exact.corner[c] = vector<double>(patch.outline.corner[c]);
    exact.normal = vector<double>(patch.normal);
    exact.corners = patch.outline.corners;
  }
  std::vector<cuda::End> ends;
  ends.reserve(elements.size());
  for (const Element& element : elements)
    ends.push_back({vector<float>(element.centroid), element.sides, vector<float>(element.normal), 0});
  return {patches, ends, static_cast<float>(scene.extent), ray_scene.surface_epsilon()};
}

TracedTile traced_tile(const cuda::TileResult& result, const cuda::TilePlace& place, std::size_t elements) {
  static_assert(cuda::kTile == kTileSize && sizeof(TileBits) == sizeof result.part);
  static_assert(std::endian::native == std::endian::little, "a word's parts stand lowest first");
  TracedTile tile;
  if (result.facing == 0) return tile;
  std::memcpy(tile.bits.data(), result.part, sizeof result.part);
  tile.rays = result.tested;
  complete_tile(place.row, place.column, elements, tile);
  return tile;
}

}  // namespace fluxel
