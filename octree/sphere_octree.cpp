#include "octree/sphere_octree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_scan.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "octree/octree_builder.hpp"

namespace fluxel {

namespace {

/// Runs an octree's passes by the threads of the caller's arena: see OctreeBuilder.
class Threads {
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
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n), [&pass](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) pass(k);
    });
  }
  template <class T>
  [[nodiscard]] T sum_before(Array<T>& values, std::size_t n) const {
    return tbb::parallel_scan(
        tbb::blocked_range<std::size_t>(0, n), T{0},
        [&values](const auto& range, T sum, bool is_final) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) {
            const T value = values[k];
            if (is_final) values[k] = sum;
            sum += value;
          }
          return sum;
        },
        std::plus<>());
  }
  /// By their spheres, too, which are in that order: numbers that differ all need no stable sort.
  void sort(Array<OctreeReference>& references, std::size_t /*n*/, std::size_t /*cubes*/) const {
    tbb::parallel_sort(references);
  }
};

bool is_sphere(const Sphere& sphere) {
  return std::isfinite(sphere.x) && std::isfinite(sphere.y) && std::isfinite(sphere.z) &&
         std::isfinite(sphere.radius) && sphere.radius >= 0;
}

}  // namespace

SphereOctree::SphereOctree(std::span<const Sphere> spheres, int threads) {
  if (!std::ranges::all_of(spheres, is_sphere))
    throw std::invalid_argument("a sphere of an octree is not finite, or its radius is below 0");
  arrays_.frame = frame_of(spheres.data(), spheres.size());
  tbb::task_arena(threads).execute([&] {
    Threads machine;
    OctreeBuilder builder(machine, spheres.data(), spheres.size(), arrays_.frame);
    builder.build();
    arrays_.nodes = std::move(builder.nodes());
    arrays_.references = std::move(builder.references());
  });
}

}  // namespace fluxel
