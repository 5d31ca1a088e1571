#include "octree/sphere_octree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_scan.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

namespace fluxel {

namespace {

/// So few references are one loop; more levels would take longer to go down.
constexpr std::uint32_t kFew = 8;

/// A cube is not halved where its children would hold more than so many times its references (Frolov et al.
/// 2014).
constexpr double kMostGrowth = 2.5;

/// Of references that are looked at on one level: more are left as they are, so that numbers of 32 bits hold.
constexpr std::size_t kMostOpen = std::size_t{1} << 30;

/// A sphere that reaches into a cube, in the order of a sort: the cube's number among those of its level,
/// then the sphere's.
using Reference = std::uint64_t;

std::uint32_t cube_of(Reference reference) { return static_cast<std::uint32_t>(reference >> 32); }
std::uint32_t sphere_of(Reference reference) { return static_cast<std::uint32_t>(reference); }

template <class Work>
void for_each(std::size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&work](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) work(k);
  });
}

/// Makes of each value the sum of those before it, and returns the sum of all.
std::uint32_t sum_before(std::vector<std::uint32_t>& values) {
  return tbb::parallel_scan(
      tbb::blocked_range<std::size_t>(0, values.size()), std::uint32_t{0},
      [&values](const auto& range, std::uint32_t sum, bool is_final) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
          const std::uint32_t value = values[k];
          if (is_final) values[k] = sum;
          sum += value;
        }
        return sum;
      },
      std::plus<>());
}

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};

  void add(const Sphere& sphere) {
    const glm::dvec3 centre(sphere.x, sphere.y, sphere.z);
    low = glm::min(low, centre - static_cast<double>(sphere.radius));
    high = glm::max(high, centre + static_cast<double>(sphere.radius));
  }
};

bool is_sphere(const Sphere& sphere) {
  return std::isfinite(sphere.x) && std::isfinite(sphere.y) && std::isfinite(sphere.z) &&
         std::isfinite(sphere.radius) && sphere.radius >= 0;
}

}  // namespace

/// From the cubes of a level to those of the next one, by passes over all references.
class SphereOctree::Pass {
 public:
  Pass(SphereOctree& tree, std::span<const Sphere> spheres)
      : tree_(tree), spheres_(spheres), cubes_(1), open_(spheres.size()) {
    for_each(open_.size(), [this](std::size_t k) { open_[k] = k; });
    tree_.nodes_.resize(1);
    find_ranges();
  }

  [[nodiscard]] bool is_done() const { return cubes_.empty(); }

  void run(int level) {
    test(level);
    const std::uint32_t divided = divide();
    keep_leaves();
    append(divided);
  }

 private:
  struct Cube {
    OctreePlace place{0, 0, 0};
    std::uint32_t first = 0, count = 0;  // in open_
  };

  /// Which children each reference goes on to.
  void test(int level) {
    met_.assign(open_.size(), 0);
    if (level == kOctreeLevels || open_.size() > kMostOpen) return;
    const OctreeView view = tree_.view();
    for_each(open_.size(), [&](std::size_t k) {
      const Cube& cube = cubes_[cube_of(open_[k])];
      if (cube.count > kFew)
        met_[k] =
            static_cast<std::uint8_t>(view.children_met(cube.place, level, spheres_[sphere_of(open_[k])]));
    });
  }

  /// Decides which cubes are divided, and returns how many.
  std::uint32_t divide() {
    rank_.resize(cubes_.size());
    for_each(cubes_.size(), [this](std::size_t c) {
      const Cube& cube = cubes_[c];
      std::uint64_t grown = 0;
      for (std::uint32_t k = cube.first; k < cube.first + cube.count; ++k)
        grown += static_cast<std::uint64_t>(std::popcount(met_[k]));
      rank_[c] = grown > 0 && static_cast<double>(grown) <= kMostGrowth * cube.count ? 1 : 0;
    });
    divided_.assign(rank_.begin(), rank_.end());
    return sum_before(rank_);
  }

  void keep_leaves() {
    std::vector<std::uint32_t> kept(cubes_.size());
    for_each(cubes_.size(), [&](std::size_t c) { kept[c] = divided_[c] != 0 ? 0 : cubes_[c].count; });
    const std::uint32_t all = sum_before(kept);
    const auto first_node = static_cast<std::uint32_t>(tree_.nodes_.size() - cubes_.size());
    const auto first_kept = static_cast<std::uint32_t>(tree_.references_.size());
    const auto next_node = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.references_.resize(first_kept + all);
    for_each(cubes_.size(), [&](std::size_t c) {
      const Cube& cube = cubes_[c];
      OctreeNode& node = tree_.nodes_[first_node + c];
      if (divided_[c] != 0) {
        node = {next_node + 8 * rank_[c], OctreeNode::kInner};
        return;
      }
      node = {first_kept + kept[c], cube.count};
      for (std::uint32_t k = 0; k < cube.count; ++k)
        tree_.references_[node.first + k] = sphere_of(open_[cube.first + k]);
    });
  }

  /// Children of what is divided, with their references.
  void append(std::uint32_t divided) {
    std::vector<std::uint32_t> place(open_.size());
    for_each(open_.size(), [&](std::size_t k) {
      place[k] = divided_[cube_of(open_[k])] != 0 ? static_cast<std::uint32_t>(std::popcount(met_[k])) : 0;
    });
    std::vector<Reference> next(sum_before(place));
    for_each(open_.size(), [&](std::size_t k) {
      const std::uint32_t cube = cube_of(open_[k]);
      if (divided_[cube] == 0) return;
      std::uint32_t at = place[k];
      for (std::uint32_t child = 0; child < 8; ++child)
        if ((met_[k] >> child & 1u) != 0)
          next[at++] = (Reference{8 * rank_[cube] + child} << 32) | sphere_of(open_[k]);
    });
    tbb::parallel_sort(next);
    std::vector<Cube> children(std::size_t{8} * divided);
    for_each(cubes_.size(), [&](std::size_t c) {
      if (divided_[c] == 0) return;
      for (std::uint32_t child = 0; child < 8; ++child)
        children[8 * rank_[c] + child].place = cubes_[c].place.child(child);
    });
    cubes_ = std::move(children);
    open_ = std::move(next);
    tree_.nodes_.resize(tree_.nodes_.size() + cubes_.size());
    find_ranges();
  }

  void find_ranges() {
    for_each(open_.size(), [this](std::size_t k) {
      if (k == 0 || cube_of(open_[k - 1]) != cube_of(open_[k]))
        cubes_[cube_of(open_[k])].first = static_cast<std::uint32_t>(k);
    });
    for_each(open_.size(), [this](std::size_t k) {
      Cube& cube = cubes_[cube_of(open_[k])];
      if (k + 1 == open_.size() || cube_of(open_[k + 1]) != cube_of(open_[k]))
        cube.count = static_cast<std::uint32_t>(k) + 1 - cube.first;
    });
  }

  SphereOctree& tree_;
  std::span<const Sphere> spheres_;
  std::vector<Cube> cubes_;        // of the level
  std::vector<Reference> open_;    // of its cubes, in their order
  std::vector<std::uint8_t> met_;  // of each reference: the children that it goes on to
  // Of each cube: whether it is divided, and how many are before it.
  std::vector<std::uint8_t> divided_;
  std::vector<std::uint32_t> rank_;
};

SphereOctree::SphereOctree(std::span<const Sphere> spheres, int threads) {
  if (!std::ranges::all_of(spheres, is_sphere))
    throw std::invalid_argument("a sphere of an octree is not finite, or its radius is below 0");
  Bounds bounds;
  for (const Sphere& sphere : spheres) bounds.add(sphere);
  if (!spheres.empty()) {
    const glm::dvec3 extent = bounds.high - bounds.low;
    const double largest = std::max({extent.x, extent.y, extent.z});
    const glm::dvec3 farthest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    const double magnitude = std::max({farthest.x, farthest.y, farthest.z, 1e-30});
    // A point on the upper faces lies inside too.
    margin_ = 1e-14 * magnitude;
    edge_ = largest * (1 + 1e-12) + 4 * margin_;
    low_ = bounds.low - margin_;
  }
  tbb::task_arena(threads).execute([&] {
    Pass pass(*this, spheres);
    for (int level = 0; !pass.is_done(); ++level) pass.run(level);
  });
}

}  // namespace fluxel
