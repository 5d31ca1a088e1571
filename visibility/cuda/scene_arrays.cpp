#include "visibility/cuda/scene_arrays.hpp"

#include <algorithm>

#include "visibility/cuda/trace_group.hpp"
#include "visibility/cuda/wide_tree.hpp"

namespace fluxel::cuda {

namespace {

Occluder occluder_of(const ExactPatch& patch) {
  Occluder occluder{};
  Double3 middle{0, 0, 0};
  for (std::uint32_t c = 0; c < 4; ++c) {
    const Double3& corner = patch.corner[std::min(c, patch.corners - 1)];
    occluder.corner[c] = narrow(corner);
    if (c < patch.corners) middle = middle + 1.0 / patch.corners * corner;
  }
  occluder.normal = narrow(patch.normal);
  occluder.centre = narrow(middle);
  for (const Float3& corner : occluder.corner)
    occluder.radius = std::max(occluder.radius, length(corner - occluder.centre));
  occluder.corners = patch.corners;
  return occluder;
}

/// Of the ends [first, first + kGroup), those without sides left out.
GroupHull hull_of(const std::vector<End>& ends, std::size_t first, float lift) {
  GroupHull hull{};
  bool any = false;
  for (std::size_t k = first; k < first + kGroup; ++k) {
    if (ends[k].sides == 0) continue;
    for (std::uint32_t side = 0; side < 2; ++side) {
      const Float3 at = lifted(ends[k], side, lift);
      const float point[3] = {at.x, at.y, at.z};
      Box& box = hull.side[side];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = any ? std::min(box.low[axis], point[axis]) : point[axis];
        box.high[axis] = any ? std::max(box.high[axis], point[axis]) : point[axis];
      }
    }
    any = true;
  }
  return hull;
}

template <class Item>
std::size_t bytes_of(const std::vector<Item>& items) {
  return items.size() * sizeof(Item);
}

}  // namespace

SceneArrays::SceneArrays(const std::vector<ExactPatch>& patches, const std::vector<End>& elements,
                         float scene_extent, float ray_lift)
    : ends(elements), extent(scene_extent), lift(ray_lift) {
  const WideTree tree(patches, extent);
  nodes = tree.nodes;
  for (const std::uint32_t patch : tree.order) {
    exact.push_back(patches[patch]);
    exact.back().number = patch;
    occluders.push_back(occluder_of(patches[patch]));
  }
  ends.resize((ends.size() + kTile - 1) / kTile * kTile, End{});
  for (std::size_t first = 0; first < ends.size(); first += kGroup)
    hulls.push_back(hull_of(ends, first, lift));
}

TileScene SceneArrays::view() const {
  return {ends.data(),
          hulls.data(),
          occluders.data(),
          exact.data(),
          nodes.data(),
          static_cast<std::uint32_t>(ends.size() / kTile),
          static_cast<std::uint32_t>(exact.size()),
          extent,
          lift};
}

std::size_t SceneArrays::bytes() const {
  return bytes_of(ends) + bytes_of(hulls) + bytes_of(occluders) + bytes_of(exact) + bytes_of(nodes);
}

}  // namespace fluxel::cuda
