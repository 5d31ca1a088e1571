#pragma once

#include "visibility/cuda/occluder_test.hpp"
#include "visibility/cuda/warp.hpp"

namespace fluxel::cuda {

FLUXEL_PORTABLE inline float power_of_two(int exponent) {
  const auto bits = static_cast<std::uint32_t>(exponent + 127) << 23;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

FLUXEL_PORTABLE inline Box child_box(const WideNode& node, std::uint32_t child) {
  Box box{};
  for (int axis = 0; axis < 3; ++axis) {
    const float unit = power_of_two(node.exponent[axis]);
    box.low[axis] = node.origin[axis] + unit * static_cast<float>(node.low[axis][child]);
    box.high[axis] = node.origin[axis] + unit * static_cast<float>(node.high[axis][child]);
  }
  return box;
}

FLUXEL_PORTABLE inline bool is_node(const WideNode& node, std::uint32_t child) {
  return (node.inner >> child & 1u) != 0;
}

FLUXEL_PORTABLE inline std::uint32_t child_node(const WideNode& node, std::uint32_t child) {
  return node.first_child + count_bits(node.inner & ((1u << child) - 1));
}

/// Of a leaf; 0 where there is no child.
FLUXEL_PORTABLE inline std::uint32_t patches_of(const WideNode& node, std::uint32_t child) {
  return is_node(node, child) ? 0u : node.patches[child] >> 5;
}

/// A segment or a ray as boxes see it.
struct Slabs {
  float origin[3], inverse[3];

  FLUXEL_PORTABLE Slabs(const Float3& from, const Float3& along)
      : origin{from.x, from.y, from.z}, inverse{1 / along.x, 1 / along.y, 1 / along.z} {}
};

/// Where a ray that ends at the parameter `far` enters the box; infinity only where it certainly misses it
/// (Ize, Robust BVH ray traversal, 2013: a far end that is moved by the rounding of three operations). Where
/// 0 times infinity is not a number, the origin lies in the box's widened face and the ray along it: missed,
/// as fmin and fmax leave out what is no number.
FLUXEL_PORTABLE inline float entry_of_box(const Slabs& slabs, const Box& box, float far) {
  float near = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = (box.low[axis] - slabs.origin[axis]) * slabs.inverse[axis];
    const float b = (box.high[axis] - slabs.origin[axis]) * slabs.inverse[axis];
    near = std::fmax(near, std::fmin(a, b));
    far = std::fmin(far, std::fmax(a, b));
  }
  return near <= far * (1 + 16 * kUlp) ? near : INFINITY;
}

/// Whether the segment meets any patch, by a walk of its own down the tree.
template <class Scene>
FLUXEL_PORTABLE bool is_occluded(const Scene& scene, const Float3& from, const Float3& along) {
  struct Siblings {
    std::uint32_t node;
    std::uint32_t left;  // children still to be looked at
  };
  Siblings stack[kMaxLevels];
  std::uint32_t size = 0;
  const Slabs slabs(from, along);
  const float ray_length = length(along);
  stack[size++] = {0, 0xFF};
  while (size > 0) {
    Siblings& top = stack[size - 1];
    if (top.left == 0) {
      --size;
      continue;
    }
    const std::uint32_t child = lowest_bit(top.left);
    top.left &= top.left - 1;
    const WideNode& node = scene.nodes[top.node];
    const bool inner = is_node(node, child);
    const std::uint32_t patches = patches_of(node, child);
    if (!inner && patches == 0) continue;
    scene.count(Work::box_of_ray);
    if (!(entry_of_box(slabs, child_box(node, child), 1) < INFINITY)) continue;
    if (inner) {
      stack[size++] = {child_node(node, child), 0xFF};
      continue;
    }
    const std::uint32_t first = node.first_patch + (node.patches[child] & 31u);
    for (std::uint32_t patch = first; patch < first + patches; ++patch) {
      const Occluder& occluder = scene.occluders[patch];
      const float farthest = length(occluder.centre - from) + occluder.radius;
      if (meets(scene, patch, from, along,
                margins(farthest, farthest + ray_length, ray_length, scene.extent)))
        return true;
    }
  }
  return false;
}

}  // namespace fluxel::cuda
