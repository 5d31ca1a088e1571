#pragma once

#include <algorithm>
#include <vector>

#include "octree/octree_builder.hpp"
#include "octree/octree_look_up.hpp"

namespace fluxel::cuda {

/// What runs an octree's passes by plain loops, in the order of a device: to test it. See OctreeBuilder.
class PlainLoops {
 public:
  template <class T>
  using Array = std::vector<T>;

  template <class T>
  [[nodiscard]] Array<T> array(std::size_t n) const {
    return Array<T>(n);
  }
  template <class T>
  void grow(Array<T>& items, std::size_t n) const {
    items.resize(n);
  }
  template <class Pass>
  void for_each(std::size_t n, const Pass& pass) const {
    for (std::size_t k = 0; k < n; ++k) pass(k);
  }
  template <class T>
  [[nodiscard]] T sum_before(Array<T>& values, std::size_t n) const {
    T sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const T value = values[k];
      values[k] = sum;
      sum += value;
    }
    return sum;
  }
  void sort(Array<OctreeReference>& references, std::size_t n, std::size_t /*cubes*/) const {
    std::stable_sort(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(n),
                     [](OctreeReference a, OctreeReference b) { return cube_of(a) < cube_of(b); });
  }
};

/// The tree that a device makes, by the same code on the host.
inline OctreeArrays octree_on_host(const std::vector<Sphere>& spheres) {
  PlainLoops loops;
  OctreeArrays tree;
  tree.frame = frame_of(spheres.data(), spheres.size());
  OctreeBuilder builder(loops, spheres.data(), spheres.size(), tree.frame);
  builder.build();
  tree.nodes = std::move(builder.nodes());
  tree.references = std::move(builder.references());
  return tree;
}

inline HoldingSpheres look_up_on_host(const OctreeView& tree, const std::vector<Sphere>& spheres,
                                      const std::vector<OctreePoint>& points) {
  PlainLoops loops;
  HoldingSpheres holding;
  const std::uint32_t count =
      look_up(loops, OctreeLookUp{tree, spheres.data(), points.data(), nullptr, nullptr}, points.size(),
              holding.first, holding.spheres);
  holding.first.push_back(count);
  return holding;
}

}  // namespace fluxel::cuda
